"""Runs that stop: by a signal, killed at any moment, and how they go on."""

import json
import random
import shutil
import signal
import subprocess
import time
import unittest

from program import HOLE, IMPACT, MOVING, PROGRAM, ProgramTest, fields, history, replaced, series

# A few hundred iterations or steps, each cheap: a run takes about 0.1 s.
RELAXED = replaced(HOLE, "points = [20, 20]", "points = [14, 14]")
MARCHED = replaced(replaced(MOVING, "points = [20, 20]", "points = [12, 12]"), '"4 ms"', '"21 ms"')
MARCHED += '\n[[initial]]\nvelocity = ["2 m/s * sin(30 rad/m * y)", 0]\n'
# What a run keeps from row to row is part of where it goes on.
MARCHED += """
[[probe]]
name = "swing"
kind = "displacement"
at = [0, "50 mm"]
component = "x"

[[probe]]
name = "most"
kind = "largest"
of = "swing"

[[probe]]
name = "when"
kind = "largest"
of = "swing"
gives = "time"
"""
SLABS = replaced(replaced(MARCHED, "points = [12, 12]", "points = [10, 10]"), 'method = "verlet"',
                 'method = "space-time"\nstep = "0.5 ms"')
# About a second, so that it can be interrupted on its way.
SLOW = replaced(replaced(HOLE, "points = [20, 20]", "points = [40, 40]"), "stretch = [1.2, 1.4]",
                "stretch = [1.001, 1.5]\nincrement = 0.03")
# Never to be waited for.
LONG = replaced(replaced(HOLE, "points = [20, 20]", "points = [60, 60]"), "stretch = [1.2, 1.4]",
                "stretch = [1.001, 1.5]\nincrement = 0.02")


def results(folder):
    """All that a run leaves but its log, without what depends on the clock."""
    found = {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
    del found["riven.log"]
    summary = json.loads(found.pop("summary.json"))
    for key in ("wall_s", "bond_evaluations_per_second"):
        del summary["timing"][key]
    del summary["memory_peak_bytes"]
    return found, summary


class ResumeTest(ProgramTest):
    def start(self, *words, **options):
        run = subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.top, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, **options)
        self.addCleanup(run.communicate)
        self.addCleanup(run.kill)
        return run

    def stopped(self, number, *words, when, **options):
        """Starts a run, sends it a signal when a file is there, and returns what it said and its exit code."""
        run = self.start(*words, **options)
        end = time.monotonic() + 60
        while not (self.top / when).exists():
            self.assertIsNone(run.poll(), "the run ended by itself")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.001)
        run.send_signal(number)
        return run.communicate(timeout=60)[1], run.returncode

    def assert_same(self, folder, whole):
        self.assertEqual(results(self.top / folder), results(self.top / whole))


class Killed(ResumeTest):
    def test_fifty_runs_killed_at_any_moment(self):
        luck = random.Random(5)
        cases = {}
        for name, text in {"relaxed": RELAXED, "marched": MARCHED, "impact": IMPACT, "slabs": SLABS}.items():
            words = ["run", self.write(f"{name}.toml", text), "--checkpoint-every", "12 steps", "--threads", 1]
            begin = time.monotonic()
            self.command(*words, "-o", f"{name}-whole")
            cases[name] = (words, time.monotonic() - begin)
        kills = 0
        for trial in range(50):
            name = luck.choice(list(cases))
            words, seconds = cases[name]
            words = [*words, "-o", f"{name}-{trial}"]
            folder = self.top / words[-1]
            for _ in range(luck.choice([1, 1, 2, 3])):
                run = self.start(*words, *(["--resume"] if folder.exists() else []))
                time.sleep(luck.uniform(0, 0.9 * seconds))
                run.kill()
                run.communicate(timeout=60)
                kills += run.returncode == -signal.SIGKILL
                if folder.exists():
                    self.assert_readable(folder)
            if not folder.exists():
                self.assertIn("there is none", self.command(*words, "--resume", expect=2).stderr)
            self.command(*words, *(["--resume"] if folder.exists() else []))
            self.assert_same(words[-1], f"{name}-whole")
            shutil.rmtree(folder)
        self.assertGreater(kills, 40)
        # What was killed before its folder had its name is swept up by the next run there.
        for name, (words, _) in cases.items():
            for trial in range(50):
                if list(self.top.glob(f".{name}-{trial}.new.*")):
                    self.command(*words, "-o", f"{name}-{trial}")
        self.assertEqual([path for path in self.everything() if path.startswith(".")], [])

    def assert_readable(self, folder):
        self.assertTrue((folder / "case.toml").exists() and (folder / "resolved.toml").exists())
        if (folder / "summary.json").exists():
            json.loads((folder / "summary.json").read_text())
        if (folder / "fields.pvd").exists():
            for _, file in series(folder):
                fields(file)

    def test_force_replaces_a_result_in_one_moment(self):
        luck = random.Random(6)
        case = self.write("relaxed.toml", RELAXED)
        self.command("run", case, "-o", "out")
        for _ in range(10):
            run = self.start("run", case, "-o", "out", "--force")
            time.sleep(luck.uniform(0, 0.08))
            run.kill()
            run.communicate(timeout=60)
            self.assert_readable(self.top / "out")
        self.command("run", case, "-o", "out", "--force")
        self.assertEqual([path for path in self.everything() if path.startswith(".")], [])


