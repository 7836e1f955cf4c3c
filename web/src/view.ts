// The field view: one scene per result, all with the same state, field, colours, deformation and camera.

import {
  fittingPose,
  listen,
  pan,
  poseOf,
  project,
  projection,
  setPose,
  turn,
  unit,
  cross,
  zoom,
  type Box,
  type Projection,
  type Vector,
} from "./camera";
import { colourTable, paint } from "./colours";
import { FieldStore, float32, uint32, type ColourMap, type Field, type ResultData, type ViewData } from "./data";
import { drawDecor, insetFor, type Bar, type Decor } from "./decor";
import { h } from "./dom";
import { EMPTY_RANGE, fieldIndex, fieldTitle, joined, nearestState, rangeOf, scalars, type Component, type Range } from "./fields";
import { pick } from "./pick";
import { Scene } from "./scene";
import { colour, onTheme, rgb } from "./theme";
import { float32Digits, pretty, quantity } from "./units";

/** What the controls set. */
export interface Settings {
  state: number; // index into View.values
  field: string;
  component: Component;
  map: string;
  range: "all" | "state" | Range;
  deformation: number;
  clip: number | null; // points with more damage are hidden
  ghost: boolean;
}

/** One result on the screen. */
interface Panel {
  result: ResultData;
  view: ViewData;
  store: FieldStore;
  scene: Scene;
  frame: HTMLElement;
  overlay: HTMLCanvasElement;
  tip: HTMLElement;
  note: HTMLElement;
  bounds: Box;
  state: number;
}

/** What is known of a point: the answer of picking. */
export interface Picked {
  result: string;
  point: number;
  state: number;
  undeformed: number[];
  deformed: number[];
  fields: Record<string, number[]>;
}

export class View {
  readonly element = h("div", { class: "panels" });
  readonly dimension: 2 | 3;
  /** Values of the parameter at which there is a state, of any result. */
  readonly values: number[];
  /** All fields of all results, each once. */
  readonly fields: Field[];
  readonly settings: Settings;
  range: Range = [0, 1];
  private readonly panels: Panel[] = [];
  private readonly changed: (() => void)[] = [];
  private readonly failed: ((error: unknown) => void)[] = [];
  private readonly ranges = new Map<string, Promise<Range>>();
  private work: Promise<void> = Promise.resolve();
  private waiting = false;
  private decorFrame = 0;

  constructor(
    private readonly results: ResultData[],
    private readonly maps: ColourMap[],
  ) {
    const views = results.map((result) => result.view!);
    this.dimension = views.some((v) => v.dimension === 3) ? 3 : 2;
    this.values = [...new Set(views.flatMap((v) => v.states.map((s) => s.value)))].sort((a, b) => a - b);
    const names = new Set<string>();
    this.fields = views.flatMap((v) => v.fields).filter((f) => !names.has(f.name) && names.add(f.name));
    this.settings = {
      state: Math.max(0, this.values.length - 1),
      field: this.fields[0]?.name ?? "",
      component: 0,
      map: maps[0]!.name,
      range: "all",
      deformation: 1,
      clip: null,
      ghost: false,
    };
  }

  onChange(listener: () => void): void {
    this.changed.push(listener);
  }

  /** What cannot be shown is told to `listener`; the view stays as it was. */
  onError(listener: (error: unknown) => void): void {
    this.failed.push(listener);
  }

  /** Unpacks the points and draws the first picture. The element must be in the page, for its size. */
  async open(): Promise<void> {
    for (const result of this.results) this.panels.push(await this.makePanel(result));
    await this.chooseField();
    await this.draw();
    await this.fit("oblique");
    new ResizeObserver(() => this.resize()).observe(this.element);
    onTheme(() => this.retheme());
  }

