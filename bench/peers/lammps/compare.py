#!/usr/bin/env python3
"""The same problem, PMB or LPS, with LAMMPS and with Riven: directed bonds per CPU second over whole time steps.

compare.py --riven build/release/bench/riven_bench    rounds of LAMMPS and Riven in turn
compare.py                                            LAMMPS alone
compare.py --check                                    LAMMPS against a plain sum over bonds
"""

import argparse
import collections
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile

INPUT = pathlib.Path(__file__).with_name("block.lmp")
SIDE = 40
ISAS = ["portable", "avx2", "avx512"]
# Names of Riven's benchmarks; Google Benchmark may add a suffix such as /real_time.
RIVEN_FILTER = {"pmb": "^pmb_step/listed:{listed}/threads:{threads}/isa:{isa}(/.*)?$",
                "lps": "^lps_step/listed:{listed}/threads:{threads}/isa:{isa}/dimension:3(/.*)?$"}
RIVEN_SECONDS = 3  # about as long as LAMMPS's 20 steps

# CPU seconds of the time steps alone; bytes: the largest resident memory, and what LAMMPS counts while it steps.
LammpsRun = collections.namedtuple("LammpsRun", "seconds peak held")


def offsets():
    """Bonds of a point on the lattice, in spacings."""
    reach = range(-3, 4)
    return [o for o in itertools.product(reach, repeat=3) if 0 < math.hypot(*o) <= 3.0001]


def directed_bonds(side):
    return sum(math.prod(max(side - abs(k), 0) for k in offset) for offset in offsets())


def output_of(command):
    """What the command said, and its largest resident memory in bytes."""
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read()
    if process.returncode != 0:
        sys.exit(f"compare.py: {' '.join(command)} ended with {process.returncode}:\n{text[-2000:]}")
    return text, usage.ru_maxrss * 1024


def run_lammps(options, side, steps, as_shipped, threads=1, dump="/dev/null"):
    command = [options.lammps, "-log", "none", "-in", str(INPUT)]
    for name, value in (("model", options.model), ("side", side), ("steps", steps), ("as_shipped", int(as_shipped)), ("dump", dump)):
        command += ["-var", name, str(value)]
    if threads > 1:
        command = ["mpirun", "-np", str(threads)] + command
    text, peak = output_of(command)
    listed = int(re.search(r"total # of bonds = (\d+)", text)[1])
    if listed != directed_bonds(side):
        sys.exit(f"compare.py: LAMMPS lists {listed} directed bonds, not {directed_bonds(side)}: not the same problem")
    # The last run's: those before it set up.
    loop = re.findall(r"Loop time of (\S+) on (\d+) procs for (\d+) steps", text)[-1]
    used = re.findall(r"([\d.]+)% CPU use", text)[-1]
    if (int(loop[1]), int(loop[2])) != (threads, steps):
        sys.exit(f"compare.py: LAMMPS made {loop[2]} steps on {loop[1]} processes, not {steps} on {threads}")
    held = re.findall(r"memory allocation \(min/avg/max\) = \S+ \| (\S+)", text)[-1]
    return LammpsRun(float(loop[0]) * threads * float(used) / 100, peak, float(held) * threads * 2**20)


def lammps_rate(options, as_shipped):
    run = run_lammps(options, SIDE, options.steps, as_shipped, options.threads)
    return directed_bonds(SIDE) * options.steps / run.seconds


def run_riven(options, listed):
    """The one result of Riven's benchmark, with its counters."""
    name = RIVEN_FILTER[options.model].format(listed=int(listed), threads=options.threads, isa=ISAS.index(options.isa))
    command = [options.riven, f"--benchmark_filter={name}", f"--benchmark_min_time={RIVEN_SECONDS}"]
    with tempfile.NamedTemporaryFile("r") as out:  # a file: on standard output other lines may stand
        output_of(command + [f"--benchmark_out={out.name}", "--benchmark_out_format=json"])
        text = out.read()
    results = json.loads(text)["benchmarks"] if text else []
    if len(results) != 1 or results[0].get("error_occurred"):
        why = results[0].get("error_message") if len(results) == 1 else f"{len(results)} benchmarks have this name"
        sys.exit(f"compare.py: {options.riven}, {name}: {why}")
    return results[0]