class Interrupted(ResumeTest):
    def test_a_chain_of_interrupts(self):
        case = self.write("case.toml", SLOW)
        self.command("run", case, "-o", "whole")
        error, code = self.stopped(signal.SIGTERM, "run", "case.toml", "-o", "out", when="out/fields.pvd")
        self.assertEqual(code, 130, error)
        self.assertIn("To go on: riven run case.toml --resume -o out\n", error)
        self.assertEqual(self.summary("out")["status"], "interrupted")
        reached = history(self.top / "out")[1][-1][0]
        for threads in (2, 1, 3):
            run = self.start("run", "case.toml", "-o", "out", "--resume", "--threads", threads)
            time.sleep(0.2)
            run.send_signal(signal.SIGINT)
            error = run.communicate(timeout=60)[1]
            if run.returncode in (-signal.SIGINT, 0):  # before it listened, or after its end
                continue
            self.assertEqual(run.returncode, 130, error)
            self.assertIn("going on at stretch", error)
            self.assertGreaterEqual(history(self.top / "out")[1][-1][0], reached)
            reached = history(self.top / "out")[1][-1][0]
        self.command("run", case, "-o", "out", "--resume")
        self.assert_same("out", "whole")
        self.assertFalse((self.top / "out/checkpoint.h5").exists(), "a finished run needs none")

    def test_an_interrupt_of_a_motion(self):
        long = replaced(MARCHED, '"21 ms"', '"2 s"')
        case = self.write("case.toml", long)
        _, code = self.stopped(signal.SIGTERM, "run", case, "--checkpoint-every", "never", when="results/case/fields.pvd")
        self.assertEqual(code, 130)
        self.assertTrue((self.top / "results/case/checkpoint.h5").exists())
        error, code = self.stopped(signal.SIGINT, "run", case, "--resume", when="results/case/fields/0009.vtu")
        self.assertEqual(code, 130, error)
        wall = self.summary("results/case")["timing"]["wall_s"]
        self.assertRegex(error, r"going on at time [\d.e-]+, after \d+ steps and [\d.]+ s")
        self.assertGreater(wall, 0)


