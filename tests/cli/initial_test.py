"""Initial conditions: what they do to a run, what `riven check` says of them, and what is refused."""

import unittest

from program import HOLE, MOVING, ProgramTest, fields, replaced, series

LOAD = MOVING[MOVING.index("[[load]]"):MOVING.index("[solver]")]
FREE = replaced(replaced(MOVING, LOAD, ""), 'on = "right"', 'on = "all"') + """
[set.all]
where = "x > -1 m"

[set.right_half]
where = "x > 0"

[set.upper_half]
where = "y > 0"
"""


def initial(text):
    return f"\n[[initial]]\n{text}\n"


class Initial(ProgramTest):
    def test_a_body_that_flies(self):
        case = self.write("case.toml", FREE + initial('velocity = ["3 m/s", "-1 mm / 1 ms"]'))
        done = self.command("run", case, "-o", "out")
        self.assertNotIn("there is no load", done.stderr)
        _, named = fields(series(self.top / "out")[-1][1])
        for ux, uy, _ in named["displacement"]:
            self.assertAlmostEqual(ux, 3 * 4e-3, delta=1e-12)
            self.assertAlmostEqual(uy, -4e-3, delta=1e-12)
        energy = self.summary("out")["energy"]
        kinetic = 0.5 * 1100 * 0.2 * 0.2 * 0.01 * 10
        self.assertAlmostEqual(energy["kinetic"], kinetic, delta=1e-9 * kinetic)
        self.assertLess(abs(energy["balance_error"]), 1e-9)

    def test_check_says_what_moves(self):
        case = self.write("case.toml", FREE + initial('on = "right_half"\nvelocity = ["100 /s * x", "free"]') +
                          initial('on = ["upper_half"]\ndisplacement = ["free", "1 mm"]\nvelocity = ["free", "2 m/s"]'))
        said = self.command("check", case).stdout
        self.assertIn("# initial displacement: 200 of 400 points, at most 0.001 m\n", said)
        self.assertIn("# initial velocity: 300 of 400 points, at most 9.70824 m/s\n", said)
        self.assertIn('[[initial]]\non = ["upper_half"]\ndisplacement = ["free", "1 mm"]\n', said)
        self.command("run", case, "-o", "out")
        self.command("run", "out/resolved.toml", "-o", "again")
        self.assertEqual((self.top / "out/history.csv").read_bytes(), (self.top / "again/history.csv").read_bytes())

    def test_the_loads_hold_what_they_prescribe(self):
        case = self.write("case.toml", MOVING + initial('displacement = ["1e-3 * x", "1 mm"]'))
        self.command("run", case, "-o", "out")
        points, named = fields(series(self.top / "out")[0][1])
        for (x, _, _), (ux, uy, _) in zip(points, named["displacement"]):
            self.assertAlmostEqual(ux, 1e-3 * x, delta=1e-15)
            self.assertAlmostEqual(uy, 1e-3, delta=1e-15)
        # The edges are held at 0: they pull back.
        self.assertLess(abs(self.summary("out")["energy"]["balance_error"]), 0.05)
        self.assertGreater(self.summary("out")["energy"]["external_work"], 0)

    def test_refusals(self):
        twice = initial('on = "right_half"\nvelocity = ["1 m/s", 0]') + initial('on = "upper_half"\nvelocity = [0, "free"]')
        inclusion = '\n[[inclusion]]\ndisc = { radius = "20 mm" }\n'
        for text, said in {
                FREE + twice: "component 0 of the velocity is given twice for the point at (",
                FREE + initial('velocity = ["1 m", 0]'): "initial.1.velocity",
                FREE + initial('velocity = ["1 m/s * t", 0]'): "t",
                FREE + initial('velocity = [1, 0]'): "1 has no unit",
                FREE + initial('velocity = ["1 m/s"]'): "expected 2, one per direction",
                FREE + initial('on = "left"\nvelocity = ["1 m/s", 0]'): '"left" is an edge',
                FREE + initial('on = "no"\nvelocity = ["1 m/s", 0]'): '"no" is neither',
                FREE + initial('velocity = ["free", "free"]'): "says nothing",
                FREE + initial('on = "all"'): "says nothing",
                FREE + initial('velocity = ["1 m/s * sqrt(x / 1 m)", 0]'): "is no finite number at (",
                FREE + inclusion + initial('velocity = ["1 m/s", 0]'): "free to move, and they start at rest",
                HOLE + initial('velocity = ["1 m/s", 0]'): 'it belongs to solver.method = "verlet"'}.items():
            error = self.refused("check", self.write("case.toml", text))
            self.assertIn(said, error)
            self.assertRegex(error, r"case\.toml:\d+:\d+: ")
            self.assertIn("initial", error)


if __name__ == "__main__":
    unittest.main()