  private async makePanel(result: ResultData): Promise<Panel> {
    const view = result.view!;
    const what = `the points of "${result.name}"`;
    const positions = await float32(view.positions, 3 * view.points, what);
    const cells = await Promise.all(
      view.cells.map(async ({ kind, nodes }) => ({ kind, nodes: await uint32(nodes, view.points, `the cells of "${result.name}"`) })),
    );
    const inset = insetFor(this.dimension);
    const holder = h("div", { class: "gl" });
    holder.style.inset = `${inset.top}px ${inset.right}px ${inset.bottom}px ${inset.left}px`;
    const overlay = h("canvas", { class: "overlay", "aria-hidden": "true" });
    const tip = h("div", { class: "tip", hidden: true });
    const note = h("p", { class: "panel-note", hidden: true });
    const name = this.results.length > 1 ? h("h3", {}, result.name) : null;
    const frame = h("div", { class: "frame", tabindex: "0", role: "img", "aria-label": `Field of ${result.title}` }, holder, overlay, tip);
    this.element.append(h("div", { class: "panel" }, name, frame, note));
    const scene = new Scene({ dimension: view.dimension, spacing: view.spacing, positions, cells }, holder);
    const panel: Panel = {
      result,
      view,
      store: new FieldStore(view, result.name),
      scene,
      frame,
      overlay,
      tip,
      note,
      bounds: boxOf(positions),
      state: -1,
    };
    listen(holder, scene, {
      changed: () => this.cameraMoved(panel),
      hover: (x, y) => this.hover(panel, x, y),
      leave: () => (tip.hidden = true),
    });
    return panel;
  }

  /** The field that says most at first sight: damage if there is any, else energy, else displacement. */
  private async chooseField(): Promise<void> {
    const has = (name: string) => this.fields.some((f) => f.name === name);
    let name = this.fields[0]?.name ?? "";
    if (has("strain_energy_density")) name = "strain_energy_density";
    if (has("damage") && (await this.rangeAtLast("damage"))[1] > 0) name = "damage";
    this.settings.field = name;
    this.settings.component = this.field?.components === 1 ? 0 : "magnitude";
  }

  private async rangeAtLast(name: string): Promise<Range> {
    let range = EMPTY_RANGE;
    for (const panel of this.panels) {
      const f = fieldIndex(panel.view, name);
      if (f >= 0 && panel.view.states.length > 0)
        range = joined(range, rangeOf(await panel.store.get(panel.view.states.length - 1, f)));
    }
    return range;
  }

  get field(): Field | undefined {
    return this.fields.find((f) => f.name === this.settings.field);
  }
  get map(): ColourMap {
    return this.maps.find((m) => m.name === this.settings.map) ?? this.maps[0]!;
  }
  /** The value of the parameter that is shown. */
  get value(): number {
    return this.values[this.settings.state] ?? NaN;
  }

  /** The parameter at the state that the result of this name shows; NaN where it shows none. */
  valueOf(result: string): number {
    const panel = this.panels.find((p) => p.result.name === result);
    return panel?.view.states[panel.state]?.value ?? NaN;
  }

  /** Changes settings and draws. Changes that come while a picture is in the making share the next one. */
  set(change: Partial<Settings>): Promise<void> {
    Object.assign(this.settings, change);
    this.settings.state = Math.max(0, Math.min(this.values.length - 1, this.settings.state));
    if (!this.waiting) {
      this.waiting = true;
      this.work = this.work.then(() => {
        this.waiting = false;
        return this.draw();
      });
      this.work = this.work.catch((error: unknown) => this.failed.forEach((listener) => listener(error)));
    }
    return this.work;
  }

