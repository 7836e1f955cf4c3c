"""`riven run`: what a run leaves in its folder, and where."""

import math
import re
import unittest

from program import HOLE, MOVING, PLAIN, ProgramTest, fields, history, plain_force, replaced, series

FILES = ["case.toml", "energy.csv", "fields", "fields.pvd", "fields/0000.vtu", "fields/0001.vtu", "history.csv", "resolved.toml",
         "riven.log", "summary.json"]


def contents(folder):
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*"))


class Results(ProgramTest):
    def test_the_folder_holds_what_is_promised(self):
        case = self.write("sheet.toml", PLAIN)
        done = self.command("run", case)
        self.assertEqual(done.stdout, "", "scripts read standard output")
        folder = self.top / "results/sheet"
        self.assertEqual(contents(folder), FILES)
        self.assertEqual((folder / "case.toml").read_text(), PLAIN)
        self.assertRegex((folder / "riven.log").read_text(), r"(?m)^\d{4}-\d\d-\d\d .* info .*400 points")
        self.assertIn("results/sheet", done.stderr)
        self.assertEqual(self.everything(), sorted(
            ["sheet.toml", "results", "results/sheet"] + ["results/sheet/" + name for name in FILES]))

    def test_summary(self):
        self.command("run", self.write("sheet.toml", PLAIN), "-o", "out")
        summary = self.summary("out")
        self.assertEqual(set(summary), {"status", "case", "version", "instruction_set", "metrics", "states", "energy", "timing",
                                        "memory_peak_bytes"})
        self.assertEqual((summary["status"], summary["case"]), ("finished", "sheet"))
        self.assertEqual([state["stretch"] for state in summary["states"]], [1.2, 1.4])
        for state in summary["states"]:
            force = state["metrics"]["force_x"]
            self.assertEqual(force["unit"], "N")
            # The deformation is homogeneous: what is left is rounding (measured: 3e-9).
            self.assertAlmostEqual(force["value"] / plain_force(state["stretch"]), 1, delta=1e-7)
        self.assertEqual(summary["metrics"], summary["states"][-1]["metrics"])
        energy = summary["energy"]
        self.assertEqual(set(energy), {"kinetic", "strain", "dissipated", "damped", "held", "external_work", "balance_error"})
        # W = C10 (2 s^2 + s^-4 - 3) over the volume.
        strain = 1e6 * (2 * 1.4**2 + 1.4**-4 - 3) * 0.2 * 0.2 * 0.01
        self.assertAlmostEqual(energy["strain"] / strain, 1, delta=1e-7)
        self.assertLess(abs(energy["balance_error"]), 0.01)  # the work of five long load steps; measured 3e-3
        timing = summary["timing"]
        self.assertEqual(timing["points"], 400)
        self.assertEqual(timing["bonds"], 400 * 28)
        self.assertGreater(timing["steps"], 2)
        self.assertGreaterEqual(timing["iterations"], timing["steps"])
        self.assertAlmostEqual(timing["bond_evaluations_per_second"] * timing["wall_s"],
                               timing["bonds"] * timing["iterations"], delta=1e-6 * timing["bonds"])
        self.assertGreater(summary["memory_peak_bytes"], 1e6)
        self.assertLess(summary["memory_peak_bytes"], 1e9)

    def test_expectations_that_overrides_leave_out_are_counted(self):
        text = PLAIN + "".join(f'\n[[expect]]\nmetric = "force_x"\nmin = "1 N"\nat = {at}\nkind = "published"\n' for at in (1.2, 1.4))
        case = self.write("sheet.toml", text)
        self.assertNotIn("left out", self.command("run", case, "-o", "all").stderr)
        said = self.command("run", case, "-o", "one", "--set", "solver.stretch=[1.2]").stderr
        self.assertIn("1 expectation is at a state that this run does not reach; it is left out\n", said)
        said = self.command("check", case, "--set", "solver.stretch=[1.1]").stdout
        self.assertIn("# 2 expectations are at states that this run does not reach; they are left out\n", said)

    def test_a_field_is_expected_at_those_of_its_states_that_are_reached(self):
        points = "lambda,X_m,Y_m,ux_m,uy_m\n" + "".join(f"{s},0.05,0.05,{(s - 1) * 0.05},{(s - 1) * 0.05}\n"
                                                       for s in (1.1, 1.2, 1.4))
        self.write("points.csv", points)
        case = self.write("sheet.toml", PLAIN + '\n[[expect]]\nfield = "displacement"\nfile = "points.csv"\n'
                          'tolerance = "1 %"\nkind = "reference"\n')
        # 1.2 lies on the way, 1.4 beyond the end.
        run = self.command("run", case, "-o", "some", "--set", "solver.stretch=[1.1,1.3]")
        self.assertIn("2 expectations are at states that this run does not reach; they are left out\n", run.stderr)
        said = self.command("verify", case, "--set", "solver.stretch=[1.1,1.3]").stdout
        self.assertEqual(re.findall(r"displacement field +(\S+)", said), ["1.1"], said)

    def test_history_and_fields(self):
        self.command("run", self.write("hole.toml", HOLE), "-o", "out")
        columns, rows = history(self.top / "out")
        self.assertEqual(columns, ["stretch", "force_x [N]", "force_y [N]", "hole_x"])
        stretches = [row[0] for row in rows]
        self.assertEqual(stretches, sorted(stretches))
        self.assertLessEqual({1.2, 1.4}, set(stretches))
        self.assertEqual(len(rows), self.summary("out")["timing"]["steps"])
        states = series(self.top / "out")
        self.assertEqual([value for value, _ in states], [1.2, 1.4])
        for stretch, file in states:
            points, named = fields(file)
            self.assertEqual(len(points), self.summary("out")["timing"]["points"])
            self.assertTrue(all(math.hypot(x, y) > 0.025 for x, y, _ in points), "points in the hole")
            self.assertEqual(set(named), {"displacement", "damage", "strain_energy_density", "nominal_stress"})
            self.assertEqual({len(t) for t in named["nominal_stress"]}, {9})
            # Points beside the edges follow them.
            for (x, y, _), (ux, uy, _) in zip(points, named["displacement"]):
                if abs(x) > 0.094:
                    self.assertAlmostEqual(ux / x, stretch - 1, delta=0.05 * (stretch - 1))
                self.assertGreater(ux * x + uy * y, 0)

    def test_the_fields_that_are_asked_for(self):
        self.command("run", self.write("sheet.toml", PLAIN), "--set", 'output.fields=["displacement"]', "-o", "out")
        self.assertEqual(set(fields(series(self.top / "out")[0][1])[1]), {"displacement"})

    def test_the_resolved_case_runs_again_to_the_same_bits(self):
        self.write("reference/points.csv", "X_m,Y_m,ux_m,uy_m\n0.05,0.05,0.02,0.02\n")
        for name, text in {"hole": HOLE, "moving": MOVING}.items():
            expect = '\n[[expect]]\nfield = "displacement"\nfile = "reference/points.csv"\nkind = "published"\n'
            self.command("run", self.write(f"{name}.toml", text + expect), "-o", f"{name}-1")
            self.command("run", self.top / f"{name}-1/resolved.toml", "-o", f"{name}-2")
            for file in ["history.csv", "fields/0000.vtu", "fields/0001.vtu"]:
                self.assertEqual((self.top / f"{name}-1" / file).read_bytes(),
                                 (self.top / f"{name}-2" / file).read_bytes(), file)
            self.assertEqual(*((self.top / f"{name}-{n}/resolved.toml").read_text() for n in (1, 2)))

    def test_the_resolved_case_names_its_references_from_where_it_lies(self):
        self.write("work/reference/points.csv", "X_m,Y_m,ux_m,uy_m\n0.05,0.05,0.02,0.02\n")
        expect = '[[expect]]\nfield = "displacement"\nfile = "../reference/points.csv"\nkind = "published"\n'
        self.write("work/cases/sheet.toml", f'{PLAIN}\n{expect}\n[short]\nset = ["solver.stretch=[1.2]"]\n\n'
                   + expect.replace("[[expect]]", "[[short.expect]]"))
        self.command("run", "../cases/sheet.toml", "-o", "../new/results/sheet", cwd=self.write("work/here/x", "").parent)
        text = (self.top / "work/new/results/sheet/resolved.toml").read_text()
        self.assertEqual(text.count('file = "../../../reference/points.csv"'), 2)
        (self.top / "work").rename(self.top / "moved")
        resolved = "moved/new/results/sheet/resolved.toml"
        self.command("check", resolved)
        self.assertIn("displacement field", self.command("verify", resolved).stdout)
        # Through a link the path must lead to the same file.
        (self.top / "link").symlink_to(self.top / "moved/new/results")
        self.command("check", "link/sheet/resolved.toml")
        self.command("run", resolved, "-o", "link/again")
        self.command("check", "moved/new/results/again/resolved.toml")

    def test_the_number_of_threads_changes_no_bit(self):
        case = self.write("hole.toml", HOLE)
        moving = self.write("moving.toml", MOVING)
        for threads in (1, 2, 3):
            for path in (case, moving):
                self.command("run", path, "--threads", threads, "-o", f"{path.stem}-{threads}")
        for name, count in {"hole": 2, "moving": 3}.items():
            for file in ["history.csv", *(f"fields/{i:04}.vtu" for i in range(count))]:
                found = {(self.top / f"{name}-{threads}" / file).read_bytes() for threads in (1, 2, 3)}
                self.assertEqual(len(found), 1, file)

    def test_a_run_in_time(self):
        self.command("run", self.write("moving.toml", MOVING))
        summary = self.summary("results/moving")
        self.assertEqual([state["time"] for state in summary["states"]], [0, 0.002, 0.004])
        columns, rows = history(self.top / "results/moving")
        self.assertEqual(columns, ["time [s]", "force_x [N]", "force_y [N]"])
        self.assertEqual([round(row[0], 9) for row in rows], [0, 0.001, 0.002, 0.003, 0.004])
        self.assertGreater(rows[-1][1], 0)
        self.assertGreater(summary["energy"]["kinetic"], 0)
        self.assertGreater(summary["energy"]["external_work"], 0)
        self.assertLess(abs(summary["energy"]["balance_error"]), 5e-3)
        self.assertNotIn("iterations", summary["timing"])

    def test_a_load_that_begins_late(self):
        # Until then there is nothing but rounding, which must not count as energy from nowhere.
        late = replaced(MOVING, "1e4 /s^2 * x * t*t", "10 /s * x * max(0 s, t - 2 ms)")
        self.command("run", self.write("late.toml", late))
        rows = history(self.top / "results/late")[1]
        self.assertAlmostEqual(rows[1][1], 0, delta=1e-6)
        self.assertGreater(rows[-1][1], 1)
        rest = MOVING[:MOVING.index("[[load]]")] + MOVING[MOVING.index("[solver]"):]
        done = self.command("run", self.write("rest.toml", rest))
        self.assertIn("warning: there is no load", done.stderr)

    def test_overrides_are_what_ran(self):
        self.command("run", self.write("sheet.toml", PLAIN), "--set", "solver.stretch=[1.1]", "--set",
                     "material.rubber.youngs_modulus=12 MPa", "-o", "out")
        state, = self.summary("out")["states"]
        self.assertAlmostEqual(state["metrics"]["force_x"]["value"] / (2 * plain_force(1.1)), 1, delta=1e-6)
        resolved = (self.top / "out/resolved.toml").read_text()
        self.assertIn("stretch = [1.1]", resolved)
        self.assertIn('"12000000 Pa"', resolved)

    def test_expectations_beyond_the_overrides_do_not_stop_a_run(self):
        expect = '\n[[expect]]\nmetric = "force_x"\nvalue = "1 N"\ntolerance = 1\nat = 1.4\nkind = "reference"\n'
        case = self.write("sheet.toml", PLAIN + expect)
        self.command("run", case, "--set", "solver.stretch=[1.1]", "-o", "out")
        self.command("check", self.top / "out/resolved.toml")


