// One result on the screen: its scene, what is drawn around it, and what is under the pointer.

import { cross, project, projection, unit, type Box, type Projection, type Vector } from "./camera";
import { FieldStore, float32, uint32, type ResultData, type ViewData } from "./data";
import { drawDecor, insetFor, type Decor } from "./decor";
import { h } from "./dom";
import { pick } from "./pick";
import { Scene } from "./scene";
import { tipContent, type Picked } from "./tip";
import { quantity } from "./units";

export class Panel {
  readonly view: ViewData;
  readonly store: FieldStore;
  readonly tip = h("div", { class: "tip", hidden: true });
  /** The bounds of the undeformed body. */
  readonly bounds: Box;
  state = -1;
  private readonly overlay = h("canvas", { class: "overlay", "aria-hidden": "true" });
  private readonly note = h("p", { class: "panel-note", hidden: true });
  private asked = 0; // number of the last question for a tip

  private constructor(
    readonly result: ResultData,
    readonly dimension: 2 | 3, // of the whole view: a sheet beside a solid is drawn as one
    readonly element: HTMLElement,
    readonly frame: HTMLElement,
    readonly holder: HTMLElement,
    readonly scene: Scene,
  ) {
    this.view = result.view!;
    this.store = new FieldStore(this.view, result.name);
    this.bounds = boxOf(scene.body.positions);
    frame.append(this.overlay, this.tip);
    element.append(this.note);
  }

  /** Unpacks the points and puts the panel into `place`. */
  static async make(result: ResultData, dimension: 2 | 3, named: boolean, place: HTMLElement): Promise<Panel> {
    const view = result.view!;
    const positions = await float32(view.positions, 3 * view.points, `the points of "${result.name}"`);
    const cells = await Promise.all(
      view.cells.map(async ({ kind, nodes }) => ({ kind, nodes: await uint32(nodes, view.points, `the cells of "${result.name}"`) })),
    );
    const inset = insetFor(dimension);
    const holder = h("div", { class: "gl" });
    holder.style.inset = `${inset.top}px ${inset.right}px ${inset.bottom}px ${inset.left}px`;
    const frame = h("div", { class: "frame", tabindex: "0", role: "img" }, holder);
    const element = h("div", { class: "panel" }, named ? h("h3", { title: result.name }, result.label) : null, frame);
    place.append(element);
    const scene = new Scene({ dimension, spacing: view.spacing, positions, cells }, holder);
    return new Panel(result, dimension, element, frame, holder, scene);
  }

  /** Width and height of the field's part of the panel (CSS pixels). */
  get size(): [number, number] {
    const inset = insetFor(this.dimension);
    const { clientWidth, clientHeight } = this.frame;
    return [Math.max(1, clientWidth - inset.left - inset.right), Math.max(1, clientHeight - inset.top - inset.bottom)];
  }

  get projection(): Projection {
    return projection(this.scene, ...this.size);
  }

  /** "time 48 µs". */
  get caption(): string {
    const at = this.view.states[this.state];
    const { name, unit: of } = this.result.parameter;
    return at ? `${name} ${quantity(at.value, of)}` : "undeformed";
  }

  /** Says in words what is shown: below the panel of one of several results, and to screen readers. */
  describe(field: string, named: boolean, hasField: boolean): void {
    this.frame.setAttribute("aria-label", `${this.result.title}: ${field} at ${this.caption}`);
    const sentences: string[] = [];
    if (named && this.state >= 0) sentences.push(`${this.caption} (state ${this.state + 1} of ${this.view.states.length})`);
    if (!hasField) sentences.push(`no field "${field}": the points are grey`);
    this.note.textContent = sentences.join("; ");
    this.note.hidden = sentences.length === 0;
  }

  drawOverlay(): void {
    const ratio = window.devicePixelRatio || 1;
    this.overlay.width = Math.round(this.frame.clientWidth * ratio);
    this.overlay.height = Math.round(this.frame.clientHeight * ratio);
    const ctx = this.overlay.getContext("2d")!;
    ctx.scale(ratio, ratio);
    drawDecor(ctx, this.decor());
  }

