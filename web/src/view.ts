// The field view: a panel per result, all with the same state, field, colours, deformation and camera.

import { fittingPose, listen, pan, poseOf, setPose, turn, zoom, type Box } from "./camera";
import { colourTable, paint } from "./colours";
import { parametersOf, type ColourMap, type Field, type ResultData, type ViewData } from "./data";
import { drawBar, type Bar } from "./decor";
import { h } from "./dom";
import { EMPTY_RANGE, fieldIndex, fieldTitle, joined, nearestState, rangeOf, scalars, type Component, type Range } from "./fields";
import { boxOf, Panel, sizeOf } from "./panel";
import { picture } from "./picture";
import { onTheme, rgb } from "./theme";
import type { Picked } from "./tip";
import { quantity } from "./units";

/** What the controls set. */
export interface Settings {
  state: number; // index into View.values
  field: string;
  component: Component;
  map: string;
  range: "all" | "state" | Range;
  deformation: number;
  clip: number | null; // points with more damage are hidden
  ghost: boolean; // the undeformed body is shown, too
}

/** What one panel is to show. */
interface Shown {
  state: number;
  values: Float32Array | null;
  displacement: Float32Array | null;
  damage: Float32Array | null;
}

/** After the last moving picture the full one follows (ms). */
const STILL_AFTER = 300;

export class View {
  readonly element = h("div", { class: "panels" });
  private readonly grid = h("div", { class: "grid" });
  private readonly barCanvas = h("canvas", { class: "bar", role: "img" });
  readonly dimension: 2 | 3;
  /** Results over different parameters have no value in common: their states go by number. */
  readonly byNumber: boolean;
  /** Values of the parameter at which there is a state, of any result; by number: 1, 2, ... */
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
  private linked = true;
  private columns = 1;
  private frame = 0;
  private still = 0;

  constructor(
    private readonly results: ResultData[],
    private readonly maps: ColourMap[],
  ) {
    const views = results.map((result) => result.view!);
    this.dimension = views.some((v) => v.dimension === 3) ? 3 : 2;
    this.byNumber = parametersOf(results).length > 1;
    this.values = this.byNumber
      ? Array.from({ length: Math.max(...views.map((v) => v.states.length)) }, (_, n) => n + 1)
      : [...new Set(views.flatMap((v) => v.states.map((s) => s.value)))].sort((a, b) => a - b);
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
    this.element.append(this.grid, this.barCanvas);
    for (const result of this.results) this.panels.push(await this.makePanel(result));
    await this.chooseField();
    await this.prepare();
    await this.fit();
    this.changed.forEach((listener) => listener());
    new ResizeObserver(() => void this.resize()).observe(this.element);
    onTheme(() => this.retheme());
  }

  private async makePanel(result: ResultData): Promise<Panel> {
    const panel = await Panel.make(result, this.dimension, this.results.length > 1, this.grid);
    listen(panel.holder, panel.scene, {
      changed: () => this.cameraMoved(panel),
      hover: (x, y) => void panel.hover(x, y).catch((error: unknown) => this.fail(error)),
      leave: () => panel.leave(),
    });
    return panel;
  }

  private fail(error: unknown): void {
    this.failed.forEach((listener) => listener(error));
  }

  // --- what is shown -------------------------------------------------------------------------------------------

  /** The field that the program chose, or the one that says most at first sight: damage if there is any, else energy. */
  private async chooseField(): Promise<void> {
    const has = (name: string) => this.fields.some((f) => f.name === name);
    let name = this.fields[0]?.name ?? "";
    if (has("strain_energy_density")) name = "strain_energy_density";
    const chosen = this.results.map(({ view }) => view!.field).find((field) => field !== undefined && has(field));
    if (chosen !== undefined) name = chosen;
    else if (has("damage") && (await this.rangeAtLast("damage"))[1] > 0) name = "damage";
    this.settings.field = name;
    this.settings.component = this.field?.components === 1 ? 0 : "magnitude";
  }

  private async rangeAtLast(name: string): Promise<Range> {
    let range = EMPTY_RANGE;
    for (const { view, store } of this.panels) {
      const f = fieldIndex(view, name);
      if (f >= 0 && view.states.length > 0) range = joined(range, rangeOf(await store.get(view.states.length - 1, f)));
    }
    return range;
  }

  get field(): Field | undefined {
    return this.fields.find((f) => f.name === this.settings.field);
  }
  get map(): ColourMap {
    return this.maps.find((m) => m.name === this.settings.map) ?? this.maps[0]!;
  }
  /** The value of the parameter that is shown, or the number of the state. */
  get value(): number {
    return this.values[this.settings.state] ?? NaN;
  }

  /** The parameter at the state that the result of this name shows; NaN where it shows none. */
  valueOf(result: string): number {
    const panel = this.panels.find((p) => p.result.name === result);
    return panel?.view.states[panel.state]?.value ?? NaN;
  }

