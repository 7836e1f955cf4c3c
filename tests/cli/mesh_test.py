"""Bodies from meshes: a mesh of squares is the lattice of their centres."""

import unittest

from program import BOX, HOLE, PLAIN, ProgramTest, history, plain_force, replaced

MESH = 'mesh = { file = "sheet.msh", unit = "mm", thickness = "10 mm" }'


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


class Meshes(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("sheet.msh", squares(20, 10))

    def last(self, text, name):
        self.command("run", self.write(f"{name}.toml", text), "-o", name)
        return history(self.top / name)[1][-1]

    def test_squares_give_the_force_of_the_lattice(self):
        lattice, mesh = self.last(PLAIN, "lattice"), self.last(replaced(PLAIN, BOX, MESH), "mesh")
        # Homogeneous: what is left is rounding of positions and the solver's tolerance (none here).
        self.assertAlmostEqual(mesh[1] / lattice[1], 1, delta=1e-9)
        self.assertAlmostEqual(mesh[1] / plain_force(1.4), 1, delta=1e-7)

    def test_check_describes_the_mesh(self):
        said = self.command("check", self.write("case.toml", replaced(PLAIN, BOX, MESH) + '\n[set.top_row]\ngroup = "top row"\n')).stdout
        self.assertRegex(said, r"# elements: 400 in \S.*sheet.msh, filling x -0.1 to 0.1 m, y -0.1 to 0.1 m\n")
        self.assertRegex(said, r"# body: 400 points with listed bonds, mean spacing 0.01 m, volume 0.0004 m\^3, 276 ghost points")
        self.assertIn("# set top_row: 20 points, x -0.095 to 0.095 m, y 0.095 to 0.095 m", said)
        self.assertNotIn("# warning", said)

    def test_the_resolved_case_finds_its_mesh(self):
        self.write("data/sheet.msh", squares(20, 10))
        self.command("run", self.write("case.toml", replaced(HOLE, BOX, replaced(MESH, "sheet.msh", "data/sheet.msh"))), "-o", "1")
        (self.top / "elsewhere").mkdir()
        self.command("run", "../1/resolved.toml", "-o", "../2", cwd=self.top / "elsewhere")
        for file in ["history.csv", "fields/0001.vtu", "resolved.toml"]:
            self.assertEqual((self.top / "1" / file).read_bytes(), (self.top / "2" / file).read_bytes(), file)

    def test_a_changed_mesh_is_not_resumed(self):
        case = self.write("case.toml", replaced(PLAIN, BOX, MESH))
        self.command("run", case, "-o", "out")
        self.write("sheet.msh", squares(10, 20))
        self.assertIn("holds a run of another case", self.command("run", case, "-o", "out", "--resume", expect=2).stderr)


if __name__ == "__main__":
    unittest.main()
