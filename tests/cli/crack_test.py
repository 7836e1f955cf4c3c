"""Cracks of every form that cut bodies, and probes that follow them: lengths, speeds and fragments of real runs, the same after a stop."""

import math
import pathlib
import random
import shutil
import signal
import subprocess
import time
import unittest

from program import BLOCK, PROGRAM, ProgramTest, box_stl, fields, history, replaced, series

# A strip with a notch in its left edge; its long edges move apart, and the crack runs along the middle until it is through.
STRIP = """title = "Strip that tears"

[geometry]
box = { size = ["40 mm", "20 mm"], thickness = "1 mm", points = [60, 30] }
horizon = "3 dx"

[[crack]]
from = ["-20 mm", 0]
to = ["-10 mm", 0]

[model]
kind = "pmb"

[material.glass]
law = "linear-elastic"
youngs_modulus = "72 GPa"
density = "2440 kg/m^3"
critical_stretch = 0.006

[[initial]]
velocity = [0, "100 /s * y"]

[[load]]
on = ["top", "bottom"]
displacement = ["free", "100 /s * t * y"]

[solver]
method = "verlet"
until = "60 us"

[output]
every = "10 us"
history_every = "0.5 us"
fields = ["displacement", "damage", "fragment"]

""" + "".join(f'[[probe]]\nname = "{name}"\nkind = "{kind}"\n{more}\n' for name, kind, more in [
    ("crack_length", "crack-length", ""), ("crack_area", "crack-area", ""), ("crack_speed", "crack-speed", 'over = "4 us"'), ("tip", "crack-tip", ""),
    ("branches", "branches", ""), ("crack_angle", "crack-angle", 'length = "12 mm"'), ("fragments", "fragments", "")])


def outside(text, **values):
    """A case with another form of crack."""
    return replaced(text, 'from = ["-20 mm", 0]\nto = ["-10 mm", 0]\n', values["crack"] + "\n")


