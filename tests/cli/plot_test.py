"""`riven plot`: pictures of fields and charts of histories."""

import os
import struct
import unittest
import zlib

from program import HOLE, MOVING, PLAIN, ProgramTest, history, replaced


def size(path):
    """Width and height of a PNG file."""
    return struct.unpack(">II", path.read_bytes()[16:24])


def pixels(path):
    """Width, height and rows of (red, green, blue) of a PNG file with 8 bits per channel."""
    data, at, packed = path.read_bytes(), 8, b""
    if not data.startswith(b"\x89PNG\r\n\x1a\n"):
        raise ValueError(f"{path} is no PNG file")
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body, at = data[at + 8:at + 8 + length], at + 12 + length
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            if (depth, colour) != (8, 2):
                raise ValueError(f"{path}: {depth} bits, colour type {colour}")
        if kind == b"IDAT":
            packed += body
    raw, stride, before, rows = zlib.decompress(packed), 3 * width, bytearray(3 * width), []
    for y in range(height):
        how, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = line[i - 3] if i >= 3 else 0, before[i], before[i - 3] if i >= 3 else 0
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda value: abs(guess - value))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[how]) % 256
        rows.append([tuple(line[i:i + 3]) for i in range(0, stride, 3)])
        before = line
    return width, height, rows


