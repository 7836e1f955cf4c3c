"""Bodies from meshes and surfaces: a mesh of squares is the lattice of their centres, the surface of a box its lattice."""

import unittest

from program import BLOCK, BLOCK_BOX, BOX, HOLE, PLAIN, ProgramTest, box_stl, history, plain_force, replaced, squares

MESH = 'mesh = { file = "sheet.msh", unit = "mm", thickness = "10 mm" }'


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

    def test_the_surface_of_a_box_gives_the_box(self):
        self.write("data/block.stl", box_stl(40, 20, 30))
        block = self.last(BLOCK, "block")
        for unit, scale in {"mm": 1, "m": 1e-3}.items():
            self.write("data/block.stl", box_stl(40 * scale, 20 * scale, 30 * scale))
            surface = self.last(replaced(BLOCK, BLOCK_BOX, f'surface = {{ file = "data/block.stl", unit = "{unit}", spacing = "5 mm" }}'),
                                f"surface-{unit}")
            for ours, theirs in zip(surface, block, strict=True):
                self.assertAlmostEqual(ours, theirs, delta=1e-9 * abs(block[1]))  # rounding of positions
        # The resolved case finds its surface wherever it is.
        (self.top / "surface-m").rename(self.top / "moved")
        (self.top / "data/block.stl").unlink()
        self.command("run", "moved/resolved.toml", "-o", "again")
        for file in ["history.csv", "fields/0000.vtu", "resolved.toml", "tables/geometry-surface.stl"]:
            self.assertEqual((self.top / "moved" / file).read_bytes(), (self.top / "again" / file).read_bytes(), file)

    def test_check_describes_the_surface(self):
        self.write("block.stl", box_stl(40, 20, 30))
        case = self.write("case.toml", replaced(BLOCK, BLOCK_BOX, 'surface = { file = "block.stl", unit = "mm", spacing = "5 mm" }'))
        said = self.command("check", case).stdout
        self.assertIn("# surface: 12 triangles in block.stl, around 2.4e-05 m^3\n", said)
        self.assertRegex(said, r"# body: 192 points of 8 x 4 x 6 cells, spacing 0.005 m, volume 2.4e-05 m\^3")


if __name__ == "__main__":
    unittest.main()