class Folders(ProgramTest):
    def test_an_existing_folder_is_replaced_by_force_only(self):
        case = self.write("sheet.toml", PLAIN)
        self.command("run", case)
        before = (self.top / "results/sheet/summary.json").read_bytes()
        self.assertIn("--force", self.refused("run", case))
        self.assertEqual((self.top / "results/sheet/summary.json").read_bytes(), before)
        self.command("run", case, "--force", "--set", "solver.stretch=[1.3]")
        self.assertEqual(contents(self.top / "results/sheet"), [f for f in FILES if f != "fields/0001.vtu"])
        self.assertEqual([state["stretch"] for state in self.summary("results/sheet")["states"]], [1.3])

    def test_force_never_removes_what_is_no_result(self):
        case = self.write("sheet.toml", PLAIN)
        note = self.write("mine/note.txt", "dear")
        self.assertIn("not a result of Riven", self.refused("run", case, "-o", "mine", "--force"))
        self.assertEqual(note.read_text(), "dear")
        self.assertIn("is where Riven runs", self.refused("run", case, "-o", ".", "--force"))

    def test_folders_that_cannot_be(self):
        case = self.write("sheet.toml", PLAIN)
        self.write("file", "")
        self.assertIn("cannot create a result folder", self.refused("run", case, "-o", "file/below"))
        self.assertIn("cannot create a result folder", self.refused("run", case, "-o", "/proc/riven"))

    def test_the_name_follows_the_case(self):
        home = self.top / "home"
        self.write("home/cases/topic/shipped.toml", PLAIN)
        self.write("work/own.toml", PLAIN)
        work, environment = self.top / "work", {"RIVEN_HOME": str(home)}
        self.command("run", "topic/shipped", cwd=work, environment=environment)
        self.command("run", "own.toml", cwd=work, environment=environment)
        self.assertEqual(contents(work / "results/topic/shipped"), FILES)
        self.assertEqual(contents(work / "results/own"), FILES)
        self.assertEqual(self.summary("work/results/topic/shipped")["case"], "topic/shipped")

    def test_a_link_to_the_case_and_a_path_that_leads_away(self):
        self.write("cases here/sheet.toml", PLAIN)
        (self.top / "elsewhere").mkdir()
        (self.top / "link.toml").symlink_to(self.top / "cases here/sheet.toml")
        self.command("run", "../link.toml", "-o", "deep/er/out", cwd=self.top / "elsewhere")
        self.assertEqual(contents(self.top / "elsewhere/deep/er/out"), FILES)