def printed(command):
    """Nothing where the command is missing or fails."""
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False).stdout
    except FileNotFoundError:
        return ""


def instructions(program, model):
    """The widest registers in LAMMPS's force loop."""
    libraries = re.findall(r"liblammps\S* => (\S+)", printed(["ldd", program]))
    symbol = f"_ZN9LAMMPS_NS11PairPeri{model.upper()}7computeEii"
    code = printed(["objdump", f"--disassemble={symbol}", os.path.realpath((libraries or [program])[0])])
    return next((isa for register, isa in (("%zmm", "avx512"), ("%ymm", "avx"), ("%xmm", "sse2")) if register in code),
                "unknown")


def best_isa():
    flags = pathlib.Path("/proc/cpuinfo").read_text().split()
    return "avx512" if "avx512f" in flags else "avx2" if "avx2" in flags else "portable"


def compare(options):
    runs = {"LAMMPS, bonds alone": lambda: lammps_rate(options, as_shipped=False),
            "LAMMPS, as shipped": lambda: lammps_rate(options, as_shipped=True)}
    if options.riven:
        runs["Riven, lattice"] = lambda: run_riven(options, listed=False)["bonds/cpu_s"]
        runs["Riven, listed"] = lambda: run_riven(options, listed=True)["bonds/cpu_s"]
    print(f"{options.model}, {SIDE}^3 points, {directed_bonds(SIDE)} directed bonds, threads: {options.threads}")
    print(f"instructions: LAMMPS {instructions(options.lammps, options.model)}, Riven {options.isa if options.riven else 'not run'}")
    print("million directed bonds per CPU second over whole time steps:")
    print("round  " + "  ".join(runs))
    rates = {name: [] for name in runs}
    for k in range(options.rounds):
        for name, run in runs.items():
            rates[name].append(run() / 1e6)
        print(f"{k + 1:5}  " + "  ".join(f"{rates[name][-1]:{len(name)}.1f}" for name in runs), flush=True)
    for label, pick in (("median", statistics.median), ("best", max)):
        print(f"{label:>6} " + "  ".join(f"{pick(rates[name]):{len(name)}.1f}" for name in runs))
    for riven, lammps in itertools.product([n for n in runs if "Riven" in n], [n for n in runs if "LAMMPS" in n]):
        ratio = statistics.median(a / b for a, b in zip(rates[riven], rates[lammps]))
        print(f"{riven} / {lammps}: {ratio:.2f} (median of the rounds' ratios)")
    compare_memory(options)


def compare_memory(options):
    print("bytes per directed bond:")
    for name, as_shipped in (("bonds alone", False), ("as shipped", True)):
        tiny, run = (run_lammps(options, side, 1, as_shipped) for side in (4, SIDE))
        peak, held = ((big - small) / directed_bonds(SIDE) for small, big in zip(tiny[1:], run[1:]))
        print(f"LAMMPS, {name}: {peak:.1f} at its largest, in set-up; {held:.1f} while it steps, by its own count")
    if options.riven:
        for name, listed in (("lattice", False), ("listed", True)):
            print(f"Riven, {name}: {run_riven(options, listed)['bytes/bond']:.1f} (as the benchmark counts)")


def springs(bonds, extensions):
    """PMB's forces along the bonds (N/m^6)."""
    micromodulus = 12 * 72e9 / (math.pi * (3e-3) ** 4)
    return [micromodulus * e / length for (_, _, length, _), e in zip(bonds, extensions)]


def solid(bonds, extensions):
    """Those of the linear peridynamic solid, whose influence is 1 / length: of each bond's first point."""
    bulk, shear = 72e9 / (3 * (1 - 2 * 0.22)), 72e9 / (2 * (1 + 0.22))
    moment, dilatation = collections.Counter(), collections.Counter()
    for (i, _, length, volume), e in zip(bonds, extensions):
        moment[i] += length * volume
        dilatation[i] += 3 * e * volume
    forces = []
    for (i, _, length, _), e in zip(bonds, extensions):
        theta = dilatation[i] / moment[i]
        forces.append((3 * bulk * theta + 15 * shear * (e - theta * length / 3) / length) / moment[i])
    return forces


