"""bench/peers/lammps/compare.py with stand-ins for LAMMPS and for Riven's benchmark: rates, ratio, refusals."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

COMPARE = pathlib.Path(__file__).resolve().parents[2] / "bench/peers/lammps/compare.py"

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


if __name__ == "__main__":
    unittest.main()
