// The plots of the histories: which columns over which, and the files to download.

import { Chart } from "./chart";
import { readHistory, type Column, type ResultData } from "./data";
import { download, fileName, h, words } from "./dom";
import { csv, type Line, type Table } from "./series";
import { onTheme } from "./theme";
import { withUnit } from "./units";

/** Where the results are: the values of the parameter that the view shows, one per result (NaN: nothing shown). */
export type Shown = (result: string) => number;

/** At first not more lines than these: a plot of twenty probes says nothing. */
const FIRST_LINES = 4;

export class Plots {
  readonly element = h("div", { class: "plots" });
  private readonly cards: PlotCard[] = [];

  constructor(private readonly shown: Shown) {
    onTheme(() => this.cards.forEach((card) => card.chart.build()));
  }

  /** Unpacks the histories of all results and plots those of one name together; tells what is damaged. */
  async open(results: ResultData[], failed: (error: unknown) => void): Promise<void> {
    const names = [...new Set(results.flatMap((result) => result.histories.map((history) => history.name)))];
    for (const name of names) {
      const tables: Table[] = [];
      for (const result of results)
        for (const history of result.histories.filter((h) => h.name === name && h.rows > 0))
          await readHistory(history).then((columns) => tables.push({ result, history, columns }), failed);
      if (tables.length > 0) this.add(name, tables);
    }
    if (this.cards.length === 0) this.element.append(h("p", { class: "quiet" }, results.length > 1 ? "These results have no histories." : "This result has no histories."));
  }

  private add(name: string, tables: Table[]): void {
    const columns = allColumns(tables);
    for (const { title, chosen, files } of plotsOf(name, columns, (c) => hasNumber(tables, columns[c]!.name))) {
      const card = new PlotCard(title, tables, columns, chosen, files, this.shown);
      this.cards.push(card);
      this.element.append(card.element);
      card.draw();
    }
  }

  mark(): void {
    this.cards.forEach((card) => card.chart.mark());
  }

  summary(): { title: string; lines: { label: string; points: number }[] }[] {
    return this.cards.map((card) => ({ title: card.title, lines: card.chart.summary() }));
  }
}

/** The columns of all tables, each name once: cases need not have the same probes. */
function allColumns(tables: Table[]): Column[] {
  const columns = new Map<string, Column>();
  for (const { history } of tables) for (const column of history.columns) if (!columns.has(column.name)) columns.set(column.name, column);
  return [...columns.values()];
}

/** Whether there is anything to plot of a column. */
const hasNumber = (tables: Table[], name: string): boolean =>
  tables.some(({ history, columns }) => columns[history.columns.findIndex((column) => column.name === name)]?.some(Number.isFinite));

interface PlotPlan {
  title: string;
  chosen: number[]; // indices of columns
  files: boolean; // whether it offers the CSV files
}

/** What is plotted of a history at first. Energies and the error of their balance differ by powers of ten. */
function plotsOf(name: string, columns: Column[], filled: (column: number) => boolean): PlotPlan[] {
  const rest = columns.map((_, c) => c).slice(1).filter(filled);
  if (rest.length === 0) return []; // A case without probes has nothing but the parameter.
  if (name === "energy") {
    const error = rest.filter((c) => /balance|error/.test(columns[c]!.name));
    const energies = rest.filter((c) => !error.includes(c));
    const plans = [{ title: "Energy", chosen: energies }, { title: "Energy balance", chosen: error }];
    return plans.filter(({ chosen }) => chosen.length > 0).map((plan, n) => ({ ...plan, files: n === 0 }));
  }
  const { unit } = columns[rest[0]!]!;
  const chosen = rest.filter((c) => columns[c]!.unit === unit).slice(0, FIRST_LINES);
  const title = /^[a-z_]+$/.test(name) ? name.charAt(0).toUpperCase() + words(name).slice(1) : name;
  return [{ title, chosen, files: true }];
}

class PlotCard {
  readonly chart = new Chart();
  readonly element: HTMLElement;
  private readonly note = h("p", { class: "plot-note", hidden: true });
  private x = 0;

  constructor(
    readonly title: string,
    private readonly tables: Table[],
    private readonly columns: Column[],
    private chosen: number[],
    files: boolean,
    private readonly shown: Shown,
  ) {
    const head = h("header", {}, h("h3", {}, title), this.xChoice(), this.yChoice(), files ? this.fileButtons() : null);
    this.element = h("article", { class: "plot", "aria-label": `Plot: ${title}` }, head, this.chart.element, this.chart.legend, this.note);
  }

