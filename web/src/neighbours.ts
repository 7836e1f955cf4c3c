// The points around each point: discs grow as these go apart, so that a stretched sheet stays closed, and what lies
// inside of a solid is not drawn.

/** Neighbours of point i: list[start[i]] ... list[start[i + 1] - 1]. */
export interface Neighbours {
  start: Uint32Array;
  list: Uint32Array;
}

/** More than this many neighbours add nothing to a picture. */
const MOST = 8;

/** The points nearer than `reach` to each point, found in a grid of cells of that size. */
export function findNeighbours(xyz: Float32Array, reach: number): Neighbours {
  const count = xyz.length / 3;
  const cells = sortIntoCells(xyz, reach);
  const start = new Uint32Array(count + 1);
  let list = new Uint32Array(count * 6);
  let used = 0;
  for (let i = 0; i < count; ++i) {
    start[i] = used;
    if (used + MOST > list.length) {
      const longer = new Uint32Array(list.length * 2 + MOST);
      longer.set(list);
      list = longer;
    }
    used = addNeighbours(i, xyz, reach, cells, list, used);
  }
  start[count] = used;
  return { start, list: list.subarray(0, used) };
}

interface Cells {
  of: Int32Array; // cell of a point
  size: [number, number, number];
  begin: Uint32Array; // of each cell in points
  points: Uint32Array; // sorted by cell
}

function sortIntoCells(xyz: Float32Array, reach: number): Cells {
  const count = xyz.length / 3;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < xyz.length; ++i) {
    low[i % 3] = Math.min(low[i % 3]!, xyz[i]!);
    high[i % 3] = Math.max(high[i % 3]!, xyz[i]!);
  }
  // Few points far apart would need a grid without end; wider cells only cost time.
  let width = reach;
  const cellsOf = (w: number) => [0, 1, 2].map((a) => Math.floor((high[a]! - low[a]!) / w) + 1);
  while (cellsOf(width).reduce((product, n) => product * n, 1) > 8 * count + 64) width *= 1.5;
  const size = cellsOf(width) as [number, number, number];
  const of = new Int32Array(count);
  const begin = new Uint32Array(size[0] * size[1] * size[2] + 1);
  for (let i = 0; i < count; ++i) {
    const at = [0, 1, 2].map((a) => Math.floor((xyz[3 * i + a]! - low[a]!) / width));
    of[i] = (at[2]! * size[1] + at[1]!) * size[0] + at[0]!;
    ++begin[of[i]! + 1]!;
  }
  for (let c = 1; c < begin.length; ++c) begin[c]! += begin[c - 1]!;
  const next = begin.slice();
  const points = new Uint32Array(count);
  for (let i = 0; i < count; ++i) points[next[of[i]!]!++] = i;
  return { of, size, begin, points };
}

function addNeighbours(
  i: number,
  xyz: Float32Array,
  reach: number,
  cells: Cells,
  list: Uint32Array,
  used: number,
): number {
  const { of, size, begin, points } = cells;
  const cx = of[i]! % size[0];
  const cy = Math.floor(of[i]! / size[0]) % size[1];
  const cz = Math.floor(of[i]! / (size[0] * size[1]));
  const end = used + MOST;
  for (let z = Math.max(0, cz - 1); z <= Math.min(size[2] - 1, cz + 1); ++z)
    for (let y = Math.max(0, cy - 1); y <= Math.min(size[1] - 1, cy + 1); ++y)
      for (let x = Math.max(0, cx - 1); x <= Math.min(size[0] - 1, cx + 1); ++x) {
        const cell = (z * size[1] + y) * size[0] + x;
        for (let k = begin[cell]!; k < begin[cell + 1]! && used < end; ++k) {
          const j = points[k]!;
          if (j !== i && distance(xyz, i, j) < reach) list[used++] = j;
        }
      }
  return used;
}

function distance(xyz: Float32Array, i: number, j: number): number {
  const x = xyz[3 * i]! - xyz[3 * j]!;
  const y = xyz[3 * i + 1]! - xyz[3 * j + 1]!;
  const z = xyz[3 * i + 2]! - xyz[3 * j + 2]!;
  return Math.sqrt(x * x + y * y + z * z);
}

/** How two points went apart: their distance now by their distance at first. */
const stretchOf = (undeformed: Float32Array, deformed: Float32Array, i: number, j: number): number =>
  distance(deformed, i, j) / distance(undeformed, i, j);

/**
 * Writes the radius of each point into `radii`: `radius` times the largest stretch between it and its neighbours. A
 * neighbour across a crack goes far without the material being stretched, so the stretch counts only up to a little
 * more than what 95 % of the points have. Returns that limit.
 */
export function stretchedRadii(
  undeformed: Float32Array,
  deformed: Float32Array,
  neighbours: Neighbours,
  radius: number,
  radii: Float32Array,
): number {
  const { start, list } = neighbours;
  for (let i = 0; i < radii.length; ++i) {
    let most = start[i] === start[i + 1] ? 1 : 0;
    for (let k = start[i]!; k < start[i + 1]!; ++k) most = Math.max(most, stretchOf(undeformed, deformed, i, list[k]!));
    radii[i] = most;
  }
  const limit = 1.1 * percentile(radii, 0.95);
  for (let i = 0; i < radii.length; ++i) radii[i] = radius * Math.max(0.05, Math.min(radii[i]!, limit));
  return limit;
}

const ALL_SIDES = 0b111111;

/**
 * Whether point i of a solid cannot be seen, for it has on all six sides a neighbour that is shown and has not gone
 * farther away than `limit` times its distance (as across an open crack).
 */
export function isCovered(
  i: number,
  undeformed: Float32Array,
  deformed: Float32Array,
  neighbours: Neighbours,
  shown: Uint8Array,
  limit: number,
): boolean {
  const { start, list } = neighbours;
  let sides = 0;
  for (let k = start[i]!; k < start[i + 1]!; ++k) {
    const j = list[k]!;
    if (shown[j] && stretchOf(undeformed, deformed, i, j) <= limit) sides |= 1 << sideOf(undeformed, i, j);
  }
  return sides === ALL_SIDES;
}

/** 0 to 5: the side (-x, +x, -y, ...) of i on which j lies. */
function sideOf(xyz: Float32Array, i: number, j: number): number {
  const x = xyz[3 * j]! - xyz[3 * i]!;
  const y = xyz[3 * j + 1]! - xyz[3 * i + 1]!;
  const z = xyz[3 * j + 2]! - xyz[3 * i + 2]!;
  const [ax, ay, az] = [Math.abs(x), Math.abs(y), Math.abs(z)];
  if (ax >= ay && ax >= az) return x > 0 ? 1 : 0;
  if (ay >= az) return y > 0 ? 3 : 2;
  return z > 0 ? 5 : 4;
}

function percentile(values: Float32Array, part: number): number {
  const step = Math.max(1, Math.floor(values.length / 5000));
  const sample = values.filter((_, i) => i % step === 0).sort();
  return sample[Math.floor(part * (sample.length - 1))] ?? 1;
}
