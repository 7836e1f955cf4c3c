// The controls below the view, and the keys.

import { download, fileName, h } from "./dom";
import { components, componentName, EMPTY_RANGE, type Component } from "./fields";
import type { ColourMap, ResultData } from "./data";
import { words } from "./dom";
import { pretty, quantity, scaleFor, short } from "./units";
import type { View } from "./view";

/** A picture of a run is on the screen this long (ms), at least. */
const FRAME = 280;

export class Controls {
  readonly element = h("div", { class: "controls" });
  private readonly play = h("button", { type: "button", class: "icon", title: "Play (space)", "aria-label": "Play", onclick: () => this.togglePlay() }, "▶");
  private readonly slider = h("input", { type: "range", min: 0, step: 1, "aria-label": "State" });
  private readonly stateText = h("output", { class: "state" });
  private readonly field = h("select", { "aria-label": "Field" });
  private readonly component = h("select", { "aria-label": "Component" });
  private readonly map = h("select", { "aria-label": "Colour map" });
  private readonly range = h("select", { "aria-label": "Range of the colours" });
  private readonly low = h("input", { type: "number", step: "any", "aria-label": "Lowest colour", class: "wide" });
  private readonly high = h("input", { type: "number", step: "any", "aria-label": "Highest colour", class: "wide" });
  private readonly rangeUnit = h("span", { class: "quiet" });
  private readonly deformation = h("input", { type: "number", step: "any", min: 0, value: 1, "aria-label": "Scale of the deformation" });
  private readonly deformationSlider = h("input", { type: "range", min: 0, max: 100, step: 1, "aria-label": "Scale of the deformation (slider)" });
  private readonly clip = h("input", { type: "checkbox", "aria-label": "Hide damaged points" });
  private readonly clipAt = h("input", { type: "number", step: 0.05, min: 0, max: 1, value: 0.35, "aria-label": "Hide points with damage above" });
  private readonly clipText = h("span", { class: "quiet" });
  private readonly ghost = h("input", { type: "checkbox" });
  private largest = 2;
  private playing = false;

  constructor(
    private readonly view: View,
    private readonly results: ResultData[],
    maps: ColourMap[],
  ) {
    this.slider.max = String(Math.max(0, view.values.length - 1));
    for (const map of maps) this.map.append(h("option", { value: map.name, title: map.label }, words(map.name)));
    for (const [value, label] of [["all", "all states"], ["state", "this state"], ["typed", "typed"]] as const)
      this.range.append(h("option", { value }, label));
    for (const field of view.fields) this.field.append(h("option", { value: field.name }, words(field.name)));
    this.lay();
    this.listen();
    view.onChange(() => this.show());
  }

  private lay(): void {
    const label = (name: string, ...of: (Node | string)[]) => h("label", {}, h("span", { class: "label" }, name), ...of);
    const group = (name: string, ...of: (Node | string)[]) => h("span", { class: "group" }, h("span", { class: "label" }, name), ...of);
    const has = (name: string) => this.view.fields.some((f) => f.name === name);
    const button = (text: string, title: string, action: () => void) => h("button", { type: "button", title, onclick: action }, text);
    const looks = this.view.dimension === 3 ? ["x", "y", "z"].map((d) => button(`${d}`, `Look along ${d}`, () => void this.view.fit(d))) : [];
    const rows = [
      this.view.values.length > 0 ? h("div", { class: "row states" }, this.play, this.slider, this.stateText) : null,
      h(
        "div",
        { class: "row" },
        this.view.fields.length > 0 ? group("Colour", this.field, this.component) : null,
        label("Map", this.map),
        group("Range", this.range, this.low, "–", this.high, this.rangeUnit),
        has("displacement") ? group("Deformation ×", this.deformation, this.deformationSlider) : null,
        has("damage") ? h("span", { class: "group" }, h("label", {}, this.clip, "hide damage >"), this.clipAt, this.clipText) : null,
        h("label", {}, this.ghost, "undeformed"),
        h("span", { class: "group push" }, looks.length > 0 ? h("span", { class: "label" }, "Along") : null, ...looks, button("Reset view", "Show all (r)", () => void this.view.fit()), button("Save picture", "As PNG, with title and colour bar", () => void this.savePicture())),
      ),
    ];
    this.element.append(...rows.filter((row) => row !== null));
  }