class Wishes(ResumeTest):
    """What --resume and --checkpoint-every do, allow and refuse."""

    def stop(self, case):
        error, code = self.stopped(signal.SIGTERM, "run", case, "-o", "out", when="out/fields.pvd")
        self.assertEqual(code, 130, error)

    def contents(self):
        return {path: (self.top / path).read_bytes() for path in self.everything() if (self.top / path).is_file()}

    def test_a_changed_case(self):
        case = self.write("case.toml", SLOW)
        self.stop(case)
        before = self.contents()
        error = self.refused("run", case, "-o", "out", "--resume", "--set", "solver.tolerance=1e-4")
        self.assertIn("solver.tolerance (was 1e-05, is 0.0001)", error)
        self.write("case.toml", replaced(SLOW, '"6 MPa"', '"7 MPa"').replace("radius", "center = [0, 0], radius"))
        error = self.refused("run", case, "-o", "out", "--resume")
        self.assertIn("material.rubber.youngs_modulus (was '6000000 Pa', is '7000000 Pa')", error)
        self.assertNotIn("hole", error)
        self.write("case.toml", SLOW)
        self.assertEqual(self.contents(), before)
        # Names, expectations and how often a checkpoint is written change no result.
        self.write("case.toml", replaced(SLOW, '"Sheet"', '"Other"'))
        self.command("run", case, "-o", "out", "--resume", "--checkpoint-every", "60 min")

    def test_a_changed_table(self):
        self.write("pull.csv", "s,u\n1,0\n3,2\n")
        text = SLOW.replace("(stretch - 1)", "pull(stretch)")
        text += '\n[table.pull]\nfile = "pull.csv"\nargument = "s"\nvalue = "u"\n'
        case = self.write("case.toml", text)
        self.stop(case)
        self.write("pull.csv", "s,u\n1,0\n3,2.1\n")
        self.assertIn("table.pull.file", self.refused("run", case, "-o", "out", "--resume"))
        # The tables that the result keeps are the same.
        self.command("run", "out/resolved.toml", "-o", "out", "--resume", expect=0)

    def test_damaged_checkpoints(self):
        case = self.write("case.toml", LONG)
        self.stop(case)
        path = self.top / "out/checkpoint.h5"
        good = path.read_bytes()
        at = len(good) // 2
        for damaged, said in {good[:at]: "damaged", good[:at] + bytes([good[at] ^ 1]) + good[at + 1:]: "damaged",
                              b"something else": "is no checkpoint of Riven",
                              good.replace(b"format 2", b"format 9", 1): 'has format "9"'}.items():
            path.write_bytes(damaged)
            before = self.contents()
            self.assertIn(said, self.refused("run", case, "-o", "out", "--resume"))
            self.assertEqual(self.contents(), before)
        path.write_bytes(good)
        for name in ("history.csv", "energy.csv"):
            rows = (self.top / "out" / name).read_bytes()
            (self.top / "out" / name).write_bytes(rows[:20])
            self.assertIn(name, self.refused("run", case, "-o", "out", "--resume"))
            (self.top / "out" / name).write_bytes(rows)

    def test_nothing_to_resume(self):
        case = self.write("case.toml", RELAXED)
        self.assertIn("expected a result folder, there is none", self.refused("run", case, "--resume"))
        self.write("mine/note.txt", "dear")
        self.assertIn("is not a result", self.refused("run", case, "-o", "mine", "--resume"))
        self.assertIn("--resume", self.refused("run", case, "--resume", "--force"))
        self.command("run", case, "-o", "out")
        before = self.contents()
        self.assertIn("the run is finished", self.command("run", case, "-o", "out", "--resume").stderr)
        self.assertEqual(self.contents(), before)
        # Killed before its first checkpoint.
        (self.top / "out/summary.json").unlink()
        (self.top / "out/fields.pvd").unlink()
        (self.top / "out/history.csv").write_text("stretch\n1")
        done = self.command("run", case, "-o", "out", "--resume")
        self.assertIn("there is no checkpoint: the run starts over", done.stderr)
        self.command("run", case, "-o", "whole")
        self.assert_same("out", "whole")

    def test_a_failed_run_goes_on_from_its_last_checkpoint(self):
        failing = replaced(RELAXED, "stretch = [1.2, 1.4]", "stretch = [0.95, 0.3]\nmax_iterations = 2000")
        failing += "\n[model]\nstabilisation = 0\n"
        case = self.write("case.toml", failing)
        words = ["run", case, "-o", "out", "--checkpoint-every", "50 steps"]
        self.command(*words, expect=3)
        before = results(self.top / "out")
        error = self.command(*words, "--resume", expect=3).stderr
        self.assertRegex(error, r"going on at stretch 0\.\d+")
        after = results(self.top / "out")
        for found, _ in (before, after):
            del found["checkpoint.h5"]  # the time that it holds differs
        self.assertEqual(after, before)

    def test_a_folder_in_use(self):
        case = self.write("case.toml", LONG)
        run = self.start("run", case, "-o", "out")
        while not (self.top / "out/fields.pvd").exists():
            time.sleep(0.001)
        for option in ("--resume", "--force"):
            self.assertIn("a run writes there", self.command("run", case, "-o", "out", option, expect=2).stderr)
        run.kill()

    def test_how_often(self):
        case = self.write("case.toml", RELAXED)

        def written(*words):
            self.command("run", case, "-o", "out", "--force", *words)
            return (self.top / "out/riven.log").read_text().count("checkpoint at")

        self.assertEqual(written(), 0)
        self.assertEqual(written("--checkpoint-every", "never"), 0)
        iterations = self.summary("out")["timing"]["iterations"]
        self.assertEqual(written("--checkpoint-every", "50 steps"), iterations // 50)
        self.assertEqual(written("--set", "output.checkpoint_every=100 steps"), iterations // 100)
        self.assertGreater(written("--checkpoint-every", "1 us"), iterations // 2)
        for wrong in ("often", "0 steps", "-1 s", "5 m", "1.5 steps"):
            self.assertIn("checkpoint_every", self.refused("run", case, "-o", "no", "--checkpoint-every", wrong))


if __name__ == "__main__":
    unittest.main()
