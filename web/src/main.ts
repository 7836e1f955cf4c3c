// Builds the page from the data in it.

import "uplot/dist/uPlot.min.css";
import "./style.css";
import { Controls } from "./controls";
import { canUnpack, DataError, parametersOf, readPage, type PageData, type ResultData } from "./data";
import { h } from "./dom";
import type { Component } from "./fields";
import { helpDialog } from "./help";
import { Plots } from "./plots";
import { caseTexts, factsTable, metricsTable, verdictTable } from "./tables";
import { setTheme, theme } from "./theme";
import type { Picked } from "./tip";
import { View } from "./view";
import { hasWebGL2 } from "./vtk";

/** For tests and for the curious: the page from the console. */
interface Riven {
  /** Fulfilled when everything that can be shown is shown. */
  ready: Promise<void>;
  /** Shows state `index` (of all states of all results, by parameter); fulfilled when it is on the screen. */
  setState(index: number): Promise<void>;
  /** Colours by a field; `component`: an index or "magnitude". */
  setField(name: string, component?: Component): Promise<void>;
  /** What the view shows; null without a view. */
  state(): Record<string, unknown> | null;
  /** The point at x, y (CSS pixels of the page) with its values; null where there is none. */
  pickAt(x: number, y: number): Promise<Picked | null>;
  /** Where a point of result `n` is in the page, and whether it is to be seen. */
  placeOf(point: number, n?: number): { x: number; y: number; shown: boolean } | null;
  /** The lines of all plots, with their numbers of points. */
  plots(): ReturnType<Plots["summary"]>;
}
declare global {
  interface Window {
    riven: Riven;
  }
}

const STATUS = {
  finished: "The run came to its end.",
  failed: "The run failed. What it had reached by then is shown; the log below says why.",
  interrupted: "The run was interrupted. What it had reached by then is shown.",
  unfinished: "The run is not finished: it goes on, or was killed. What it has written is shown.",
} as const;

/** How the runs ended. Of several, those that finished share a badge. */
function badges(results: ResultData[]): HTMLElement[] {
  const badge = (status: ResultData["status"], text: string) => h("span", { class: `badge ${status}`, title: STATUS[status] }, text);
  if (results.length === 1) return [badge(results[0]!.status, results[0]!.status)];
  const finished = results.filter((r) => r.status === "finished").length;
  const others = results.filter((r) => r.status !== "finished").map((r) => badge(r.status, `${r.label}: ${r.status}`));
  return finished > 0 ? [badge("finished", `${finished} finished`), ...others] : others;
}

function header(data: PageData): HTMLElement {
  const { results, program, written } = data;
  const title = results.length === 1 ? results[0]!.title : results.map((r) => r.label).join(" · ");
  const link = (id: string, name: string) => h("a", { href: `#${id}` }, name);
  const help = helpDialog();
  const toggle = h("button", { type: "button", class: "icon", title: "Light or dark", "aria-label": "Light or dark", onclick: () => setTheme(theme() === "dark" ? "light" : "dark") }, "◐");
  const keys = h("button", { type: "button", class: "icon", title: "Keys (?)", "aria-label": "Keys", onclick: () => help.showModal() }, "?");
  document.addEventListener("keydown", (event) => {
    if (event.key === "?" && !help.open) help.showModal();
  });
  return h(
    "header",
    { class: "top" },
    h("h1", { title }, title),
    ...badges(results),
    h("nav", { "aria-label": "Sections" }, link("view", "View"), link("plots", "Plots"), link("numbers", "Numbers"), link("run", "Run"), link("case", "Case")),
    h("span", { class: "program", title: `written ${written}` }, program),
    toggle,
    keys,
    help,
  );
}

const message = (text: string, kind = "warning"): HTMLElement => h("p", { class: `message ${kind}`, role: kind === "error" ? "alert" : "status" }, text);

const words = (error: unknown): string =>
  error instanceof DataError ? error.message : `Something went wrong in this page: ${error instanceof Error ? error.message : String(error)}.`;

/** Sentences near the view: what went wrong in the run, what was thinned. */
function remarks(results: ResultData[]): HTMLElement[] {
  const named = (r: ResultData, text: string) => (results.length > 1 ? `${r.label}: ${text}` : text);
  return results.flatMap((r) => [
    ...(r.status === "finished" ? [] : [message(named(r, STATUS[r.status]), r.status === "failed" ? "error" : "warning")]),
    ...r.notes.map((note) => message(named(r, note), "note")),
  ]);
}

/** "a, b and c"; `before` stands before each but the first. */
const listed = (names: string[], before: string): string => names.map((name, n) => (n === 0 ? name : before + name)).join(", ").replace(/, (?=[^,]*$)/, " and ");