class Screen(ProgramTest):
    def test_progress_is_plain_lines_off_a_terminal(self):
        done = self.command("run", self.write("sheet.toml", PLAIN))
        self.assertNotIn("\x1b", done.stderr)
        self.assertNotIn("\r", done.stderr)
        lines = done.stderr.splitlines()
        self.assertRegex(lines[0], r"^Sheet: 400 points, 11200 bonds, \d+ threads?, about \d+ MB of memory and [\d.]+ s -> results/sheet$")
        self.assertTrue(any(re.match(r"step \d+/\d+, stretch 1\.4, residual ", line) for line in lines), lines)
        self.assertRegex(lines[-2], r"^finished in [\d.]+ s, \d+ force evaluations")
        self.assertTrue(lines[-1].startswith("results: results/sheet/ "), lines[-1])

    def test_what_is_rarely_meant_is_said(self):
        self.assertNotIn("warning", self.command("run", self.write("plain.toml", PLAIN)).stderr)
        self.assertNotIn("warning", self.command("run", self.write("moving.toml", MOVING)).stderr)
        jump = replaced(MOVING, "1e4 /s^2 * x * t*t", "1e4 /s^2 * x * t*t + 1 mm")
        said = self.command("check", self.write("jump.toml", jump)).stdout
        self.assertIn("# warning: the loads are not zero at time 0", said)
        text = replaced(PLAIN, 'horizon = "3 dx"', 'horizon = "2 dx"')
        self.assertIn("warning: the horizon is 2 spacings", self.command("run", self.write("s.toml", text)).stderr)


if __name__ == "__main__":
    unittest.main()
