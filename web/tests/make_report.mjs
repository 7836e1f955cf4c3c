// Makes reports with data from formulas, by the contract of README.md: what the page shows can then be held against
// the formulas. As a program: node tests/make_report.mjs FOLDER [large]

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync } from "node:zlib";

const TEMPLATE = fileURLToPath(new URL("../dist/report.html", import.meta.url));
export const MARKER = '<script id="riven-data" type="application/json">{}</script>';

const ARRAYS = { float32: Float32Array, float64: Float64Array, uint32: Uint32Array };

/** base64(zlib(bytes, shuffled)): all first bytes of the values, then all second bytes, ... */
export function pack(type, values) {
  const array = ARRAYS[type].from(values);
  const width = array.BYTES_PER_ELEMENT;
  const bytes = new Uint8Array(array.buffer);
  const shuffled = new Uint8Array(bytes.length);
  for (let i = 0; i < array.length; ++i)
    for (let b = 0; b < width; ++b) shuffled[b * array.length + i] = bytes[i * width + b];
  return { type, count: array.length, data: deflateSync(shuffled).toString("base64") };
}

/** The page with `data` (an object, or the text of the element) in the place of the marker. */
export function fill(data) {
  const template = readFileSync(TEMPLATE, "utf8");
  if (template.split(MARKER).length !== 2) throw new Error("the template has not exactly one marker");
  const json = typeof data === "string" ? data : JSON.stringify(data);
  return template.replace(MARKER, () => MARKER.replace("{}", () => json.replaceAll("<", "\\u003c")));
}

export const COLOUR_MAPS = [
  { name: "viridis", label: "Viridis", diverging: false, anchors: [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37]] },
  { name: "cool-warm", label: "Cool to warm", diverging: true, anchors: [[59, 76, 192], [141, 176, 254], [221, 221, 221], [244, 154, 123], [180, 4, 38]] },
  { name: "greys", label: "Greys", diverging: false, anchors: [[20, 20, 20], [235, 235, 235]] },
];

export const page = (...results) => ({
  format: 1,
  program: "Riven 0.1.0 (avx2)",
  written: "2026-01-02T03:04:05Z",
  colour_maps: COLOUR_MAPS,
  results,
});

/** A result of `points` (undeformed, [x, y, z]) whose fields are formulas of point and state. */
function result({ name, title, parameter, states, points, dimension, spacing, cells = [], fields, histories, ...rest }) {
  return {
    name,
    title,
    status: "finished",
    parameter,
    facts: [
      { label: "Wall time", value: "2.41 s" },
      { label: "Points", value: String(points.length) },
      { label: "Energy balance", value: "1.2e-06" },
      { label: "Version", value: "Riven 0.1.0 (avx2)" },
    ],
    metrics: [],
    verdicts: [],
    case_text: `title = "${title}"\n`,
    resolved_text: `title = "${title}"\n\n[solver]\nmethod = "dynamic-relaxation"\n`,
    log_text: "[info] step 1/5\n[info] done\n",
    notes: [],
    ...rest,
    histories: histories.map(({ columns, rows, ...more }) => ({
      columns: columns.map(({ of: _, ...column }) => column),
      rows: rows.length,
      values: pack("float64", columns.flatMap(({ of }) => rows.map(of))),
      ...more,
    })),
    view: rest.view === null ? null : {
      dimension,
      spacing,
      points: points.length,
      points_of: points.length,
      positions: pack("float32", points.flat()),
      cells: cells.map(({ kind, nodes }) => ({ kind, nodes: pack("uint32", nodes) })),
      fields: fields.map(({ of: _, ...field }) => field),
      states: states.map((value, s) => ({
        value,
        values: fields.map(({ of }) => pack("float32", points.flatMap((p, i) => of(p, value, s, i)))),
      })),
    },
  };
}

const range = (n, of) => Array.from({ length: n }, (_, i) => of(i));

