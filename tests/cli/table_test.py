"""Tables: functions from CSV files that formulas call."""

import re
import shutil
import unittest

from program import MOVING, PLAIN, ProgramTest, history, replaced, series

# The parabola of MOVING's load, 1e4 /s^2 x t^2, in steps of 0.02 ms: linear between them it is 1e-6 x off at the most.
PARABOLA = "time [ms],stretch [%]\n" + "".join(f"{0.02 * n:.2f},{100 * 1e4 * (2e-5 * n)**2:.9f}\n" for n in range(201))


def called(text, name, file, old, new, more=""):
    return replaced(replaced(text, "[geometry]", f'[table.{name}]\nfile = "{file}"\n{more}\n[geometry]'), old, new)


class Tables(ProgramTest):
    def test_a_table_of_time_gives_what_its_formula_gives(self):
        self.write("data/parabola.csv", PARABOLA)
        self.command("run", self.write("formula.toml", MOVING))
        self.command("run", self.write("table.toml", called(MOVING, "pull", "data/parabola.csv", "1e4 /s^2 * x * t*t",
                                                            "pull(t) * x")))
        columns, wanted = history(self.top / "results/formula")
        self.assertEqual(history(self.top / "results/table")[0], columns)
        largest = max(abs(row[1]) for row in wanted)
        for row, other in zip(wanted, history(self.top / "results/table")[1], strict=True):
            self.assertAlmostEqual(row[0], other[0], delta=1e-15)
            self.assertAlmostEqual(row[1] / largest, other[1] / largest, delta=1e-3)  # measured: 9e-5

    def test_a_table_of_the_stretch(self):
        self.write("pull.csv", "stretch,part\n1,0\n1.4,0.4\n")
        self.command("run", self.write("formula.toml", PLAIN))
        self.command("run", self.write("table.toml", called(PLAIN, "pull", "pull.csv", "(stretch - 1)*x", "pull(stretch)*x")))
        wanted, found = (history(self.top / "results" / name)[1] for name in ("formula", "table"))
        largest = wanted[-1][1]
        for row, other in zip(wanted, found, strict=True):
            self.assertEqual(row[0], other[0])
            self.assertAlmostEqual(row[1] / largest, other[1] / largest, delta=1e-9)  # rounding: measured 3e-15

    def test_a_result_runs_again_wherever_it_is(self):
        self.write("data/parabola.csv", PARABOLA)
        self.command("run", self.write("sheet.toml", called(MOVING, "pull", "data/parabola.csv", "1e4 /s^2 * x * t*t",
                                                            "pull(t) * x")), "-o", "first")
        self.assertEqual((self.top / "first/tables/pull.csv").read_text(), PARABOLA)
        (self.top / "first").rename(self.top / "moved")
        shutil.rmtree(self.top / "data")
        (self.top / "sheet.toml").unlink()
        self.command("run", "moved/resolved.toml", "-o", "second")
        for name in ["history.csv", "resolved.toml", "tables/pull.csv"] + [str(file.relative_to(self.top / "moved"))
                                                                        for _, file in series(self.top / "moved")]:
            self.assertEqual((self.top / "moved" / name).read_bytes(), (self.top / "second" / name).read_bytes(), name)
        self.command("run", "moved/resolved.toml", "-o", "moved", "--force")
        self.assertEqual((self.top / "moved/history.csv").read_bytes(), (self.top / "second/history.csv").read_bytes())

    def test_held_beyond_its_ends(self):
        self.write("pull.csv", "time [ms],displacement [mm]\n0,0\n1,2\n")
        text = called(MOVING, "pull", "pull.csv", "1e4 /s^2 * x * t*t", "pull(t) * x / 0.1 m")
        self.assertIn("has no value at", self.refused("run", self.write("sheet.toml", text)))
        self.command("run", "sheet.toml", "--set", 'table.pull.outside="hold"')

    def test_a_set_bounded_by_a_table(self):
        self.write("edge.csv", "x [mm],y [mm]\n-100,0\n0,50\n100,0\n")
        text = called(PLAIN, "edge", "edge.csv", 'title = "Sheet"', 'title = "Sheet"\n[set.above]\nwhere = "y > edge(x)"\n')
        checked = self.command("check", self.write("sheet.toml", text)).stdout
        points = [(-95 + 10 * i, -95 + 10 * j) for i in range(20) for j in range(20)]
        above = sum(y > 50 - abs(x) / 2 for x, y in points)
        self.assertEqual(int(re.search(r"^# set above: (\d+) points", checked, re.MULTILINE)[1]), above)

    def test_check_prints_it(self):
        self.write("pull.csv", "time [ms],u [mm],v [mm]\n0,0,0\n1,3,-1\n4,2,7\n")
        text = called(MOVING, "pull", "pull.csv", "1e4 /s^2 * x * t*t", "pull(t) * x / 0.1 m", 'value = "v"\n')
        said = self.command("check", self.write("sheet.toml", text)).stdout
        self.assertRegex(said, r"(?m)^# table pull: \S.*pull.csv, 3 points, time 0 to 0.004 s, v -0.001 to 0.007 m; beyond its "
                               r"ends an error$")
        self.assertIn('[table.pull]\nfile = "pull.csv"\nargument = "time [ms]"\nvalue = "v"\noutside = "error"\n', said)
        again = self.command("check", self.write("again.toml", said)).stdout
        self.assertIn("# table pull: ", again)


if __name__ == "__main__":
    unittest.main()
