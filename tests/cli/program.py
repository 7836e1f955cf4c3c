"""What the tests of the built program share: running it in an empty folder, small cases, reading field files."""

import base64
import csv
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("RIVEN_PROGRAM", str(ROOT / "build/release/riven"))

# A sheet whose response is known: C10 = 1 MPa, so the force on an edge is 2 MPa (s - s^-5) 0.2 m 10 mm.
PLAIN = """title = "Sheet"

[geometry]
box = { size = ["0.2 m", "0.2 m"], thickness = "10 mm", points = [20, 20] }
horizon = "3 dx"

[material.rubber]
law = "neo-hookean"
youngs_modulus = "6 MPa"
density = "1100 kg/m^3"

[[load]]
on = ["left", "right", "bottom", "top"]
displacement = ["(stretch - 1)*x", "(stretch - 1)*y"]

[solver]
method = "dynamic-relaxation"
stretch = [1.2, 1.4]

[[probe]]
name = "force"
kind = "reaction"
on = "right"
"""

HOLE = PLAIN + """
[[hole]]
disc = { radius = "30 mm" }

[[probe]]
name = "hole_x"
kind = "stretch"
from = ["-30 mm", 0]
to = ["30 mm", 0]
"""

MOVING = """title = "Sheet that is pulled"

[geometry]
box = { size = ["0.2 m", "0.2 m"], thickness = "10 mm", points = [20, 20] }
horizon = "3 dx"

[material.rubber]
law = "neo-hookean"
youngs_modulus = "6 MPa"
density = "1100 kg/m^3"

[[load]]
on = ["left", "right"]
displacement = ["1e4 /s^2 * x * t*t", "free"]

[solver]
method = "verlet"
until = "4 ms"

[output]
every = "2 ms"
history_every = "1 ms"

[[probe]]
name = "force"
kind = "reaction"
on = "right"
"""


BOX = 'box = { size = ["0.2 m", "0.2 m"], thickness = "10 mm", points = [20, 20] }'
POINTS = 'points = { file = "sheet.csv", thickness = "10 mm", box = { size = ["0.2 m", "0.2 m"] } }'

# A plate that is torn apart: its halves move away from each other, and bonds break at the tip of the crack first.
TORN = """title = "Plate with a crack, torn"

[geometry]
box = { size = ["40 mm", "40 mm"], thickness = "1 mm", points = [20, 20] }
horizon = "3 dx"

[[crack]]
from = ["-20 mm", 0]
to = [0, 0]

[model]
kind = "pmb"

[material.glass]
law = "linear-elastic"
youngs_modulus = "72 GPa"
density = "2440 kg/m^3"
critical_stretch = 0.001

[[initial]]
velocity = [0, "500 /s * y"]

[solver]
method = "verlet"
until = "20 us"

[output]
every = "5 us"
history_every = "1 us"

[[probe]]
name = "corner"
kind = "displacement"
at = ["-19 mm", "19 mm"]
"""

# A ball that falls on a plate, and a wall that comes from below. Some bonds break.
IMPACT = """title = "Ball on a plate"

[geometry]
box = { size = ["24 mm", "24 mm", "8 mm"], points = [12, 12, 4] }
horizon = "3 dx"

[model]
kind = "pmb"

[material.glass]
law = "linear-elastic"
youngs_modulus = "72 GPa"
density = "2440 kg/m^3"
critical_stretch = 0.004

[contact]

[[impactor]]
name = "ball"
sphere = { center = [0, "1 mm", "10.5 mm"], radius = "6 mm" }
mass = "20 g"
velocity = [0, 0, "-60 m/s"]

[[impactor]]
name = "wall"
plane = { point = [0, 0, "-4.2 mm"], normal = [0, 0, 2] }
velocity = [0, 0, "10 m/s * (1 - cos(2*pi*t/20us))"]

[solver]
method = "verlet"
until = "40 us"

[output]
every = "10 us"
history_every = "0.5 us"

[[probe]]
name = "ball"
kind = "impactor"
impactor = "ball"

[[probe]]
name = "wall"
kind = "impactor"
impactor = "wall"
"""

BLOCK_BOX = 'box = { size = ["40 mm", "20 mm", "30 mm"], from = [0, 0, 0], spacing = "5 mm" }'
BLOCK = f"""title = "Block"

[geometry]
{BLOCK_BOX}
horizon = "3 dx"

[model]
kind = "lps"

[material.glass]
law = "linear-elastic"
youngs_modulus = "72 GPa"
poissons_ratio = 0.22

[[load]]
on = ["left", "right"]
displacement = ["(stretch - 1)*x", "free", "free"]

[solver]
method = "dynamic-relaxation"
stretch = [1.0001]
increment = 0.0001

[[probe]]
name = "force"
kind = "reaction"
on = "right"
"""


def lattice_csv(side, spacing, thickness=10):
    """Points of a square lattice around the origin as CSV text; lengths in mm."""
    middle, volume = (side - 1) / 2, spacing**2 * thickness
    return "x [mm],y [mm],volume [mm^3]\n" + "".join(
        f"{spacing * (i - middle)},{spacing * (j - middle)},{volume}\n" for j in range(side) for i in range(side))