  decor(): Decor {
    const [width, height] = this.size;
    const camera = this.scene.renderer.getActiveCamera();
    const half = camera.getParallelScale();
    const [x, y] = camera.getFocalPoint();
    const wide = (half * width) / height;
    const flat = this.dimension === 2;
    return {
      width: this.frame.clientWidth,
      height: this.frame.clientHeight,
      inset: insetFor(this.dimension),
      plane: flat ? { x: [x - wide, x + wide], y: [y - half, y + half] } : null,
      triad: flat ? null : { axes: this.screenAxes(), size: this.bodySize },
    };
  }

  /** The undeformed body: a point is the middle of a cube, but the nodes of a mesh lie on its faces. */
  private get bodySize(): Vector {
    const { cells, spacing, dimension } = this.view;
    return sizeOf(this.bounds).map((extent, a) => (cells.length > 0 || a >= dimension ? extent : extent + spacing)) as Vector;
  }

  private screenAxes(): [number, number, number][] {
    const camera = this.scene.renderer.getActiveCamera();
    const forward = camera.getDirectionOfProjection() as Vector;
    const right = unit(cross(forward, camera.getViewUp() as Vector));
    const up = cross(right, forward);
    return [0, 1, 2].map((a) => [right[a]!, up[a]!, -forward[a]!]);
  }

  /** The point at x, y (pixels from the corner of the field's part), or -1. */
  pointAt(x: number, y: number): number {
    return pick(this.scene, this.projection, x, y);
  }

  /** Where a point is in the page (CSS pixels). */
  placeOf(point: number): { x: number; y: number; shown: boolean } {
    const { deformed, shown, canvas } = this.scene;
    const box = canvas.getBoundingClientRect();
    const [x, y] = project(this.projection, deformed[3 * point]!, deformed[3 * point + 1]!, deformed[3 * point + 2]!);
    return { x: box.left + x, y: box.top + y, shown: shown[point] === 1 };
  }

  /** All that is known of a point at the state shown. */
  async inspect(point: number): Promise<Picked> {
    const { view, store, scene, state, result } = this;
    const at = (values: ArrayLike<number>, width: number) => Array.from({ length: width }, (_, c) => values[point * width + c]!);
    const fields: Picked["fields"] = {};
    if (view.states.length > 0)
      for (const [f, field] of view.fields.entries()) fields[field.name] = at(await store.get(state, f), field.components);
    const undeformed = at(scene.body.positions, 3);
    // Where it really went, whatever the scale of the drawing.
    const u = fields["displacement"] ?? [0, 0, 0];
    return { result: result.name, point, state, undeformed, deformed: undeformed.map((x, a) => x + u[a]!), fields };
  }

  /** Shows the tip of the point under the pointer, if there is one. */
  async hover(x: number, y: number): Promise<void> {
    const question = ++this.asked;
    const point = this.pointAt(x, y);
    if (point < 0) return this.leave();
    const picked = await this.inspect(point);
    if (question !== this.asked) return; // The pointer has moved on.
    this.tip.replaceChildren(...tipContent(picked, this.view));
    this.tip.hidden = false;
    this.placeTip(x, y);
  }

  leave(): void {
    ++this.asked;
    this.tip.hidden = true;
  }

  private placeTip(x: number, y: number): void {
    const { tip, frame } = this;
    const inset = insetFor(this.dimension);
    const [px, py] = [x + inset.left, y + inset.top];
    const right = px + 16 + tip.offsetWidth <= frame.clientWidth;
    tip.style.left = `${Math.max(2, right ? px + 16 : px - 14 - tip.offsetWidth)}px`;
    tip.style.top = `${Math.max(2, Math.min(py + 12, frame.clientHeight - tip.offsetHeight - 2))}px`;
  }
}

/** The box around points, moved by scale * displacement. */
export function boxOf(xyz: Float32Array, displacement?: Float32Array, scale = 1): Box {
  const box: Box = [Infinity, -Infinity, Infinity, -Infinity, Infinity, -Infinity];
  for (let i = 0, a = 0; i < xyz.length; ++i, a = a === 4 ? 0 : a + 2) {
    const x = xyz[i]! + (displacement ? scale * displacement[i]! : 0);
    if (x < box[a]!) box[a] = x;
    if (x > box[a + 1]!) box[a + 1] = x;
  }
  return box;
}

export const sizeOf = (box: Box): Vector => [box[1] - box[0], box[3] - box[2], box[5] - box[4]];