  private listen(): void {
    const view = this.view;
    this.slider.addEventListener("input", () => void this.go(Number(this.slider.value), true));
    this.field.addEventListener("change", () => void this.setField(this.field.value));
    this.component.addEventListener("change", () => void view.set({ component: componentOf(this.component.value) }));
    this.map.addEventListener("change", () => void view.set({ map: this.map.value }));
    this.range.addEventListener("change", () => this.chooseRange());
    for (const input of [this.low, this.high]) input.addEventListener("change", () => this.typedRange());
    this.deformation.addEventListener("change", () => {
      const value = Number(this.deformation.value);
      if (Number.isFinite(value) && value >= 0) void view.set({ deformation: value });
    });
    this.deformationSlider.addEventListener("input", () => {
      void view.set({ deformation: Number(((Number(this.deformationSlider.value) / 100) * this.largest).toPrecision(3)) }, true);
    });
    const clip = () => void view.set({ clip: this.clip.checked ? Number(this.clipAt.value) : null });
    this.clip.addEventListener("change", clip);
    this.clipAt.addEventListener("change", clip);
    this.ghost.addEventListener("change", () => void view.set({ ghost: this.ghost.checked }));
  }

  /** Deformation may be drawn so large that it can be seen: the slider's end makes it a quarter of the body. */
  async scaleSlider(): Promise<void> {
    const part = await this.view.largestDisplacement();
    const wanted = part > 0 ? 0.25 / part : 2;
    const power = 10 ** Math.floor(Math.log10(wanted));
    this.largest = Math.max(2, Math.ceil(wanted / power) * power);
    this.show();
  }

  setField(name: string, component?: Component): Promise<void> {
    const field = this.view.fields.find((f) => f.name === name);
    if (!field) return Promise.reject(new Error(`no field "${name}"`));
    const first = field.components === 1 ? 0 : "magnitude";
    const typed = Array.isArray(this.view.settings.range);
    return this.view.set({ field: name, component: component ?? first, ...(typed ? { range: "all" as const } : {}) });
  }

  go(state: number, moving = false): Promise<void> {
    return this.view.set({ state }, moving);
  }

  private chooseRange(): void {
    if (this.range.value !== "typed") {
      void this.view.set({ range: this.range.value as "all" | "state" });
      return;
    }
    void this.view.set({ range: [...this.view.range] });
  }

  private get unitScale(): { factor: number; unit: string } {
    const [low, high] = this.view.range ?? EMPTY_RANGE;
    return scaleFor(Math.max(Math.abs(low), Math.abs(high)), this.view.field?.unit ?? "");
  }

  private typedRange(): void {
    const { factor } = this.unitScale;
    const [low, high] = [Number(this.low.value) / factor, Number(this.high.value) / factor];
    if (low < high) void this.view.set({ range: [low, high] });
    else this.show();
  }

  /** Takes over what the view shows. */
  show(): void {
    const { view } = this;
    const { settings } = view;
    this.slider.value = String(settings.state);
    this.stateText.textContent = this.stateName();
    this.slider.setAttribute("aria-valuetext", this.stateText.textContent);
    this.field.value = settings.field;
    this.showComponents();
    this.map.value = settings.map;
    this.range.value = Array.isArray(settings.range) ? "typed" : settings.range;
    const { factor, unit } = this.unitScale;
    const digits = (v: number) => {
      const text = String(Number((v * factor).toPrecision(4)));
      return text.length > 9 ? (v * factor).toExponential(3) : text;
    };
    const typed = Array.isArray(settings.range);
    for (const [input, value] of [[this.low, view.range[0]], [this.high, view.range[1]]] as const) {
      input.value = digits(value);
      input.disabled = !typed;
    }
    this.rangeUnit.textContent = pretty(unit);
    this.deformation.value = String(settings.deformation);
    this.deformationSlider.value = String((100 * settings.deformation) / this.largest);
    this.clip.checked = settings.clip !== null;
    const hidden = this.results.map((r, n) => r.view!.points - view.shownPoints()[n]!);
    this.clipText.textContent = settings.clip === null ? "" : `${hidden.join(", ")} hidden`;
    this.ghost.checked = settings.ghost;
  }

