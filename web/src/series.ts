// Columns of histories, of one result or of several, as one table for uPlot.

import type { HistoryData, ResultData } from "./data";

/** A history of one result, unpacked. */
export interface Table {
  result: ResultData;
  history: HistoryData;
  columns: Float64Array[];
}

/** One line of a plot: y over x, in the order of the rows. */
export interface Line {
  label: string;
  unit: string;
  table: Table;
  name: string; // of the column
  x: Float64Array;
  y: Float64Array;
}

/** uPlot's form: x ascending, and for each line a value or null at each x. */
export interface Merged {
  x: number[];
  ys: (number | null)[][];
}

const number = (value: number): number | null => (Number.isFinite(value) ? value : null);

/** Lines of one table share their rows; those of several tables get rows of their own, sorted by x. */
export function merge(lines: Line[]): Merged {
  const rows: { x: number; row: number; table: Table }[] = [];
  for (const table of new Set(lines.map((line) => line.table))) {
    const { x } = lines.find((line) => line.table === table)!;
    for (let row = 0; row < x.length; ++row) if (Number.isFinite(x[row])) rows.push({ x: x[row]!, row, table });
  }
  rows.sort((a, b) => a.x - b.x || a.row - b.row);
  const ys = lines.map((line) => rows.map(({ row, table }) => (table === line.table ? number(line.y[row]!) : null)));
  return { x: rows.map(({ x }) => x), ys };
}

/** The row in which a line has a value, nearest to row `from`; null if it has none. */
export function nearestRow(x: ArrayLike<number>, y: ArrayLike<number | null | undefined>, from: number): number | null {
  if (y[from] != null) return from;
  let below = from;
  let above = from;
  while (below >= 0 && y[below] == null) --below;
  while (above < y.length && y[above] == null) ++above;
  if (below < 0) return above < y.length ? above : null;
  if (above >= y.length) return below;
  return x[from]! - x[below]! <= x[above]! - x[from]! ? below : above;
}

/** A history as CSV, in the form of the program's own files: "name [unit]" above the shortest exact digits. */
export function csv(table: Table): string {
  const cell = (text: string) => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const digits = (value: number) => (Number.isFinite(value) ? String(value) : Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf");
  const lines = [table.history.columns.map(({ name, unit }) => cell(unit ? `${name} [${unit}]` : name)).join(",")];
  for (let row = 0; row < table.history.rows; ++row) lines.push(table.columns.map((column) => digits(column[row]!)).join(","));
  return lines.join("\n") + "\n";
}
