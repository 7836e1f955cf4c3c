// One plot: a few lines over x, drawn by uPlot.

import uPlot from "uplot";
import { DASHES, LINE_COLOURS, LINE_COLOURS_DARK } from "./colours";
import { h, words } from "./dom";
import { merge, nearestRow, type Line, type Merged } from "./series";
import { colour, FONT, theme } from "./theme";
import { powerOfTen, pretty, scaleFor, tickLabels, withUnit } from "./units";

export interface ChartOptions {
  /** Of the y axis, where the names of its lines have no word in common. */
  title: string;
  xTitle: string;
  xUnit: string;
  logX: boolean;
  logY: boolean;
  /** Where the shown state is on the x axis; one per result. */
  marks(): number[];
}

interface LineStyle {
  stroke: string;
  dash: readonly number[];
}

/** A short history is drawn with a dot at each row. */
const DOTS_UP_TO = 30;

export class Chart {
  readonly element = h("div", { class: "chart" });
  readonly legend = h("div", { class: "legend" });
  private readonly tip = h("div", { class: "tip chart-tip", hidden: true });
  private plot: uPlot | null = null;
  private lines: Line[] = [];
  private merged: Merged = { x: [], ys: [] };
  private options: ChartOptions | null = null;

  constructor() {
    this.element.append(this.tip);
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  /** Shows `lines`, instead of those there were. */
  show(lines: Line[], options: ChartOptions): void {
    this.lines = lines;
    this.options = options;
    this.merged = merge(lines);
    this.build();
  }

  /** Draws anew: for another theme. */
  build(): void {
    if (!this.options) return;
    this.plot?.destroy();
    this.tip.hidden = true;
    const data = [this.merged.x, ...this.merged.ys] as uPlot.AlignedData;
    this.plot = new uPlot(this.uplotOptions(this.options), data, this.element);
    this.drawLegend();
  }

  /** The state shown elsewhere has changed. */
  mark(): void {
    this.plot?.redraw(false);
  }

  /** What is drawn: label and number of points of each line. */
  summary(): { label: string; points: number }[] {
    return this.lines.map((line, n) => ({
      label: line.label,
      points: this.merged.ys[n]!.filter((y) => y !== null).length,
    }));
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width > 0 && height > 0) this.plot?.setSize({ width, height });
  }

  private style(n: number): LineStyle {
    const tables = [...new Set(this.lines.map((line) => line.table))];
    const columns = [...new Set(this.lines.map((line) => line.name))];
    const table = tables.indexOf(this.lines[n]!.table);
    const column = columns.indexOf(this.lines[n]!.name);
    // Several results: a colour for each; the dashes tell columns apart, or results where there is one column.
    const hue = tables.length > 1 ? table : column;
    const dash = tables.length > 1 && columns.length === 1 ? table : column;
    const colours = theme() === "dark" ? LINE_COLOURS_DARK : LINE_COLOURS;
    return { stroke: colours[hue % colours.length]!, dash: DASHES[dash % DASHES.length]! };
  }

  private uplotOptions(options: ChartOptions): uPlot.Options {
    const units = [...new Set(this.lines.map((line) => line.unit))];
    const dots = this.merged.x.length <= DOTS_UP_TO;
    const series = this.lines.map((line, n): uPlot.Series => {
      const { stroke, dash } = this.style(n);
      return {
        label: line.label,
        scale: `y${units.indexOf(line.unit)}`,
        stroke,
        dash: [...dash],
        width: 1.75,
        paths: inRowOrder(line),
        points: { show: dots, size: 5, fill: stroke },
      };
    });
    const axes = [axis("x", options.xTitle, options.xUnit), ...units.map((unit, k) => this.yAxis(unit, k))];
    return {
      width: Math.max(50, this.element.clientWidth),
      height: Math.max(50, this.element.clientHeight),
      legend: { show: false },
      cursor: {
        drag: { x: true, y: true, uni: 12 },
        points: { size: 8 },
        dataIdx: (u, s, row) => (s === 0 ? row : nearestRow(u.data[0]!, u.data[s]!, row)) as number,
      },
      scales: {
        x: { time: false, distr: options.logX ? 3 : 1, ...(options.logX ? {} : { range: padded(0) }) },
        ...Object.fromEntries(units.map((_, k) => [`y${k}`, options.logY ? { distr: 3 as const } : { range: padded(0.06) }])),
      },
      series: [{ label: options.xTitle }, ...series],
      axes,
      hooks: { setCursor: [(u) => this.drawTip(u)], draw: [(u) => drawMarks(u, options.marks())] },
    };
  }

