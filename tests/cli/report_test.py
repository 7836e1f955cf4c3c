"""`riven report`, `riven run --report`: the page of results, read back as a browser would."""

import base64
import csv
import datetime
import json
import re
import resource
import signal
import struct
import subprocess
import time
import unittest
import zlib

from program import HOLE, MOVING, PLAIN, PROGRAM, TORN, ProgramTest, fields, plain_force, replaced, series

EXPECTED = PLAIN + "".join(f"""
[[expect]]
metric = "force_x"
{value}
at = {at}
kind = "{kind}"
source = "{source}"
""" for value, at, kind, source in [
    (f'value = "{plain_force(1.2):.9g} N"\ntolerance = "0.1 %"', 1.2, "reference", "closed form"),
    (f'value = "{plain_force(1.4) / 1.02:.9g} N"\ntolerance = "0.1 %"', 1.4, "reference", "a <b> & \\\"c\\\""),
    (f'value = "{plain_force(1.4) / 2:.9g} N"', 1.4, "published", "a paper"),
    ('min = "1 N"', 1.4, "reference", "")])
EXPECTED += '\n[[expect]]\nfield = "displacement"\nfile = "points.csv"\ntolerance = 0.01\nkind = "reference"\n'
WIDTH = {"float32": "f", "float64": "d", "uint32": "I"}


def unpacked(array):
    """The numbers of a packed array."""
    planes, letter = zlib.decompress(base64.b64decode(array["data"], validate=True)), WIDTH[array["type"]]
    count, width = array["count"], struct.calcsize(letter)
    if len(planes) != count * width:
        raise ValueError(f"{len(planes)} bytes for {count} numbers")
    return [struct.unpack("<" + letter, bytes(planes[b * count + i] for b in range(width)))[0] for i in range(count)]


def single(number):
    """The number as a 32-bit float has it."""
    return struct.unpack("<f", struct.pack("<f", number))[0]


class ReportTest(ProgramTest):
    def page(self, file):
        """The data of a page."""
        text = (self.top / file).read_text(encoding="utf-8")
        self.assertTrue(text.lower().startswith("<!doctype html>"))
        found = re.findall(r'<script id="riven-data" type="application/json">([^<]*)</script>', text)
        self.assertEqual(len(found), 1)
        data = json.loads(found[0])
        self.assertEqual(data["format"], 1)
        return data

    def assert_histories(self, result, folder):
        """Both histories have the numbers of their files, bit for bit."""
        self.assertEqual([history["name"] for history in result["histories"]], ["history", "energy"])
        for history in result["histories"]:
            with open(folder / f"{history['name']}.csv", newline="", encoding="utf-8") as file:
                header, *rows = csv.reader(file)
            named = [c["name"] + (f" [{c['unit']}]" if c["unit"] else "") for c in history["columns"]]
            self.assertEqual(named, header)
            self.assertEqual(history["rows"], len(rows))
            self.assertGreater(len(rows), 0)
            columns = [float(row[c]) for c in range(len(header)) for row in rows]
            self.assertEqual(list(map(str, unpacked(history["values"]))), list(map(str, columns)))  # nan is nan

    def assert_view(self, view, folder):
        """All states of a small result are there, as 32-bit floats."""
        states = series(folder)
        points, named = fields(states[0][1])
        self.assertEqual((view["points"], view["points_of"]), (len(points), len(points)))
        self.assertEqual(unpacked(view["positions"]), [single(x) for point in points for x in point])
        self.assertEqual(view["cells"], [])
        self.assertEqual({field["name"] for field in view["fields"]}, set(named))
        self.assertEqual(view["fields"][0], {"name": "displacement", "unit": "m", "components": 3})
        self.assertEqual([state["value"] for state in view["states"]], [value for value, _ in states])
        for state, (_, file) in zip(view["states"], states):
            named = fields(file)[1]
            for field, array in zip(view["fields"], state["values"]):
                self.assertEqual(array["type"], "float32")
                self.assertEqual(unpacked(array), [single(x) for values in named[field["name"]] for x in values])
                self.assertEqual(array["count"], field["components"] * len(points))

    def started(self, *words):
        run = subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.top, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
        self.addCleanup(run.communicate)
        self.addCleanup(run.kill)
        return run

    def wait_for(self, run, file):
        end = time.monotonic() + 60
        while not (self.top / file).exists():
            self.assertIsNone(run.poll(), "the run ended by itself")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.001)


