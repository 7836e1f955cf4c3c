"""Finite elements on meshes of files: the answer of the generator's mesh, groups as edges and sets, pressure, messages."""

import json
import math
import struct
import unittest

from program import ProgramTest, history, replaced

COOK = """title = "Cook's membrane"

[geometry]
GEOMETRY

[model]
kind = "finite-elements"
plane = "strain"

[material.rubber]
law = "neo-hookean"
c10 = "40 MPa"
bulk_modulus = "4000 MPa"

[[load]]
on = "left"
displacement = [0, 0]

[[load]]
on = "right"
traction = [0, "6.25 MPa * (stretch - 1)"]

[solver]
method = "newton"
stretch = [2]
tolerance = 1e-10
increment = 0.5

[[probe]]
name = "tip"
kind = "displacement"
at = ["48 mm", "60 mm"]

[[probe]]
name = "support"
kind = "reaction"
on = "left"

[[probe]]
name = "end"
kind = "nominal-stress"
on = "right"
"""
CORNERS = [(0, 0), (48, 44), (48, 60), (0, 44)]
OWN = 'quadrilateral = { corners = [[0, 0], ["48 mm", "44 mm"], ["48 mm", "60 mm"], [0, "44 mm"]], thickness = "1 mm", elements = [8, 6] }'
MESH = 'mesh = { file = "cook.msh", unit = "mm", as = "elements", thickness = "1 mm" }'


def place(x, y):
    """Of the unit square in the quadrilateral (mm)."""
    weights = [(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y]
    return tuple(sum(w * c[d] for w, c in zip(weights, CORNERS, strict=True)) for d in range(2))


class MeshFile:
    """Nodes, elements and groups, written in MSH 4.1. Numbers of nodes and elements count from 1."""

    TYPES = {("line", 2): 1, ("t3", 3): 2, ("q4", 4): 3, ("line", 3): 8, ("q8", 8): 16, ("point", 1): 15}
    DIMENSION = {"line": 1, "t3": 2, "q4": 2, "q8": 2, "point": 0}

    def __init__(self):
        self.nodes, self.blocks, self.groups = [], [], []

    def add(self, kind, elements, group=None):
        """A block of elements, each a list of nodes, in an entity of its own."""
        if group is not None and (self.DIMENSION[kind], group) not in self.groups:
            self.groups.append((self.DIMENSION[kind], group))
        self.blocks.append((kind, elements, group))

    def write(self, path, binary=False):
        text = f"$MeshFormat\n4.1 {int(binary)} 8\n".encode()
        text += (struct.pack("<i", 1) + b"\n" if binary else b"") + b"$EndMeshFormat\n"
        text += f"$PhysicalNames\n{len(self.groups)}\n".encode()
        text += b"".join(f'{d} {n + 1} "{name}"\n'.encode() for n, (d, name) in enumerate(self.groups)) + b"$EndPhysicalNames\n"
        pieces = []
        put = lambda form, *values: pieces.append(struct.pack("<" + form, *values) if binary else (" ".join(map(repr, values)) + "\n").encode())
        section = lambda name: f"${name}\n".encode() + b"".join(pieces) + f"\n$End{name}\n".encode()
        entities = [(self.DIMENSION[kind], n + 1, group) for n, (kind, _, group) in enumerate(self.blocks)]
        put("4Q", *(sum(d == of for d, _, _ in entities) for of in range(4)))
        for d, tag, group in sorted(entities, key=lambda e: e[:2]):
            tags = [self.groups.index((d, group)) + 1] if group is not None else []
            put(f"i{3 if d == 0 else 6}dQ{len(tags)}i" + ("Q" if d > 0 else ""), tag, *([0.0] * (3 if d == 0 else 6)), len(tags), *tags,
                *([0] if d > 0 else []))
        text += section("Entities")
        pieces.clear()
        count = len(self.nodes)
        put("4Q", 1, count, 1, count)
        put("3iQ", 2, 1, 0, count)
        for n in range(count):
            put("Q", n + 1)
        for x in self.nodes:
            put("3d", float(x[0]), float(x[1]), float(x[2]) if len(x) > 2 else 0.0)
        text += section("Nodes")
        pieces.clear()
        total = sum(len(elements) for _, elements, _ in self.blocks)
        put("4Q", len(self.blocks), total, 1, total)
        number = 0
        for (kind, elements, _), (d, tag, _) in zip(self.blocks, entities, strict=True):
            put("3iQ", d, tag, self.TYPES[kind, len(elements[0])], len(elements))
            for nodes in elements:
                number += 1
                put(f"{1 + len(nodes)}Q", number, *(n + 1 for n in nodes))
        path.write_bytes(text + section("Elements"))
        return path


def cook(element, along=(8, 6), groups=True, place=place):
    """The regular mesh that `quadrilateral` makes, with its ends as groups of lines."""
    mesh, number = MeshFile(), {}

    def node(i, j):
        if (i, j) not in number:
            number[i, j] = len(mesh.nodes)
            mesh.nodes.append(place(i / (2 * along[0]), j / (2 * along[1])))
        return number[i, j]

    elements = []
    for j in range(0, 2 * along[1], 2):
        for i in range(0, 2 * along[0], 2):
            c = [node(i, j), node(i + 2, j), node(i + 2, j + 2), node(i, j + 2)]
            if element == "q4":
                elements.append(c)
            elif element == "q8":
                elements.append(c + [node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 2), node(i, j + 1)])
            elif (i + j) // 2 % 2 == 0:
                elements += [[c[0], c[1], c[2]], [c[0], c[2], c[3]]]
            else:
                elements += [[c[0], c[1], c[3]], [c[1], c[2], c[3]]]
    mesh.add(element, elements, "panel" if groups else None)
    for name, i in (("left", 0), ("right", 2 * along[0])) if groups else ():
        lines = [[node(i, j), node(i, j + 2)] + ([node(i, j + 1)] if element == "q8" else []) for j in range(0, 2 * along[1], 2)]
        mesh.add("line", lines, name)
    return mesh


