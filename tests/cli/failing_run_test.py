"""Runs that cannot end well: what they say, and what they leave on disk."""

import math
import resource
import signal
import subprocess
import time
import unittest

from program import HOLE, MOVING, PLAIN, PROGRAM, ProgramTest, fields, history, replaced, series

# Without stabilisation compression folds the sheet beside the hole near a stretch of 0.8.
COMPRESSED = replaced(HOLE, "stretch = [1.2, 1.4]", "stretch = [0.95, 0.3]\nmax_iterations = 2000")
COMPRESSED += "\n[model]\nstabilisation = 0\n"
# Long enough to be interrupted on any machine.
LONG = replaced(replaced(HOLE, "points = [20, 20]", "points = [160, 160]"), "stretch = [1.2, 1.4]",
                "stretch = [1.001, 3]\nincrement = 0.005")


class Failing(ProgramTest):
    def test_an_impossible_load_keeps_what_was_reached(self):
        done = self.command("run", self.write("case.toml", COMPRESSED), expect=3)
        self.assertEqual(done.stdout, "")
        error, = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
        self.assertIn("case.toml: no equilibrium beyond 0.", error)  # when
        self.assertRegex(error, r"at \(-?[\d.e-]+, -?[\d.e-]+, 0\) m")  # where
        self.assertIn("folded", error)  # why
        self.assertIn("try a larger model.stabilisation or a finer lattice, or another load", error)
        self.assertNotIn("increment", error)  # it was halved 256 times
        self.assertRegex(error, r"The last good state, stretch 0\.\d+, is in results/case$")
        folder = self.top / "results/case"
        summary = self.summary("results/case")
        self.assertEqual(summary["status"], "failed")
        rows = history(folder)[1]
        last = rows[-1]
        self.assertLess(last[0], 0.95)
        self.assertEqual([state["stretch"] for state in summary["states"]], [0.95, last[0]])
        self.assertEqual(summary["metrics"]["force_x"]["value"], last[1])
        states = series(folder)
        self.assertEqual([value for value, _ in states], [0.95, last[0]])
        points, named = fields(states[-1][1])
        edge = [ux / x for (x, _, _), (ux, _, _) in zip(points, named["displacement"]) if x > 0.094]
        self.assertAlmostEqual(sum(edge) / len(edge), last[0] - 1, delta=0.02)
        self.assertIn("no equilibrium", (folder / "riven.log").read_text())

    def test_too_few_iterations(self):
        case = self.write("case.toml", replaced(HOLE, "stretch = [1.2, 1.4]", "stretch = [1.2]\nmax_iterations = 3"))
        error = self.command("run", case, expect=3).stderr
        self.assertIn("not converged in the 3 iterations of solver.max_iterations", error)
        self.assertRegex(error, r"the largest force at \(-?[\d.e-]+, -?[\d.e-]+, 0\) m")
        self.assertIn("No state was reached", error)
        self.assertEqual(self.summary("results/case")["status"], "failed")
        self.assertEqual(self.summary("results/case")["states"], [])

    def test_motion_that_runs_away(self):
        case = self.write("case.toml", replaced(MOVING, "1e4 /s^2", "-1e6 /s^2"))
        error = self.command("run", case, expect=3).stderr
        self.assertRegex(error, r"error: .*case\.toml: at t = [\d.e-]+ s, step \d+")
        self.assertIn("try a s", error)
        summary = self.summary("results/case")
        self.assertEqual(summary["status"], "failed")
        self.assertEqual(summary["states"][0]["time"], 0)
        self.assertLess(summary["states"][-1]["time"], 0.004)

    def readable(self, folder, error):
        """The last good state, which the message names, is on disk, and all of its numbers are."""
        value, file = series(self.top / folder)[-1]
        self.assertIn(f"The last good state, time {value:.6g}, is in {folder}", error)
        points, named = fields(file)
        self.assertEqual(len(points), self.summary(folder)["timing"]["points"])
        for _, file in series(self.top / folder):
            for tuples in fields(file)[1].values():
                self.assertTrue(all(math.isfinite(x) for one in tuples for x in one))

    def test_a_load_that_is_no_number(self):
        case = self.write("case.toml", replaced(MOVING, "1e4 /s^2 * x * t*t", "10 /s * x * t * sqrt(1 - t / 3 ms)"))
        error = self.command("run", case, expect=3).stderr
        self.assertRegex(error, r"at t = 0\.00[\d]+ s, step \d+: the displacement that a load prescribes is not a finite number at \(-?0\.")
        self.readable("results/case", error)

    def test_bonds_that_push(self):
        # Turned about, the published law of one loading pushes; it has no energy whose balance could tell.
        case = self.write("case.toml", replaced(replaced(MOVING, "1e4 /s^2 * x * t*t", "1e9 /s^2 * x * t*t"), '"4 ms"', '"40 ms"')
                          + '\n[model]\nkind = "membrane-bond"\nloading = "uniaxial-compression"\nvariant = "published"\n')
        error = self.command("run", case, expect=3).stderr
        self.assertRegex(error, r"at t = [\d.e-]+ s, step \d+: ")
        self.readable("results/case", error)

    def test_a_failed_result_is_replaced_by_force(self):
        self.command("run", self.write("case.toml", COMPRESSED), expect=3)
        case = self.write("case.toml", PLAIN)
        self.command("run", case, "--force")
        self.assertEqual(self.summary("results/case")["status"], "finished")

    def test_a_full_disk(self):
        case = self.write("case.toml", PLAIN)

        def limited(size):
            return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        # The case and its history fit, the fields do not.
        done = self.command("run", case, expect=3, preexec_fn=limited(6000))
        self.assertRegex(done.stderr, r"error: .*fields/0000\.vtu: is the disk full\?")
        self.assertEqual(self.summary("results/case")["status"], "failed")
        self.assertGreaterEqual(len(history(self.top / "results/case")[1]), 2)
        self.assertEqual([name for name in self.everything() if "tmp" in name], [])
        # Not even the case fits: nothing is left.
        said = self.refused("run", case, "-o", "none", expect=3, preexec_fn=limited(100))
        self.assertIn("is the disk full?", said)