class CrackProbes(ProgramTest):
    def columns(self, folder):
        names, rows = history(self.top / folder)
        return {name.split(" ")[0]: [row[n] for row in rows] for n, name in enumerate(names)}, names

    def test_a_strip_tears_from_its_notch_to_the_other_edge(self):
        self.command("run", self.write("strip.toml", STRIP), "-o", "out", "--threads", 1)
        found, names = self.columns("out")
        self.assertEqual(names, ["time [s]", "crack_length [m]", "crack_area [m^2]", "crack_speed [m/s]", "tip_x [m]", "tip_y [m]", "branches",
                                 "crack_angle [deg]", "fragments"])
        self.assertEqual((found["crack_length"][0], found["crack_speed"][0], found["branches"][0], found["fragments"][0]), (0, 0, 0, 1))
        self.assertTrue(math.isnan(found["tip_x"][0]) and math.isnan(found["crack_angle"][0]))
        for name in ("crack_length", "crack_area"):
            self.assertEqual(found[name], sorted(found[name]), name)
        # From the notch to the edge it is 30 mm. Where it ends, damage spreads along the edge, as much as a horizon.
        self.assertAlmostEqual(found["crack_length"][-1], 0.03, delta=0.002)
        self.assertAlmostEqual(found["tip_x"][-1], 0.02, delta=0.001)
        self.assertAlmostEqual(found["crack_angle"][-1], 0, delta=2)
        self.assertGreater(max(found["crack_speed"]), 1000)
        self.assertLess(max(found["crack_speed"]), 3102)  # Rayleigh waves of this glass
        self.assertEqual(found["crack_speed"][-1], 0)
        # The speed is the slope of the length over the last 4 us, eight rows and the one before them.
        middle = next(n for n, length in enumerate(found["crack_length"]) if length > 0.015)
        rows = [n for n in range(middle + 1) if found["time"][n] >= found["time"][middle] - 4e-6]
        times, lengths = [found["time"][n] for n in rows], [found["crack_length"][n] for n in rows]
        mean = sum(times) / len(rows)
        slope = sum((t - mean) * s for t, s in zip(times, lengths)) / sum((t - mean)**2 for t in times)
        self.assertAlmostEqual(found["crack_speed"][middle] / slope, 1, delta=1e-9)
        # The field of the last state counts what the probe counts.
        numbers = [number for number, in fields(series(self.top / "out")[-1][1])[1]["fragment"]]
        sizes = {number: numbers.count(number) for number in numbers}
        self.assertEqual(sum(size >= 4 for size in sizes.values()), found["fragments"][-1])
        self.assertEqual(sorted(sizes.values(), reverse=True), [sizes[number] for number in sorted(sizes)])
        self.assertEqual(min(sizes), 1)

    def test_a_set_is_looked_at_alone(self):
        sets = '[set.west]\nwhere = "x < 0"\n\n[set.east]\nwhere = "x > 0"\n\n[model]'
        probes = "".join(f'\n[[probe]]\nname = "{kind}_{on}"\nkind = "{kind}"\non = "{on}"\n' for kind in ("crack-area", "crack-length") for on in ("west", "east"))
        self.command("run", self.write("strip.toml", replaced(STRIP, "[model]", sets) + probes), "-o", "out", "--threads", 1)
        last = {name: column[-1] for name, column in self.columns("out")[0].items()}
        self.assertAlmostEqual((last["crack-area_west"] + last["crack-area_east"]) / last["crack_area"], 1, delta=1e-12)
        self.assertAlmostEqual(last["crack-length_west"], 0.01, delta=0.002)
        # No old crack is in the east: its length is from end to end, and a horizon of 2 mm in doubt.
        self.assertAlmostEqual(last["crack-length_east"], 0.02, delta=0.002)

    def test_threads_and_stops_change_no_bit(self):
        case = self.write("strip.toml", STRIP)
        words = ["run", case, "--checkpoint-every", "7 steps"]
        begin = time.monotonic()
        self.command(*words, "-o", "whole", "--threads", 1)
        seconds = time.monotonic() - begin
        self.command(*words, "-o", "two", "--threads", 2)
        luck, whole = random.Random(3), (self.top / "whole/history.csv").read_bytes()
        self.assertEqual((self.top / "two/history.csv").read_bytes(), whole)
        kills = 0
        for trial in range(6):
            for _ in range(3):
                run = subprocess.Popen([PROGRAM, *map(str, words), "-o", "out", "--threads", "1", *(["--resume"] if (self.top / "out").exists() else [])],
                                       cwd=self.top, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(luck.uniform(0.2, 0.7) * seconds)
                run.kill()
                run.wait(timeout=60)
                kills += run.returncode == -signal.SIGKILL
            self.command(*words, "-o", "out", "--threads", 1, *(["--resume"] if (self.top / "out").exists() else []))
            self.assertEqual((self.top / "out/history.csv").read_bytes(), whole, f"trial {trial}")
            shutil.rmtree(self.top / "out")
        self.assertGreater(kills, 0)  # how many depends on the machine

    def test_expected_angles_have_their_unit(self):
        short = replaced(STRIP, '"60 us"', '"30 us"')
        for value, code in {'"1 deg"': 0, '"-60 deg"': 1}.items():
            expect = f'\n[[expect]]\nmetric = "crack_angle"\nvalue = {value}\nabsolute_tolerance = "5 deg"\nkind = "reference"\n'
            self.command("verify", self.write("strip.toml", short + expect), expect=code)
        expect = '\n[[expect]]\nmetric = "crack_angle"\nvalue = "1 mm"\ntolerance = 1\nkind = "reference"\n'
        self.assertIn("found a value in m", self.refused("run", self.write("strip.toml", short + expect)))


class CrackForms(ProgramTest):
    def last(self, text, name):
        self.command("run", self.write(f"{name}.toml", text), "-o", name, "--threads", 1)
        return history(self.top / name)[1][-1]

    def test_a_path_is_its_pieces(self):
        short = replaced(STRIP, '"60 us"', '"30 us"')
        corner = '["-14 mm", "1 mm"]'
        pieces = replaced(short, 'to = ["-10 mm", 0]\n', f'to = {corner}\n\n[[crack]]\nfrom = {corner}\nto = ["-10 mm", 0]\n')
        path = outside(short, crack=f'path = [["-20 mm", 0], {corner}, ["-10 mm", 0]]')
        self.assertGreater(self.last(path, "path")[1], 0.005)  # it has grown, to say something of it
        self.last(pieces, "pieces")
        # It runs again from where it is kept.
        self.last((self.top / "path/resolved.toml").read_text(), "again")
        for other in ("pieces", "again"):
            self.assertEqual((self.top / other / "history.csv").read_bytes(), (self.top / "path/history.csv").read_bytes(), other)

    def test_forms_in_space_agree(self):
        # The section x = 12 mm of the block, as far as z = 15 mm; the penny and the triangles are made for it.
        square = '[["12 mm", "-1 mm", "-1 mm"], ["12 mm", "21 mm", "-1 mm"], ["12 mm", "21 mm", "15 mm"], ["12 mm", "-1 mm", "15 mm"]]'
        corners = ["12 -1 -1", "12 21 -1", "12 21 15", "12 -1 15"]
        stl = "solid\n" + "".join("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {corners[n]}\n" for n in one) + "endloop\nendfacet\n"
                                  for one in [(0, 1, 2), (0, 2, 3)]) + "endsolid\n"
        self.write("data/cut.stl", stl)
        whole = self.last(BLOCK, "whole")[1]
        polygon = self.last(BLOCK + f"\n[[crack]]\npolygon = {square}\n", "polygon")[1]
        surface = self.last(BLOCK + '\n[[crack]]\nsurface = { file = "data/cut.stl", unit = "mm" }\n', "surface")[1]
        self.assertEqual(surface, polygon)
        self.assertLess(polygon, 0.9 * whole)
        through = self.last(BLOCK + '\n[[crack]]\npenny = { center = ["12 mm", "10 mm", "15 mm"], normal = [2, 0, 0], radius = "30 mm" }\n', "penny")[1]
        self.assertLess(abs(through), 1e-5 * whole)  # two pieces, at rest as far as `tolerance` asks
        # The result keeps its surface, wherever it and the file go.
        (self.top / "surface").rename(self.top / "moved")
        (self.top / "data/cut.stl").unlink()
        self.command("run", "moved/resolved.toml", "-o", "again", "--threads", 1)
        self.assertEqual((self.top / "again/history.csv").read_bytes(), (self.top / "moved/history.csv").read_bytes())
        self.assertEqual(pathlib.Path(self.top / "again/tables/crack-1.stl").read_text(), stl)

    def test_area_and_fragments_in_space(self):
        plane = '[["20 mm", "-1 mm", "-1 mm"], ["20 mm", "21 mm", "-1 mm"], ["20 mm", "21 mm", "31 mm"], ["20 mm", "-1 mm", "31 mm"]]'
        probes = '\n[[probe]]\nname = "parts"\nkind = "fragments"\n\n[[probe]]\nname = "area"\nkind = "crack-area"\n'
        self.assertEqual(self.last(BLOCK + probes, "one")[-2:], [1, 0])
        # A crack of the case is none that has grown.
        self.assertEqual(self.last(BLOCK + probes + f"\n[[crack]]\npolygon = {plane}\n", "two")[-2:], [2, 0])


if __name__ == "__main__":
    unittest.main()