class MeshElements(ProgramTest):
    def last(self, text, name):
        self.command("run", self.write(f"{name}.toml", text), "-o", name)
        return history(self.top / name)[1][-1]

    def test_a_mesh_gives_the_answer_of_the_generator(self):
        for element in ["q4", "q8", "t3"]:
            own = self.last(COOK.replace("GEOMETRY", f'{OWN}\nelement = "{element}"'), f"own-{element}")
            for binary in [False, True]:
                cook(element).write(self.top / "cook.msh", binary)
                ours = self.last(COOK.replace("GEOMETRY", MESH), f"mesh-{element}-{binary}")
                for a, b in zip(ours, own, strict=True):  # rounding and the solver's tolerance
                    self.assertAlmostEqual(a, b, delta=1e-8 * max(map(abs, own[3:] if abs(b) > 1 else own[1:3])))

    def test_sides_of_the_box_are_edges_without_groups(self):
        cook("q4", groups=False, place=lambda x, y: (48 * x, 20 * y)).write(self.top / "cook.msh")
        text = COOK.replace("GEOMETRY", MESH).replace('at = ["48 mm", "60 mm"]', 'at = ["48 mm", "20 mm"]')
        self.assertAlmostEqual(self.last(text, "box")[4], -6.25e6 * 20e-3 * 1e-3, delta=1e-6)

    def test_check_describes_groups_and_reads_itself(self):
        mesh = cook("q8")
        mesh.nodes.append((100, 0))  # of no element
        mesh.add("point", [[0]], "origin")
        mesh.write(self.top / "cook.msh")
        said = self.command("check", self.write("case.toml", COOK.replace("GEOMETRY", MESH))).stdout
        self.assertIn("# mesh: 48 elements q8 of 9 quadrature points, 173 nodes", said)
        self.assertIn("# edge right: 6 sides, 1.6e-05 m^2", said)
        self.assertIn("# set panel: 173 points", said)
        self.assertIn("# set origin: 1 points", said)
        self.assertIn("# warning: 1 nodes of the mesh belong to no element and are left out, the first at (0.1, 0, 0) m", said)
        again = self.command("check", self.write("again.toml", said)).stdout
        kept = lambda lines: [line for line in lines.splitlines() if "time:" not in line]
        self.assertEqual(kept(said), kept(again))

    def test_a_result_runs_again_without_its_mesh(self):
        cook("q4").write(self.top / "cook.msh")
        case = self.write("case.toml", COOK.replace("GEOMETRY", MESH))
        self.command("run", case, "-o", "1")
        self.assertIn("nothing to resume", self.command("run", case, "-o", "1", "--resume").stderr)
        (self.top / "cook.msh").unlink()
        (self.top / "1").rename(self.top / "moved")
        self.command("run", "moved/resolved.toml", "-o", "2")
        for file in ["history.csv", "fields/0000.vtu", "resolved.toml", "tables/geometry-mesh.msh"]:
            self.assertEqual((self.top / "moved" / file).read_bytes(), (self.top / "2" / file).read_bytes(), file)
        cook("t3").write(self.top / "cook.msh")
        self.assertIn("another case", self.command("run", case, "-o", "moved", "--resume", expect=2).stderr)

    def test_groups_are_sets_of_materials_loads_and_probes(self):
        # Two strips, one stiffer, pulled on points: incompressible sheets of both get as narrow.
        mesh = cook("q4", (4, 2), place=lambda x, y: (40 * x, 20 * y))
        kind, elements, _ = mesh.blocks.pop(0)
        mesh.groups.clear()
        mesh.blocks.clear()
        mesh.add(kind, elements[:4], "soft half")
        mesh.add(kind, elements[4:], "stiff half")
        corner = [n for n, x in enumerate(mesh.nodes) if x == (0, 0)]
        mesh.add("point", [corner], "corner")
        ends = [sorted((n for n, x in enumerate(mesh.nodes) if x[0] == at), key=lambda n: mesh.nodes[n][1]) for at in (0, 40)]
        for name, nodes in zip(["fixed", "drawn"], ends, strict=True):
            mesh.add("line", [[a, b] for a, b in zip(nodes, nodes[1:], strict=False)], name)
        mesh.write(self.top / "cook.msh")
        text = f"""title = "Strips"
[geometry]
{MESH}
[model]
kind = "finite-elements"
[set.end]
group = "drawn"
[material.soft]
law = "neo-hookean"
c10 = "1 MPa"
[material.stiff]
law = "neo-hookean"
c10 = "3 MPa"
on = "stiff half"
[[load]]
on = ["fixed", "end"]
displacement = ["(stretch - 1)*x", "free"]
[[load]]
on = "corner"
displacement = ["free", 0]
[solver]
method = "newton"
stretch = [1.5]
tolerance = 1e-10
[[probe]]
name = "pull"
kind = "reaction"
on = "end"
component = "x"
[[probe]]
name = "soft"
kind = "nominal-stress"
on = "soft half"
[[probe]]
name = "fixed"
kind = "nominal-stress"
on = "fixed"
"""
        self.command("run", self.write("strips.toml", text), "-o", "strips")
        names, rows = history(self.top / "strips")
        columns = dict(zip(names, rows[-1], strict=True))
        stress = 2e6 * (1.5 - 1.5**-2)  # of the soft one
        self.assertAlmostEqual(columns["pull [N]"], 2 * stress * 20e-6, delta=1e-7)
        self.assertAlmostEqual(columns["fixed_x [Pa]"], -2 * stress, delta=1e-1)

    def test_pressure_holds_what_it_presses(self):
        # All round: a block in equilibrium with p, J from U' = -p.
        cook("q4", (3, 2), place=lambda x, y: (30 * x, 20 * y)).write(self.top / "cook.msh")
        text = COOK.replace("GEOMETRY", MESH).split("[[load]]")[0] + """[[load]]
on = ["left", "right", "bottom", "top"]
pressure = "400 MPa * (stretch - 1)"
[set.corner]
where = "x < 1 um && y < 1 um"
[set.foot]
where = "y < 1 um"
[[load]]
on = "corner"
displacement = [0, "free"]
[[load]]
on = "foot"
displacement = ["free", 0]
[solver]
method = "newton"
stretch = [2]
tolerance = 1e-10
increment = 0.25
[[probe]]
name = "width"
kind = "stretch"
from = [0, "20 mm"]
to = ["30 mm", "20 mm"]
[[probe]]
name = "end"
kind = "nominal-stress"
on = "right"
"""
        self.command("run", self.write("pressed.toml", text), "-o", "pressed")
        names, rows = history(self.top / "pressed")
        found = dict(zip(names, rows[-1], strict=True))
        stretch = found["width"]
        # Plane strain: sigma = U'(J) + mu J^(-5/3) (s^2 - I1 / 3) with J = s^2, I1 = 2 s^2 + 1.
        j = stretch**2
        sigma = 4e9 * (j - 1) + 80e6 * j**(-5 / 3) * (j - (2 * j + 1) / 3)
        self.assertAlmostEqual(sigma, -400e6, delta=400)
        self.assertAlmostEqual(found["end_x [Pa]"], -400e6 * stretch, delta=400)
        energy = json.loads((self.top / "pressed/summary.json").read_text())["energy"]
        self.assertLess(abs(energy["balance_error"]), 1e-3)

    def test_wrong_meshes_are_refused(self):
        text = COOK.replace("GEOMETRY", MESH)
        case = self.write("case.toml", text)

        def refusal(mesh, case=case):
            mesh.write(self.top / "cook.msh")
            return self.refused("run", case)

        mixed = cook("q4")
        mixed.add("t3", [[0, 1, 2]])
        self.assertIn("the mesh has 48 quadrangles and 1 triangles; expected elements of one kind", refusal(mixed))
        lines = MeshFile()
        lines.nodes = [(0, 0), (1, 0)]
        lines.add("line", [[0, 1]])
        self.assertIn("the mesh has lines only", refusal(lines))
        flat = cook("q4")
        flat.nodes[0] = flat.nodes[flat.blocks[0][1][0][2]]
        self.assertRegex(refusal(flat), r"cook.msh, element 1: this quadrangle is \w+, at \(.*\) m; expected one with a positive area")
        turned = cook("t3")
        turned.blocks[0][1][5].reverse()
        self.assertIn("element 6: this triangle is turned over against others of its surface, at (", refusal(turned))
        torn = cook("q4")
        for element in torn.blocks[0][1][24:]:
            element[:] = [n + 1000 for n in element]
        torn.nodes += [(0, 0)] * (1000 - len(torn.nodes)) + cook("q4").nodes
        torn.blocks = torn.blocks[:1]
        self.assertRegex(refusal(torn), r"falls into 2 parts that share no node; .* 9 pairs of nodes of different parts lie at one place: "
                                        r'"Coherence;"')
        cook("q4").write(self.top / "cook.msh")
        self.assertIn("did you mean \"right\"?",
                      self.refused("run", self.write("typo.toml", text.replace('on = "right"\ntraction', 'on = "rihgt"\ntraction'))))
        self.assertIn('found "q8", and the mesh has q4; expected "q4", or nothing',
                      self.refused("run", self.write("kind.toml", text.replace(MESH, MESH + '\nelement = "q8"'))))
        self.assertIn("needs a mesh; expected", self.refused("run", self.write("points.toml", text.replace(', as = "elements"', "") + "")))
        self.assertIn('"panel" is a set, and a pressure acts on an edge', self.refused("run", self.write("set.toml", text.replace(
            'on = "right"\ntraction = [0, "6.25 MPa * (stretch - 1)"]', 'on = "panel"\npressure = "1 MPa"'))))


if __name__ == "__main__":
    unittest.main()