  /**
   * Changes settings and draws. Changes that come while a picture is in the making share the next one. `moving`: more
   * changes follow soon.
   */
  set(change: Partial<Settings>, moving = false): Promise<void> {
    Object.assign(this.settings, change);
    this.settings.state = Math.max(0, Math.min(this.values.length - 1, this.settings.state));
    if (!this.waiting) {
      this.waiting = true;
      this.work = this.work
        .then(() => {
          this.waiting = false;
          return this.draw(moving);
        })
        .catch((error: unknown) => this.fail(error));
    }
    return this.work;
  }

  private async draw(moving: boolean): Promise<void> {
    await this.prepare();
    this.render(moving);
    this.changed.forEach((listener) => listener());
  }

  private async prepare(): Promise<void> {
    const settings = { ...this.settings };
    const shown = await Promise.all(this.panels.map((panel) => this.shownBy(panel, settings)));
    this.range = await this.rangeFor(settings, shown);
    const table = colourTable(this.map);
    this.panels.forEach((panel, n) => this.fill(panel, shown[n]!, settings, table));
  }

  /** The state of a result that belongs to the place `index` of the slider. */
  private stateOf(view: ViewData, index: number): number {
    if (!this.byNumber) return nearestState(view, this.values[index]!);
    return Math.round((index / Math.max(1, this.values.length - 1)) * (view.states.length - 1));
  }

