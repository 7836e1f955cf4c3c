// One result drawn by vtk.js: a body of points and cells whose coordinates and colours change in place.

import { pixelsPerMetre } from "./camera";
import type { Cells } from "./data";
import { Dots, spread } from "./dots";
import { findNeighbours, isCovered, stretchedRadii, type Neighbours } from "./neighbours";
import { vtkActor, vtkDataArray, vtkMapper, vtkOpenGLRenderWindow, vtkPoints, vtkPolyData, vtkRenderer, vtkRenderWindow, vtkSphereMapper } from "./vtk";

/** The undeformed body: points (x y z of each) and the cells between them. */
export interface Body {
  dimension: 2 | 3;
  spacing: number;
  positions: Float32Array;
  cells: { kind: Cells["kind"]; nodes: Uint32Array }[];
}

export type Rgb = [number, number, number];

// Radius (in spacings) of discs and spheres: they reach the middle of the square between four points of a lattice, so
// that a sheet, or the surface of a solid, has no gaps.
const RADIUS = 0.72;
// Of discs that lie in a line (CSS pixels).
const LEAST_RADIUS = 4;
// Where a full picture takes longer than this (ms), moving pictures show fewer and larger points.
const SLOW = 120;
const COARSE_POINTS = 20000;

export class Scene {
  readonly renderWindow = vtkRenderWindow.newInstance();
  readonly renderer = vtkRenderer.newInstance({ background: [1, 1, 1] });
  readonly glWindow = vtkOpenGLRenderWindow.newInstance();
  /** Deformed coordinates, colours and radii of all points, as they are on the screen. */
  readonly deformed: Float32Array;
  readonly rgba: Uint8Array;
  readonly radii: Float32Array;
  /** 1 where a point is to be seen. */
  readonly shown: Uint8Array;

  private readonly points = vtkPoints.newInstance();
  private readonly colours;
  private readonly mesh = vtkPolyData.newInstance();
  private readonly bare: Uint8Array;
  private readonly isLine: boolean;
  private readonly ghost: vtkActor;
  private readonly neighbours: Neighbours;
  private readonly dots: Dots;
  private coarse: Dots | null = null;
  private drawn = new Uint32Array();
  private stretchLimit = 1;
  private hidden = false;
  private slow = false;
  private height = 1; // of the picture, CSS pixels
  private grown = 1;

  constructor(
    readonly body: Body,
    container: HTMLElement,
  ) {
    const count = body.positions.length / 3;
    this.deformed = body.positions.slice();
    this.rgba = new Uint8Array(count * 4).fill(255);
    this.radii = new Float32Array(count);
    this.shown = new Uint8Array(count).fill(1);
    this.bare = bareMask(body);
    this.isLine = isLine(body);
    this.neighbours = findNeighbours(body.positions, 1.3 * body.spacing);
    this.points.setData(this.deformed, 3);
    this.colours = vtkDataArray.newInstance({ name: "colour", numberOfComponents: 4, values: this.rgba });

    this.renderWindow.addRenderer(this.renderer);
    this.glWindow.setContainer(container);
    this.renderWindow.addView(this.glWindow);
    this.ghost = this.addGhost();
    this.dots = this.addDots(count);
    if (body.cells.length > 0) this.addMesh();
    this.renderer.getActiveCamera().setParallelProjection(body.dimension === 2);
  }

  private addDots(most: number): Dots {
    const dots = new Dots(most);
    this.addActor(dots.actor);
    return dots;
  }

  private addMesh(): void {
    this.mesh.setPoints(this.points);
    this.mesh.getPointData().setScalars(this.colours);
    const mapper = vtkMapper.newInstance();
    mapper.setInputData(this.mesh);
    mapper.setColorModeToDirectScalars();
    const actor = vtkActor.newInstance();
    actor.setMapper(mapper);
    this.addActor(actor);
    this.updateCells();
  }

  private addActor(actor: vtkActor): void {
    // Without light the colours of a sheet are exactly those of the bar.
    actor.getProperty().setLighting(this.body.dimension === 3);
    actor.getProperty().setAmbient(0.35);
    actor.getProperty().setDiffuse(0.65);
    this.renderer.addActor(actor);
  }

  /** The undeformed body, faint and behind: small dots, or the wires of a mesh. */
  private addGhost(): vtkActor {
    const { positions, cells, dimension, spacing } = this.body;
    const behind = positions.slice();
    if (dimension === 2) for (let i = 2; i < behind.length; i += 3) behind[i] = -2 * spacing;
    const data = vtkPolyData.newInstance();
    data.getPoints().setData(behind, 3);
    const actor = vtkActor.newInstance();
    if (cells.length > 0) {
      const mapper = vtkMapper.newInstance();
      setCells(data, cells, () => true);
      mapper.setInputData(data);
      actor.setMapper(mapper);
      actor.getProperty().setRepresentationToWireframe();
    } else {
      const mapper = vtkSphereMapper.newInstance();
      mapper.setInputData(data);
      mapper.setRadius(0.22 * spacing);
      actor.setMapper(mapper);
    }
    actor.getProperty().setLighting(false);
    actor.setVisibility(false);
    this.renderer.addActor(actor);
    return actor;
  }

