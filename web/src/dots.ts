// Points of a scene as discs or spheres: impostors, drawn by vtk's sphere mapper.

import { vtkActor, vtkDataArray, vtkPolyData, vtkSphereMapper } from "./vtk";

/** All points of a scene, as they are to be drawn. */
export interface DotSource {
  deformed: Float32Array;
  rgba: Uint8Array;
  radii: Float32Array;
}

/** Some of the points, copied into arrays of their own: those that are not drawn cost nothing. */
export class Dots {
  readonly actor = vtkActor.newInstance();
  private readonly data = vtkPolyData.newInstance();
  private readonly colours = vtkDataArray.newInstance({ name: "colour", numberOfComponents: 4, values: new Uint8Array(4) });
  private readonly radiusArray = vtkDataArray.newInstance({ name: "radius", numberOfComponents: 1, values: new Float32Array(1) });
  private readonly xyz: Float32Array;
  private readonly rgba: Uint8Array;
  private readonly radii: Float32Array;

  /** There are never more than `most` points to draw. */
  constructor(most: number) {
    this.xyz = new Float32Array(3 * most);
    this.rgba = new Uint8Array(4 * most);
    this.radii = new Float32Array(most);
    this.data.getPointData().setScalars(this.colours);
    this.data.getPointData().addArray(this.radiusArray);
    const mapper = vtkSphereMapper.newInstance();
    mapper.setInputData(this.data);
    mapper.setScaleArray("radius");
    mapper.setColorModeToDirectScalars();
    this.actor.setMapper(mapper);
  }

  /** Takes over the points `of` the source, `grow` times as large. */
  fill(source: DotSource, of: Uint32Array, grow = 1): void {
    const { xyz, rgba, radii } = this;
    for (let n = 0; n < of.length; ++n) {
      const point = of[n]!;
      radii[n] = grow * source.radii[point]!;
      for (let a = 0; a < 3; ++a) xyz[3 * n + a] = source.deformed[3 * point + a]!;
      for (let c = 0; c < 4; ++c) rgba[4 * n + c] = source.rgba[4 * point + c]!;
    }
    this.data.getPoints().setData(xyz.subarray(0, 3 * of.length), 3);
    this.colours.setData(rgba.subarray(0, 4 * of.length), 4);
    this.radiusArray.setData(radii.subarray(0, of.length), 1);
    this.data.getPoints().modified();
    this.data.modified();
  }
}

/** `count` of `points`, without the pattern that a fixed step makes on a lattice. */
export function spread(points: Uint32Array, count: number): Uint32Array {
  // Steps of the golden ratio fall evenly, and hardly ever twice on the same place.
  const golden = 0.6180339887498949;
  return Uint32Array.from({ length: count }, (_, n) => points[Math.floor(((n * golden) % 1) * points.length)]!);
}
