"""`riven material`: the curves of a case's materials; and what `riven check` says of them."""

import csv
import math
import re
import unittest

from plot_test import pixels, size
from program import MOVING, PLAIN, ProgramTest, replaced

RUBBER = 'law = "neo-hookean"\nyoungs_modulus = "6 MPa"\ndensity = "1100 kg/m^3"'  # C10 = 1 MPa
SOLID = replaced(PLAIN, RUBBER, 'law = "linear-elastic"\nyoungs_modulus = "72 GPa"\npoissons_ratio = 0.22') + \
    '\n[model]\nkind = "lps"\n'
# It loses strong ellipticity in uniaxial stress at 1.2908 and 0.7539, found by another program.
UNSTABLE = replaced(PLAIN, RUBBER, 'law = "mooney-rivlin"\nc10 = "1000 Pa"\nc01 = "-700 Pa"\nbulk_modulus = "500 Pa"')


def table(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0], [[float(cell) for cell in row] for row in rows[1:]]


class Material(ProgramTest):
    def test_a_rubber(self):
        printed = self.command("material", self.write("sheet.toml", PLAIN)).stdout
        files = [f"results/sheet-material/rubber{part}" for part in (".csv", ".png", "-shear.csv", "-shear.png")]
        self.assertEqual(printed.splitlines(), [
            "rubber: neo-hookean, Young's modulus 6e+06 Pa, Poisson's ratio 0.5, shear modulus 2e+06 Pa, incompressible; "
            f"waves in a sheet {math.sqrt(8e6 / 1100):.5g} m/s along, {math.sqrt(2e6 / 1100):.5g} m/s across", *files])
        self.assertEqual([p for p in self.everything() if "." in p], sorted([*files, "sheet.toml"]))
        columns, rows = table(self.top / files[0])
        self.assertEqual(columns, ["stretch", "uniaxial [Pa]", "planar [Pa]", "equibiaxial [Pa]"])
        self.assertEqual((len(rows), rows[0][0], rows[-1][0]), (101, 0.7, 3))
        for stretch, *stresses in rows:
            for stress, power in zip(stresses, (2, 3, 5)):
                self.assertAlmostEqual(stress, 2e6 * (stretch - stretch**-power), delta=1e-7)
        columns, rows = table(self.top / files[2])
        self.assertEqual(columns, ["amount_of_shear", "simple_shear [Pa]"])
        self.assertEqual((rows[0][0], rows[-1][0]), (0, 3 - 1 / 3))
        for shear, stress in rows:
            self.assertAlmostEqual(stress, 2e6 * shear, delta=1e-7)
        self.assertEqual(size(self.top / files[1]), (1600, 1200))
        colours = {colour for row in pixels(self.top / files[1])[2] for colour in row}
        self.assertLessEqual({(0, 114, 178), (213, 94, 0), (0, 158, 115)}, colours)

    def test_a_solid(self):
        printed = self.command("material", self.write("plate.toml", SOLID), "--points", "3", "-o", "curves").stdout
        self.assertIn("Young's modulus 7.2e+10 Pa, Poisson's ratio 0.22", printed)
        self.assertNotIn("waves", printed, "there is no density")
        columns, rows = table(self.top / "curves/rubber.csv")
        self.assertEqual([row[0] for row in rows], [0.9, 1, 1.1])
        for stretch, uniaxial, planar, equibiaxial in rows:
            for stress, modulus in ((uniaxial, 72e9), (planar, 72e9 / (1 - 0.22**2)), (equibiaxial, 72e9 / (1 - 0.22))):
                self.assertAlmostEqual(stress, modulus * (stretch - 1), delta=1e-3)
        columns, rows = table(self.top / "curves/rubber-volume.csv")
        self.assertEqual(columns, ["volume_ratio", "pressure [Pa]"])
        bulk = 72e9 / (3 * (1 - 2 * 0.22))
        for ratio, pressure in rows:
            side = ratio ** (1 / 3)
            self.assertAlmostEqual(pressure, -3 * bulk * (side - 1) / side**2, delta=1e-3)

    def test_curves_end_where_the_law_does(self):
        case = self.write("gent.toml", replaced(PLAIN, 'law = "neo-hookean"\nyoungs_modulus = "6 MPa"',
                                                'law = "gent"\nshear_modulus = "1 MPa"\nlimit = 5'))
        said = self.command("material", case, "--range", "1, 3").stdout
        end = float(re.search(r"(?m)^  uniaxial ends at a stretch of ([\d.]+): the law has no answer beyond$", said)[1])
        self.assertAlmostEqual(end**2 + 2 / end - 3, 5, delta=1e-3)  # I1 - 3; five digits are printed
        self.assertIn(f"  warning: in uniaxial tension from a stretch of {end:.4g} upwards the law has no answer", said)
        for stretch, stress, *_ in table(self.top / "results/gent-material/rubber.csv")[1]:
            self.assertEqual(math.isnan(stress), stretch > end)

    def test_options(self):
        case = self.write("sheet.toml", PLAIN)
        self.command("material", case, "--range", "0.5,200 %", "--points", "4", "-o", "a/b", "--material", "rubber",
                     "--size", "400x300", "--set", 'material.rubber.youngs_modulus="3 MPa"')
        rows = table(self.top / "a/b/rubber.csv")[1]
        self.assertEqual([row[0] for row in rows], [0.5, 1, 1.5, 2])
        self.assertAlmostEqual(rows[-1][1], 1e6 * (2 - 0.25), delta=1e-7)
        self.assertEqual(size(self.top / "a/b/rubber.png"), (400, 300))
        self.assertIn("a/b/rubber.csv: exists already; expected another folder (-o), or --force to replace it",
                      self.refused("material", case, "-o", "a/b"))
        self.command("material", case, "-o", "a/b", "--force")
        self.assertEqual(len(table(self.top / "a/b/rubber.csv")[1]), 101)

    def test_wrong_input(self):
        case = self.write("sheet.toml", PLAIN)
        springs = self.write("springs.toml", replaced(SOLID, "\npoissons_ratio = 0.22", "").replace("lps", "pmb"))
        self.write("file", "")
        for words, message in {
                ("nothing.toml",): "nothing.toml: no such file",
                (case, "--material", "ruber"): '--material ruber: the case has no such material; it has rubber; did you mean "rubber"?',
                (case, "--range", "1"): "--range 1: expected two stretches, as in 0.5,3",
                (case, "--range", "2,1"): "--range 2,1: expected the lower stretch first, and above 0",
                (case, "--range", "0,1"): "expected the lower stretch first, and above 0",
                (case, "--range", "1,1e999"): "--range",
                (case, "--range", "1,2 mm"): "--range",
                (case, "--points", "1"): "--points: Value 1 not in range 2 to 1000000",
                (case, "--size", "10x10"): "--size 10x10: expected width x height in pixels",
                (case, "-o", "file"): "file: is a file, expected a folder",
                (case, "-o", "file/curves"): "file",
                (case, "--set", 'material.rubber.law="gant"'): 'did you mean "gent"?',
                (springs,): "springs.toml:7:1: material.rubber.poissons_ratio: missing; curves need a number above -1 and below 0.5",
                (case, "--rnge", "1,2"): 'did you mean "--range"?'}.items():
            with self.subTest(" ".join(map(str, words))):
                self.assertIn(message, self.refused("material", *words))


