import type { ColourMap } from "./data";

/** Lines of plots: the palette of Okabe and Ito, which people with colour blindness can tell apart. */
export const LINE_COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"] as const;
/** The same on a dark ground, where the blue would drown. */
export const LINE_COLOURS_DARK = ["#56b4e9", "#e69f00", "#2fc79a", "#e39bc4", "#f0e442", "#d55e00", "#b0b0b0"] as const;
export const DASHES: readonly number[][] = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 2], [12, 4, 2, 3, 2, 3]];

/** What has no value is drawn in this grey. */
export const NO_VALUE: readonly [number, number, number] = [150, 150, 150];

/** The colour at `t` in 0..1 (outside: the end's colour): linear between anchors that are equally spaced. */
export function colourAt(map: ColourMap, t: number): [number, number, number] {
  const last = map.anchors.length - 1;
  const x = Math.max(0, Math.min(1, t)) * last;
  const k = Math.min(Math.floor(x), Math.max(0, last - 1));
  const a = map.anchors[k]!;
  const b = map.anchors[Math.min(k + 1, last)]!;
  return [0, 1, 2].map((c) => Math.round(a[c]! + (x - k) * (b[c]! - a[c]!))) as [number, number, number];
}

const STEPS = 1024;

/** A table of colours, so that 300 000 points take milliseconds. */
export function colourTable(map: ColourMap): Uint8Array {
  const table = new Uint8Array(STEPS * 3);
  for (let n = 0; n < STEPS; ++n) table.set(colourAt(map, n / (STEPS - 1)), n * 3);
  return table;
}

/** Writes the colour of each of `values` into `rgba`; `low` and `high` are the ends of the map. */
export function paint(values: Float32Array, low: number, high: number, table: Uint8Array, rgba: Uint8Array): void {
  const scale = high > low ? (STEPS - 1) / (high - low) : 0;
  const flat = high > low ? 0 : (STEPS - 1) / 2;
  for (let i = 0, to = 0; i < values.length; ++i, to += 4) {
    const v = values[i]!;
    const known = v === v;
    const n = 3 * Math.max(0, Math.min(STEPS - 1, Math.round((v - low) * scale + flat)));
    rgba[to] = known ? table[n]! : NO_VALUE[0];
    rgba[to + 1] = known ? table[n + 1]! : NO_VALUE[1];
    rgba[to + 2] = known ? table[n + 2]! : NO_VALUE[2];
    rgba[to + 3] = 255;
  }
}