class Interrupts(ProgramTest):
    def started(self):
        """A long run that has reached its first output state."""
        run = subprocess.Popen([PROGRAM, "run", self.write("case.toml", LONG)], cwd=self.top, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.communicate)
        self.addCleanup(run.kill)
        self.wait_for(run, lambda: (self.top / "results/case/fields.pvd").exists())
        return run

    def wait_for(self, run, condition):
        end = time.monotonic() + 60
        while not condition():
            self.assertIsNone(run.poll(), "the run ended by itself")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.001)

    def test_an_interrupted_run_leaves_its_last_good_state(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.started()
            run.send_signal(number)
            out, err = run.communicate(timeout=60)
            self.assertEqual((run.returncode, out), (130, ""), err)
            folder = self.top / "results/case"
            last = history(folder)[1][-1]
            self.assertIn(f"interrupted. The last good state, stretch {last[0]:.6g}, is in results/case", err)
            summary = self.summary("results/case")
            self.assertEqual(summary["status"], "interrupted")
            self.assertLess(last[0], 3)
            self.assertEqual(summary["states"][-1]["stretch"], last[0])
            self.assertEqual(series(folder)[-1][0], last[0])
            self.assertEqual(len(fields(series(folder)[-1][1])[0]), summary["timing"]["points"])
            self.command("run", self.write("case.toml", PLAIN), "--force")
            (self.top / "results").rename(self.top / f"kept-{number}")

    def test_a_second_signal_kills(self):
        run = self.started()

        def handled():
            """Whether the program still has its own way with SIGINT."""
            with open(f"/proc/{run.pid}/status", encoding="ascii") as status:
                caught = next(line for line in status if line.startswith("SigCgt"))
            return int(caught.split()[1], 16) >> (signal.SIGINT - 1) & 1

        self.assertTrue(handled())
        run.send_signal(signal.SIGINT)
        self.wait_for(run, lambda: not handled())
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=60)
        self.assertEqual(run.returncode, -signal.SIGINT)
        self.assertFalse((self.top / "results/case/summary.json").exists())
        self.assertGreaterEqual(len(history(self.top / "results/case")[1]), 1)


if __name__ == "__main__":
    unittest.main()