class Contents(ReportTest):
    def test_a_membrane(self):
        done = self.command("run", self.write("sheet.toml", HOLE), "--report")
        self.assertEqual(done.stdout, "", "scripts read standard output")
        self.assertIn("wrote results/sheet/report.html", done.stderr)
        folder = self.top / "results/sheet"
        data = self.page("results/sheet/report.html")
        self.assertRegex(data["program"], r"^Riven \d+\.\d+\.\d+ \((portable|avx2|avx512)\)$")
        written = datetime.datetime.strptime(data["written"], "%Y-%m-%dT%H:%M:%SZ")
        now = datetime.datetime.now(datetime.timezone.utc).replace(tzinfo=None)
        self.assertLess(abs((now - written).total_seconds()), 100)
        self.assertGreaterEqual(len(data["colour_maps"]), 3)
        for colour_map in data["colour_maps"]:
            self.assertEqual({len(anchor) for anchor in colour_map["anchors"]}, {3})
            self.assertTrue(all(0 <= value <= 255 for anchor in colour_map["anchors"] for value in anchor))
        result, = data["results"]
        self.assertEqual(set(result), {"name", "title", "status", "parameter", "facts", "metrics", "histories", "verdicts",
                                       "case_text", "resolved_text", "log_text", "notes", "view"})
        self.assertEqual((result["name"], result["title"], result["status"]), ("sheet", "Sheet", "finished"))
        self.assertEqual(result["parameter"], {"name": "stretch", "unit": ""})
        self.assertEqual((result["verdicts"], result["notes"]), ([], []))
        self.assertEqual(result["case_text"], HOLE)
        self.assertEqual(result["resolved_text"], (folder / "resolved.toml").read_text())
        self.assertEqual(result["log_text"], (folder / "riven.log").read_text())
        self.assertIn("finished in", result["log_text"])
        self.assert_histories(result, folder)
        self.assert_view(result["view"], folder)
        self.assertEqual(result["view"]["dimension"], 2)
        self.assertAlmostEqual(result["view"]["spacing"], 0.01, places=12)
        summary = self.summary("results/sheet")
        self.assertEqual({m["name"]: (m["value"], m["unit"]) for m in result["metrics"]},
                         {name: (m["value"], m["unit"]) for name, m in summary["metrics"].items()})
        facts = {fact["label"]: fact["value"] for fact in result["facts"]}
        self.assertEqual(facts["status"], "finished")
        self.assertEqual(facts["program"], data["program"])
        self.assertEqual(facts["points"], str(summary["timing"]["points"]))
        self.assertEqual(facts["directed bonds"].replace(" ", ""), str(summary["timing"]["bonds"]))
        self.assertEqual(facts["load steps"], str(summary["timing"]["steps"]))
        self.assertEqual(facts["iterations"].replace(" ", ""), str(summary["timing"]["iterations"]))
        self.assertEqual(facts["strain energy"], f"{summary['energy']['strain']:.6g} J")
        self.assertRegex(facts["memory at the peak"], r"^\d+ MB$")

    def test_a_fracture(self):
        self.command("run", self.write("torn.toml", TORN), "--report")
        folder = self.top / "results/torn"
        result, = self.page("results/torn/report.html")["results"]
        self.assertEqual(result["parameter"], {"name": "time", "unit": "s"})
        self.assertEqual(len(result["view"]["states"]), 5)
        self.assert_histories(result, folder)
        self.assert_view(result["view"], folder)
        damage = [field["name"] for field in result["view"]["fields"]].index("damage")
        first, last = (max(unpacked(result["view"]["states"][n]["values"][damage])) for n in (0, -1))
        self.assertGreater(last, first, "bonds broke")
        energy = result["histories"][1]
        dissipated = [c["name"] for c in energy["columns"]].index("dissipated")
        rows = energy["rows"]
        lost = unpacked(energy["values"])[dissipated * rows:(dissipated + 1) * rows]
        self.assertEqual(lost, sorted(lost))
        self.assertGreater(lost[-1], 0)

    def test_energies_are_those_of_the_summary(self):
        for name, text in {"plain": PLAIN, "moving": MOVING, "torn": TORN}.items():
            self.command("run", self.write(f"{name}.toml", text))
            with open(self.top / "results" / name / "energy.csv", newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            energy = self.summary(f"results/{name}")["energy"]
            for key, value in energy.items():
                self.assertEqual(float(rows[-1].get(f"{key} [J]", rows[-1].get(key))), value, key)
            for row in rows:
                parts = [float(row[f"{key} [J]"]) for key in ("kinetic", "strain", "dissipated", "damped", "held", "external_work")]
                error = sum(parts[:-1]) - parts[-1]
                # The scale is the largest energy so far, at least the largest of this row; rounding aside.
                self.assertLessEqual(abs(float(row["balance_error"])) * max(map(abs, parts)), abs(error) + 1e-12 * max(parts))
            with open(self.top / "results" / name / "history.csv", newline="", encoding="utf-8") as file:
                self.assertEqual([row[0] for row in list(csv.reader(file))[1:]], [list(row.values())[0] for row in rows])

    def test_a_model_without_energy_balance_has_none(self):
        text = MOVING + '\n[model]\nkind = "membrane-bond"\nloading = "uniaxial"\nvariant = "published"\n'
        self.command("run", self.write("bond.toml", text), "--report")
        self.assertIsNone(self.summary("results/bond")["energy"]["balance_error"])
        result, = self.page("results/bond/report.html")["results"]
        self.assert_histories(result, self.top / "results/bond")
        self.assertTrue(all(x != x for x in unpacked(result["histories"][1]["values"])[-result["histories"][1]["rows"]:]))
        self.assertNotIn("error of the energy balance", {fact["label"] for fact in result["facts"]})

    def test_verdicts_are_those_of_verify(self):
        self.write("points.csv", "lambda,X_m,Y_m,ux_m,uy_m\n1.4,0.03,0.05,0.012,0.0201\n")
        printed = self.command("verify", self.write("sheet.toml", EXPECTED), expect=1).stdout.splitlines()
        self.command("report", "results/sheet")
        rows = [re.split(r"  +", line.strip()) for line in printed if line.startswith("  ")][1:]
        verdicts = self.page("results/sheet/report.html")["results"][0]["verdicts"]
        self.assertEqual(len(verdicts), len(rows))

        def percent(fraction):
            return "0 %" if abs(fraction) < 1e-10 else f"{100 * fraction:.3g} %"

        for row, said in zip(rows, verdicts):
            cells = [said["what"] + (f" [{said['unit']}]" if said["unit"] else ""), f"{said['at']:.6g}"]
            if said["ours"] is not None:
                cells += ["-" if said["expected"] is None else f"{said['expected']:.6g}", f"{said['ours']:.6g}"]
            cells += [percent(said["deviation"])] if said["deviation"] is not None else []
            cells += [said["limit"]] if said["limit"] else []
            self.assertEqual(row, cells + [said["verdict"].replace("missed", "MISSED")])
        self.assertEqual([v["verdict"] for v in verdicts], ["ok", "missed", "reported", "ok", "ok"])
        self.assertEqual([v["kind"] for v in verdicts], ["reference", "reference", "published", "reference", "reference"])
        self.assertEqual(verdicts[1]["source"], 'a <b> & "c"')
        self.assertIsNone(verdicts[4]["ours"])

    def test_expectations_that_cannot_be_judged_are_noted(self):
        text = replaced(MOVING, "1e4 /s^2", "-1e6 /s^2") + \
            '\n[[expect]]\nmetric = "force_x"\nmin = "-1e9 N"\nat = {}\nkind = "reference"\n'.format('"4 ms"') + \
            '\n[[expect]]\nmetric = "force_x"\nmin = "-1e9 N"\nat = {}\nkind = "reference"\n'.format('"0 ms"')
        self.command("run", self.write("fast.toml", text), "--report", expect=3)
        result, = self.page("results/fast/report.html")["results"]
        self.assertEqual([v["at"] for v in result["verdicts"]], [0])
        note, = result["notes"]
        self.assertRegex(note, r"^Not compared: .*resolved\.toml:\d+:\d+: .*no output state at 0\.004\.$")

    def test_all_of_the_last_lines_of_a_long_log(self):
        self.command("run", self.write("sheet.toml", PLAIN))
        lines = [f"line {n} </script>" for n in range(1000)]
        self.write("results/sheet/riven.log", "\n".join(lines) + "\n")
        self.command("report", "results/sheet")
        self.assertEqual(self.page("results/sheet/report.html")["results"][0]["log_text"], "\n".join(lines[-200:]) + "\n")

    def test_the_page_needs_no_sources(self):
        self.command("run", self.write("sheet.toml", PLAIN), "--report", environment={"RIVEN_HOME": "/nowhere"})
        self.page("results/sheet/report.html")


class Stopped(ReportTest):
    def test_a_failed_run(self):
        text = replaced(HOLE, "stretch = [1.2, 1.4]", "stretch = [0.95, 0.3]\nmax_iterations = 2000")
        self.command("run", self.write("pressed.toml", text + "\n[model]\nstabilisation = 0\n"), "--report", expect=3)
        result, = self.page("results/pressed/report.html")["results"]
        self.assertEqual(result["status"], "failed")
        self.assertIn("no equilibrium", result["log_text"])
        self.assert_histories(result, self.top / "results/pressed")
        self.assert_view(result["view"], self.top / "results/pressed")

    def test_a_run_that_reached_nothing(self):
        text = replaced(HOLE, "stretch = [1.2, 1.4]", "stretch = [1.2]\nmax_iterations = 3")
        self.command("run", self.write("hopeless.toml", text), "--report", expect=3)
        result, = self.page("results/hopeless/report.html")["results"]
        self.assertEqual((result["status"], result["view"], result["histories"]), ("failed", None, []))

    def test_a_wrong_case_has_no_page(self):
        self.assertIn("titel", self.refused("run", self.write("wrong.toml", replaced(PLAIN, "title", "titel")), "--report"))

    def test_an_interrupted_run_and_its_resumption(self):
        long = replaced(replaced(HOLE, "points = [20, 20]", "points = [60, 60]"), "[1.2, 1.4]", "[1.001, 1.2]\nincrement = 0.02")
        run = self.started("run", self.write("long.toml", long), "--report")
        self.wait_for(run, "results/long/fields.pvd")
        run.send_signal(signal.SIGINT)
        error = run.communicate(timeout=60)[1]
        self.assertEqual(run.returncode, 130, error)
        self.assertRegex(error, r"To go on: riven run .*long\.toml'? --resume --report\n")
        result, = self.page("results/long/report.html")["results"]
        self.assertEqual(result["status"], "interrupted")
        self.assert_histories(result, self.top / "results/long")
        self.command("run", "long.toml", "--resume", "--report")
        result, = self.page("results/long/report.html")["results"]
        self.assertEqual(result["status"], "finished")
        self.assert_histories(result, self.top / "results/long")

    def test_a_run_that_goes_on_or_was_killed(self):
        long = replaced(replaced(HOLE, "points = [20, 20]", "points = [60, 60]"), "[1.2, 1.4]", "[1.001, 3]\nincrement = 0.005")
        run = self.started("run", self.write("long.toml", long))
        self.wait_for(run, "results/long/fields.pvd")
        self.command("report", "results/long", "-o", "now.html")
        run.kill()
        run.communicate(timeout=60)
        self.command("report", "results/long")
        for file in ("now.html", "results/long/report.html"):
            result, = self.page(file)["results"]
            self.assertEqual((result["status"], result["metrics"]), ("unfinished", []))
            self.assertGreaterEqual(len(result["view"]["states"]), 1)
        self.assert_histories(result, self.top / "results/long")

    def test_a_result_without_energies_as_older_ones(self):
        self.command("run", self.write("sheet.toml", PLAIN))
        (self.top / "results/sheet/energy.csv").unlink()
        self.command("report", "results/sheet")
        result, = self.page("results/sheet/report.html")["results"]
        self.assertEqual([history["name"] for history in result["histories"]], ["history"])


class Files(ReportTest):
    def test_several_results(self):
        self.command("run", self.write("sheet.toml", PLAIN), "-o", "a")
        self.command("run", "sheet.toml", "-o", "b/a")
        self.command("run", self.write("moving.toml", MOVING), "-o", "c")
        done = self.command("report", "a", "b/a", "c")
        self.assertRegex(done.stdout, r"^wrote report\.html \(\d+ (kB|MB)\)\n$")
        results = self.page("report.html")["results"]
        self.assertEqual([result["name"] for result in results], ["a", "b/a", "moving"])
        for result, folder in zip(results, ("a", "b/a", "c")):
            self.assert_view(result["view"], self.top / folder)
        self.assertIn("b/../a: is named twice", self.refused("report", "a", "b/../a"))

    def test_which_files_are_replaced(self):
        self.command("run", self.write("sheet.toml", PLAIN), "-o", "out", "--report")
        self.command("report", "out")
        self.command("report", "out", "-o", "new.html")
        self.write("mine.html", "<html>dear</html>")
        self.assertIn("is no report of Riven", self.refused("report", "out", "-o", "mine.html"))
        self.assertEqual((self.top / "mine.html").read_text(), "<html>dear</html>")
        self.command("report", "out", "-o", "mine.html", "--force")
        self.page("mine.html")
        self.assertIn("is a folder", self.refused("report", "out", "-o", "out"))
        self.assertIn("there is no folder", self.refused("report", "out", "-o", "none/page.html"))
        self.assertIn("cannot write /proc/page.html", self.refused("report", "out", "-o", "/proc/page.html", expect=3))
        self.command("run", "sheet.toml", "-o", "out", "--force", "--report")
        # At the end of a run, too.
        self.command("run", "sheet.toml", "-o", "out", "--resume", "--report")
        self.write("out/report.html", "mine")
        said = self.command("run", "sheet.toml", "-o", "out", "--resume", "--report", expect=2).stderr
        self.assertIn("is no report of Riven", said)
        self.assertEqual((self.top / "out/report.html").read_text(), "mine")

    def test_folders_that_are_no_results(self):
        self.command("run", self.write("sheet.toml", PLAIN))
        self.assertIn("required", self.command("report", expect=2).stderr)
        self.assertIn('there is none; did you mean "sheet"?', self.refused("report", "results/shet"))
        self.assertIn('there is none; did you mean "sheet"?', self.refused("report", "results/sheett/"))
        self.assertIn("is not a result of Riven", self.refused("report", "results"))
        self.assertIn("expected a result folder", self.refused("report", "sheet.toml"))
        self.assertIn("there is none", self.refused("report", "no/such/place"))

    def test_damaged_results(self):
        self.command("run", self.write("sheet.toml", PLAIN), "-o", "out")
        for name in ("fields.pvd", "summary.json", "history.csv", "energy.csv"):
            path = self.top / "out" / name
            good = path.read_bytes()
            path.write_bytes(good[:len(good) // 3] + b'\n"' + good[len(good) // 3:len(good) // 2] + b"\n")
            self.assertIn(f"out/{name}", self.refused("report", "out"))
            path.write_bytes(good)
        self.command("report", "out")

    def test_a_damaged_state_is_left_out(self):
        self.command("run", self.write("sheet.toml", PLAIN), "-o", "out")
        whole = series(self.top / "out")
        path = self.top / "out" / "fields/0001.vtu"
        path.write_bytes(path.read_bytes()[:1000])
        said = self.command("report", "out").stdout
        self.assertIn("The state at 1.4 is left out: ", said)
        self.assertIn("out/fields/0001.vtu", said)
        result = self.page("out/report.html")["results"][0]
        self.assertEqual([state["value"] for state in result["view"]["states"]],
                         [value for value, file in whole if file != path])
        self.assertIn("out/fields/0001.vtu", " ".join(result["notes"]))
        for _, file in whole:
            file.unlink()
        self.command("report", "out")
        self.assertIsNone(self.page("out/report.html")["results"][0]["view"])

    def test_the_page_shows_first_what_riven_plot_shows(self):
        self.command("run", self.write("torn.toml", TORN), "-o", "torn", "--report")
        self.assertEqual(self.page("torn/report.html")["results"][0]["view"]["field"], "damage")
        # Bonds that the crack cut from the start are no news.
        calm = self.write("calm.toml", replaced(TORN, "500 /s", "0.5 /s"))
        self.command("run", calm, "-o", "calm", "--report")
        self.assertEqual(self.page("calm/report.html")["results"][0]["view"]["field"], "strain_energy_density")

    def test_a_full_disk(self):
        self.command("run", self.write("sheet.toml", PLAIN), "-o", "out", "--report")
        before = (self.top / "out/report.html").read_bytes()
        said = self.refused("report", "out", expect=3,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000)))
        self.assertIn("out/report.html: is the disk full?", said)
        self.assertEqual((self.top / "out/report.html").read_bytes(), before)


if __name__ == "__main__":
    unittest.main()
