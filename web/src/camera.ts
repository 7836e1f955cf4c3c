// Cameras: fitting, panning, zooming, turning, and where a point of the body lies on the screen.

import type { Scene } from "./scene";

export type Vector = [number, number, number];
export type Box = [number, number, number, number, number, number]; // x from, x to, y from, ...

const ANGLE = 30; // of the view, degrees
const FREE = 0.06; // part of the picture that stays free around a body

/** A copy of where a camera stands, so that several views can share it. */
export interface Pose {
  position: Vector;
  focus: Vector;
  up: Vector;
  scale: number;
}

export function poseOf(scene: Scene): Pose {
  const camera = scene.renderer.getActiveCamera();
  return {
    position: camera.getPosition() as Vector,
    focus: camera.getFocalPoint() as Vector,
    up: camera.getViewUp() as Vector,
    scale: camera.getParallelScale(),
  };
}

export function setPose(scene: Scene, pose: Pose): void {
  const camera = scene.renderer.getActiveCamera();
  camera.setPosition(...pose.position);
  camera.setFocalPoint(...pose.focus);
  camera.setViewUp(...pose.up);
  camera.setParallelScale(pose.scale);
  camera.setViewAngle(ANGLE);
}

/** Directions from which a solid is looked at: where the camera stands, and what is up. */
export const DIRECTIONS: Record<string, { from: Vector; up: Vector }> = {
  x: { from: [1, 0, 0], up: [0, 0, 1] },
  y: { from: [0, -1, 0], up: [0, 0, 1] },
  z: { from: [0, 0, 1], up: [0, 1, 0] },
  oblique: { from: [0.55, -0.7, 0.46], up: [0, 0, 1] },
};

/** The pose that shows all of `box` in a window of this aspect (width / height), seen from `direction`. */
export function fittingPose(box: Box, aspect: number, dimension: 2 | 3, direction: string): Pose {
  const focus: Vector = [(box[0] + box[1]) / 2, (box[2] + box[3]) / 2, (box[4] + box[5]) / 2];
  const half: Vector = [(box[1] - box[0]) / 2, (box[3] - box[2]) / 2, (box[5] - box[4]) / 2];
  const radius = Math.hypot(...half) || 1;
  if (dimension === 2) {
    const scale = (1 + FREE) * Math.max(half[1], half[0] / aspect) || 1;
    return { position: [focus[0], focus[1], focus[2] + 4 * radius], focus, up: [0, 1, 0], scale };
  }
  const { from, up } = DIRECTIONS[direction]!;
  const distance = fittingDistance(half, unit(from), up, aspect) || radius;
  const position = focus.map((f, a) => f + distance * unit(from)[a]!) as Vector;
  return { position, focus, up, scale: radius };
}

/** How far the camera must be for all corners of a box to be in the picture. */
function fittingDistance(half: Vector, from: Vector, up: Vector, aspect: number): number {
  const right = unit(cross(up, from));
  const above = cross(from, right);
  const slope = Math.tan((ANGLE * Math.PI) / 360) / (1 + FREE);
  let distance = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const at = half.map((length, a) => (corner & (1 << a) ? length : -length)) as Vector;
    const aside = Math.max(Math.abs(dot(at, right)) / aspect, Math.abs(dot(at, above)));
    distance = Math.max(distance, dot(at, from) + aside / slope);
  }
  return distance;
}

/** From the world to clip coordinates, and the size of the window in CSS pixels. */
export interface Projection {
  matrix: number[]; // 4 x 4, row by row
  width: number;
  height: number;
}

export function projection(scene: Scene, width: number, height: number): Projection {
  const camera = scene.renderer.getActiveCamera();
  return { matrix: [...camera.getCompositeProjectionMatrix(width / height, -1, 1)], width, height };
}

