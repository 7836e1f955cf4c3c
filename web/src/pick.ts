import { pixelsPerMetre, project, type Projection } from "./camera";
import type { Scene } from "./scene";

/** How far from the pointer (pixels) a point may be to be meant by it. */
const REACH = 9;

/**
 * The point at x, y (CSS pixels), or -1. Of the points whose disc or sphere is under the pointer it is the nearest to
 * the eye (3D) or to the pointer (2D). A loop over all points: 300 000 take some 5 ms.
 */
export function pick(scene: Scene, p: Projection, x: number, y: number): number {
  const { deformed, shown, body } = scene;
  const radius = body.spacing * 0.75 * pixelsPerMetre(scene, p.height);
  const reach = Math.max(REACH, radius);
  let best = -1;
  let bestDistance = reach * reach;
  let front = -1;
  let frontDepth = Infinity;
  for (let i = 0; i < shown.length; ++i) {
    if (!shown[i]) continue;
    const [px, py, depth] = project(p, deformed[3 * i]!, deformed[3 * i + 1]!, deformed[3 * i + 2]!);
    const distance = (px - x) ** 2 + (py - y) ** 2;
    if (distance < bestDistance) {
      bestDistance = distance;
      best = i;
    }
    if (distance < radius * radius && depth < frontDepth) {
      frontDepth = depth;
      front = i;
    }
  }
  return body.dimension === 3 && front >= 0 ? front : best;
}
