import { h } from "./dom";

const KEYS: [string, string][] = [
  ["space", "play, pause"],
  ["← →", "state before, next state"],
  ["Home End", "first, last state"],
  ["+ −", "zoom in, out"],
  ["shift + arrows", "move the view (2D), turn it (3D)"],
  ["r", "show all"],
  ["?", "these keys"],
];
const MOUSE: [string, string][] = [
  ["drag", "move the view (2D), turn it (3D)"],
  ["shift + drag, right drag", "move the view (3D)"],
  ["wheel", "zoom at the pointer"],
  ["point at a point", "its number, place and values"],
  ["drag in a plot", "zoom; double click: back"],
];

/** The dialog that lists keys and gestures. */
export function helpDialog(): HTMLDialogElement {
  const list = (pairs: [string, string][]) => h("table", {}, ...pairs.map(([key, what]) => h("tr", {}, h("th", { scope: "row" }, key), h("td", {}, what))));
  const dialog = h("dialog", { class: "help", "aria-label": "Keys" }, h("h2", {}, "Keys"), list(KEYS), h("h2", {}, "Mouse"), list(MOUSE), h("button", { type: "button", onclick: () => dialog.close() }, "Close"));
  return dialog;
}
