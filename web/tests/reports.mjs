// The reports that the tests open, and their data as read without any code of the page.

import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { inflateSync } from "node:zlib";
import { fill, PAGES } from "./make_report.mjs";

const GIVEN = process.env.RIVEN_REPORTS;
const folder = mkdtempSync(join(tmpdir(), "riven-reports-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

/** The file of a report: of the program, if RIVEN_REPORTS names a folder that has it, else made from formulas. */
export function reportFile(name) {
  const given = GIVEN && join(GIVEN, `${name}.html`);
  if (given && existsSync(given)) return given;
  if (given && !PAGES[name]) throw new Error(`${given}: no such report`);
  return write(name, fill(PAGES[name]()));
}

/** A report from formulas, whatever RIVEN_REPORTS says. */
export const madeFile = (name) => write(`made-${name}`, fill(PAGES[name]()));

export function write(name, html) {
  const file = join(folder, `${name}.html`);
  writeFileSync(file, html);
  return file;
}

const ELEMENT = /<script id="riven-data" type="application\/json">([\s\S]*?)<\/script>/;
export const dataOf = (file) => JSON.parse(ELEMENT.exec(readFileSync(file, "utf8"))[1]);

/** The values of a packed array. */
export function unpack({ type, count, data }) {
  const Type = { float32: Float32Array, float64: Float64Array, uint32: Uint32Array }[type];
  const width = Type.BYTES_PER_ELEMENT;
  const shuffled = inflateSync(Buffer.from(data, "base64"));
  const bytes = new Uint8Array(shuffled.length);
  for (let i = 0; i < count; ++i) for (let b = 0; b < width; ++b) bytes[i * width + b] = shuffled[b * count + i];
  return new Type(bytes.buffer);
}

/** A field of a result at a state: { field, values }. */
export function fieldAt(result, name, state) {
  const f = result.view.fields.findIndex((field) => field.name === name);
  return { field: result.view.fields[f], values: unpack(result.view.states[state].values[f]) };
}

export function magnitudes({ field, values }) {
  const width = field.components;
  return Float32Array.from({ length: values.length / width }, (_, i) => Math.hypot(...values.subarray(i * width, (i + 1) * width)));
}

/** The colour of a map at t in 0..1. */
export function colourOf(map, t) {
  const x = Math.max(0, Math.min(1, t)) * (map.anchors.length - 1);
  const k = Math.min(map.anchors.length - 2, Math.floor(x));
  return [0, 1, 2].map((c) => map.anchors[k][c] + (x - k) * (map.anchors[k + 1][c] - map.anchors[k][c]));
}
