"""`riven compare`: a result against reference points and histories."""

import json
import unittest

from program import HOLE, PLAIN, ROOT, ProgramTest, plain_force

REFERENCE = ROOT / "cases/neo-hookean-membrane/reference/equibiaxial-hole.csv"


class Compare(ProgramTest):
    def setUp(self):
        super().setUp()
        self.command("run", self.write("sheet.toml", PLAIN), "-o", "sheet")

    def test_a_shipped_reference(self):
        # On 25 x 25 points the field is 0.8 % off beyond a horizon of the hole.
        self.command("run", "neo-hookean-membrane/equibiaxial-hole", "--set", "geometry.box.points=[25,25]", "--set",
                     "solver.stretch=[1.5, 2]", "-o", "hole")
        words = ["compare", "hole", REFERENCE, "--exclude-within", "1 horizon", "--json"]
        found = json.loads(self.command(*words).stdout)
        self.assertEqual([state["value"] for state in found["states"]], [1.5, 2])
        self.assertEqual(found["missing"], [2.5, 3])
        self.assertEqual(found["uncompared"], [])
        worst = max(state["relative_l2"] for state in found["states"])
        self.assertGreater(worst, 1e-5)
        self.assertLess(worst, 0.03)
        for state in found["states"]:
            self.assertGreater(state["used"], 20)
            self.assertGreater(state["excluded"], 0)
            self.assertEqual(state["outside"], 0)
        self.command(*words, "--tolerance", f"{1.01 * worst}")
        self.command(*words, "--tolerance", f"{100 * 1.01 * worst} %")
        self.command(*words, "--tolerance", f"{0.99 * worst}", expect=1)
        everywhere = json.loads(self.command("compare", "hole", REFERENCE, "--json").stdout)
        self.assertGreater(everywhere["states"][0]["used"], found["states"][0]["used"])

    def test_points(self):
        self.write("points.csv", "stretch,X_m,Y_m,ux_m,uy_m\n1.4,0.05,0.02,0.02,0.008\n1.4,-0.03,0,-0.012,0\n")
        table = self.command("compare", "sheet", "points.csv", "--tolerance", "1e-9").stdout
        self.assertEqual(table.splitlines()[1].split()[0], "1.4")
        self.assertEqual(table.splitlines()[2:], ["not compared, for the reference lacks them: 1.2"])
        self.write("points.csv", "stretch,X_m,Y_m,ux_m,uy_m\n1.4,0.05,0,0.021,0\n")
        state, = json.loads(self.command("compare", "sheet", "points.csv", "--json", "--tolerance", "4 %",
                                         expect=1).stdout)["states"]
        self.assertAlmostEqual(state["relative_l2"], 1 / 21, delta=1e-9)
        self.assertAlmostEqual(state["maximum"], 0.001, delta=1e-9)
        self.command("compare", "sheet", "points.csv", "--tolerance", "5 %")

    def test_histories(self):
        rows = "".join(f"{stretch},{1.01 * plain_force(stretch)}\n" for stretch in (1.2, 1.4))
        self.write("curve.csv", "stretch,F_N\n" + rows)
        words = ["compare", "sheet", "curve.csv", "--history", "force_x=F_N"]
        found = json.loads(self.command(*words, "--json").stdout)
        self.assertAlmostEqual(found["relative_l2"], 0.01 / 1.01, delta=1e-6)
        self.assertEqual((found["used"], found["outside"]), (2, 0))
        self.command(*words, "--tolerance", "1 %")
        self.command(*words, "--tolerance", "0.9 %", expect=1)

    def test_units_of_a_reference(self):
        force = {stretch: plain_force(stretch) for stretch in (1.2, 1.4)}
        for header, factor in {"F [kN]": 1e-3, "F[N]": 1, "F": 1}.items():
            self.write("curve.csv", f"stretch [-],{header}\n" + "".join(f"{s},{factor * f}\n" for s, f in force.items()))
            words = ["compare", "sheet", "curve.csv", "--history", "force_x=F", "--json"]
            self.assertLess(json.loads(self.command(*words).stdout)["relative_l2"], 1e-6)
        self.write("curve.csv", "stretch,F [kPa]\n1.2,1\n")
        said = self.refused("compare", "sheet", "curve.csv", "--history", "force_x=F")
        self.assertIn('curve.csv:1: column "F [kPa]" is a pressure; expected ', said)
        self.assertIn('as "force_x [N]" of the history is', said)
        self.write("curve.csv", "stretch [s],F [N]\n1.2,1\n")
        self.assertIn('"stretch [s]" is a time', self.refused("compare", "sheet", "curve.csv", "--history", "force_x=F"))

    def test_wrong_words(self):
        self.write("points.csv", "stretch,X_m,Y_m,ux_m,uy_m\n1.4,0.05,0,0.02,0\n")
        self.write("curve.csv", "stretch,F_N\n1.4,1\n")
        (self.top / "none").mkdir()
        for words, message in [
                (["none", "points.csv"], "is not a result of Riven"),
                (["nowhere", "points.csv"], "expected a result folder"),
                (["sheet", "nothing.csv"], "there is no such file"),
                (["sheet", "curve.csv"], 'expected a column "X_m"; there are: stretch, F_N'),
                (["sheet", "points.csv", "--tolerance", "1 mm"], "--tolerance"),
                (["sheet", "points.csv", "--exclude-within", "3"], "--exclude-within"),
                (["sheet", "curve.csv", "--history", "force_x"], "expected metric=column"),
                (["sheet", "curve.csv", "--history", "force_z=F_N"], 'expected a column "force_z"'),
                (["sheet", "curve.csv", "--history", "force_x=F_kN"], 'expected a column "F_kN"')]:
            with self.subTest(" ".join(words)):
                said = self.refused("compare", *words)
                self.assertIn(message, said)

    def test_lengths_know_the_lattice(self):
        self.command("run", self.write("hole.toml", HOLE), "-o", "hole")
        # 10 mm from the hole's edge is one spacing.
        self.write("points.csv", "stretch,X_m,Y_m,ux_m,uy_m\n1.4,0.039,0,0.02,0\n1.4,0.08,0,0.03,0\n")
        for length, excluded in {"8 mm": 0, "1 dx": 1, "1 horizon": 1}.items():
            words = ["compare", "hole", "points.csv", "--json", "--exclude-within", length]
            self.assertEqual(json.loads(self.command(*words).stdout)["states"][0]["excluded"], excluded, length)
        said = self.refused("compare", "hole", "points.csv", "--exclude-within", "5 dx + 1 mm")
        self.assertIn("none of the 2 reference points can be compared", said)


if __name__ == "__main__":
    unittest.main()
