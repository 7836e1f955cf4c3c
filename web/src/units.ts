// Numbers that people can read: "12.5 kN" instead of 12500, and all digits where they are wanted.

const PREFIXES = new Map([
  [-12, "p"],
  [-9, "n"],
  [-6, "µ"],
  [-3, "m"],
  [0, ""],
  [3, "k"],
  [6, "M"],
  [9, "G"],
  [12, "T"],
]);
// Units that may take a prefix when they stand first: "m/s" and "J/m^3" do, "m^2" (a square of km?) does not.
const PREFIXABLE = /^(N|Pa|J|W|m|s|Hz)(?![\p{L}\p{N}^²³*])/u;

/** How numbers of one size are written: value * factor in `unit`, with `exponent` for units without prefixes. */
export interface Scale {
  factor: number;
  unit: string;
}

/** The scale in which `largest` (an absolute value, SI) has one to three digits before the point. */
export function scaleFor(largest: number, unit: string): Scale {
  if (!(largest > 0) || !Number.isFinite(largest)) return { factor: 1, unit };
  const exponent = Math.floor(Math.log10(largest * (1 + 1e-9)));
  if (PREFIXABLE.test(unit)) {
    // Seconds grow by 60, not by thousands.
    const most = unit.startsWith("s") ? 0 : 12;
    const power = Math.max(-12, Math.min(most, 3 * Math.floor(exponent / 3)));
    return { factor: 10 ** -power, unit: PREFIXES.get(power)! + unit };
  }
  if (exponent >= -3 && exponent < 5) return { factor: 1, unit };
  return { factor: 10 ** -exponent, unit: `${superscript(exponent)}${unit ? " " + unit : ""}` };
}

/** "10⁵", "2·10⁵". */
export function powerOfTen(value: number): string {
  const exponent = Math.floor(Math.log10(Math.abs(value)) + 1e-9);
  const lead = Number((value / 10 ** exponent).toPrecision(3));
  return `${lead === 1 ? "" : `${lead}·`}${superscript(exponent)}`;
}

function superscript(exponent: number): string {
  return "10" + [...String(exponent)].map((c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]!)).join("");
}

/** Units as they are set in print: "J/m^3" is "J/m³", "10⁻³ " stays. */
export const pretty = (unit: string): string => unit.replace(/\^([23])/g, (_, n: string) => (n === "2" ? "²" : "³")).replaceAll("*", "·");

/** "force [kN]"; without brackets where there is no unit. */
export const withUnit = (name: string, unit: string): string => (unit ? `${name} [${pretty(unit)}]`.trim() : name);

/** `value` rounded to `digits` significant digits, without trailing zeros. */
export function short(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "–" : value > 0 ? "∞" : "-∞";
  return String(Number(value.toPrecision(digits))).replace("-", "−");
}

/** `value` (SI) as people say it: "12.5 kN". */
export function quantity(value: number | null, unit: string, digits = 4): string {
  if (value === null || Number.isNaN(value)) return "–";
  const scale = scaleFor(Math.abs(value), unit);
  const between = scale.unit.startsWith("10") ? "·" : " ";
  return `${short(value * scale.factor, digits)}${scale.unit ? between + pretty(scale.unit) : ""}`;
}

/** The shortest digits that name this float32 and no other. */
export function float32Digits(value: number): string {
  if (!Number.isFinite(value)) return String(value);
  for (let digits = 1; digits < 9; ++digits) {
    const text = String(Number(value.toPrecision(digits)));
    if (Math.fround(Number(text)) === value) return text;
  }
  return String(Number(value.toPrecision(9)));
}

/** Steps of 1, 2 or 5 times a power of ten: about `wanted` ticks between `low` and `high`. */
export function ticks(low: number, high: number, wanted: number): number[] {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [low];
  const raw = span / Math.max(1, wanted);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((s) => s * power >= raw * 0.75) ?? 10);
  const found: number[] = [];
  for (let n = Math.ceil(low / step - 1e-9); n * step <= high + 1e-9 * span; ++n) found.push(n === 0 ? 0 : n * step);
  return found;
}

/** Labels for `values`, all with the decimals that tell the nearest two apart. */
export function tickLabels(values: number[]): string[] {
  const step = values.length > 1 ? Math.abs(values[1]! - values[0]!) : Math.abs(values[0] ?? 1) || 1;
  const decimals = Math.max(0, Math.min(12, -Math.floor(Math.log10(step * (1 + 1e-9)))));
  const needed = step < 1 || values.some((v) => Math.abs(v - Math.round(v)) > step * 1e-6);
  const more = needed && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6 ? 1 : 0;
  return values.map((v) => {
    if (Math.abs(v) >= 1e6) return v.toExponential(2).replace("-", "−");
    return v.toFixed(decimals + more).replace("-", "−");
  });
}