/** CSS pixels of a world point from the top left corner, and its depth (more is farther). */
export function project(p: Projection, x: number, y: number, z: number): [number, number, number] {
  const m = p.matrix;
  const w = m[12]! * x + m[13]! * y + m[14]! * z + m[15]!;
  const cx = (m[0]! * x + m[1]! * y + m[2]! * z + m[3]!) / w;
  const cy = (m[4]! * x + m[5]! * y + m[6]! * z + m[7]!) / w;
  const cz = (m[8]! * x + m[9]! * y + m[10]! * z + m[11]!) / w;
  return [((cx + 1) / 2) * p.width, ((1 - cy) / 2) * p.height, cz];
}

/** CSS pixels per metre at the focus. */
export function pixelsPerMetre(scene: Scene, height: number): number {
  const camera = scene.renderer.getActiveCamera();
  const half = camera.getParallelProjection()
    ? camera.getParallelScale()
    : camera.getDistance() * Math.tan((ANGLE * Math.PI) / 360);
  return height / (2 * half);
}

/** Moves camera and focus so that what is under the pointer follows it by dx, dy pixels (down is positive). */
export function pan(scene: Scene, dx: number, dy: number, height: number): void {
  const camera = scene.renderer.getActiveCamera();
  const pixels = pixelsPerMetre(scene, height);
  const forward = camera.getDirectionOfProjection() as Vector;
  const right = unit(cross(forward, camera.getViewUp() as Vector));
  const up = cross(right, forward);
  const move = [0, 1, 2].map((a) => (-dx * right[a]! + dy * up[a]!) / pixels) as Vector;
  const add = (v: number[]) => v.map((c, a) => c + move[a]!) as Vector;
  const pose = poseOf(scene);
  camera.setFocalPoint(...add(pose.focus));
  camera.setPosition(...add(pose.position));
}

/** Zooms in by `factor` and keeps what is at x, y (pixels from the middle, down positive) where it is. */
export function zoom(scene: Scene, factor: number, x: number, y: number, height: number): void {
  const camera = scene.renderer.getActiveCamera();
  if (camera.getParallelProjection()) camera.setParallelScale(camera.getParallelScale() / factor);
  else camera.dolly(factor);
  pan(scene, x * (1 - factor), y * (1 - factor), height);
}

/** Turns the camera around its focus, as if the body were a ball under the pointer. */
export function turn(scene: Scene, dx: number, dy: number, height: number): void {
  const camera = scene.renderer.getActiveCamera();
  camera.azimuth((-180 * dx) / height);
  camera.elevation((180 * dy) / height);
  camera.orthogonalizeViewUp();
}

export function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export function unit(a: Vector): Vector {
  const length = Math.hypot(...a) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
}

export interface PointerActions {
  changed(): void;
  hover(x: number, y: number): void;
  leave(): void;
}

/** Pointer and wheel on `element` move the camera of `scene`: drag pans (2D) or turns (3D), shift or right pans. */
export function listen(element: HTMLElement, scene: Scene, actions: PointerActions): void {
  let last: { x: number; y: number } | null = null;
  let panning = false;
  const height = () => element.clientHeight;
  element.addEventListener("pointerdown", (event) => {
    last = { x: event.clientX, y: event.clientY };
    panning = scene.body.dimension === 2 || event.button !== 0 || event.shiftKey;
    element.setPointerCapture(event.pointerId);
    actions.leave();
  });
  element.addEventListener("pointermove", (event) => {
    if (!last) {
      actions.hover(event.offsetX, event.offsetY);
      return;
    }
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    last = { x: event.clientX, y: event.clientY };
    (panning ? pan : turn)(scene, dx, dy, height());
    actions.changed();
  });
  const end = () => (last = null);
  element.addEventListener("pointerup", end);
  element.addEventListener("pointercancel", end);
  element.addEventListener("pointerleave", () => actions.leave());
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const factor = Math.exp(-Math.max(-200, Math.min(200, event.deltaY)) * 0.0015);
      zoom(scene, factor, event.offsetX - element.clientWidth / 2, event.offsetY - height() / 2, height());
      actions.leave();
      actions.changed();
    },
    { passive: false },
  );
}