// --- a rubber sheet with a hole -----------------------------------------------------------------------------------

export const MEMBRANE = {
  side: 0.5,
  hole: 0.08,
  states: [1, 1.5, 2, 2.5, 3],
  points(n = 50) {
    const h = this.side / n;
    const at = (i) => (i + 0.5) * h - this.side / 2;
    return range(n * n, (k) => [at(k % n), at(Math.floor(k / n)), 0]).filter(([x, y]) => Math.hypot(x, y) > this.hole);
  },
  displacement: ([x, y], stretch) => [(stretch - 1) * x, (stretch - 1) * y * 0.8, 0],
  energy: ([x, y], stretch) => 1e6 * (stretch - 1) * (0.2 + 0.08 / Math.hypot(x, y)),
  stress: ([x, y], stretch) => [3e7 * (stretch - 1) * (1 + x), 1e7 * x * y * (stretch - 1), 0, 1e7 * x * y * (stretch - 1), 2e7 * (stretch - 1) * (1 - y), 0, 0, 0, 0],
  force: (stretch) => 18166 * (stretch - stretch ** -5),
};

/** A bar: points in a row, in a page of two dimensions. */
export function bar(n = 200) {
  const h = 1 / n;
  return result({
    name: "bar",
    title: "A bar",
    parameter: { name: "time", unit: "s" },
    states: [0, 1e-4],
    points: range(n, (i) => [(i + 0.5) * h, 0, 0]),
    dimension: 2,
    spacing: h,
    fields: [{ name: "displacement", unit: "m", components: 3, of: ([x], t) => [10 * t * x, 0, 0] }],
    histories: [],
  });
}

export function membrane(name = "equibiaxial-hole", factor = 1, n = 50) {
  const m = MEMBRANE;
  const rows = range(41, (i) => 1 + 0.05 * i);
  return result({
    name,
    title: "A rubber sheet with a hole",
    parameter: { name: "stretch", unit: "" },
    states: m.states,
    points: m.points(n),
    dimension: 2,
    spacing: m.side / n,
    fields: [
      { name: "displacement", unit: "m", components: 3, of: m.displacement },
      { name: "strain_energy_density", unit: "J/m^3", components: 1, of: (p, s) => factor * m.energy(p, s) },
      { name: "nominal_stress", unit: "Pa", components: 9, of: m.stress },
    ],
    histories: [
      {
        name: "history",
        rows,
        columns: [
          { name: "stretch", unit: "", of: (s) => s },
          { name: "force_right_x", unit: "N", of: (s) => factor * m.force(s) },
          { name: "force_top_y", unit: "N", of: (s) => (s < 1.2 ? NaN : 0.9 * factor * m.force(s)) },
          { name: "opening", unit: "m", of: (s) => 0.16 * s },
        ],
      },
      {
        name: "energy",
        rows,
        columns: [
          { name: "stretch", unit: "", of: (s) => s },
          { name: "kinetic_energy", unit: "J", of: (s) => 1e-3 * s },
          { name: "strain_energy", unit: "J", of: (s) => 700 * (s - 1) ** 2 },
          { name: "dissipated_energy", unit: "J", of: () => 0 },
          { name: "external_work", unit: "J", of: (s) => 705 * (s - 1) ** 2 },
          { name: "balance_error", unit: "", of: (s) => 1e-7 * s },
        ],
      },
    ],
    metrics: [
      { name: "force_right_x", value: factor * m.force(3), unit: "N" },
      { name: "force_top_y", value: null, unit: "N" },
    ],
    verdicts: m.states.slice(1).flatMap((s) => [
      { what: "force_right_x", unit: "N", at: s, kind: "reference", expected: m.force(s), ours: m.force(s) * 1.00004, deviation: 4e-5, limit: "0.1 %", verdict: "ok", source: "finite elements, 400 x 400" },
      { what: "displacement", unit: "", at: s, kind: "reference", expected: null, ours: null, deviation: 1.8e-4, limit: "0.1 %", verdict: s === 3 ? "missed" : "ok", source: "finite elements" },
      { what: "force_right_x", unit: "N", at: s, kind: "published", expected: m.force(s) * 1.02, ours: m.force(s), deviation: -0.0196, limit: "", verdict: "reported", source: "figure 7, read off <b>by hand</b>" },
    ]),
    case_text: 'title = "A rubber sheet with a hole"\n# <script>alert(1)</script> & co.\n\n[geometry]\nbox = { size = ["0.5 m", "0.5 m"], thickness = "10 mm", points = [100, 100] }\nhorizon = "3 dx"\n',
  });
}

