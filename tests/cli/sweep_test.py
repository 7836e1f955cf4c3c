"""`riven sweep`: what it runs, what it tells, and how it stops and goes on."""

import csv
import json
import pathlib
import re
import signal
import statistics
import subprocess
import time
import unittest

from program import HOLE, PLAIN, PROGRAM, ProgramTest, plain_force, replaced

SMALL = replaced(HOLE, "points = [20, 20]", "points = [14, 14]")
# Some seconds, so that it can be stopped on its way.
SLOW = replaced(replaced(HOLE, "points = [20, 20]", "points = [40, 40]"), "stretch = [1.2, 1.4]",
                "stretch = [1.001, 1.5]\nincrement = 0.01")


class SweepTest(ProgramTest):
    def rows(self, folder):
        with open(self.top / folder / "sweep.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def bits(self, folder):
        """The history and the fields of each variant."""
        return {str(p.relative_to(self.top / folder)): p.read_bytes() for p in sorted((self.top / folder).rglob("*"))
                if p.name == "history.csv" or p.suffix == ".vtu"}


class Sweep(SweepTest):
    def test_numbers_are_those_of_single_runs(self):
        case = self.write("sheet.toml", PLAIN)
        done = self.command("sweep", case, "material.rubber.youngs_modulus=6 MPa,12MPa", "geometry.horizon=2 dx,3 dx")
        folder = "results/sheet-sweep"
        rows = self.rows(folder)
        self.assertEqual([(row["material.rubber.youngs_modulus"], row["geometry.horizon"]) for row in rows],
                         [("6 MPa", "2 dx"), ("6 MPa", "3 dx"), ("12MPa", "2 dx"), ("12MPa", "3 dx")])
        self.assertEqual([float(row["material.rubber.youngs_modulus_si [Pa]"]) for row in rows], [6e6, 6e6, 12e6, 12e6])
        for row in rows:
            # The closed form, in proportion to the modulus; 1e-4 is the default tolerance's part of it.
            force = plain_force(1.4) * float(row["material.rubber.youngs_modulus_si [Pa]"]) / 6e6
            self.assertAlmostEqual(float(row["force_x [N]"]) / force, 1, delta=1e-4)
            self.assertEqual(row["status"], "finished")
            self.assertGreater(float(row["wall [s]"]), 0)
            self.assertAlmostEqual(float(row["geometry.horizon_si [m]"]), int(row["geometry.horizon"][0]) * 0.01, delta=1e-15)
            sets = [word for key in ("material.rubber.youngs_modulus", "geometry.horizon")
                    for word in ("--set", f"{key}={row[key]}")]
            self.command("run", case, *sets, "-o", "single", "--force")
            self.assertEqual(float(row["force_x [N]"]), self.summary("single")["metrics"]["force_x"]["value"])
            self.assertIn(f"{float(row['force_x [N]']):.6g}", done.stdout)
        self.assertEqual(len({row["folder"] for row in rows}), 4)
        self.assertEqual(done.stdout.count("finished"), 4)
        self.assertEqual(len(re.findall(r"(?m)^\[\d/4\] .*: .*force_x", done.stderr)), 4)
        self.assertEqual(len(re.findall(r"about .* left", done.stderr)), 3)
        self.assertTrue((self.top / folder / "sweep.png").read_bytes().startswith(b"\x89PNG"))
        self.assertEqual(list((self.top / folder).glob("*.log")), [])

    def test_side_by_side_gives_the_same_bits(self):
        case = self.write("sheet.toml", SMALL)
        words = ["sweep", case, "geometry.horizon=2 dx,2.5 dx,3 dx", "--set", "solver.stretch=[1.2]"]
        self.command(*words, "-o", "one")
        self.command(*words, "-o", "two", "-j", 2, "--threads", 1)
        self.assertEqual(len(self.bits("one")), 6)
        self.assertEqual(self.bits("one"), self.bits("two"))

    def test_lists_and_names(self):
        case = self.write("sheet.toml", PLAIN)
        self.command("sweep", case, "geometry.box.points=[10, 10],[12,12]", "title=\"a, b\",\"a; b\"", "-o", "out")
        rows = self.rows("out")
        self.assertEqual(len(rows), 4)
        self.assertEqual({self.summary(pathlib.Path("out") / row["folder"])["timing"]["points"] for row in rows}, {100, 144})
        self.assertEqual(len({row["folder"] for row in rows}), 4, "both titles read the same as names of files")
        self.assertNotIn("title_si", rows[0])

    def test_one_that_fails_does_not_stop_the_others(self):
        case = self.write("sheet.toml", SMALL)
        done = self.command("sweep", case, "solver.max_iterations=1,20000", "-o", "out", expect=3)
        self.assertEqual([row["status"] for row in self.rows("out")], ["failed", "finished"])
        self.assertRegex(done.stderr, r"max_iterations=1: failed .*no equilibrium beyond")
        self.assertEqual([p.name for p in (self.top / "out").glob("*.log")], ["solver.max_iterations=1.log"])

    def test_wrong_input_starts_nothing(self):
        case = self.write("sheet.toml", SMALL)
        good = "geometry.horizon=2 dx,3 dx"
        for words, message in {
                (good, "geometry.horizn=1 mm"): 'error: variant geometry.horizon=2 dx, geometry.horizn=1 mm: --set geometry.horizn: '
                                                'unknown key',
                ("geometry.horizon=3 dx,3 kg",): "error: variant geometry.horizon=3 kg: --set geometry.horizon",
                ("probe.2.from=[\"-30 mm\", 0],[0, 0]",): "variant probe.2.from=[0, 0]: ",
                ("geometry.horizon",): "geometry.horizon: expected KEY=a,b,c",
                ("=1",): "=1: expected KEY=a,b,c",
                ("geometry.horizon=",): "geometry.horizon=: value 1 is empty",
                ("geometry.horizon=2 dx,,3 dx",): "value 2 is empty",
                ("geometry.horizon=2 dx,2 dx",): "the value 2 dx stands there twice",
                (good, "geometry.horizon=4 dx"): "geometry.horizon: the key stands there twice",
                (good, "--force", "--resume"): "--resume",
                (good, "-j", "0"): "--jobs",
                (good, "--resume"): "results/sheet-sweep: is not a sweep of Riven (it has no sweep.toml)",
                (): "sheet.toml: has no [study], which says what to sweep; expected KEY=a,b,c",
                ("a=" + ",".join(map(str, range(200))), "b=" + ",".join(map(str, range(200)))): "more than 10000 variants"}.items():
            with self.subTest(" ".join(words)):
                self.assertIn(message, self.refused("sweep", case, *words))
        self.assertIn('did you mean "neo-hookean-membrane/equibiaxial-hole"?',
                      self.refused("sweep", "neo-hookean-membrane/equibiaxial-hol", good))
        self.assertIn("side by side need about", self.refused("sweep", case, "geometry.box.points=[40000,40000],[39999,39999]",
                                                              "-j", 2))

    def test_force_replaces_sweeps_only(self):
        case = self.write("sheet.toml", SMALL)
        words = ["sweep", case, "geometry.horizon=2 dx", "-o", "out", "--set", "solver.stretch=[1.1]"]
        note = self.write("out/note.txt", "dear")
        self.assertIn("out: exists already", self.refused(*words))
        self.assertIn("is not a sweep of Riven (it has no sweep.toml); --force does not remove it",
                      self.refused(*words, "--force"))
        note.unlink()
        self.command(*words, "--force")
        self.assertIn("exists already", self.refused(*words))
        self.write("out/old.txt", "of the older sweep")
        self.command(*words, "--force")
        self.assertFalse((self.top / "out/old.txt").exists())
        self.assertIn("holds another sweep (was values = [\"2 dx\"], is values = [\"3 dx\"])",
                      self.refused("sweep", case, "geometry.horizon=3 dx", "-o", "out", "--set", "solver.stretch=[1.1]",
                                   "--resume"))
        self.assertIn("holds another sweep", self.refused("sweep", case, "geometry.horizon=2 dx", "-o", "out", "--resume"))
        # The case was edited: its results are not those of the sweep any more.
        self.write("sheet.toml", replaced(SMALL, "points = [14, 14]", "points = [12, 12]"))
        self.assertIn("holds another sweep (was checksum = ", self.refused(*words, "--resume"))


# Discs that a seed puts somewhere; what their points feel differs, what the edge feels does not.
STUDY = SMALL + """
[set.discs]
random_discs = { number = 2, radius = "15 mm" }

[[probe]]
name = "inside"
kind = "nominal-stress"
on = "discs"

[[probe]]
name = "most"
kind = "largest"
of = "inside_xx"

[[probe]]
name = "hole_then"
kind = "largest"
of = "inside_xx"
gives = "hole_x"

[study]
keys = ["set.discs.random_discs.number, set.discs.random_discs.radius = (2, 15 mm), (4, 12 mm)",
        "set.discs.random_discs.seed = 1, 2, 3"]
plots = ["hole_x, inside_xx", "radius, most"]
"""


class Study(SweepTest):
    def test_the_case_says_what_to_run(self):
        case = self.write("sheet.toml", STUDY)
        done = self.command("sweep", case, "--set", "solver.stretch=[1.1,1.2]")
        folder = "results/sheet-sweep"
        rows = self.rows(folder)
        number, radius, seed = (f"set.discs.random_discs.{key}" for key in ("number", "radius", "seed"))
        self.assertEqual([(row[number], row[radius], row[seed]) for row in rows],
                         [("2", "15 mm", s) for s in "123"] + [("4", "12 mm", s) for s in "123"])
        self.assertEqual([row["folder"] for row in rows][:2], ["number=2,radius=15_mm,seed=1", "number=2,radius=15_mm,seed=2"])
        self.assertEqual([float(row[radius + "_si [m]"]) for row in rows], 3 * [0.015] + 3 * [0.012])
        self.assertEqual(len({row["inside_xx [Pa]"] for row in rows}), 6, "each has its own discs")
        self.assert_means(folder, rows)
        for picture in ("sweep.png", "sweep-2.png"):
            self.assertTrue((self.top / folder / picture).read_bytes().startswith(b"\x89PNG"), picture)
        self.assertRegex(done.stdout, r"(?m)^number +radius +seed +status ")
        self.assertRegex(done.stdout, r"(?m)^2 +15 mm +3 .* ± ")
        self.assertIn("(sweep.csv, sweep-means.csv, sweep.png, sweep-2.png)", done.stderr)

    def assert_means(self, folder, rows):
        with open(self.top / folder / "sweep-means.csv", newline="", encoding="utf-8") as file:
            means = list(csv.DictReader(file))
        self.assertEqual([(mean["set.discs.random_discs.number"], mean["runs"]) for mean in means], [("2", "3"), ("4", "3")])
        for mean, group in zip(means, (rows[:3], rows[3:])):
            values = [float(row["most [Pa]"]) for row in group]
            # Rounding of a sum of three.
            self.assertAlmostEqual(float(mean["most mean [Pa]"]) / statistics.mean(values), 1, delta=1e-12)
            self.assertAlmostEqual(float(mean["most deviation [Pa]"]) / statistics.stdev(values), 1, delta=1e-6)

    def test_words_come_before_the_study(self):
        case = self.write("sheet.toml", STUDY)
        self.command("sweep", case, "set.discs.random_discs.seed=1,2", "--plot", "stretch,hole_x", "-o", "out",
                     "--set", "solver.stretch=[1.1]")
        self.assertEqual(len(self.rows("out")), 2)
        self.assertEqual([p.name for p in (self.top / "out").glob("*.png")], ["sweep.png"])
        self.assertFalse((self.top / "out/sweep-means.csv").exists(), "seeds alone are what is looked at")
        self.assertIn("holds another sweep", self.refused("sweep", case, "-o", "out", "--resume"))

    def test_check_tells_what_it_is(self):
        case = self.write("sheet.toml", STUDY)
        said = self.command("check", case).stdout
        self.assertIn("# study: 6 variants over number, radius, seed", said)
        self.assertRegex(said, r"(?m)^#   2 shapes: its points have [\d.]+ % of the body's volume, the shapes add up to [\d.]+ %$")
        self.assertEqual(len(re.findall(r"(?m)^#   center \(\S+, \S+\) m$", said)), 2)
        for old, new, message in (("seed = 1, 2, 3", "sed = 1, 2, 3", 'sed: unknown key'),
                                  ("(4, 12 mm)", "(4)", "study.keys: set.discs.random_discs.number, set.discs.random_discs.radius = "
                                   "(2, 15 mm), (4): (4) has 1 value; expected 2"),
                                  ("(4, 12 mm)", "(40, 15 mm)", "variant number=40, radius=15 mm, seed=1: --set "
                                   "set.discs.random_discs.number: no room for 40 discs of radius 0.015 m"),
                                  ("radius, most", "radius, mst", '"mst" is neither a column of the history'),
                                  ("radius, most", "radius", "--plot radius: expected two names"),
                                  ("radius, most", "radios, most", '"radios" is neither a column of the history nor a swept key')):
            with self.subTest(new):
                wrong = self.write("wrong.toml", replaced(STUDY, old, new))
                self.assertIn(message, self.refused("check", wrong))
                self.assertIn(message, self.refused("sweep", wrong))
                self.assertFalse((self.top / "results/wrong-sweep").exists())


class Stopped(SweepTest):
    def stopped(self, number, words):
        """Starts a sweep, sends it a signal when its second run has a state; returns exit code and messages."""
        sweep = subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.top, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                 text=True)
        self.addCleanup(sweep.communicate)
        self.addCleanup(sweep.kill)
        end = time.monotonic() + 60
        while len(list((self.top / "out").glob("*/fields.pvd"))) < 2:
            self.assertIsNone(sweep.poll(), "the sweep ended by itself")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.005)
        sweep.send_signal(number)
        return sweep.wait(timeout=60), sweep.communicate()[1]

    def setUp(self):
        super().setUp()
        case = self.write("sheet.toml", SLOW)
        self.words = ["sweep", case, "geometry.horizon=2 dx,2.5 dx,3 dx", "--threads", 1]
        self.command(*self.words, "-o", "whole", "-j", 2)

    def assert_goes_on(self):
        done = self.command(*self.words, "-o", "out", "--resume")
        self.assertEqual([row["status"] for row in self.rows("out")], 3 * ["finished"])
        self.assertEqual(self.bits("out"), self.bits("whole"))
        return done

    def test_interrupt(self):
        code, said = self.stopped(signal.SIGINT, [*self.words, "-o", "out", "-j", 1])
        self.assertEqual(code, 130)
        self.assertEqual([row["status"] for row in self.rows("out")], ["finished", "interrupted", "not started"])
        self.assertIn("warning: interrupted. To go on: riven sweep ", said)
        self.assertTrue(said.strip().endswith("--resume"))
        self.assertTrue((self.top / "out" / self.rows("out")[1]["folder"] / "checkpoint.h5").exists())
        first = self.top / "out" / self.rows("out")[0]["folder"] / "summary.json"
        written = first.stat().st_mtime_ns
        self.assert_goes_on()
        self.assertEqual(first.stat().st_mtime_ns, written, "what is finished is kept")

    def test_kill(self):
        code, _ = self.stopped(signal.SIGKILL, [*self.words, "-o", "out", "-j", 1])
        self.assertEqual(code, -signal.SIGKILL)
        self.assertFalse((self.top / "out/sweep.csv").exists())
        self.assert_goes_on()
        running = json.loads((self.top / "out/geometry.horizon=3_dx/summary.json").read_text())
        self.assertEqual(running["status"], "finished")


if __name__ == "__main__":
    unittest.main()