  draw(): void {
    const lines: Line[] = this.tables.flatMap((table) => this.linesOf(table));
    const { name, unit } = this.columns[this.x]!;
    const { log_x: logX = false, log_y: logY = false } = this.tables[0]!.history;
    const without = this.tables.filter((table) => !this.valuesIn(table, this.x));
    this.note.textContent = `Not over ${words(name)}, so left out: ${without.map(({ result }) => `${result.label} (over ${words(result.parameter.name)})`).join(", ")}.`;
    this.note.hidden = without.length === 0;
    this.chart.show(lines, { title: words(this.tables[0]!.history.name), xTitle: words(name), xUnit: unit, logX, logY, marks: () => this.marks() });
  }

  private linesOf(table: Table): Line[] {
    const x = this.valuesIn(table, this.x);
    return this.chosen.flatMap((column) => {
      const { name, unit } = this.columns[column]!;
      const y = this.valuesIn(table, column);
      const label = this.tables.length > 1 ? `${table.result.label}: ${words(name)}` : words(name);
      return x && y ? [{ label, name, unit, table, x, y }] : [];
    });
  }

  private valuesIn(table: Table, column: number): Float64Array | undefined {
    return table.columns[table.history.columns.findIndex(({ name }) => name === this.columns[column]!.name)];
  }

  /** x of the row that is nearest to the shown state. */
  private marks(): number[] {
    return this.tables.map((table) => {
      const value = this.shown(table.result.name);
      if (this.x === 0 && this.valuesIn(table, 0) === table.columns[0]) return value;
      const parameter = table.columns[0]!;
      let best = 0;
      parameter.forEach((p, row) => {
        if (Math.abs(p - value) < Math.abs(parameter[best]! - value)) best = row;
      });
      return Number.isNaN(value) ? NaN : (this.valuesIn(table, this.x)?.[best] ?? NaN);
    });
  }

  private xChoice(): HTMLElement {
    const select = h("select", { "aria-label": `${this.title}: x axis` });
    this.columns.forEach(({ name }, c) => select.append(h("option", { value: c }, words(name))));
    select.addEventListener("change", () => {
      this.x = Number(select.value);
      this.draw();
    });
    return h("label", {}, "over ", select);
  }

  /** A fold-out list of the columns, with boxes to tick. */
  private yChoice(): HTMLElement {
    const boxes = this.columns.map(({ name, unit }, c) => {
      const box = h("input", { type: "checkbox", value: c });
      box.checked = this.chosen.includes(c);
      box.addEventListener("change", () => this.choose(c, box.checked, list));
      return h("label", {}, box, ` ${withUnit(words(name), unit)}`);
    });
    const list = h("div", { class: "menu", tabindex: "-1" }, ...boxes);
    return foldOut("columns", `${this.title}: columns`, list);
  }

  /** There are two y axes: a column in a third unit takes the place of those in the unit chosen first. */
  private choose(column: number, on: boolean, list: HTMLElement): void {
    this.chosen = on ? [...this.chosen, column] : this.chosen.filter((c) => c !== column);
    const units = [...new Set(this.chosen.map((c) => this.columns[c]!.unit))];
    if (units.length > 2) this.chosen = this.chosen.filter((c) => this.columns[c]!.unit !== units[0]);
    list.querySelectorAll("input").forEach((box) => (box.checked = this.chosen.includes(Number(box.value))));
    this.draw();
  }

  private fileButtons(): HTMLElement {
    const buttons = this.tables.map((table) => {
      const save = () => download(`${fileName(table.result.name)}-${fileName(table.history.name)}.csv`, new Blob([csv(table)], { type: "text/csv" }));
      const label = this.tables.length > 1 ? table.result.label : "CSV";
      return h("button", { type: "button", class: "small", title: `Save the history of ${table.result.name} as CSV`, onclick: save }, label);
    });
    if (buttons.length === 1) return buttons[0]!;
    return foldOut("CSV", `${this.title}: CSV files`, h("div", { class: "menu", tabindex: "-1" }, ...buttons));
  }
}

/** A list that opens on a click and closes when the focus leaves it. */
function foldOut(name: string, label: string, list: HTMLElement): HTMLElement {
  const fold = h("details", { class: "choice" }, h("summary", { "aria-label": label }, name), list);
  fold.addEventListener("focusout", (event) => {
    if (!fold.contains(event.relatedTarget as Node | null)) fold.open = false;
  });
  fold.addEventListener("keydown", (event) => {
    if (event.key === "Escape") fold.open = false;
  });
  return fold;
}