  private async draw(): Promise<void> {
    const settings = { ...this.settings };
    const shown = await Promise.all(this.panels.map((panel) => this.valuesOf(panel, settings)));
    this.range = await this.rangeFor(settings, shown.map((s) => s.values));
    const table = colourTable(this.map);
    this.panels.forEach((panel, n) => {
      const { values, displacement, damage, state } = shown[n]!;
      panel.state = state;
      const scene = panel.scene;
      scene.deform(displacement, settings.deformation);
      if (values) paint(values, this.range[0], this.range[1], table, scene.rgba);
      else paint(new Float32Array(panel.view.points).fill(NaN), 0, 1, table, scene.rgba);
      for (let i = 0; i < scene.shown.length; ++i) scene.shown[i] = settings.clip !== null && damage && damage[i]! > settings.clip ? 0 : 1;
      scene.update();
      scene.setGhost(settings.ghost);
      scene.setGround(rgb("ground"), rgb("faint"));
      panel.tip.hidden = true;
      this.describe(panel, values !== null);
    });
    this.render();
    this.changed.forEach((listener) => listener());
  }

  private async valuesOf(panel: Panel, settings: Settings) {
    const { view, store } = panel;
    const state = nearestState(view, this.values[settings.state] ?? 0);
    const get = async (name: string) => {
      const f = fieldIndex(view, name);
      return f >= 0 && view.states.length > 0 ? store.get(state, f) : null;
    };
    const field = this.field;
    const values = field ? await get(field.name) : null;
    return {
      state,
      values: values && field ? scalars(values, field, settings.component) : null,
      displacement: await get("displacement"),
      damage: settings.clip === null ? null : await get("damage"),
    };
  }

  private async rangeFor(settings: Settings, shown: (Float32Array | null)[]): Promise<Range> {
    let range: Range;
    if (Array.isArray(settings.range)) range = settings.range;
    else if (settings.range === "all") range = await this.rangeOfAll(settings.field, settings.component);
    else range = shown.reduce((r, values) => (values ? joined(r, rangeOf(values)) : r), EMPTY_RANGE);
    if (range[0] > range[1]) return [0, 1];
    if (!Array.isArray(settings.range) && this.map.diverging && range[0] < 0 && range[1] > 0) {
      const most = Math.max(-range[0], range[1]);
      return [-most, most];
    }
    return range;
  }

  /** The range of a field over all states of all results; unpacks all of them, once. */
  private rangeOfAll(name: string, component: Component): Promise<Range> {
    const key = `${name}/${component}`;
    let range = this.ranges.get(key);
    if (!range) {
      range = this.scanRange(name, component);
      this.ranges.set(key, range);
    }
    return range;
  }

  private async scanRange(name: string, component: Component): Promise<Range> {
    let range = EMPTY_RANGE;
    for (const { view, store } of this.panels) {
      const f = fieldIndex(view, name);
      if (f < 0) continue;
      for (let s = 0; s < view.states.length; ++s)
        range = joined(range, rangeOf(scalars(await store.get(s, f), view.fields[f]!, component)));
    }
    return range;
  }

  private describe(panel: Panel, hasField: boolean): void {
    const { result, view, state, frame, note } = panel;
    const at = view.states[state];
    const title = this.field ? fieldTitle(this.field, this.settings.component) : "no field";
    const shown = at ? `${result.parameter.name} ${quantity(at.value, result.parameter.unit)}` : "undeformed";
    frame.setAttribute("aria-label", `${result.title}: ${title} at ${shown}`);
    const lines: string[] = [];
    if (at && this.panels.length > 1) lines.push(`${shown} (state ${state + 1} of ${view.states.length})`);
    if (!hasField && this.field) lines.push(`This result has no field "${this.field.name}": its points are grey.`);
    note.textContent = lines.join(". ");
    note.hidden = lines.length === 0;
  }

  // --- drawing -------------------------------------------------------------------------------------------------

  render(): void {
    for (const panel of this.panels) {
      panel.scene.render();
      this.drawOverlay(panel);
    }
  }

  private size(panel: Panel): [number, number] {
    const inset = insetFor(this.dimension);
    const { clientWidth, clientHeight } = panel.frame;
    return [Math.max(1, clientWidth - inset.left - inset.right), Math.max(1, clientHeight - inset.top - inset.bottom)];
  }