  private showComponents(): void {
    const { field, settings } = this.view;
    const choices = field ? components(field, this.view.dimension) : [];
    this.component.hidden = choices.length < 2;
    this.component.replaceChildren(...choices.map((c) => h("option", { value: c }, componentName(field!, c))));
    this.component.value = String(settings.component);
  }

  private stateName(): string {
    const { parameter } = this.results[0]!;
    const { values, settings } = this.view;
    if (values.length === 0) return "undeformed";
    if (this.view.byNumber) return `state ${settings.state + 1} of ${values.length}`;
    return `${parameter.name} ${quantity(this.view.value, parameter.unit)} (${settings.state + 1} of ${values.length})`;
  }

  // --- playing -------------------------------------------------------------------------------------------------

  togglePlay(): void {
    this.playing = !this.playing;
    this.play.textContent = this.playing ? "⏸" : "▶";
    this.play.setAttribute("aria-label", this.playing ? "Pause" : "Play");
    if (this.playing) void this.run();
  }

  private async run(): Promise<void> {
    const last = this.view.values.length - 1;
    if (this.view.settings.state >= last) await this.go(0);
    while (this.playing && this.view.settings.state < last) {
      await new Promise((next) => setTimeout(next, FRAME));
      if (this.playing) await this.go(this.view.settings.state + 1, true);
    }
    if (this.playing) this.togglePlay();
  }

  get isPlaying(): boolean {
    return this.playing;
  }

  private async savePicture(): Promise<void> {
    const name = `${this.results.map((r) => fileName(r.name)).join("-")}-${fileName(this.view.settings.field)}-${this.view.byNumber ? "state-" : ""}${short(this.view.value)}.png`;
    download(name, await this.view.picture());
  }

  // --- keys ----------------------------------------------------------------------------------------------------

  /** Keys that work wherever the focus is, but in fields where they mean something themselves. */
  key(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.altKey || event.metaKey) return false;
    const target = event.target as HTMLElement;
    const tag = target.tagName;
    if (tag === "INPUT" && (target as HTMLInputElement).type !== "checkbox" && event.target !== this.slider) return false;
    if (tag === "SELECT" || tag === "PRE") return false;
    if (event.key === " " && (tag === "BUTTON" || tag === "SUMMARY" || tag === "A" || tag === "INPUT")) return event.target === this.slider && this.press(" ", event.shiftKey);
    return this.press(event.key, event.shiftKey);
  }

  private press(key: string, shift: boolean): boolean {
    const { view } = this;
    const state = view.settings.state;
    const arrows: Record<string, "left" | "right" | "up" | "down"> = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" };
    if (shift && arrows[key]) return view.nudge(arrows[key]), true;
    if (key === " ") return this.togglePlay(), true;
    if (key === "ArrowLeft") return void this.go(state - 1, true), true;
    if (key === "ArrowRight") return void this.go(state + 1, true), true;
    if (key === "Home") return void this.go(0), true;
    if (key === "End") return void this.go(view.values.length - 1), true;
    if (key === "+" || key === "=") return view.nudge("in"), true;
    if (key === "-") return view.nudge("out"), true;
    if (key === "r") return void view.fit(), true;
    return false;
  }
}

const componentOf = (text: string): Component => (text === "magnitude" ? "magnitude" : Number(text));