  private async shownBy({ view, store }: Panel, settings: Settings): Promise<Shown> {
    const state = view.states.length > 0 ? this.stateOf(view, settings.state) : -1;
    const get = async (name: string) => {
      const f = fieldIndex(view, name);
      return f >= 0 && state >= 0 ? store.get(state, f) : null;
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

  /** Gives the scene its places, colours and hidden points. */
  private fill(panel: Panel, { state, values, displacement, damage }: Shown, settings: Settings, table: Uint8Array): void {
    const { scene } = panel;
    panel.state = state;
    scene.deform(displacement, settings.deformation);
    paint(values ?? new Float32Array(scene.shown.length).fill(NaN), ...this.range, table, scene.rgba);
    if (damage && settings.clip !== null) for (let i = 0; i < damage.length; ++i) scene.shown[i] = damage[i]! > settings.clip ? 0 : 1;
    else scene.shown.fill(1);
    scene.update();
    scene.setGhost(settings.ghost);
    scene.setGround(rgb("ground"), rgb("faint"));
    panel.leave();
    panel.describe(this.field ? fieldTitle(this.field, settings.component) : "points", this.panels.length > 1, values !== null || !this.field);
  }

  private async rangeFor(settings: Settings, shown: Shown[]): Promise<Range> {
    if (Array.isArray(settings.range)) return settings.range;
    let range = EMPTY_RANGE;
    if (settings.range === "all") range = await this.rangeOfAll(settings.field, settings.component);
    else for (const { values } of shown) if (values) range = joined(range, rangeOf(values));
    if (range[0] > range[1]) return [0, 1];
    if (!this.map.diverging || range[0] >= 0 || range[1] <= 0) return range;
    // The middle of a diverging map is zero.
    const most = Math.max(-range[0], range[1]);
    return [-most, most];
  }

  /** The range of a field over all states of all results; unpacks all of them, once. */
  private rangeOfAll(name: string, component: Component): Promise<Range> {
    const key = `${name}/${component}`;
    const range = this.ranges.get(key) ?? this.scanRange(name, component);
    this.ranges.set(key, range);
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

  // --- drawing -------------------------------------------------------------------------------------------------

  /** Draws all panels; after moving pictures that were coarse, a full one follows. */
  private render(moving = false): void {
    clearTimeout(this.still);
    let coarse = false;
    for (const panel of this.panels) {
      coarse = panel.scene.render(moving) || coarse;
      panel.drawOverlay();
    }
    this.drawBar();
    if (coarse) this.still = window.setTimeout(() => this.render(), STILL_AFTER);
  }

  private renderSoon(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.render(true);
    });
  }

  /** One bar serves all panels: their colours are the same. */
  private drawBar(): void {
    const bar = this.bar();
    const { barCanvas } = this;
    barCanvas.hidden = bar === null;
    if (!bar) return;
    const ratio = window.devicePixelRatio || 1;
    barCanvas.width = Math.round(barCanvas.clientWidth * ratio);
    barCanvas.height = Math.round(barCanvas.clientHeight * ratio);
    barCanvas.setAttribute("aria-label", `${bar.title} from ${quantity(bar.low, bar.unit)} to ${quantity(bar.high, bar.unit)}`);
    const ctx = barCanvas.getContext("2d")!;
    ctx.scale(ratio, ratio);
    drawBar(ctx, bar, barCanvas.clientHeight);
  }

  private resize(): void {
    for (const panel of this.panels) panel.scene.resize(...panel.size);
    this.render();
  }

  private retheme(): void {
    for (const panel of this.panels) panel.scene.setGround(rgb("ground"), rgb("faint"));
    this.render();
  }

  private bar(): Bar | null {
    const field = this.field;
    if (!field) return null;
    const title = fieldTitle(field, this.settings.component);
    return { title, unit: field.unit, low: this.range[0], high: this.range[1], table: colourTable(this.map) };
  }

  picture(): Promise<Blob> {
    return picture(this.panels, this.bar(), this.columns);
  }

  // --- camera --------------------------------------------------------------------------------------------------

  private cameraMoved(by: Panel): void {
    const pose = poseOf(by.scene);
    if (this.linked) for (const panel of this.panels) if (panel !== by) setPose(panel.scene, pose);
    this.renderSoon();
  }

  /**
   * Shows all of the bodies as they are now and at the first and the last state; solids from `direction`. Bodies of
   * about the same size share a camera; others would be specks, and have cameras of their own.
   */
  async fit(direction = "oblique"): Promise<void> {
    const boxes = await Promise.all(this.panels.map((panel) => this.boundsOf(panel)));
    const all = boxes.reduce(union);
    this.linked = boxes.every((box) => Math.max(...sizeOf(box)) > 0.5 * Math.max(...sizeOf(all)));
    this.arrange(all);
    this.panels.forEach(({ scene, size }, n) => {
      scene.resize(...size);
      setPose(scene, fittingPose(this.linked ? all : boxes[n]!, size[0] / size[1], this.dimension, direction));
    });
    this.render();
  }

  /** As many panels side by side as make bodies like `box` largest. */
  private arrange(box: Box): void {
    const { clientWidth, clientHeight } = this.grid;
    const [wide, tall] = this.dimension === 2 ? sizeOf(box) : [1, 1];
    const room = (columns: number) => {
      const rows = Math.ceil(this.panels.length / columns);
      // What axes, titles and notes take of a panel.
      return Math.min((clientWidth / columns - 75) / wide!, (clientHeight / rows - 100) / tall!);
    };
    const counts = this.panels.map((_, n) => n + 1);
    this.columns = counts.reduce((best, n) => (room(n) > room(best) ? n : best), 1);
    this.grid.style.gridTemplateColumns = `repeat(${this.columns}, minmax(0, 1fr))`;
  }

  private async boundsOf({ view, store, scene, bounds, state }: Panel): Promise<Box> {
    const f = fieldIndex(view, "displacement");
    const states = f < 0 ? [] : [...new Set([0, state, view.states.length - 1])].filter((s) => s >= 0);
    let box = bounds;
    for (const s of states) box = union(box, boxOf(scene.body.positions, await store.get(s, f), this.settings.deformation));
    const rim = scene.body.spacing;
    return box.map((edge, n) => edge + (n % 2 === 0 ? -rim : rim)) as Box;
  }

  /** Moves the cameras from the keyboard. */
  nudge(what: "in" | "out" | "left" | "right" | "up" | "down"): void {
    const moves = { left: [40, 0], right: [-40, 0], up: [0, 40], down: [0, -40] } as const;
    for (const { scene, size } of this.panels) {
      if (what === "in" || what === "out") zoom(scene, what === "in" ? 1.25 : 0.8, 0, 0, size[1]);
      else (this.dimension === 2 ? pan : turn)(scene, moves[what][0], moves[what][1], size[1]);
    }
    this.render(true);
  }

  // --- points --------------------------------------------------------------------------------------------------

  /** The point at x, y (CSS pixels in the page); null where there is none. */
  async pickAt(x: number, y: number): Promise<Picked | null> {
    for (const panel of this.panels) {
      const box = panel.scene.canvas.getBoundingClientRect();
      if (x < box.left || x > box.right || y < box.top || y > box.bottom) continue;
      const point = panel.pointAt(x - box.left, y - box.top);
      if (point >= 0) return panel.inspect(point);
    }
    return null;
  }

  /** Where a point of panel `n` is in the page, and whether it is to be seen. */
  placeOf(point: number, n = 0): { x: number; y: number; shown: boolean } {
    return this.panels[n]!.placeOf(point);
  }

  /** How many points each result shows. */
  shownPoints(): number[] {
    return this.panels.map(({ scene }) => scene.shown.reduce((sum, s) => sum + s, 0));
  }

  /** The largest displacement at the last state, in parts of the size of the bodies. */
  async largestDisplacement(): Promise<number> {
    let part = 0;
    for (const { view, store, bounds } of this.panels) {
      const f = fieldIndex(view, "displacement");
      if (f < 0 || view.states.length === 0) continue;
      const values = scalars(await store.get(view.states.length - 1, f), view.fields[f]!, "magnitude");
      const largest = rangeOf(values)[1];
      part = Math.max(part, largest / (Math.max(...sizeOf(bounds)) || 1));
    }
    return part;
  }
}

const union = (a: Box, b: Box): Box => a.map((edge, n) => (n % 2 === 0 ? Math.min(edge, b[n]!) : Math.max(edge, b[n]!))) as Box;