  private resize(): void {
    for (const panel of this.panels) panel.scene.resize(...this.size(panel));
    this.render();
  }

  private retheme(): void {
    for (const panel of this.panels) panel.scene.setGround(rgb("ground"), rgb("faint"));
    this.render();
  }

  private drawOverlay(panel: Panel): void {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = panel.frame;
    const { overlay } = panel;
    overlay.width = Math.round(clientWidth * ratio);
    overlay.height = Math.round(clientHeight * ratio);
    const ctx = overlay.getContext("2d")!;
    ctx.scale(ratio, ratio);
    drawDecor(ctx, this.decor(panel));
  }

  private decor(panel: Panel): Decor {
    const [width, height] = this.size(panel);
    const camera = panel.scene.renderer.getActiveCamera();
    const flat = this.dimension === 2;
    const half = camera.getParallelScale();
    const focus = camera.getFocalPoint();
    const wide = (half * width) / height;
    return {
      width: panel.frame.clientWidth,
      height: panel.frame.clientHeight,
      inset: insetFor(this.dimension),
      bar: this.bar(),
      plane: flat ? { x: [focus[0] - wide, focus[0] + wide], y: [focus[1] - half, focus[1] + half] } : null,
      triad: flat ? null : { axes: this.screenAxes(panel), size: sizeOf(panel.bounds) },
    };
  }

  private bar(): Bar | null {
    const field = this.field;
    if (!field) return null;
    const title = fieldTitle(field, this.settings.component);
    return { title, unit: field.unit, low: this.range[0], high: this.range[1], table: colourTable(this.map) };
  }

  private screenAxes(panel: Panel): [number, number, number][] {
    const camera = panel.scene.renderer.getActiveCamera();
    const forward = camera.getDirectionOfProjection() as Vector;
    const right = unit(cross(forward, camera.getViewUp() as Vector));
    const up = cross(right, forward);
    return [0, 1, 2].map((a) => [right[a]!, up[a]!, -forward[a]!]);
  }

  // --- camera --------------------------------------------------------------------------------------------------

  private cameraMoved(by: Panel): void {
    const pose = poseOf(by.scene);
    for (const panel of this.panels) if (panel !== by) setPose(panel.scene, pose);
    this.renderSoon();
  }

  private renderSoon(): void {
    if (this.decorFrame) return;
    this.decorFrame = requestAnimationFrame(() => {
      this.decorFrame = 0;
      this.render();
    });
  }

  /** Shows all of the bodies as they are now and at the first and the last state. */
  async fit(direction = "oblique"): Promise<void> {
    let box: Box = [Infinity, -Infinity, Infinity, -Infinity, Infinity, -Infinity];
    for (const panel of this.panels) {
      box = unionBox(box, panel.bounds);
      const f = fieldIndex(panel.view, "displacement");
      const states = f < 0 ? [] : [...new Set([0, panel.state, panel.view.states.length - 1])].filter((s) => s >= 0);
      for (const s of states) box = unionBox(box, boxOf(panel.scene.body.positions, await panel.store.get(s, f), this.settings.deformation));
    }
    const margin = Math.max(0, ...this.panels.map((p) => p.scene.body.spacing));
    box = box.map((edge, n) => edge + (n % 2 === 0 ? -margin : margin)) as Box;
    for (const panel of this.panels) {
      const [width, height] = this.size(panel);
      panel.scene.resize(width, height);
      setPose(panel.scene, fittingPose(box, width / height, this.dimension, direction));
    }
    this.render();
  }

  /** Moves the cameras from the keyboard: "in", "out", or an arrow key's direction. */
  nudge(what: "in" | "out" | "left" | "right" | "up" | "down"): void {
    const step = 40;
    const moves = { left: [step, 0], right: [-step, 0], up: [0, step], down: [0, -step] };
    for (const panel of this.panels) {
      const height = this.size(panel)[1];
      if (what === "in" || what === "out") zoom(panel.scene, what === "in" ? 1.25 : 0.8, 0, 0, height);
      else (this.dimension === 2 ? pan : turn)(panel.scene, moves[what][0]!, moves[what][1]!, height);
    }
    this.render();
  }