/** More pictures side by side are too small, and browsers limit the number of drawings by WebGL in a page. */
const MOST_PANELS = 6;

/** The view with its controls; null (and a message in `place`) where there is nothing to draw or it cannot be drawn. */
async function openView(data: PageData, place: HTMLElement): Promise<{ view: View; controls: Controls } | null> {
  const all = data.results.filter((r) => r.view !== null);
  const drawn = all.slice(0, MOST_PANELS);
  if (drawn.length < all.length) place.append(message(`The first ${MOST_PANELS} of ${all.length} results are drawn; plots and tables have all of them.`, "note"));
  if (drawn.length === 0) {
    place.append(message(`${data.results.length > 1 ? "These results have" : "This result has"} no field files: there is nothing to draw.`, "note"));
    return null;
  }
  if (!hasWebGL2()) {
    place.append(message("The field view needs WebGL 2, which this browser does not offer here. Plots and tables work."));
    return null;
  }
  if (!canUnpack()) return null;
  const parameters = parametersOf(drawn);
  if (parameters.length > 1) place.append(message(`Results over ${listed(parameters, "over ")}: the slider goes by state number.`, "note"));
  const view = new View(drawn, data.colour_maps);
  const controls = new Controls(view, drawn, data.colour_maps);
  place.append(view.element, controls.element);
  const told = new Set<string>();
  view.onError((error) => {
    if (!told.has(words(error))) place.prepend(message(words(error), "error"));
    told.add(words(error));
  });
  try {
    await view.open();
    await controls.scaleSlider();
  } catch (error) {
    place.replaceChildren(message(words(error), "error"));
    return null;
  }
  return { view, controls };
}

async function openPlots(plots: Plots, results: ResultData[], place: HTMLElement): Promise<void> {
  if (!canUnpack()) {
    place.append(message("This browser is too old to unpack the data (no DecompressionStream): fields and plots are left out. Tables work."));
    return;
  }
  await plots.open(results, (error) => place.prepend(message(words(error), "error")));
}

function sections(results: ResultData[]): HTMLElement[] {
  const section = (id: string, title: string, ...of: Node[]) => h("section", { id, "aria-label": title }, h("h2", {}, title), ...of);
  return [
    section("numbers", "Numbers", verdictTable(results), metricsTable(results)),
    section("run", "Run", factsTable(results)),
    section("case", "Case", caseTexts(results)),
  ];
}

async function start(): Promise<void> {
  const page = document.getElementById("page")!;
  let data: PageData;
  try {
    data = readPage();
  } catch (error) {
    page.replaceChildren(message(words(error), "error"));
    return;
  }
  document.title = `${data.results.map((r) => r.title).join(" · ")} – Riven`;
  const { results } = data;
  const viewPlace = h("section", { id: "view", class: "view", "aria-label": "View" }, ...remarks(results));
  let shown: View | null = null;
  // The nearest state of each result is what its panel shows.
  const plots = new Plots((name) => shown?.valueOf(name) ?? NaN);
  window.riven.plots = () => plots.summary();
  const plotPlace = h("section", { id: "plots", class: "plot-side", "aria-label": "Plots" }, plots.element);
  const stage = h("div", { class: "stage" }, viewPlace, plotPlace);
  page.replaceChildren(header(data), h("main", {}, stage, ...sections(results)));

  const [opened] = await Promise.all([openView(data, viewPlace), openPlots(plots, results, plotPlace)]);
  stage.classList.toggle("without-view", !opened);
  stage.classList.toggle("without-plots", plotPlace.querySelector(".plot, .message") === null);
  if (!opened) return;
  shown = opened.view;
  opened.view.onChange(() => plots.mark());
  plots.mark();
  connect(opened.view, opened.controls);
}

function connect(view: View, controls: Controls): void {
  document.addEventListener("keydown", (event) => {
    if (controls.key(event)) event.preventDefault();
  });
  Object.assign(window.riven, {
    setState: (index: number) => controls.go(index),
    setField: (name: string, component?: Component) => controls.setField(name, component),
    state: () => ({ ...view.settings, value: view.value, values: view.values, range: view.range, playing: controls.isPlaying, shown: view.shownPoints() }),
    pickAt: (x: number, y: number) => view.pickAt(x, y),
    placeOf: (point: number, n = 0) => view.placeOf(point, n),
  });
}

const nothing = () => Promise.resolve();
window.riven = { ready: nothing(), setState: nothing, setField: nothing, state: () => null, pickAt: () => Promise.resolve(null), placeOf: () => null, plots: () => [] };
window.riven.ready = start();
