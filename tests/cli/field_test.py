"""Fields: values at places from CSV files, that formulas read."""

import math
import shutil
import unittest

from program import BLOCK, BLOCK_BOX, BOX, MOVING, PLAIN, ProgramTest, history, replaced, series

# Powers of two, so that places in a file are the points' own to the last bit.
SIDE, DX = 16, 1 / 64
EDGE = SIDE * DX / 2
DYADIC = 'box = { size = ["0.25 m", "0.25 m"], thickness = "10 mm", points = [16, 16] }'
ALONG = [(i + 0.5) * DX - EDGE for i in range(SIDE)]
PLACES = [(x, y) for y in ALONG for x in ALONG]
# On the four edges, and beyond their ends as far as the mirror layers of two loaded edges reach.
BEYOND = [(i + 0.5) * DX - EDGE for i in range(-3, SIDE + 3)]
ON_EDGES = [(side * EDGE, y) for side in (-1, 1) for y in BEYOND] + [(x, side * EDGE) for side in (-1, 1) for x in BEYOND]


def rows(places, **values):
    """CSV text in SI units; each value is a unit and a function of the place."""
    head = [f"{axis} [m]" for axis in "xyz"[:len(places[0])]] + [f"{name} [{unit}]" for name, (unit, _) in values.items()]
    lines = [[*place, *(value(*place) for _, value in values.values())] for place in places]
    return "".join(",".join(map(str, line)) + "\n" for line in [head, *lines])


def read_fields(text, file, *names):
    return replaced(text, "[material", "".join(f'[field.{name}]\nfile = "{file}"\nvalue = "{name}"\n\n' for name in names) + "[material")


