"""Writes scattered-hole.csv: points strewn over the sheet without its hole, each with the area that is nearest to it.

    python3 scattered-hole.py > scattered-hole.csv
"""

import math
import random

SIDE, RADIUS, ALONG, SAMPLES = 500.0, 80.0, 50, 10  # mm, mm, points along a side, samples along a spacing
SPACING = SIDE / ALONG

chance = random.Random(1)
points = [(SPACING * (i + 0.5 + chance.uniform(-0.2, 0.2)), SPACING * (j + 0.5 + chance.uniform(-0.2, 0.2)))
          for j in range(ALONG) for i in range(ALONG)]
points = [p for p in points if math.dist(p, (SIDE / 2, SIDE / 2)) > RADIUS]

cells = {}  # points by the square of the lattice that they lie in
for n, (x, y) in enumerate(points):
    cells.setdefault((int(x / SPACING), int(y / SPACING)), []).append(n)

area, step = [0.0] * len(points), SPACING / SAMPLES
for j in range(ALONG * SAMPLES):
    for i in range(ALONG * SAMPLES):
        at = (step * (i + 0.5), step * (j + 0.5))
        if math.dist(at, (SIDE / 2, SIDE / 2)) > RADIUS:
            near = [n for b in range(-2, 3) for a in range(-2, 3)
                    for n in cells.get((i // SAMPLES + a, j // SAMPLES + b), ())]
            area[min(near, key=lambda n: math.dist(points[n], at))] += step * step

print("x [mm],y [mm],area [mm^2]")
for (x, y), a in zip(points, area):
    print(f"{x - SIDE / 2:.4f},{y - SIDE / 2:.4f},{a:.2f}")
