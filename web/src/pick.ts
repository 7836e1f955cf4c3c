import { pixelsPerMetre, type Projection } from "./camera";
import type { Scene } from "./scene";

/** How far from the pointer (pixels) a point may be to be meant by it. */
const REACH = 9;

/**
 * The point at x, y (CSS pixels), or -1. Of the points whose disc or sphere is under the pointer it is the nearest to
 * the eye (3D) or to the pointer (2D). A plain loop over all points, without a call or an object in it: 300 000 take
 * a few milliseconds.
 */
export function pick(scene: Scene, p: Projection, x: number, y: number): number {
  const { deformed, shown, body } = scene;
  const m = p.matrix;
  const radius = body.spacing * 0.75 * pixelsPerMetre(scene, p.height);
  const reach = Math.max(REACH, radius);
  let [best, bestDistance] = [-1, reach * reach];
  let [front, frontDepth] = [-1, Infinity];
  for (let i = 0, at = 0; i < shown.length; ++i, at += 3) {
    if (shown[i] === 0) continue;
    const [wx, wy, wz] = [deformed[at]!, deformed[at + 1]!, deformed[at + 2]!];
    const w = m[12]! * wx + m[13]! * wy + m[14]! * wz + m[15]!;
    const px = ((m[0]! * wx + m[1]! * wy + m[2]! * wz + m[3]!) / w + 1) * 0.5 * p.width - x;
    if (px > reach || px < -reach) continue;
    const py = (1 - (m[4]! * wx + m[5]! * wy + m[6]! * wz + m[7]!) / w) * 0.5 * p.height - y;
    const distance = px * px + py * py;
    if (distance < bestDistance) [best, bestDistance] = [i, distance];
    if (distance >= radius * radius) continue;
    const depth = (m[8]! * wx + m[9]! * wy + m[10]! * wz + m[11]!) / w;
    if (depth < frontDepth) [front, frontDepth] = [i, depth];
  }
  return body.dimension === 3 && front >= 0 ? front : best;
}
