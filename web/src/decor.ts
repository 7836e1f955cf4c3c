// What is drawn around and over the field: axes, colour bar, triad. The screen and saved pictures share this code.

import type { Vector } from "./camera";
import { colour, FONT } from "./theme";
import { pretty, scaleFor, short, tickLabels, ticks } from "./units";

export interface Inset {
  left: number;
  right: number;
  top: number;
  bottom: number;
}
/** The field itself is drawn inside of these margins (CSS pixels). */
export const insetFor = (dimension: 2 | 3): Inset =>
  dimension === 2 ? { left: 58, right: 12, top: 10, bottom: 40 } : { left: 4, right: 4, top: 4, bottom: 4 };

export interface Bar {
  title: string;
  unit: string;
  low: number;
  high: number;
  table: Uint8Array;
}
export interface Decor {
  width: number;
  height: number;
  inset: Inset;
  /** 2D: what part of the plane is to be seen (m). */
  plane: { x: [number, number]; y: [number, number] } | null;
  /** 3D: the axes x, y, z as they point on the screen (right, up), and the size of the body. */
  triad: { axes: [number, number, number][]; size: Vector } | null;
}

type Ctx = CanvasRenderingContext2D;

export function drawDecor(ctx: Ctx, decor: Decor): void {
  ctx.save();
  ctx.lineWidth = 1;
  if (decor.plane) drawAxes(ctx, decor, decor.plane);
  if (decor.triad) drawTriad(ctx, decor, decor.triad);
  ctx.restore();
}

function text(ctx: Ctx, words: string, x: number, y: number, align: CanvasTextAlign, size = 12, weight = 400): void {
  ctx.font = `${weight} ${size}px ${FONT}`;
  ctx.textAlign = align;
  ctx.textBaseline = "middle";
  ctx.fillStyle = colour("ink");
  ctx.fillText(words, x, y);
}

function line(ctx: Ctx, x0: number, y0: number, x1: number, y1: number, stroke = colour("axis")): void {
  ctx.strokeStyle = stroke;
  ctx.beginPath();
  ctx.moveTo(x0, y0);
  ctx.lineTo(x1, y1);
  ctx.stroke();
}

/** Axes with ticks along the left and the lower edge, in one unit of length. */
function drawAxes(ctx: Ctx, decor: Decor, plane: NonNullable<Decor["plane"]>): void {
  const { inset, width, height } = decor;
  const [left, right, top, bottom] = [inset.left, width - inset.right, inset.top, height - inset.bottom];
  const scale = scaleFor(Math.max(plane.x[1] - plane.x[0], plane.y[1] - plane.y[0]) / 2, "m");
  ctx.strokeStyle = colour("axis");
  ctx.strokeRect(left - 0.5, top - 0.5, right - left + 1, bottom - top + 1);

  const xs = ticks(plane.x[0] * scale.factor, plane.x[1] * scale.factor, (right - left) / 65);
  tickLabels(xs).forEach((label, n) => {
    const x = left + ((xs[n]! / scale.factor - plane.x[0]) / (plane.x[1] - plane.x[0])) * (right - left);
    line(ctx, x, bottom, x, bottom + 5);
    text(ctx, label, x, bottom + 14, "center");
  });
  const ys = ticks(plane.y[0] * scale.factor, plane.y[1] * scale.factor, (bottom - top) / 50);
  tickLabels(ys).forEach((label, n) => {
    const y = bottom - ((ys[n]! / scale.factor - plane.y[0]) / (plane.y[1] - plane.y[0])) * (bottom - top);
    line(ctx, left - 5, y, left, y);
    text(ctx, label, left - 8, y, "right");
  });
  text(ctx, `x [${scale.unit}]`, (left + right) / 2, height - 10, "center", 12, 600);
  ctx.save();
  ctx.translate(9, (top + bottom) / 2);
  ctx.rotate(-Math.PI / 2);
  text(ctx, `y [${scale.unit}]`, 0, 0, "center", 12, 600);
  ctx.restore();
}

const AXIS_NAMES = ["x", "y", "z"];
const AXIS_COLOURS = ["#d1495b", "#3a9a4e", "#3b7dd8"];

function drawTriad(ctx: Ctx, decor: Decor, triad: NonNullable<Decor["triad"]>): void {
  const arm = 30;
  const [ox, oy] = [52, decor.height - 68];
  ctx.lineWidth = 2;
  // Axes that point to the viewer are drawn last, over the others.
  const order = [0, 1, 2].sort((a, b) => triad.axes[a]![2] - triad.axes[b]![2]);
  for (const a of order) {
    const [right, up] = triad.axes[a]!;
    line(ctx, ox, oy, ox + arm * right, oy - arm * up, AXIS_COLOURS[a]);
    text(ctx, AXIS_NAMES[a]!, ox + (arm + 10) * right, oy - (arm + 10) * up, "center", 12, 600);
  }
  ctx.lineWidth = 1;
  const scale = scaleFor(Math.max(...triad.size), "m");
  const size = triad.size.map((s) => short(s * scale.factor, 3)).join(" × ");
  text(ctx, `undeformed: ${size} ${scale.unit}`, 12, decor.height - 16, "left");
}

/** The width of a colour bar with its numbers (CSS pixels). */
export const BAR_WIDTH = 108;

/** The colour bar: title, unit and numbers that all fit into its width. */
export function drawBar(ctx: Ctx, bar: Bar, whole: number): void {
  const scale = scaleFor(Math.max(Math.abs(bar.low), Math.abs(bar.high)), bar.unit);
  const left = 8;
  ctx.lineWidth = 1;
  const lines = titleLines(ctx, bar, pretty(scale.unit));
  lines.forEach((words, n) => text(ctx, words, left - 1, 18 + 15 * n, "left", 12, 600));
  const top = 26 + 15 * lines.length;
  const bottom = whole - 22;
  const steps = bar.table.length / 3;
  const height = bottom - top;
  for (let y = 0; y < height; ++y) {
    const n = 3 * Math.round((1 - y / Math.max(1, height - 1)) * (steps - 1));
    ctx.fillStyle = `rgb(${bar.table[n]},${bar.table[n + 1]},${bar.table[n + 2]})`;
    ctx.fillRect(left, top + y, 14, 1.5);
  }
  ctx.strokeStyle = colour("axis");
  ctx.strokeRect(left - 0.5, top - 0.5, 15, height + 1);
  const marks = barMarks(bar.low * scale.factor, bar.high * scale.factor, height / 40);
  marks.forEach(({ value, label }) => {
    const span = (bar.high - bar.low) * scale.factor;
    const y = span > 0 ? bottom - ((value - bar.low * scale.factor) / span) * height : (top + bottom) / 2;
    line(ctx, left + 14, y, left + 18, y);
    text(ctx, label, left + 21, y, "left");
  });
}

function barMarks(low: number, high: number, wanted: number): { value: number; label: string }[] {
  if (!(high > low)) return [{ value: low, label: short(low, 5) }];
  const values = ticks(low, high, wanted);
  return tickLabels(values).map((label, n) => ({ value: values[n]!, label }));
}

/** The title in lines of the width that there is, and the unit in a line of its own. */
function titleLines(ctx: Ctx, bar: Bar, unit: string): string[] {
  ctx.font = `600 12px ${FONT}`;
  const lines: string[] = [];
  for (const word of bar.title.split(" ")) {
    const longer = `${lines.at(-1) ?? ""} ${word}`.trim();
    if (lines.length > 0 && ctx.measureText(longer).width < 98) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return unit ? [...lines, `[${unit}]`] : lines;
}
