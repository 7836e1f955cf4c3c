"""The comparisons of bench/peers with stand-ins for the other programs and for Riven: rates, ratios, decks, refusals."""

import importlib.util
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PEERS = pathlib.Path(__file__).resolve().parents[2] / "bench/peers"
COMPARE = PEERS / "lammps/compare.py"

# Prints what LAMMPS does, for bonds given in $TOY_BONDS: a set-up run that must not count, then the steps.
LAMMPS = """
import os, sys
variables = {a: b for option, a, b in zip(sys.argv, sys.argv[1:], sys.argv[2:]) if option == "-var"}
bonds = os.environ["TOY_BONDS"] if variables["side"] == "40" else "2712"
loop = 2.0 if variables["as_shipped"] == "0" else 4.0
print(f"Peridynamic bonds:\\n  total # of bonds = {bonds}")
for seconds, used, steps in (99, 1.0, 0), (loop, 50.0, variables["steps"]):
    print("Per MPI rank memory allocation (min/avg/max) = 10.0 | 10.0 | 10.0 Mbytes")
    print(f"Loop time of {seconds} on 1 procs for {steps} steps with 64000 atoms")
    print(f"{used}% CPU use with 1 MPI tasks x 1 OpenMP threads")
"""

# Has one benchmark for each kind of body, whose rates are those of $TOY_RATES.
RIVEN = """
import json, os, re, sys
options = dict(word.lstrip("-").split("=", 1) for word in sys.argv[1:])
rates = json.loads(os.environ["TOY_RATES"])
results = [{"name": name, "bonds/cpu_s": rate, "bytes/bond": 9.5} for name, rate in rates.items()
           if re.search(options["benchmark_filter"], name)]
if results:
    with open(options["benchmark_out"], "w") as out:
        json.dump({"benchmarks": results}, out)
"""

LATTICE, LISTED = "pmb_step/listed:0/threads:1/isa:1/real_time", "pmb_step/listed:1/threads:1/isa:1/real_time"


class Compare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name, text in (("lmp", LAMMPS), ("riven_bench", RIVEN)):
            (self.folder / name).write_text(f"#!{sys.executable}\n{text}")
            (self.folder / name).chmod(0o755)

    def compare(self, bonds=7153608, rates=None):
        return subprocess.run(
            [sys.executable, "-B", COMPARE, "--rounds", "3", "--steps", "10", "--isa", "avx2", "--lammps",
             self.folder / "lmp", "--riven", self.folder / "riven_bench"],
            env=os.environ | {"TOY_BONDS": str(bonds), "TOY_RATES": json.dumps(rates or {})},
            capture_output=True, text=True, check=False)

    def test_rates_are_of_cpu_time_and_the_ratio_is_of_pairs(self):
        done = self.compare(rates={LATTICE: 715.3608e6, LISTED: 143.07216e6})
        self.assertEqual(done.returncode, 0, done.stderr)
        # 2 s at half of a core for ten steps: 71.5 million bonds per CPU second.
        self.assertIn("    3                 71.5                35.8           715.4          143.1\n", done.stdout)
        self.assertIn("Riven, lattice / LAMMPS, bonds alone: 10.00 ", done.stdout)
        self.assertIn("Riven, listed / LAMMPS, as shipped: 4.00 ", done.stdout)
        self.assertIn("Riven, listed: 9.5 ", done.stdout)

    def test_another_number_of_bonds_stops_it(self):
        done = self.compare(bonds=7000000)
        self.assertEqual(done.returncode, 1)
        self.assertIn("lists 7000000 directed bonds, not 7153608", done.stderr)

    def test_a_benchmark_that_is_missing_stops_it(self):
        done = self.compare(rates={LATTICE: 1e9})
        self.assertEqual(done.returncode, 1)
        self.assertIn("listed:1/threads:1/isa:1", done.stderr)
        self.assertIn("0 benchmarks have this name", done.stderr)