  private yAxis(unit: string, k: number): uPlot.Axis {
    const names = [...new Set(this.lines.filter((line) => line.unit === unit).map((line) => line.name))];
    const title = names.length <= 2 ? names.map(words).join(", ") : commonWord(names) || this.options!.title;
    return { ...axis(`y${k}`, title, unit), side: k === 0 ? 3 : 1, grid: { show: k === 0, stroke: colour("grid"), width: 1 } };
  }

  private drawLegend(): void {
    const item = (sample: SVGSVGElement, name: string) => h("span", { class: "item" }, sample, name);
    const tables = [...new Set(this.lines.map((line) => line.table))];
    const names = [...new Set(this.lines.map((line) => line.name))];
    if (tables.length < 2 || names.length < 2) {
      this.legend.replaceChildren(...this.lines.map((line, n) => item(this.sample(this.style(n)), line.label)));
      return;
    }
    // Many lines: what the colours mean, and what the dashes.
    const first = (is: (line: Line) => boolean) => this.style(this.lines.findIndex(is));
    const results = tables.map((table) => item(this.sample({ ...first((line) => line.table === table), dash: [] }), table.result.label));
    const columns = names.map((name) => item(this.sample({ ...first((line) => line.name === name), stroke: colour("ink") }), words(name)));
    this.legend.replaceChildren(...results, ...columns);
  }

  /** The values under the cursor, with all digits. */
  private drawTip(u: uPlot): void {
    const { idx: row, left = -1 } = u.cursor;
    this.tip.hidden = row == null || left < 0;
    if (row == null || left < 0) return;
    const { xTitle, xUnit } = this.options!;
    const digits = (value: number, unit: string) => `${value}${unit ? " " + pretty(unit) : ""}`;
    const rows = this.lines.map((line, n) => {
      const at = nearestRow(u.data[0]!, u.data[n + 1]!, row);
      const y = at === null ? null : u.data[n + 1]![at];
      return h("tr", {}, h("th", {}, this.sample(this.style(n)), " ", line.label), h("td", {}, y == null ? "–" : digits(y, line.unit)));
    });
    const head = h("tr", {}, h("th", {}, xTitle), h("td", {}, digits(u.data[0]![row]!, xUnit)));
    this.tip.replaceChildren(h("table", {}, head, ...rows));
    this.placeTip();
  }

  /** Beside the chart, or below it where there is no room: over the chart it would hide the lines. */
  private placeTip(): void {
    const chart = this.element.getBoundingClientRect();
    const { offsetWidth: width, offsetHeight: height } = this.tip;
    const beside = chart.left - width - 14;
    const top = beside > 0 ? chart.top : chart.bottom;
    this.tip.style.left = `${beside > 0 ? beside : Math.max(4, chart.right - width)}px`;
    this.tip.style.top = `${Math.max(4, Math.min(top, window.innerHeight - height - 4))}px`;
  }

  private sample({ stroke, dash }: LineStyle): SVGSVGElement {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("class", "sample");
    svg.setAttribute("viewBox", "0 0 26 8");
    const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    path.setAttribute("d", "M0 4H26");
    path.setAttribute("stroke", stroke);
    path.setAttribute("stroke-width", "2.5");
    path.setAttribute("stroke-dasharray", dash.join(" "));
    svg.append(path);
    return svg;
  }
}

/** Ends of an axis: those of the data, and a little more. */
function padded(part: number): uPlot.Range.Function {
  return (_u, low, high) => {
    if (low === null || high === null) return [0, 1];
    if (low === high) return low === 0 ? [-1, 1] : [low - 0.1 * Math.abs(low), high + 0.1 * Math.abs(high)];
    return [low - part * (high - low), high + part * (high - low)];
  };
}

// Length of a tick, and room between it and its label (CSS pixels).
const TICK = 5;
const GAP = 4;
const LABEL_FONT = `12px ${FONT}`;
const TITLE_FONT = `600 12px ${FONT}`;

/** The width of the longest label (CSS pixels). */
function widest(u: uPlot, labels: string[] | null, font = LABEL_FONT): number {
  u.ctx.save();
  u.ctx.font = font;
  const width = Math.max(0, ...(labels ?? []).map((label) => u.ctx.measureText(label).width));
  u.ctx.restore();
  return Math.ceil(width);
}

