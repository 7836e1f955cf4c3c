import type { ViewData } from "./data";
import { h } from "./dom";
import { float32Digits, pretty, quantity } from "./units";

/** What is known of a point: the answer of picking. */
export interface Picked {
  result: string;
  point: number;
  state: number;
  undeformed: number[];
  deformed: number[];
  fields: Record<string, number[]>;
}

/** Number, places and values of a point. Values have all digits of their float32. */
export function tipContent(picked: Picked, view: ViewData): HTMLElement[] {
  const place = (p: number[]) => p.slice(0, view.dimension).map((c) => quantity(c, "m", 5)).join(", ");
  const rows = view.fields
    .filter((field) => picked.fields[field.name])
    .map(({ name, unit }) => tipRow(name, lines(picked.fields[name]!.map(float32Digits)), unit));
  const table = h("table", {}, tipRow("undeformed", [place(picked.undeformed)]), tipRow("deformed", [place(picked.deformed)]), ...rows);
  return [h("strong", {}, `point ${picked.point}`), table];
}

/** A tensor has nine numbers: in three rows, as it is written. */
const lines = (digits: string[]): string[] =>
  digits.length === 9 ? [0, 3, 6].map((at) => digits.slice(at, at + 3).join(", ")) : [digits.join(", ")];

function tipRow(name: string, values: string[], unit = ""): HTMLElement {
  const last = values.length - 1;
  const cells = values.map((value, n) => h("div", {}, n === last && unit ? `${value} ${pretty(unit)}` : value));
  return h("tr", {}, h("th", {}, name), h("td", {}, ...cells));
}
