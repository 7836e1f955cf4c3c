// Numbers, facts and texts of the results, side by side where there are several.

import type { ResultData, Verdict } from "./data";
import { h, words } from "./dom";
import { pretty, quantity, short } from "./units";

type Cell = { text: string; title?: string | undefined; class?: string };

function table(head: string[], rows: Cell[][], label: string): HTMLElement {
  const cells = (row: Cell[]) =>
    row.map((cell, n) => h(n === 0 ? "th" : "td", { title: cell.title, class: cell.class, scope: n === 0 ? "row" : undefined }, cell.text));
  const body = rows.map((row) => h("tr", {}, ...cells(row)));
  const top = h("thead", {}, h("tr", {}, ...head.map((name) => h("th", { scope: "col" }, name))));
  return h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": label }, h("table", {}, top, h("tbody", {}, ...body)));
}

/** All of `lists`' names in the order in which they first come. */
const allNames = (lists: string[][]): string[] => [...new Set(lists.flat())];

/** A column for each result; over a single one there is no need to say whose it is. */
const resultColumns = (results: ResultData[], single: string): string[] => (results.length > 1 ? results.map((r) => r.label) : [single]);

function whyNoMetrics(results: ResultData[]): string {
  const stuck = results.filter((r) => r.status !== "finished" && r.histories.every((history) => history.rows === 0)).length;
  const several = results.length > 1;
  if (stuck === results.length) return several ? "The runs reached no state." : "The run reached no state.";
  if (stuck > 0) return "There are no metrics: runs reached no state, or their cases have no probes.";
  return several ? "These results have no metrics: their cases have no probes." : "This result has no metrics: its case has no probes.";
}

export function metricsTable(results: ResultData[]): HTMLElement {
  const names = allNames(results.map((r) => r.metrics.map((m) => m.name)));
  if (names.length === 0) return h("p", { class: "quiet" }, whyNoMetrics(results));
  const rows = names.map((name): Cell[] => [
    { text: words(name) },
    ...results.map(({ metrics }): Cell => {
      const metric = metrics.find((m) => m.name === name);
      if (!metric || metric.value === null) return { text: "–", class: "number" };
      return { text: quantity(metric.value, metric.unit, 6), title: exact(metric.value, metric.unit), class: "number" };
    }),
  ]);
  return table(["at the final state", ...resultColumns(results, "value")], rows, "Metrics at the final state");
}

const exact = (value: number, unit: string): string => `${value}${unit ? " " + pretty(unit) : ""}`;

const VERDICTS = { ok: "✓ ok", missed: "✗ missed", reported: "reported" } as const;

function percent(deviation: number | null): Cell {
  if (deviation === null) return { text: "–", class: "number" };
  const text = `${deviation > 0 ? "+" : ""}${short(100 * deviation, 3)} %`;
  return { text, title: String(deviation), class: "number" };
}

/** What several results may have been held against alike: the same value at the same state. */
const sameVerdict = (v: Verdict): string => JSON.stringify([v.what, v.at, v.kind, v.expected, v.limit, v.source]);

function verdictRow(key: string, results: ResultData[]): Cell[] {
  const found = results.map(({ verdicts }) => verdicts.find((v) => sameVerdict(v) === key));
  const first = found.find((v) => v !== undefined)!;
  const { parameter } = results[found.indexOf(first)]!;
  const value = (v: number | null): Cell => ({
    text: quantity(v, first.unit, 6),
    title: v === null ? undefined : exact(v, first.unit),
    class: "number",
  });
  const expected = (kind: Verdict["kind"]): Cell => (first.kind === kind ? value(first.expected) : { text: "" });
  const ours = found.flatMap((v): Cell[] => {
    if (!v) return [{ text: "–" }, { text: "" }, { text: "" }];
    return [value(v.ours), percent(v.deviation), { text: VERDICTS[v.verdict] ?? v.verdict, class: `verdict ${v.verdict}` }];
  });
  const at = `${parameter.name} ${quantity(first.at, parameter.unit)}`;
  return [{ text: words(first.what) }, { text: at, class: "number" }, expected("published"), expected("reference"), ...ours, { text: first.limit, class: "number" }, { text: first.source, class: "source" }];
}

/** Published / reference / ours / deviation; of several results, ours and deviation side by side. */
export function verdictTable(results: ResultData[]): HTMLElement {
  const some = results.filter((r) => r.verdicts.length > 0);
  if (some.length === 0) return h("p", { class: "quiet" }, "The case expects nothing: there is no published or reference value to compare with.");
  const keys = allNames(some.map((r) => r.verdicts.map(sameVerdict)));
  const ours = some.flatMap((r) => [results.length > 1 ? `ours: ${r.label}` : "ours", "deviation", "verdict"]);
  const head = ["what", "at", "published", "reference", ...ours, "limit", "source"];
  return h("div", { class: "verdicts" }, table(head, keys.map((key) => verdictRow(key, some)), "Published, reference, ours"));
}

export function factsTable(results: ResultData[]): HTMLElement {
  const labels = allNames(results.map((r) => r.facts.map((f) => f.label)));
  const rows = labels.map((label): Cell[] => [
    { text: label },
    ...results.map(({ facts }): Cell => ({ text: facts.find((f) => f.label === label)?.value ?? "–" })),
  ]);
  return table(["fact", ...resultColumns(results, "value")], rows, "Run facts");
}

const TEXTS = [
  ["As written", "case_text"],
  ["Resolved (all defaults, SI)", "resolved_text"],
  ["Log (last lines)", "log_text"],
] as const;

/** Three texts under tabs; the arrow keys go from tab to tab. */
export function caseTexts(results: ResultData[]): HTMLElement {
  const panel = h("div", { class: "texts", id: "case-panel", role: "tabpanel" });
  const tabs = TEXTS.map(([label, key], n) => h("button", { type: "button", role: "tab", "aria-controls": panel.id, id: `tab-${key}`, onclick: () => show(n) }, label));
  const show = (n: number): void => {
    const key = TEXTS[n]![1];
    tabs.forEach((tab, k) => {
      tab.setAttribute("aria-selected", String(k === n));
      tab.tabIndex = k === n ? 0 : -1;
    });
    panel.setAttribute("aria-labelledby", tabs[n]!.id);
    panel.replaceChildren(...results.map((result) => textOf(result, result[key], results.length > 1)));
  };
  const bar = h("div", { class: "tabs", role: "tablist", "aria-label": "Texts of the case" }, ...tabs);
  bar.addEventListener("keydown", (event) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0) return;
    event.stopPropagation();
    const next = (tabs.findIndex((tab) => tab.tabIndex === 0) + step + tabs.length) % tabs.length;
    show(next);
    tabs[next]!.focus();
  });
  show(0);
  return h("div", {}, bar, panel);
}

function textOf(result: ResultData, text: string, named: boolean): HTMLElement {
  const body = h("pre", { tabindex: "0", "aria-label": `Text of ${result.name}` }, text || "(empty)");
  return h("div", { class: "text" }, named ? h("h3", { title: result.name }, result.label) : null, body);
}