// --- a plate that breaks --------------------------------------------------------------------------------------------

export const FRACTURE = {
  nx: 80,
  ny: 32,
  spacing: 0.5e-3,
  states: range(7, (i) => i * 8e-6),
  /** A crack runs along y = 0 from the left; its tip is at x = tip. Damage falls off over four spacings. */
  tip: (time) => -0.02 + 800 * time,
  points() {
    const { nx, ny, spacing: h } = this;
    return range(nx * ny, (k) => [((k % nx) + 0.5 - nx / 2) * h, (Math.floor(k / nx) + 0.5 - ny / 2) * h, 0]);
  },
  damage([x, y], time) {
    if (time === 0 || x > this.tip(time)) return 0;
    return Math.max(0, 0.6 * (1 - Math.abs(y) / (4 * this.spacing)));
  },
  displacement([x, y], time) {
    const open = x < this.tip(time) ? 1e-5 : 4e-6;
    return [1e-4 * x * (time / 48e-6), Math.sign(y) * open * (1 - 20 * x) * (time / 48e-6), 0];
  },
};

export function fracture(name = "fracture", more = {}) {
  const f = FRACTURE;
  const rows = range(120, (i) => i * 0.4e-6);
  return result({
    name,
    title: "Crack in soda-lime glass",
    parameter: { name: "time", unit: "s" },
    states: f.states,
    points: f.points(),
    dimension: 2,
    spacing: f.spacing,
    fields: [
      { name: "displacement", unit: "m", components: 3, of: (p, t) => f.displacement(p, t) },
      { name: "damage", unit: "", components: 1, of: (p, t) => f.damage(p, t) },
      { name: "strain_energy_density", unit: "J/m^3", components: 1, of: ([x], t) => 4e3 * (1 + 30 * x) * (t / 48e-6) },
    ],
    histories: [
      {
        name: "history",
        rows,
        columns: [
          { name: "time", unit: "s", of: (t) => t },
          { name: "opening", unit: "m", of: (t) => 2e-5 * (t / 48e-6) ** 2 },
          { name: "tip_x", unit: "m", of: (t) => f.tip(t) },
        ],
      },
      {
        name: "energy",
        rows,
        columns: [
          { name: "time", unit: "s", of: (t) => t },
          { name: "kinetic_energy", unit: "J", of: (t) => 2e-4 * (t / 48e-6) ** 2 },
          { name: "strain_energy", unit: "J", of: (t) => 1e-3 * (1 - t / 60e-6) },
          { name: "balance_error", unit: "", of: (t) => 1e-6 * Math.sin(t * 1e6) },
        ],
      },
    ],
    metrics: [{ name: "tip_x", value: f.tip(48e-6), unit: "m" }],
    status: "interrupted",
    notes: ["Of 10 240 points, 2 560 are shown: every second one in x and y."],
    ...more,
  });
}

// --- a solid block, and meshes --------------------------------------------------------------------------------------