# Reads a deck and moves the head by the sums of its forces (m per N) and of its numbers' lengths beyond 20.
CCX = """
import pathlib, re, sys
deck = pathlib.Path(sys.argv[1] + ".inp").read_text()
forces = re.search(r"\\*CLOAD.*\\n((?:\\d.*\\n)*)", deck)[1].splitlines()
total = sum(float(line.split(",")[2]) for line in forces)
long = sum(max(0, len(word.strip()) - 20) for line in deck.splitlines() if line[0] != "*" for word in line.split(","))
pathlib.Path(sys.argv[1] + ".dat").write_text(
    f"\\n displacements (vx,vy,vz) for set PROBE and time  0.5000000E+00\\n\\n         7  9.0E+00 -1.0E+00  0.0E+00\\n"
    f"\\n displacements (vx,vy,vz) for set PROBE and time  0.1000000E+01\\n\\n         7  {total:.6E} {-long:.6E}  0.0E+00\\n")
print("Job finished")
"""


class CalculiX(unittest.TestCase):
    def setUp(self):
        spec = importlib.util.spec_from_file_location("calculix", PEERS / "calculix/compare.py")
        self.calculix = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.calculix)

    def test_decks_hold_the_whole_load_and_short_numbers(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "ccx")
            program.write_text(f"#!{sys.executable}\n{CCX}")
            program.chmod(0o755)
            done = subprocess.run([sys.executable, "-B", PEERS / "calculix/compare.py", "sheared-bar", "--ccx", program],
                                  capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        # 0.1 MPa on 20 mm x 1 mm are 2 N: 2 m of this toy, which are 2000 mm; a tenth of it on a layer of 0.1 mm.
        self.assertRegex(done.stdout, r"CPS8R    8 x 40 +2000.0000 +0.0000")
        self.assertRegex(done.stdout, r"C3D20R   8 x 40 +200.0000 +0.0000")

    def test_elements_have_their_nodes_in_order(self):
        for solid, edges in ((False, "01 12 23 30"), (True, "01 12 23 30 45 56 67 74 04 15 26 37")):
            mesh = self.calculix.Mesh(3, 2, (3.0, 2.0), 1.0, solid)
            place = {n: at for at, n in mesh.node.items()}
            corners = 8 if solid else 4
            for element in mesh.elements():
                at = [place[n] for n in element]
                self.assertEqual(len(set(element)), corners + len(edges.split()))
                for middle, (a, b) in zip(at[corners:], edges.split(), strict=True):
                    self.assertEqual([2 * m for m in middle], [p + q for p, q in zip(at[int(a)], at[int(b)])])
                (x0, y0, z0), (x1, y1, _), (x2, y2, _) = at[:3]  # counter-clockwise, the lower face first
                self.assertGreater((x1 - x0) * (y2 - y1) - (x2 - x1) * (y1 - y0), 0)
                self.assertEqual(z0, 0)

    def test_forces_are_those_of_a_quadratic_displacement_of_the_edge(self):
        # Work of a unit traction on u = x^2 over [0, 3] and a thickness of 0.5.
        for solid in (False, True):
            mesh = self.calculix.Mesh(3, 2, (3.0, 2.0), 0.5, solid)
            place = {n: at for at, n in mesh.node.items()}
            work = sum(force * (place[n][0] / 2) ** 2 for n, force in mesh.top_forces().items())
            self.assertAlmostEqual(work, 0.5 * 9, delta=1e-12)

    def test_curves_between_steps_are_cubics(self):
        curve = [(t, t**3 - t, 3 * t**2 - 1) for t in (0.0, 0.4, 1.0)]
        for t in (0.1, 0.4, 0.75, 1.0):
            self.assertAlmostEqual(self.calculix.at(curve, t), t**3 - t, delta=1e-14)

    def test_seconds_at_an_error_are_of_a_power_law(self):
        rows = [(0.04, 1.0), (0.01, 2.0), (0.0025, 4.0)]
        self.assertAlmostEqual(self.calculix.seconds_at(rows, 0.02), math.sqrt(2), delta=1e-12)
        self.assertIsNone(self.calculix.seconds_at(rows, 0.001))


if __name__ == "__main__":
    unittest.main()