  // --- picking -------------------------------------------------------------------------------------------------

  private hover(panel: Panel, x: number, y: number): void {
    const point = pick(panel.scene, this.projectionOf(panel), x, y);
    if (point < 0) {
      panel.tip.hidden = true;
      return;
    }
    void this.inspect(panel, point).then((picked) => this.showTip(panel, picked, x, y));
  }

  private projectionOf(panel: Panel): Projection {
    return projection(panel.scene, ...this.size(panel));
  }

  private async inspect(panel: Panel, point: number): Promise<Picked> {
    const { view, store, scene, state } = panel;
    const at = (values: ArrayLike<number>, width: number) => Array.from({ length: width }, (_, c) => values[point * width + c]!);
    const fields: Picked["fields"] = {};
    if (view.states.length > 0)
      for (const [f, field] of view.fields.entries()) fields[field.name] = at(await store.get(state, f), field.components);
    const undeformed = at(scene.body.positions, 3);
    // Where it really went, whatever the scale of the drawing.
    const u = fields["displacement"] ?? [0, 0, 0];
    return { result: panel.result.name, point, state, undeformed, deformed: undeformed.map((x, a) => x + u[a]!), fields };
  }

  private showTip(panel: Panel, picked: Picked, x: number, y: number): void {
    const { tip, frame, view } = panel;
    const dimension = view.dimension;
    const place = (p: number[]) => p.slice(0, dimension).map((c) => quantity(c, "m", 5)).join(", ");
    const rows: [string, string][] = [
      ["undeformed", place(picked.undeformed)],
      ["deformed", place(picked.deformed)],
    ];
    for (const field of view.fields) {
      const unit = field.unit ? ` ${pretty(field.unit)}` : "";
      rows.push([field.name, (picked.fields[field.name] ?? []).map(float32Digits).join(field.components === 9 ? "  " : ", ") + unit]);
    }
    tip.replaceChildren(h("strong", {}, `point ${picked.point}`), h("table", {}, ...rows.map(([name, value]) => tipRow(name, value, dimension))));
    tip.hidden = false;
    const inset = insetFor(this.dimension);
    const [px, py] = [x + inset.left, y + inset.top];
    const leftSide = px + 16 + tip.offsetWidth > frame.clientWidth;
    tip.style.left = `${Math.max(2, leftSide ? px - 14 - tip.offsetWidth : px + 16)}px`;
    tip.style.top = `${Math.max(2, Math.min(py + 12, frame.clientHeight - tip.offsetHeight - 2))}px`;
  }

  /** The point at x, y (CSS pixels in the page); null where there is none. */
  async pickAt(x: number, y: number): Promise<Picked | null> {
    for (const panel of this.panels) {
      const box = panel.scene.canvas.getBoundingClientRect();
      if (x < box.left || x > box.right || y < box.top || y > box.bottom) continue;
      const point = pick(panel.scene, this.projectionOf(panel), x - box.left, y - box.top);
      if (point >= 0) return this.inspect(panel, point);
    }
    return null;
  }

  /** Where a point of panel `n` is on the screen (CSS pixels in the page), and whether it is to be seen. */
  placeOf(point: number, n = 0): { x: number; y: number; shown: boolean } {
    const panel = this.panels[n]!;
    const { deformed, shown, canvas } = panel.scene;
    const box = canvas.getBoundingClientRect();
    const [x, y] = project(this.projectionOf(panel), deformed[3 * point]!, deformed[3 * point + 1]!, deformed[3 * point + 2]!);
    return { x: box.left + x, y: box.top + y, shown: shown[point] === 1 };
  }

  /** How many points each result shows. */
  shownPoints(): number[] {
    return this.panels.map((panel) => panel.scene.shown.reduce((sum, s) => sum + s, 0));
  }

