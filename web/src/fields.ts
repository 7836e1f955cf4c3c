// Fields by component: their names, their values per point, their ranges.

import type { Field, ViewData } from "./data";
import { words } from "./dom";

/** "magnitude" or the index of a component. */
export type Component = number | "magnitude";

const AXES = ["x", "y", "z"];

/** The components a user may choose from. A plane tensor or vector has no third row or column. */
export function components(field: Field, dimension: 2 | 3): Component[] {
  if (field.components === 1) return [0];
  const axes = dimension === 2 ? [0, 1] : [0, 1, 2];
  if (field.components === 3) return ["magnitude", ...axes];
  return ["magnitude", ...axes.flatMap((row) => axes.map((column) => 3 * row + column))];
}

/** "", "magnitude", "x" or "xy". */
export function componentName(field: Field, component: Component): string {
  if (field.components === 1) return "";
  if (component === "magnitude") return "magnitude";
  if (field.components === 3) return AXES[component]!;
  return AXES[Math.floor(component / 3)]! + AXES[component % 3]!;
}

/** "nominal stress xy". */
export const fieldTitle = (field: Field, component: Component): string =>
  `${words(field.name)} ${componentName(field, component)}`.trim();

/** One value per point. A magnitude is the root of the sum of all squares (of a tensor: the Frobenius norm). */
export function scalars(values: Float32Array, field: Field, component: Component): Float32Array {
  const width = field.components;
  if (width === 1) return values;
  const result = new Float32Array(values.length / width);
  for (let i = 0, at = 0; i < result.length; ++i, at += width) {
    if (component === "magnitude") {
      let sum = 0;
      for (let c = 0; c < width; ++c) sum += values[at + c]! * values[at + c]!;
      result[i] = Math.sqrt(sum);
    } else {
      result[i] = values[at + component]!;
    }
  }
  return result;
}

export type Range = [number, number];
export const EMPTY_RANGE: Range = [Infinity, -Infinity];

export function rangeOf(values: Float32Array): Range {
  let low = Infinity;
  let high = -Infinity;
  for (const v of values) {
    if (v < low && v !== -Infinity) low = v;
    if (v > high && v !== Infinity) high = v;
  }
  return [low, high];
}

export const joined = (a: Range, b: Range): Range => [Math.min(a[0], b[0]), Math.max(a[1], b[1])];

export const fieldIndex = (view: ViewData, name: string): number => view.fields.findIndex((f) => f.name === name);

/** The state of `view` whose parameter is nearest to `value`. */
export function nearestState(view: ViewData, value: number): number {
  let best = 0;
  view.states.forEach((state, s) => {
    if (Math.abs(state.value - value) < Math.abs(view.states[best]!.value - value)) best = s;
  });
  return best;
}
