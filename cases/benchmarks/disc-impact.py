"""Writes disc-impact.stl: a disc of 74 mm in diameter and 2.5 mm in height about the origin, its circle as 96 straight lines.

    python3 disc-impact.py > disc-impact.stl
"""

import math

RADIUS, HALF, SIDES = 37.0, 1.25, 96  # mm

corners = []
for i in range(SIDES):
    angle = 2 * math.pi * i / SIDES
    corners.append((RADIUS * math.cos(angle), RADIUS * math.sin(angle)))

triangles = []
for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]):
    below, above = -HALF, HALF
    triangles.append(((0, 0, above), (ax, ay, above), (bx, by, above)))  # against the clock, seen from outside
    triangles.append(((0, 0, below), (bx, by, below), (ax, ay, below)))
    triangles.append(((ax, ay, below), (bx, by, below), (bx, by, above)))
    triangles.append(((ax, ay, below), (bx, by, above), (ax, ay, above)))

print("solid disc")
for triangle in triangles:
    print("facet normal 0 0 0\nouter loop")
    for corner in triangle:
        print("vertex " + " ".join(f"{round(x, 6) + 0.0:.6g}" for x in corner))
    print("endloop\nendfacet")
print("endsolid disc")