class Fields(ProgramTest):
    def setUp(self):
        super().setUp()
        # A sheet that starts with a velocity that is no polynomial.
        self.velocity = rows(PLACES, vx=("m/s", lambda x, y: math.sin(20 * x)), vy=("m/s", lambda x, y: -10 * y + 3 * x))
        self.write("data/start.csv", self.velocity)
        free = replaced(MOVING[:MOVING.index("[[load]]")] + MOVING[MOVING.index("[solver]"):], BOX, DYADIC)
        free = replaced(free, 'kind = "reaction"\non = "right"', 'kind = "displacement"\nat = ["95 mm", "45 mm"]')
        self.formula = free + '\n[[initial]]\nvelocity = ["sin(20 /m * x) * 1 m/s", "-10 /s * y + 3 /s * x"]\n'
        self.field = read_fields(free, "data/start.csv", "vx", "vy") + '\n[[initial]]\nvelocity = ["vx", "vy"]\n'

    def same_bits(self, wanted, found):
        """Of two cases' histories and fields."""
        for name, text in {"wanted": wanted, "found": found}.items():
            self.command("run", self.write(f"{name}.toml", text), "-o", name, "--force")
        files = [str(file.relative_to(self.top / "wanted")) for _, file in series(self.top / "wanted")]
        self.assertGreater(len(files), 1)
        for name in ["history.csv", *files]:
            self.assertEqual((self.top / "wanted" / name).read_bytes(), (self.top / "found" / name).read_bytes(), name)
        self.assertNotEqual(len(set(history(self.top / "found")[1][-1])), 1)  # something moved

    def test_the_start_of_a_motion(self):
        self.same_bits(self.formula, self.field)

    def test_a_set_that_is_displaced(self):
        self.write("pull.csv", rows(PLACES, part=("m", lambda x, y: math.sin(20 * x) * y)))
        load = replaced(replaced(MOVING, BOX, DYADIC), 'on = ["left", "right"]', 'on = "ends"')
        load += '\n[set.ends]\nwhere = "abs(x) > 90 mm"\n'
        load = replaced(load, 'kind = "reaction"\non = "right"', 'kind = "displacement"\nat = ["50 mm", "45 mm"]')
        old = "1e4 /s^2 * x * t*t"
        self.same_bits(replaced(load, old, "1e4 /s^2 * (sin(20 /m * x) * y) * t*t"),
                       read_fields(replaced(load, old, "1e4 /s^2 * part * t*t"), "pull.csv", "part"))

    def test_a_set_bounded_by_a_field(self):
        self.write("where.csv", rows(PLACES, part=("m", lambda x, y: math.sin(20 * x) * y)))
        pushed = '\n[set.part]\nwhere = "{}"\n'
        wanted = replaced(self.formula, "[[initial]]", '[[initial]]\non = "part"') + pushed.format("sin(20 /m * x) * y > 10 mm")
        found = replaced(self.formula, "[[initial]]", '[[initial]]\non = "part"') + pushed.format("part > 10 mm")
        self.same_bits(wanted, read_fields(found, "where.csv", "part"))

    def test_three_dimensions(self):
        # Spacing 1/128 m; the places of the box that begins at the origin.
        box = 'box = { size = ["62.5 mm", "31.25 mm", "46.875 mm"], from = [0, 0, 0], spacing = "7.8125 mm" }'
        along = lambda count: [(n + 0.5) / 128 for n in range(count)]
        places = [(x, y, z) for x in along(8) for y in along(4) for z in along(6)]
        self.write("start.csv", rows(places, vz=("m/s", lambda x, y, z: x * math.sin(50 * y) - z)))
        text = replaced(replaced(BLOCK, BLOCK_BOX, box), 'law = "linear-elastic"', 'law = "linear-elastic"\ndensity = "2440 kg/m^3"')
        text = text[:text.index("[[load]]")] + """
[solver]
method = "verlet"
until = "20 us"

[output]
every = "10 us"
history_every = "5 us"

[[probe]]
name = "inside"
kind = "displacement"
at = ["20 mm", "10 mm", "30 mm"]

[[initial]]
velocity = [0, 0, "{}"]
"""
        self.same_bits(text.replace("{}", "1 /s * (x * sin(50 /m * y) - z)"),
                       read_fields(text.replace("{}", "vz"), "start.csv", "vz"))

    def test_edges_take_the_rows_beside_them(self):
        load = replaced(MOVING, BOX, DYADIC)
        old, new = "1e4 /s^2 * x * t*t", "1e4 /s^2 * part * t*t"
        self.write("inside.csv", rows(PLACES, part=("m", lambda x, y: x)))
        field = read_fields(replaced(load, old, new), "inside.csv", "part")
        self.same_bits(replaced(load, old, "1e4 /s^2 * (x * 15/16) * t*t"), field)  # half a spacing from the edge
        self.write("edges.csv", rows(PLACES + ON_EDGES, part=("m", lambda x, y: x)))
        self.same_bits(load, replaced(field, "inside.csv", "edges.csv"))

    def test_beyond_the_ends_of_edges(self):
        load = replaced(PLAIN, BOX, DYADIC)
        values = {"px": ("m", lambda x, y: x), "py": ("m", lambda x, y: y)}
        self.write("inside.csv", rows(PLACES, **values))
        field = replaced(load, '"(stretch - 1)*x", "(stretch - 1)*y"', '"(stretch - 1)*px", "(stretch - 1)*py"')
        said = self.refused("run", self.write("sheet.toml", read_fields(field, "inside.csv", "px", "py")))
        self.assertRegex(said, r'^error: \S.*sheet.toml:\d+:\d+: .*"\(stretch - 1\)\*p[xy]": the field p[xy] has no value at '
                               r'\(-0.125, -0.1[346]\d+, 0\) m')
        self.write("edges.csv", rows(PLACES + ON_EDGES, **values))
        self.same_bits(load, read_fields(field, "edges.csv", "px", "py"))

    def test_a_missing_row_is_told_before_the_run(self):
        self.write("data/start.csv", "\n".join(self.velocity.splitlines()[:-1]) + "\n")
        said = self.refused("run", self.write("field.toml", self.field), "-o", "out")
        line = 1 + self.field[:self.field.index("velocity =")].count("\n")
        self.assertIn(f"field.toml:{line}", said)
        self.assertIn('"vx": the field vx has no value at (0.117188, 0.117188, 0) m; expected a row of', said)
        self.assertFalse((self.top / "out").exists())

    def test_a_result_runs_again_wherever_it_is(self):
        self.command("run", self.write("field.toml", self.field), "-o", "first")
        self.assertEqual((self.top / "first/tables/vy.csv").read_text(), self.velocity)
        (self.top / "first").rename(self.top / "moved")
        shutil.rmtree(self.top / "data")
        self.command("run", "moved/resolved.toml", "-o", "second")
        for name in ["history.csv", "resolved.toml", "tables/vx.csv"] + [str(file.relative_to(self.top / "moved"))
                                                                        for _, file in series(self.top / "moved")]:
            self.assertEqual((self.top / "moved" / name).read_bytes(), (self.top / "second" / name).read_bytes(), name)

    def test_check_prints_it(self):
        said = self.command("check", self.write("field.toml", self.field)).stdout
        self.assertRegex(said, r"(?m)^# field vy: \S.*start.csv, 256 places, vy -1.52344 to 1.52344 m/s$")
        self.assertIn('[field.vx]\nfile = "data/start.csv"\nvalue = "vx"\n', said)


if __name__ == "__main__":
    unittest.main()