def squares(side, spacing):
    """A square mesh around the origin in MSH 4.1 as text, lengths in mm; the physical group "top row" is its upper side."""
    nodes = [(spacing * (i - side / 2), spacing * (j - side / 2)) for j in range(side + 1) for i in range(side + 1)]
    corner = lambda i, j: j * (side + 1) + i + 1
    cells = [(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)) for j in range(side) for i in range(side)]
    lines = [(corner(i, side), corner(i + 1, side)) for i in range(side)]
    rows = lambda first, items: "\n".join(f"{first + n} " + " ".join(map(str, item)) for n, item in enumerate(items))
    return "\n".join([
        "$MeshFormat", "4.1 0 8", "$EndMeshFormat",
        "$PhysicalNames", "1", '1 3 "top row"', "$EndPhysicalNames",
        "$Entities", "0 1 1 0", "1 0 0 0 0 0 0 1 3 0", "1 0 0 0 0 0 0 0 0", "$EndEntities",
        "$Nodes", f"1 {len(nodes)} 1 {len(nodes)}", f"2 1 0 {len(nodes)}", *(str(n + 1) for n in range(len(nodes))),
        *(f"{x} {y} 0" for x, y in nodes), "$EndNodes",
        "$Elements", f"2 {len(lines) + len(cells)} 1 {len(lines) + len(cells)}",
        f"1 1 1 {len(lines)}", rows(1, lines), f"2 1 3 {len(cells)}", rows(1 + len(lines), cells), "$EndElements", ""])


def box_stl(x, y, z):
    """The surface of a box with a corner at the origin, as text."""
    at = lambda n: f"vertex {n % 2 * x} {n // 2 % 2 * y} {n // 4 * z}\n"
    sides = ["046", "062", "137", "175", "015", "054", "267", "273", "023", "031", "457", "476"]
    return "solid\n" + "".join("facet normal 0 0 0\nouter loop\n" + "".join(at(int(c)) for c in side) + "endloop\nendfacet\n"
                               for side in sides) + "endsolid\n"


def plain_force(stretch):
    return 2e6 * (stretch - stretch**-5) * 0.2 * 0.01


def replaced(text, old, new):
    """`text` with the one place `old` changed: a case that lost it would test nothing."""
    if text.count(old) != 1:
        raise ValueError(f"{old!r} stands {text.count(old)} times in the case")
    return text.replace(old, new)


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="riven cli ")  # a blank, as users have them
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name).resolve()

    def write(self, name, text):
        path = self.top / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def command(self, *words, expect=0, cwd=None, environment=None, **options):
        """Runs the program and checks its exit code."""
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=cwd or self.top, capture_output=True, text=True,
                              env={**os.environ, **(environment or {})}, timeout=100, check=False, **options)
        self.assertEqual(done.returncode, expect, f"riven {' '.join(map(str, words))}\n{done.stdout}\n{done.stderr}")
        return done

    def refused(self, *words, expect=2, **options):
        """Runs the program, which must refuse with one line and leave nothing behind. Returns the line."""
        before = self.everything()
        done = self.command(*words, expect=expect, **options)
        self.assertEqual(done.stdout, "")
        self.assertTrue(done.stderr.startswith("error: "), done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(self.everything(), before, "something was left on disk")
        return done.stderr

    def everything(self):
        return sorted(str(p.relative_to(self.top)) for p in self.top.rglob("*"))

    def summary(self, folder):
        return json.loads((self.top / folder / "summary.json").read_text(encoding="utf-8"))


def history(folder):
    """The columns and the rows (as numbers) of a result's history.csv."""
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0], [[float(cell) for cell in row] for row in rows[1:]]


def series(folder):
    """The (value, file) of each output state of a result."""
    root = ElementTree.parse(folder / "fields.pvd").getroot()
    return [(float(entry.get("timestep")), folder / entry.get("file")) for entry in root.iter("DataSet")]


def decoded(node):
    """The numbers of a compressed binary array of a VTK file."""
    text = "".join(node.text.split())
    blocks = struct.unpack("<Q", base64.b64decode(text[:12])[:8])[0]
    header_bytes = 8 * (3 + blocks)
    header_text = 4 * ((header_bytes + 2) // 3)
    sizes = struct.unpack(f"<{3 + blocks}Q", base64.b64decode(text[:header_text]))[3:]
    data, at, raw = base64.b64decode(text[header_text:]), 0, b""
    for size in sizes:
        raw += zlib.decompress(data[at:at + size])
        at += size
    return struct.unpack(f"<{len(raw) // 8}d", raw)


def fields(file):
    """Points and point fields (name -> list of tuples) of a VTU file."""
    piece = ElementTree.parse(file).getroot().find("UnstructuredGrid/Piece")
    count = int(piece.get("NumberOfPoints"))

    def tuples(node):
        numbers, width = decoded(node), int(node.get("NumberOfComponents", "1"))
        if len(numbers) != width * count:
            raise ValueError(f"{len(numbers)} numbers for {count} points of {width} components")
        return [numbers[i:i + width] for i in range(0, len(numbers), width)]

    return tuples(piece.find("Points/DataArray")), {a.get("Name"): tuples(a) for a in piece.find("PointData")}