  /** How far the largest displacement reaches, in parts of the size of the bodies. */
  async largestDisplacement(): Promise<number> {
    const range = this.fields.some((f) => f.name === "displacement") ? await this.rangeOfAll("displacement", "magnitude") : EMPTY_RANGE;
    const size = Math.max(...this.panels.flatMap((p) => sizeOf(p.bounds)));
    return range[1] > 0 && size > 0 ? range[1] / size : 0;
  }

  // --- picture -------------------------------------------------------------------------------------------------

  /** All panels side by side under the title, as PNG, in the pixels of the screen. */
  async picture(title: string): Promise<Blob> {
    const ratio = window.devicePixelRatio || 1;
    const head = 34;
    const inset = insetFor(this.dimension);
    const width = this.panels.reduce((sum, p) => sum + p.frame.clientWidth, 0);
    const height = Math.max(...this.panels.map((p) => p.frame.clientHeight)) + head;
    const canvas = h("canvas", { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    const ctx = canvas.getContext("2d")!;
    ctx.scale(ratio, ratio);
    ctx.fillStyle = colour("ground");
    ctx.fillRect(0, 0, width, height);
    let left = 0;
    for (const panel of this.panels) {
      const [w, tall] = this.size(panel);
      panel.scene.render(); // The browser clears a canvas of WebGL once it has shown it: copy in the same turn.
      ctx.drawImage(panel.scene.canvas, left + inset.left, head + inset.top, w, tall);
      ctx.save();
      ctx.translate(left, head);
      drawDecor(ctx, this.decor(panel));
      ctx.restore();
      drawTitle(ctx, this.panels.length > 1 ? panel.result.name : title, this.caption(panel), left + 10, panel.frame.clientWidth - 20);
      left += panel.frame.clientWidth;
    }
    return new Promise((done, fail) => canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error("no picture"))), "image/png"));
  }

  private caption(panel: Panel): string {
    const at = panel.view.states[panel.state];
    const { name, unit } = panel.result.parameter;
    return at ? `${name} ${quantity(at.value, unit)}` : "";
  }
}

function tipRow(name: string, value: string, dimension: 2 | 3): HTMLElement {
  // A tensor has nine numbers: in rows, as it is written.
  const parts = value.split("  ");
  if (parts.length < 9) return h("tr", {}, h("th", {}, name), h("td", {}, value));
  const rows = [0, 3, 6].map((r) => parts.slice(r, r + 3).join(", "));
  const cell = h("td", {}, ...rows.map((row) => h("div", {}, row)));
  cell.dataset.dimension = String(dimension);
  return h("tr", {}, h("th", {}, name), cell);
}

function drawTitle(ctx: CanvasRenderingContext2D, title: string, caption: string, x: number, width: number): void {
  ctx.fillStyle = colour("ink");
  ctx.textAlign = "left";
  ctx.textBaseline = "middle";
  ctx.font = "600 15px system-ui, sans-serif";
  ctx.fillText(`${title}${caption ? ` – ${caption}` : ""}`, x, 18, width);
}

function boxOf(xyz: Float32Array, displacement?: Float32Array, scale = 1): Box {
  const box: Box = [Infinity, -Infinity, Infinity, -Infinity, Infinity, -Infinity];
  for (let i = 0, a = 0; i < xyz.length; ++i, a = a === 4 ? 0 : a + 2) {
    const x = xyz[i]! + (displacement ? scale * displacement[i]! : 0);
    if (x < box[a]!) box[a] = x;
    if (x > box[a + 1]!) box[a + 1] = x;
  }
  return box;
}

const unionBox = (a: Box, b: Box): Box =>
  a.map((edge, n) => (n % 2 === 0 ? Math.min(edge, b[n]!) : Math.max(edge, b[n]!))) as Box;

const sizeOf = (box: Box): Vector => [box[1] - box[0], box[3] - box[2], box[5] - box[4]];
