"""Writes ball.stl: a ball of 20 mm in diameter as 512 triangles, an octahedron whose sides were cut in four three times.

    python3 ball.py > ball.stl
"""

import math

RADIUS, TIMES = 10.0, 3  # mm


def on_ball(*point):
    return tuple(RADIUS * x / math.hypot(*point) for x in point)


def middle(a, b):
    return on_ball(*(p + q for p, q in zip(a, b)))


triangles = []
for x in (1, -1):
    for y in (1, -1):
        for z in (1, -1):
            corners = [on_ball(x, 0, 0), on_ball(0, y, 0), on_ball(0, 0, z)]
            triangles.append(corners if x * y * z > 0 else corners[::-1])  # against the clock, seen from outside
for _ in range(TIMES):
    finer = []
    for a, b, c in triangles:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    triangles = finer

print("solid ball")
for corners in triangles:
    print("facet normal 0 0 0\nouter loop")
    for corner in corners:
        print("vertex " + " ".join(f"{x + 0.0:.6g}" for x in corner))
    print("endloop\nendfacet")
print("endsolid ball")