class Plot(ProgramTest):
    def setUp(self):
        super().setUp()
        self.command("run", self.write("hole.toml", HOLE), "-o", "hole")

    def test_the_last_state_by_default(self):
        printed = self.command("plot", "hole").stdout
        self.assertEqual(printed, "hole/strain_energy_density-0001.png\n")
        width, height = size(self.top / printed.strip())
        self.assertEqual(max(width / 1600, height / 1200), 1, "one side is used as a whole")
        first = (self.top / printed.strip()).read_bytes()
        self.command("plot", "hole")  # replaces it
        self.assertEqual((self.top / printed.strip()).read_bytes(), first, "the same bits")
        self.assertEqual([p for p in self.everything() if p.endswith((".png", ".tmp"))],
                         ["hole/strain_energy_density-0001.png"])

    def test_states(self):
        names = {}
        for state in ("0", "first", "-2", "1", "last", "-1"):
            file = f"{state.strip('-')}x.png"
            self.command("plot", "hole", "--state", state, "-o", file, "--size", "400x300")
            names[state] = (self.top / file).read_bytes()
        self.assertEqual(names["0"], names["first"])
        self.assertEqual(names["0"], names["-2"])
        self.assertEqual(names["1"], names["last"])
        self.assertEqual(names["1"], names["-1"])
        self.assertNotEqual(names["0"], names["1"])
        printed = self.command("plot", "hole", "--state", "all", "-o", "film.png", "--size", "400x300").stdout
        self.assertEqual(printed.split(), ["film-0000.png", "film-0001.png"])
        # Both show the same axes and colours, so all that differs is the body and the title.
        films = [pixels(self.top / name) for name in printed.split()]
        self.assertEqual(films[0][:2], films[1][:2])
        self.assertNotEqual(films[0][2], films[1][2])
        self.assertEqual({films[0][2][y][x] for x in (0, -1) for y in (0, -1)}, {(255, 255, 255)})
        right = [[row[int(0.85 * film[0]):] for row in film[2]] for film in films]
        self.assertEqual(right[0], right[1], "the colour bar is another one")

    def test_options_change_the_picture(self):
        made = set()
        for words in ([], ["--field", "displacement"], ["--field", "displacement_x"], ["--scale", "3"], ["--map", "inferno"],
                      ["--range", "0, 9 MPa"], ["--range", "0,1e7"], ["--field", "nominal_stress_xx"]):
            self.command("plot", "hole", *words, "-o", "a.png", "--size", "400x300")
            made.add((self.top / "a.png").read_bytes())
        self.assertEqual(len(made), 8)
        self.command("plot", "hole", "--range", "0,9e6", "-o", "a.png", "--size", "400x300")
        self.assertIn((self.top / "a.png").read_bytes(), made, "0, 9 MPa in SI")

    def test_the_colour_in_the_middle_of_a_plain_sheet(self):
        self.command("run", self.write("plain.toml", PLAIN), "-o", "plain")
        # Homogeneous: one colour, of the energy's place in the range. W = C10 (2 s^2 + s^-4 - 3), C10 = 1 MPa.
        energy = 1e6 * (2 * 1.4**2 + 1.4**-4 - 3)
        self.command("plot", "plain", "--map", "grey", "--range", f"0,{4 * energy}", "-o", "a.png", "--size", "400x300")
        width, height, rows = pixels(self.top / "a.png")
        grey = 25 + 0.25 * (240 - 25)  # the map goes from 25 to 240
        for part in (0.4, 0.5, 0.6):
            for channel in rows[height // 2][int(part * width) - 30]:
                self.assertAlmostEqual(channel, grey, delta=0.6)

    def test_vector_files(self):
        self.command("plot", "hole", "-o", "a.svg")
        self.assertIn("<svg", (self.top / "a.svg").read_text())
        self.command("plot", "hole", "-o", "a.pdf")
        self.assertTrue((self.top / "a.pdf").read_bytes().startswith(b"%PDF"))

    def test_damage_once_bonds_break(self):
        text = replaced(replaced(MOVING, '[material.rubber]\nlaw = "neo-hookean"\nyoungs_modulus = "6 MPa"',
                                 '[model]\nkind = "pmb"\n\n[material.rubber]\nlaw = "linear-elastic"\nyoungs_modulus = "6 MPa"\n'
                                 'critical_stretch = 0.01'), "1e4 /s^2", "4e4 /s^2")
        self.command("run", self.write("tears.toml", text), "-o", "tears")
        self.assertEqual(self.command("plot", "tears", "--size", "400x300").stdout, "tears/damage-0002.png\n")
        self.assertEqual(self.command("plot", "tears", "--state", "0", "--size", "400x300").stdout,
                         "tears/strain_energy_density-0000.png\n")

    def test_histories(self):
        self.assertEqual(self.command("plot", "hole", "--history", "force_x").stdout, "hole/history-force_x.png\n")
        self.assertEqual(size(self.top / "hole/history-force_x.png"), (1600, 1200))
        self.assertEqual(history(self.top / "hole")[0], ["stretch", "force_x [N]", "force_y [N]", "hole_x"])
        self.command("plot", "hole", "--history", "force_x,force_y", "-o", "both.png", "--size", "400x300")
        rows = pixels(self.top / "both.png")[2]
        self.assertIn((0, 114, 178), {colour for row in rows for colour in row})
        self.assertIn((213, 94, 0), {colour for row in rows for colour in row})

    def test_wrong_input(self):
        for words, message in {
                ("nothing",): "nothing: expected a result folder, there is none",
                ("hole", "--field", "displacment"): 'did you mean "displacement"?',
                ("hole", "--field", "displacement_w"): "no such field; the result has displacement",
                ("hole", "--state", "2"): "--state 2: the result has 2 states; expected 0 to 1, or -2 to -1",
                ("hole", "--state", "-3"): "--state -3: the result has 2 states",
                ("hole", "--state", "lst"): "--state lst: expected a number, first, last or all",
                ("hole", "--state", "1.5"): "expected a number, first, last or all",
                ("hole", "--map", "virids"): 'did you mean "viridis"?',
                ("hole", "--range", "1"): "--range 1: expected two values",
                ("hole", "--range", "2,1"): "expected the lower value first",
                ("hole", "--range", "0,5 mm"): "is in J/m^3; found a length",
                ("hole", "--range", "0,x"): "--range",
                ("hole", "--size", "10x10"): "--size 10x10: expected width x height in pixels",
                ("hole", "--scale", "nan"): "--scale: expected a finite number",
                ("hole", "-o", "a.jpg"): "a.jpg: a picture ends in .png, .svg or .pdf",
                ("hole", "--history", "force_z"): "force_z",
                ("hole", "--history", "force_x,hole_x"): "force_x is in N, hole_x in no unit; expected columns of one unit",
                ("hole", "--history", "force_x", "--field", "damage"): "--field",
                ("hole", "--histori", "force_x"): 'did you mean "--history"?'}.items():
            with self.subTest(" ".join(words)):
                self.assertIn(message, self.refused("plot", *words))

    def test_results_without_fields(self):
        os.remove(self.top / "hole/fields.pvd")
        self.assertIn("no field files", self.refused("plot", "hole"))
        os.remove(self.top / "hole/history.csv")
        self.assertIn("has no history.csv", self.refused("plot", "hole", "--history", "force_x"))

    def test_what_cannot_be_written(self):
        self.assertIn("no/a.png", self.refused("plot", "hole", "-o", "no/a.png", expect=3))


if __name__ == "__main__":
    unittest.main()