export function block(n = [24, 12, 8]) {
  const h = 0.01;
  const points = range(n[0] * n[1] * n[2], (k) => [
    (k % n[0]) * h,
    (Math.floor(k / n[0]) % n[1]) * h,
    Math.floor(k / (n[0] * n[1])) * h,
  ]);
  return result({
    name: "block",
    title: "A solid block in tension",
    parameter: { name: "time", unit: "s" },
    states: [0, 0.001, 0.002],
    points,
    dimension: 3,
    spacing: h,
    fields: [
      { name: "displacement", unit: "m", components: 3, of: ([x, y, z], t) => [100 * t * x, -20 * t * y, 30 * t * x * z] },
      { name: "damage", unit: "", components: 1, of: ([x], t) => (t > 0 && x > 0.115 ? 0.6 : 0) },
      { name: "nominal_stress", unit: "Pa", components: 9, of: ([x, y, z], t) => range(9, (c) => 1e9 * t * (x + c * y - z)) },
    ],
    histories: [
      {
        name: "history",
        rows: range(300, (i) => i * 1e-5),
        columns: [
          { name: "time", unit: "s", of: (t) => t },
          { name: "force", unit: "N", of: (t) => 5e4 * Math.sin(1e3 * t) },
        ],
      },
      {
        name: "s-n",
        log_x: true,
        log_y: true,
        rows: range(12, (i) => 10 ** (2 + i / 2)),
        columns: [
          { name: "cycles", unit: "", of: (c) => c },
          { name: "stress_amplitude", unit: "Pa", of: (c) => 9e8 * c ** -0.12 },
        ],
      },
    ],
  });
}

/** A shell of quads and triangles, with a line across, in space. */
export function mesh(n = 24) {
  const at = (i) => i / n - 0.5;
  const points = range((n + 1) ** 2, (k) => {
    const [x, y] = [at(k % (n + 1)), at(Math.floor(k / (n + 1)))];
    return [x, y, 0.3 * x * x];
  });
  const quads = [];
  const triangles = [];
  for (let j = 0; j < n; ++j)
    for (let i = 0; i < n; ++i) {
      const [a, b, c, d] = [j * (n + 1) + i, j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i];
      if (i < n / 2) quads.push(a, b, c, d);
      else triangles.push(a, b, c, a, c, d);
    }
  const line = range(n, (i) => [(n / 2) * (n + 1) + i, (n / 2) * (n + 1) + i + 1]).flat();
  return result({
    name: "shell",
    title: "A shell of quads and triangles",
    parameter: { name: "time", unit: "s" },
    states: [0, 1],
    points,
    dimension: 3,
    spacing: 1 / n,
    cells: [
      { kind: "quad", nodes: quads },
      { kind: "triangle", nodes: triangles },
      { kind: "line", nodes: line },
    ],
    fields: [
      { name: "displacement", unit: "m", components: 3, of: ([x, y], t) => [0, 0, 0.2 * t * (0.25 - y * y)] },
      { name: "thickness", unit: "m", components: 1, of: ([x]) => 1e-3 * (1 + x) },
    ],
    histories: [],
  });
}

// --- pages ----------------------------------------------------------------------------------------------------------

export function pair() {
  const coarse = membrane("coarse/membrane-25", 0.93, 25);
  coarse.view.states = coarse.view.states.filter((_, s) => s !== 2);
  return page(membrane("fine/membrane-50"), coarse);
}

export const PAGES = {
  membrane: () => page(membrane()),
  fracture: () => page(fracture()),
  block: () => page(block()),
  mesh: () => page(mesh()),
  pair,
  failed: () => page(fracture("failed", { status: "failed", view: null, notes: [] })),
};
const LARGE = {
  "large-2d": () => page(membrane("large", 1, 560)),
  "large-3d": () => page(block([120, 60, 42])),
};

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [folder = "reports", large] = process.argv.slice(2);
  mkdirSync(folder, { recursive: true });
  for (const [name, make] of Object.entries(large ? { ...PAGES, ...LARGE } : PAGES)) {
    writeFileSync(join(folder, `${name}.html`), fill(make()));
  }
}
