"""Writes disc-impact.stl: all cells of a lattice of 0.5 mm whose centres are in a circle of 74 mm in diameter, 2.5 mm high, about the
origin. A smooth rim would cut cells, and what is cut off them is known only so well that the disc is not quite the same in x and y.

    python3 disc-impact.py > disc-impact.stl
"""

RADIUS, HALF, SPACING = 37.0, 1.25, 0.5  # mm

# Corners of the outline in the first quarter: from the x axis up, at the end of each row of cells.
rows = round(RADIUS / SPACING)
ends = []
for row in range(rows):
    y = (row + 0.5) * SPACING
    ends.append(sum(((cell + 0.5) * SPACING) ** 2 + y**2 <= RADIUS**2 for cell in range(rows)) * SPACING)
quarter = []
for row, end in enumerate(ends):
    if row == 0 or end != ends[row - 1]:
        quarter.append((end, row * SPACING))
        if row > 0:
            quarter.insert(-1, (ends[row - 1], row * SPACING))
quarter.append((ends[-1], rows * SPACING))

corners = []
for _ in range(4):
    corners += quarter
    quarter = [(-y, x) for x, y in quarter]
corners = [at for n, at in enumerate(corners) if at != corners[n - 1]]

below, above = -HALF, HALF
triangles = []
for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]):
    triangles.append(((0, 0, above), (ax, ay, above), (bx, by, above)))  # against the clock, seen from outside
    triangles.append(((0, 0, below), (bx, by, below), (ax, ay, below)))
    triangles.append(((ax, ay, below), (bx, by, below), (bx, by, above)))
    triangles.append(((ax, ay, below), (bx, by, above), (ax, ay, above)))

print("solid disc")
for triangle in triangles:
    print("facet normal 0 0 0\nouter loop")
    for corner in triangle:
        print("vertex " + " ".join(f"{x + 0.0:g}" for x in corner))
    print("endloop\nendfacet")
print("endsolid disc")