class Stability(ProgramTest):
    def warnings(self, text, *words):
        said = self.command("check", self.write("case.toml", text), *words).stdout
        return [line for line in re.findall(r"(?m)^# warning: (.*)$", said) if line.startswith("material")]

    def test_a_known_unstable_solid(self):
        said = self.command("material", self.write("case.toml", UNSTABLE), "--range", "0.74,1.35").stdout
        lost = re.findall(r"warning: in uniaxial (\w+) from a stretch of ([\d.]+) \w+ strong ellipticity is lost", said)
        self.assertEqual(lost, [("tension", "1.291"), ("compression", "0.7539")])

    def test_check_warns_of_the_stretches_of_the_case(self):
        soft = replaced(PLAIN, 'law = "neo-hookean"\nyoungs_modulus = "6 MPa"', 'law = "yeoh"\nc10 = "1 MPa"\nc20 = "-0.1 MPa"')
        # P = 2 (l - l^-2) (1 - 0.2 (l^2 + 2 / l - 3)) MPa is greatest at 1.832, by its values on a fine grid.
        stress = [(l - l**-2) * (1 - 0.2 * (l * l + 2 / l - 3)) for l in (1 + 1e-4 * n for n in range(10001))]
        border = 1 + 1e-4 * stress.index(max(stress))
        at = r"material rubber: in uniaxial tension from a stretch of ([\d.]+) upwards the nominal stress does not rise"
        self.assertEqual([w for w in self.warnings(soft) if "uniaxial" in w], [], "it goes to 1.4 only")
        found = [re.match(at, w) for w in self.warnings(soft, "--set", "solver.stretch=[2]")]
        self.assertAlmostEqual(float(next(m for m in found if m)[1]), border, delta=1e-3)
        self.assertTrue(all(w.endswith("(looked at: 1 to 2 by solver.stretch)")
                            for w in self.warnings(soft, "--set", "solver.stretch=[2]")))
        self.assertEqual(self.warnings(PLAIN, "--set", "solver.stretch=[3]"), [])

    def test_motions_have_a_range_of_their_own(self):
        soft = replaced(MOVING, 'law = "neo-hookean"\nyoungs_modulus = "6 MPa"', 'law = "yeoh"\nc10 = "1 MPa"\nc20 = "-0.1 MPa"')
        found = self.warnings(soft)
        self.assertTrue(any("uniaxial tension from a stretch of 1.832" in w for w in found), found)
        self.assertTrue(all("(looked at: 0.5 to 2, since a motion names none)" in w for w in found))
        self.assertEqual(self.warnings(MOVING), [])

    def test_check_prints_moduli(self):
        said = self.command("check", self.write("case.toml", SOLID)).stdout
        shear, bulk = 72e9 / (2 * 1.22), 72e9 / (3 * (1 - 0.44))
        self.assertIn(f"# material rubber: Young's modulus 7.2e+10 Pa, Poisson's ratio 0.22, shear modulus {shear:.6g} Pa, "
                      f"bulk modulus {bulk:.6g} Pa\n", said)
        said = self.command("check", self.write("case.toml", SOLID), "--set", 'material.rubber.density="2440 kg/m^3"').stdout
        self.assertIn(f"; waves {math.sqrt((bulk + 4 / 3 * shear) / 2440):.5g} m/s along, {math.sqrt(shear / 2440):.5g} m/s across\n", said)


if __name__ == "__main__":
    unittest.main()