function axis(scale: string, title: string, unit: string): uPlot.Axis {
  const factor = (u: uPlot) => {
    const { min, max } = u.scales[scale]!;
    const scaled = scaleFor(Math.max(Math.abs(min ?? 0), Math.abs(max ?? 0)), unit);
    // On a log axis the labels themselves are powers of ten.
    return u.scales[scale]!.distr === 3 && !isPrefixed(scaled.unit, unit) ? { factor: 1, unit } : scaled;
  };
  const isX = scale === "x";
  const label = (u: uPlot) => {
    const whole = withUnit(title, factor(u).unit);
    const room = (isX ? u.bbox.width : u.bbox.height) / (window.devicePixelRatio || 1);
    // It may stand out a little: beside the corners of a plot there is nothing.
    return isX || widest(u, [whole], TITLE_FONT) < room + 12 ? whole : withUnit("", factor(u).unit);
  };
  return {
    scale,
    stroke: colour("ink"),
    font: LABEL_FONT,
    labelFont: TITLE_FONT,
    labelSize: 18,
    labelGap: 0,
    size: isX ? 30 : (u, labels) => Math.max(52, TICK + GAP + widest(u, labels) + 3),
    gap: GAP,
    space: isX ? 70 : 36,
    ticks: { stroke: colour("axis"), width: 1, size: TICK },
    grid: { stroke: colour("grid"), width: 1 },
    label,
    values: (u, splits) => {
      if (u.scales[scale]!.distr === 3) return logLabels(u, scale, splits, factor(u).factor);
      return tickLabels(splits.map((v) => v * factor(u).factor));
    },
  };
}

const isPrefixed = (scaled: string, unit: string): boolean => !scaled.startsWith("10") && scaled.endsWith(unit);

/** Labels at powers of ten; where there are few of them, at twice and five times those, too. */
function logLabels(u: uPlot, scale: string, splits: (number | null)[], factor: number): string[] {
  const { min, max } = u.scales[scale]!;
  const few = Math.log10((max ?? 10) / (min ?? 1)) < 1.5;
  return splits.map((v) => {
    if (v === null) return "";
    const lead = Math.round(v / 10 ** Math.floor(Math.log10(v) + 1e-9));
    if (!isPowerOfTen(v) && !(few && (lead === 2 || lead === 5))) return "";
    const scaled = v * factor;
    return scaled >= 0.001 && scaled < 1e4 ? String(Number(scaled.toPrecision(3))) : powerOfTen(scaled);
  });
}

const isPowerOfTen = (v: number): boolean => v > 0 && Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9;

/** "energy" for "kinetic energy", "strain energy"; empty where they share no word. */
function commonWord(names: string[]): string {
  const sets = names.map((name) => words(name).split(" "));
  const shared = sets[0]!.filter((word) => sets.every((set) => set.includes(word)));
  return shared.join(" ");
}

/** A path through the rows as they are: x may go back and forth, as in a force over a displacement. */
function inRowOrder(line: Line): uPlot.Series.PathBuilder {
  return (u, s) => {
    const stroke = new Path2D();
    const scale = u.series[s]!.scale!;
    let pen = false;
    for (let row = 0; row < line.x.length; ++row) {
      const [x, y] = [line.x[row]!, line.y[row]!];
      if (!Number.isFinite(x) || !Number.isFinite(y)) {
        pen = false;
        continue;
      }
      const [px, py] = [u.valToPos(x, "x", true), u.valToPos(y, scale, true)];
      if (pen) stroke.lineTo(px, py);
      else stroke.moveTo(px, py);
      pen = true;
    }
    return { stroke, fill: null, clip: null, flags: 0, gaps: null, band: null } as unknown as uPlot.Series.Paths;
  };
}

/** Dashed vertical lines where the shown states are. */
function drawMarks(u: uPlot, marks: number[]): void {
  const { ctx, bbox } = u;
  const ratio = window.devicePixelRatio || 1;
  ctx.save();
  ctx.strokeStyle = colour("accent");
  ctx.lineWidth = 1.5 * ratio;
  ctx.setLineDash([4 * ratio, 3 * ratio]);
  for (const mark of new Set(marks)) {
    const x = u.valToPos(mark, "x", true);
    if (!(x >= bbox.left - 1 && x <= bbox.left + bbox.width + 1)) continue;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.restore();
}
