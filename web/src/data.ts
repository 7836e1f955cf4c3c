// What the program hands to the page (README.md has the contract), and how its arrays are unpacked.

export type PackedType = "float32" | "float64" | "uint32";
/** `count` values; `data` = base64(zlib(bytes, shuffled)). */
export interface Packed {
  type: PackedType;
  count: number;
  data: string;
}
export interface ColourMap {
  name: string;
  label: string;
  anchors: [number, number, number][];
  diverging: boolean;
}
export interface PageData {
  format: 1;
  program: string;
  written: string;
  colour_maps: ColourMap[];
  results: ResultData[];
}
export type Status = "finished" | "failed" | "interrupted" | "unfinished";
export interface ResultData {
  name: string;
  /** The last part of the name, where that tells the results apart; made here. */
  label: string;
  title: string;
  status: Status;
  parameter: { name: string; unit: string };
  facts: { label: string; value: string }[];
  metrics: { name: string; value: number | null; unit: string }[];
  histories: HistoryData[];
  verdicts: Verdict[];
  case_text: string;
  resolved_text: string;
  log_text: string;
  notes: string[];
  view: ViewData | null;
}
export interface Column {
  name: string;
  unit: string;
}
export interface HistoryData {
  name: string;
  columns: Column[];
  rows: number;
  values: Packed;
  log_x?: boolean;
  log_y?: boolean;
}
export interface Verdict {
  what: string;
  unit: string;
  at: number;
  kind: "published" | "reference";
  expected: number | null;
  ours: number | null;
  deviation: number | null;
  limit: string;
  verdict: "ok" | "missed" | "reported";
  source: string;
}
export interface Field {
  name: string;
  unit: string;
  components: 1 | 3 | 9;
}
export interface Cells {
  kind: "line" | "triangle" | "quad";
  nodes: Packed;
}
export interface ViewData {
  dimension: 2 | 3;
  spacing: number;
  points: number;
  points_of: number;
  positions: Packed;
  cells: Cells[];
  fields: Field[];
  /** The field to show first. */
  field?: string;
  states: { value: number; values: Packed[] }[];
}

/** The parameters that the results run over, each once. */
export const parametersOf = (results: ResultData[]): string[] => [...new Set(results.map((result) => result.parameter.name))];

/** Data that cannot be shown; the message says which, and is meant for the user. */
export class DataError extends Error {}

/** Reads the data element of the page. Throws DataError when there is nothing in it that this page can show. */
export function readPage(): PageData {
  const text = document.getElementById("riven-data")?.textContent ?? "{}";
  let page: Partial<PageData>;
  try {
    page = JSON.parse(text) as Partial<PageData>;
  } catch (error) {
    throw new DataError(`The data of this page are damaged: ${(error as Error).message}.`);
  }
  if (page.format === undefined) throw new DataError("This page holds no result: it is the empty template.");
  if (page.format !== 1)
    throw new DataError(`The data of this page have format ${String(page.format)}; it can show format 1.`);
  if (!page.results?.length || !page.colour_maps?.length)
    throw new DataError("The data of this page are damaged: results or colour maps are missing.");
  label(page.results);
  return page as PageData;
}

function label(results: ResultData[]): void {
  const last = (result: ResultData) => result.name.split("/").at(-1) || result.name;
  const apart = new Set(results.map(last)).size === results.length;
  for (const result of results) result.label = apart ? last(result) : result.name;
}

const BYTES = { float32: 4, float64: 8, uint32: 4 } as const;

function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The bytes in the order of the values: the packed form has all first bytes, then all second bytes, ... */
export function unshuffle(shuffled: Uint8Array, width: number): Uint8Array<ArrayBuffer> {
  const count = shuffled.length / width;
  const bytes = new Uint8Array(shuffled.length);
  for (let b = 0; b < width; ++b) {
    const plane = b * count;
    for (let i = 0, to = b; i < count; ++i, to += width) bytes[to] = shuffled[plane + i]!;
  }
  return bytes;
}

/** Whether this browser can unpack the arrays at all. */
export const canUnpack = (): boolean => typeof DecompressionStream !== "undefined";

/** Unpacks `packed`, which must have `count` values; `what` names it in messages. */
async function unpack(packed: Packed, type: PackedType, count: number, what: string): Promise<ArrayBuffer> {
  const fail = (why: string): never => {
    throw new DataError(`The data of ${what} are damaged: ${why}.`);
  };
  if (!canUnpack()) throw new DataError("This browser is too old to unpack the data (no DecompressionStream).");
  if (packed?.type !== type) fail(`they are ${String(packed?.type)}, expected ${type}`);
  if (packed.count !== count) fail(`they have ${packed.count} values, expected ${count}`);
  let bytes = new Uint8Array();
  try {
    bytes = (await inflate(fromBase64(packed.data))) as Uint8Array<ArrayBuffer>;
  } catch {
    fail("they cannot be unpacked");
  }
  if (bytes.length !== count * BYTES[type]) fail(`they have ${bytes.length} bytes, expected ${count * BYTES[type]}`);
  return unshuffle(bytes, BYTES[type]).buffer;
}

export const float32 = async (packed: Packed, count: number, what: string): Promise<Float32Array> =>
  new Float32Array(await unpack(packed, "float32", count, what));

export async function uint32(packed: Packed, below: number, what: string): Promise<Uint32Array> {
  const values = new Uint32Array(await unpack(packed, "uint32", packed.count, what));
  if (values.some((node) => node >= below)) throw new DataError(`The data of ${what} are damaged: no such point.`);
  return values;
}

/** A history, column after column. */
export async function readHistory(history: HistoryData): Promise<Float64Array[]> {
  const { rows, columns } = history;
  const all = new Float64Array(
    await unpack(history.values, "float64", rows * columns.length, `the history "${history.name}"`),
  );
  return columns.map((_, c) => all.subarray(c * rows, (c + 1) * rows));
}

/** Unpacked fields are kept until they take this much; then the oldest go. */
const KEEP_BYTES = 1 << 30;

/** The fields of one result, unpacked when first asked for. */
export class FieldStore {
  private readonly kept = new Map<string, Promise<Float32Array>>();
  private bytes = 0;

  constructor(
    private readonly view: ViewData,
    private readonly result: string,
  ) {}

  /** Field `f` at state `s`, point-major; the same array whenever it is asked for. */
  get(s: number, f: number): Promise<Float32Array> {
    const key = `${s}/${f}`;
    const found = this.kept.get(key);
    if (found) return found;
    const field = this.view.fields[f]!;
    const count = this.view.points * field.components;
    const what = `"${field.name}" at state ${s + 1} of "${this.result}"`;
    const values = float32(this.view.states[s]!.values[f]!, count, what);
    this.kept.set(key, values);
    this.bytes += count * 4;
    this.dropOldest(key);
    return values;
  }

  private dropOldest(newest: string): void {
    for (const key of this.kept.keys()) {
      if (this.bytes <= KEEP_BYTES || key === newest) return;
      this.kept.delete(key);
      this.bytes -= this.view.points * this.view.fields[Number(key.split("/")[1])]!.components * 4;
    }
  }
}