def plain_positions(model, side, steps, as_shipped):
    """Velocity Verlet with plain sums over bonds, in the order and with the material of block.lmp."""
    dx, volume, density, dt = 1e-3, 1e-9, 2440.0, 5e-8
    cells = [cell[::-1] for cell in itertools.product(range(side), repeat=3)]  # x runs fastest
    start = [[(k + 0.5 - side / 2) * dx for k in cell] for cell in cells]
    index = {cell: i for i, cell in enumerate(cells)}
    bonds = []
    for i, cell in enumerate(cells):
        for offset in offsets():
            j = index.get(tuple(a + b for a, b in zip(cell, offset)))
            length = math.hypot(*offset)
            part = min(1.0, 3.0001 - length + 0.5) if as_shipped else 1.0
            if j is not None:
                bonds.append((i, j, length * dx, part * volume))
    wave = math.pi / (side * dx)
    x = [list(p) for p in start]
    v = [[0.01 * math.sin(wave * p[k]) for k in (0, 2, 1)] for p in start]

    def kick(duration):
        lengths = [math.dist(x[i], x[j]) for i, j, _, _ in bonds]
        forces = {"pmb": springs, "lps": solid}[model](bonds, [r - bond[2] for bond, r in zip(bonds, lengths)])
        for (i, j, _, part), r, force in zip(bonds, lengths, forces):
            factor = force * part / r / density * duration
            for k in range(3):
                pull = factor * (x[j][k] - x[i][k])
                v[i][k] += pull
                if model == "lps":  # pulls at both ends; of springs, each end has its own bond
                    v[j][k] -= pull

    for _ in range(steps):
        kick(dt / 2)
        for p, velocity in zip(x, v):
            for k in range(3):
                p[k] += velocity[k] * dt
        kick(dt / 2)
    return start, x


def check(options):
    """Rounding a coordinate of 3 mm once is 4e-11 of the displacements of 1e-8 m; 20 steps leave 4e-10."""
    side, steps, tolerance = 6, 20, 1e-8
    worst = 0.0
    for as_shipped in (False, True):
        start, expected = plain_positions(options.model, side, steps, as_shipped)
        with tempfile.NamedTemporaryFile("r") as dump:
            run_lammps(options, side, steps, as_shipped, dump=dump.name)
            rows = dump.read().split("ITEM: ATOMS")[1].splitlines()[1:]
        found = [[float(word) for word in row.split()[1:]] for row in rows]
        largest = max(math.dist(a, b) for a, b in zip(expected, start))
        error = max(math.dist(a, b) for a, b in zip(expected, found, strict=True)) / largest
        print(f"{'as shipped' if as_shipped else 'bonds alone'}: displacements differ by {error:.1e} of the largest, "
              f"{largest:.3e} m, after {steps} steps (tolerance {tolerance:.0e})")
        worst = max(worst, error)
    return 0 if worst < tolerance else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", choices=["pmb", "lps"], default="pmb")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=20, help="time steps of LAMMPS per round")
    parser.add_argument("--threads", type=int, default=1, help="MPI processes for LAMMPS; one is pinned to a core")
    parser.add_argument("--riven", help="path of riven_bench; LAMMPS runs alone without it")
    parser.add_argument("--lammps", default="lmp", help="LAMMPS's program")
    parser.add_argument("--isa", choices=ISAS, default=best_isa(), help="Riven's instruction set")
    parser.add_argument("--check", action="store_true", help="LAMMPS against a plain sum over bonds, on a small block")
    options = parser.parse_args()
    options.lammps = shutil.which(options.lammps) or sys.exit(f"compare.py: {options.lammps} is not here; Debian: lammps")
    if options.threads == 1:  # what is started inherits it
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    return check(options) if options.check else compare(options)


if __name__ == "__main__":
    sys.exit(main())