  setGhost(on: boolean): void {
    this.ghost.setVisibility(on);
  }

  setGround(ground: Rgb, faint: Rgb): void {
    this.renderer.setBackground(ground);
    this.ghost.getProperty().setColor(faint);
  }

  /** Moves the points to undeformed + scale * displacement; null: to where they were. */
  deform(displacement: Float32Array | null, scale: number): void {
    const { positions, spacing } = this.body;
    const by = displacement ? scale : 0;
    for (let i = 0; i < positions.length; ++i) this.deformed[i] = by === 0 ? positions[i]! : positions[i]! + by * displacement![i]!;
    this.stretchLimit = stretchedRadii(positions, this.deformed, this.neighbours, RADIUS * spacing, this.radii);
  }

  /** Takes over places, colours, and what is `shown`. */
  update(): void {
    this.drawn = this.pointsToDraw();
    this.dots.fill(this, this.drawn, this.grown);
    if (this.body.cells.length > 0 && (this.hidden || this.shown.includes(0))) this.updateCells();
    this.colours.modified();
    this.points.modified();
    this.mesh.modified();
  }

  private pointsToDraw(): Uint32Array<ArrayBuffer> {
    const { body, shown, bare, deformed, neighbours } = this;
    const drawn = new Uint32Array(shown.length);
    let count = 0;
    for (let i = 0; i < shown.length; ++i) {
      if (!shown[i] || !bare[i]) continue;
      if (body.dimension === 3 && isCovered(i, body.positions, deformed, neighbours, shown, this.stretchLimit)) continue;
      drawn[count++] = i;
    }
    return drawn.slice(0, count);
  }

  private updateCells(): void {
    this.hidden = this.shown.includes(0);
    setCells(this.mesh, this.body.cells, (node) => this.shown[node] === 1);
  }

  /**
   * Draws. `moving`: the next picture follows soon, so a slow one may be coarse. Returns whether it was.
   * Without a graphics card 300 000 points take a second, and nobody can move a body at that rate.
   */
  render(moving = false): boolean {
    this.growLine();
    const many = this.drawn.length > 2 * COARSE_POINTS;
    const coarse = moving && this.slow && many;
    if (coarse) {
      this.coarse ??= this.addDots(COARSE_POINTS);
      this.coarse.fill(this, spread(this.drawn, COARSE_POINTS), 1.25 * Math.sqrt(this.drawn.length / COARSE_POINTS));
    }
    this.coarse?.actor.setVisibility(coarse);
    this.dots.actor.setVisibility(!coarse && this.drawn.length > 0);
    this.renderer.resetCameraClippingRange();
    const start = performance.now();
    this.renderWindow.render();
    if (many && !coarse) {
      this.waitForPicture();
      this.slow = performance.now() - start > SLOW;
    }
    return coarse;
  }

  /** A bar of points in a row would be a hairline: its discs have a least size on the screen. */
  private growLine(): void {
    if (!this.isLine) return;
    const grown = Math.max(1, LEAST_RADIUS / (RADIUS * this.body.spacing * pixelsPerMetre(this, this.height)));
    if (Math.abs(grown - this.grown) < 0.01 * grown) return;
    this.grown = grown;
    this.dots.fill(this, this.drawn, grown);
  }

  /** Drawing goes on after the call that asked for it; reading a pixel waits for its end. */
  private waitForPicture(): void {
    const gl = this.canvas.getContext("webgl2");
    gl?.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /** Fits the drawing to its container; the ratio of device to CSS pixels may have changed, too. */
  resize(width: number, height: number): void {
    this.height = height;
    const ratio = window.devicePixelRatio || 1;
    this.glWindow.setSize(Math.max(1, Math.floor(width * ratio)), Math.max(1, Math.floor(height * ratio)));
  }

  get canvas(): HTMLCanvasElement {
    return this.glWindow.getCanvas()!;
  }
}

/** Whether all points of a plane body have the same y, or the same x. */
function isLine({ dimension, positions }: Body): boolean {
  const same = (axis: number) => positions.every((x, i) => i % 3 !== axis || x === positions[axis]);
  return dimension === 2 && (same(1) || same(0));
}

/** 1 for each point that no cell uses: those are drawn as discs or spheres. */
function bareMask(body: Body): Uint8Array {
  const bare = new Uint8Array(body.positions.length / 3).fill(1);
  for (const { nodes } of body.cells) for (const node of nodes) bare[node] = 0;
  return bare;
}

const NODES = { line: 2, triangle: 3, quad: 4 } as const;

/** Gives `data` the cells of which all nodes are to be seen, in vtk's form: number of nodes, nodes, ... */
function setCells(data: vtkPolyData, cells: Body["cells"], seen: (node: number) => boolean): void {
  const lists = { lines: [] as number[], polys: [] as number[] };
  for (const { kind, nodes } of cells) {
    const list = kind === "line" ? lists.lines : lists.polys;
    const width = NODES[kind];
    for (let at = 0; at < nodes.length; at += width) {
      const cell = nodes.subarray(at, at + width);
      if (cell.every(seen)) list.push(width, ...cell);
    }
  }
  data.getLines().setData(Uint32Array.from(lists.lines));
  data.getPolys().setData(Uint32Array.from(lists.polys));
}
