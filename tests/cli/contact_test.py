"""Contact and impactors in cases: what they do to a run, and what probes say of them."""

import unittest

from program import IMPACT, ProgramTest, history, replaced

# The halves of a plate, cut by a crack, run into each other at a twentieth of the waves' speed.
HALVES = """title = "Halves of a plate"

[geometry]
box = { size = ["40 mm", "40 mm"], thickness = "1 mm", points = [20, 20] }
horizon = "3 dx"

[[crack]]
from = ["-21 mm", 0]
to = ["21 mm", 0]

[model]
kind = "pmb"

[material.glass]
law = "linear-elastic"
youngs_modulus = "72 GPa"
density = "2440 kg/m^3"

[set.upper]
where = "y > 0"

[set.lower]
where = "y < 0"

[[initial]]
on = "upper"
velocity = [0, "-200 m/s"]

[[initial]]
on = "lower"
velocity = [0, "100 m/s"]

[contact]

[solver]
method = "verlet"
until = "30 us"

[output]
every = "10 us"
history_every = "1 us"

[[probe]]
name = "upper"
kind = "displacement"
at = [0, "10 mm"]
component = "y"

[[probe]]
name = "lower"
kind = "displacement"
at = [0, "-10 mm"]
component = "y"
"""


class Contact(ProgramTest):
    def test_halves_bounce(self):
        self.command("run", self.write("case.toml", HALVES), "-o", "out")
        gap = [row[1] - row[2] for row in history(self.top / "out")[1]]
        self.assertGreater(gap[-1], 0)  # farther apart than at the start, and
        self.assertGreater(min(gap), -2e-3)  # pressed into each other by less than a spacing at the middle of each
        energy = self.summary("out")["energy"]
        self.assertLess(abs(energy["balance_error"]), 0.05)

    def test_without_contact_they_pass(self):
        self.command("run", self.write("case.toml", replaced(HALVES, "[contact]", "")), "-o", "out")
        last = history(self.top / "out")[1][-1]
        self.assertAlmostEqual(last[1], -200 * 30e-6, delta=1e-12)
        self.assertAlmostEqual(last[2], 100 * 30e-6, delta=1e-12)

    def test_impactors_are_told(self):
        case = self.write("case.toml", IMPACT)
        said = self.command("check", case).stdout
        self.assertIn("# impactor ball: sphere, free, 0.02 kg,", said)
        self.assertIn("# impactor wall: plane, prescribed velocity,", said)
        done = self.command("run", case, "-o", "out")
        self.assertNotIn("there is no load", done.stderr)
        columns, rows = history(self.top / "out")
        at = {name.split(" ")[0]: n for n, name in enumerate(columns)}
        self.assertIn("ball_position_x [m]", columns)
        self.assertIn("wall_velocity_z [m/s]", columns)
        self.assertIn("wall_force_y [N]", columns)
        first, last = rows[0], rows[-1]
        self.assertAlmostEqual(first[at["ball_position_z"]], 10.5e-3, delta=1e-15)
        self.assertEqual(first[at["ball_velocity_z"]], -60)
        self.assertGreater(last[at["ball_velocity_z"]], -30)
        # What the wall's velocity makes of the way in two periods: 10 m/s in the mean.
        self.assertAlmostEqual(last[at["wall_position_z"]], -4.2e-3 + 40e-6 * 10, delta=1e-12)
        for row in rows:
            self.assertLessEqual(row[at["wall_force_z"]], 0)
        # The force on the ball is what changes its momentum; rows are some two steps apart.
        impulse = sum(0.5 * (a[at["ball_force_z"]] + b[at["ball_force_z"]]) * (b[0] - a[0]) for a, b in zip(rows, rows[1:]))
        change = 0.02 * (last[at["ball_velocity_z"]] + 60)
        self.assertAlmostEqual(impulse, change, delta=0.1 * change)
        energy = self.summary("out")["energy"]
        self.assertGreater(energy["dissipated"], 0)
        self.assertLess(abs(energy["balance_error"]), 0.1)

    def test_resolved_case_runs_the_same(self):
        self.command("run", self.write("case.toml", IMPACT), "-o", "out")
        self.command("run", "out/resolved.toml", "-o", "again")
        self.assertEqual((self.top / "out/history.csv").read_bytes(), (self.top / "again/history.csv").read_bytes())

    def test_threads_change_nothing(self):
        case = self.write("case.toml", IMPACT)
        for threads in (1, 3):
            self.command("run", case, "--threads", threads, "-o", f"out-{threads}")
        self.assertEqual((self.top / "out-1/history.csv").read_bytes(), (self.top / "out-3/history.csv").read_bytes())

    def test_fragments_that_could_pass(self):
        case = self.write("case.toml", replaced(IMPACT, "[contact]", ""))
        self.assertIn("without [contact] fragments of the body pass through each other", self.command("check", case).stdout)


if __name__ == "__main__":
    unittest.main()
