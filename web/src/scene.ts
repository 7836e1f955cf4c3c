// One result drawn by vtk.js: a body of points and cells whose coordinates and colours change in place.

import type { Cells } from "./data";
import { findNeighbours, stretchedRadii, type Neighbours } from "./neighbours";
import {
  vtkActor,
  vtkDataArray,
  vtkMapper,
  vtkOpenGLRenderWindow,
  vtkPoints,
  vtkPolyData,
  vtkRenderer,
  vtkRenderWindow,
  vtkSphereMapper,
} from "./vtk";

/** The undeformed body: points (x y z of each) and the cells between them. */
export interface Body {
  dimension: 2 | 3;
  spacing: number;
  positions: Float32Array;
  cells: { kind: Cells["kind"]; nodes: Uint32Array }[];
}

export type Rgb = [number, number, number];

// Discs of this radius (in spacings) reach the middle of a lattice cell: they tile without gaps.
const DISC = 0.72;
// Spheres of a solid overlap a little, so that one does not look through the body.
const BALL = 0.6;

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
  private readonly radiusArray;
  private readonly bodyData = vtkPolyData.newInstance();
  private readonly meshData = vtkPolyData.newInstance();
  private readonly bare: Uint8Array;
  private readonly ghost: vtkActor | null = null;
  private neighbours: Neighbours | null = null;
  private hidden = false;

  constructor(
    readonly body: Body,
    container: HTMLElement,
  ) {
    const count = body.positions.length / 3;
    this.deformed = body.positions.slice();
    this.rgba = new Uint8Array(count * 4).fill(255);
    this.radii = new Float32Array(count).fill(this.radius);
    this.shown = new Uint8Array(count).fill(1);
    this.bare = bareMask(body);
    this.points.setData(this.deformed, 3);
    this.colours = vtkDataArray.newInstance({ name: "colour", numberOfComponents: 4, values: this.rgba });
    this.radiusArray = vtkDataArray.newInstance({ name: "radius", numberOfComponents: 1, values: this.radii });

    this.renderWindow.addRenderer(this.renderer);
    this.glWindow.setContainer(container);
    this.renderWindow.addView(this.glWindow);
    this.ghost = this.addGhost();
    if (this.bare.includes(1)) this.addPoints();
    if (body.cells.length > 0) this.addMesh();
    this.renderer.getActiveCamera().setParallelProjection(body.dimension === 2);
  }

  private get radius(): number {
    return this.body.spacing * (this.body.dimension === 2 ? DISC : BALL);
  }

  private addPoints(): void {
    this.bodyData.setPoints(this.points);
    this.bodyData.getPointData().setScalars(this.colours);
    this.bodyData.getPointData().addArray(this.radiusArray);
    const mapper = vtkSphereMapper.newInstance();
    mapper.setInputData(this.bodyData);
    mapper.setScaleArray("radius");
    this.addActor(mapper, this.body.dimension === 3);
  }

  private addMesh(): void {
    this.meshData.setPoints(this.points);
    this.meshData.getPointData().setScalars(this.colours);
    const mapper = vtkMapper.newInstance();
    mapper.setInputData(this.meshData);
    this.addActor(mapper, this.body.dimension === 3);
    this.updateCells();
  }

  private addActor(mapper: vtkMapper, lit: boolean): vtkActor {
    mapper.setColorModeToDirectScalars();
    const actor = vtkActor.newInstance();
    actor.setMapper(mapper);
    actor.getProperty().setLighting(lit);
    actor.getProperty().setAmbient(0.25);
    actor.getProperty().setDiffuse(0.75);
    this.renderer.addActor(actor);
    return actor;
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
    this.ghost!.setVisibility(on);
  }

  setGround(ground: Rgb, faint: Rgb): void {
    this.renderer.setBackground(ground);
    this.ghost!.getProperty().setColor(faint);
  }

  /** Moves the points to undeformed + scale * displacement; null: to where they were. */
  deform(displacement: Float32Array | null, scale: number): void {
    const { positions, spacing } = this.body;
    for (let i = 0; i < positions.length; ++i)
      this.deformed[i] = positions[i]! + (displacement ? scale * displacement[i]! : 0);
    this.neighbours ??= findNeighbours(positions, 1.3 * spacing);
    stretchedRadii(positions, this.deformed, this.neighbours, this.radius, this.radii);
    this.points.modified();
  }

  /** Hides what is not `shown`, and takes over changed colours and radii. */
  update(): void {
    for (let i = 0; i < this.radii.length; ++i) if (!this.shown[i] || !this.bare[i]) this.radii[i] = 0;
    if (this.body.cells.length > 0 && (this.hidden || this.shown.includes(0))) this.updateCells();
    this.colours.modified();
    this.radiusArray.modified();
    this.points.modified();
    this.bodyData.modified();
    this.meshData.modified();
  }

  private updateCells(): void {
    this.hidden = this.shown.includes(0);
    setCells(this.meshData, this.body.cells, (node) => this.shown[node] === 1);
  }

  render(): void {
    this.renderer.resetCameraClippingRange();
    this.renderWindow.render();
  }

  /** Fits the drawing to its container; the ratio of device to CSS pixels may have changed, too. */
  resize(width: number, height: number): void {
    const ratio = window.devicePixelRatio || 1;
    this.glWindow.setSize(Math.max(1, Math.floor(width * ratio)), Math.max(1, Math.floor(height * ratio)));
  }

  get canvas(): HTMLCanvasElement {
    return this.glWindow.getCanvas()!;
  }
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
