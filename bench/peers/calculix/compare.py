#!/usr/bin/env python3
"""Riven's finite elements beside CalculiX: a sheared bar at rest and a beam in motion.

compare.py sheared-bar --riven build/release/riven       displacement of the head over meshes
compare.py transverse-beam --riven build/release/riven   error over CPU seconds, meshes and steps
Without --riven CalculiX runs alone.
"""

import argparse
import bisect
import collections
import csv
import functools
import math
import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
# Reference: CalculiX's law is C10 (I1 - 3) + C01 (I2 - 3) + (J - 1)^2 / D1, Riven's has k / 2 for 1 / D1.
LAW = "*HYPERELASTIC, MOONEY-RIVLIN\n{c10}, {c01}, {d1}\n*DENSITY\n930."
BAR = {"size": (0.02, 0.1), "thickness": 1e-3, "law": {"c10": 1e6, "c01": 0.5e6, "d1": 2 / 500e6}, "traction": 0.1e6}
# A thin layer is in plane stress; forces and stiffness are those of its thickness.
BEAM = {"size": (10.0, 0.625), "thickness": 0.01, "law": {"c10": 100e6, "c01": 50e6, "d1": 2 / 1e10}, "traction": -0.128e6}
ERRORS = (0.03, 0.01, 0.003, 0.001)
LONG = 60  # s: programs that take longer run fewer times than asked
DENSE = [0.005 * k for k in range(1, 201)]  # s: where curves are compared


def number(x):
    """CalculiX reads the first 20 characters of a number."""
    return f"{x:.12e}"


class Mesh:
    """A rectangle of nx x ny elements of second order in the plane, or as one layer of solid ones.

    `nodes`: number -> place in half elements (i, j, k); k is 0 on the lower face, 1 in the middle, 2 on the upper.
    """

    def __init__(self, nx, ny, size, thickness, solid):
        self.nx, self.ny, self.size, self.thickness, self.solid = nx, ny, size, thickness, solid
        levels = (0, 1, 2) if solid else (0,)
        places = [(i, j, k) for k in levels for j in range(2 * ny + 1) for i in range(2 * nx + 1)
                  if (i % 2) + (j % 2) + (k % 2) <= 1]
        self.node = {place: n for n, place in enumerate(places, 1)}

    def elements(self):
        flat = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        order = [(i, j, 0) for i, j in flat]
        if self.solid:  # corners below and above, middles below and above, middles of the upright edges
            order = ([(i, j, k) for k in (0, 2) for i, j in flat[:4]] + [(i, j, k) for k in (0, 2) for i, j in flat[4:]] +
                     [(i, j, 1) for i, j in flat[:4]])
        for y in range(self.ny):
            for x in range(self.nx):
                yield [self.node[2 * x + i, 2 * y + j, k] for i, j, k in order]

    def on(self, **where):
        """Numbers of the nodes at a place in half elements: on(i=0), on(j=4), on(k=0)."""
        return [n for place, n in self.node.items() if all(place["ijk".index(axis)] == at for axis, at in where.items())]

    def top_forces(self):
        """Consistent shares of the nodes on the top edge or face in a traction of 1 Pa (N)."""
        area = self.size[0] / self.nx * self.thickness
        forces = dict.fromkeys(self.on(j=2 * self.ny), 0.0)
        for x in range(self.nx):
            for i in range(3):
                for k in (0, 1, 2) if self.solid else (0,):
                    n = self.node.get((2 * x + i, 2 * self.ny, k))
                    if n is None:
                        continue
                    middle = i == 1 or k == 1
                    share = (1 / 3 if middle else -1 / 12) if self.solid else (2 / 3 if middle else 1 / 6)
                    forces[n] += share * area
        return forces

    def deck(self, law):
        """Nodes, elements and material."""
        kind = "C3D20R" if self.solid else "CPS8R"
        lines = ["*NODE, NSET=ALL"]
        for (i, j, k), n in self.node.items():
            place = (i * self.size[0] / (2 * self.nx), j * self.size[1] / (2 * self.ny), k * self.thickness / 2)
            lines.append(f"{n}, " + ", ".join(map(number, place)))
        lines.append(f"*ELEMENT, TYPE={kind}, ELSET=BODY")
        for n, element in enumerate(self.elements(), 1):
            words = [str(m) for m in [n] + element]
            lines += [", ".join(words[:11]) + ("," if len(words) > 11 else "")] + [", ".join(words[11:])] * (len(words) > 11)
        lines += ["*MATERIAL, NAME=RUBBER", LAW.format(**law), "*SOLID SECTION, ELSET=BODY, MATERIAL=RUBBER"]
        if not self.solid:
            lines.append(number(self.thickness))
        return "\n".join(lines) + "\n"


def node_set(name, nodes):
    return f"*NSET, NSET={name}\n" + "".join(f"{n},\n" for n in nodes)


def held(mesh, nodes):
    """Clamped in the plane; one face of a layer of solid elements stays in its plane, the other one is free."""
    text = node_set("CLAMPED", nodes)
    if mesh.solid:
        text += node_set("FACE", mesh.on(k=0))
    return text + "*BOUNDARY\nCLAMPED, 1, 2\n" + ("FACE, 3, 3\n" if mesh.solid else "")


def user_seconds(command, folder):
    """Runs a command on one thread; what it said, and its CPU time in user mode (s)."""
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "CCX_NPROC_EQUATION_SOLVER": "1"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if done.returncode != 0:
        sys.exit(f"compare.py: {' '.join(map(str, command))} ended with {done.returncode}:\n{done.stdout[-2000:]}")
    return done.stdout, seconds


def run_ccx(options, deck):
    """Rows (time, value, ...) of the printed node, by quantity, and CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "deck.inp").write_text(deck)
        said, seconds = user_seconds([options.ccx, "deck"], folder)
        if "*ERROR" in said or "Job finished" not in said:
            sys.exit(f"compare.py: CalculiX did not finish:\n{said[-2000:]}")
        printed = pathlib.Path(folder, "deck.dat").read_text()
    rows = {}
    for quantity, time, values in re.findall(r"^ (\w+) .*? for set \w+ and time +(\S+)\n\n +\d+ +(.*)$", printed, re.M):
        rows.setdefault(quantity, []).append([float(time)] + [float(v) for v in values.split()])
    return rows, seconds


def step_of(options, mesh, problem, procedure, load, probe, printed):
    """A run of one step with nodal forces, dead as they are, in the direction given by `load`: (axis, suffix of *CLOAD)."""
    axis, amplitude = load
    forces = "".join(f"{n}, {axis}, {number(f * problem['traction'])}\n" for n, f in mesh.top_forces().items())
    deck = (mesh.deck(problem["law"]) + probe + f"*STEP, NLGEOM, INC=1000000\n{procedure}*CLOAD{amplitude}\n{forces}"
            f"*NODE PRINT, NSET=PROBE\n{printed}\n*END STEP\n")
    return run_ccx(options, deck)


def bar_ccx(options, nx, ny, solid):
    """Displacement of the middle of the head (m), and CPU seconds."""
    mesh = Mesh(nx, ny, BAR["size"], BAR["thickness"] * (0.1 if solid else 1), solid)
    probe = held(mesh, mesh.on(j=0)) + node_set("PROBE", [mesh.node[nx, 2 * ny, 0]])
    # Increments small enough to converge; convergence a hundred times stricter than by default.
    procedure = "*CONTROLS, PARAMETERS=FIELD\n5e-5, 1e-4\n*STATIC\n0.1, 1., 1e-5, 0.1\n"
    rows, seconds = step_of(options, mesh, BAR, procedure, (1, ""), probe, "U")
    return rows["displacements"][-1][1:3], seconds


def beam_ccx(options, nx, ny, step):
    """The deflection of the middle as a curve (rows of t, u, v), and CPU seconds."""
    mesh = Mesh(nx, ny, BEAM["size"], BEAM["thickness"], True)
    probe = held(mesh, mesh.on(i=0) + mesh.on(i=2 * nx)) + node_set("PROBE", [mesh.node[nx, ny, 0]])
    # Between its times an amplitude is linear: it has those of the steps.
    times = [k * step for k in range(round(1 / step) + 1)]
    probe += "*AMPLITUDE, NAME=LOAD\n" + "".join(f"{number(t)}, {number(math.sin(2 * math.pi * t))}\n" for t in times)
    procedure = f"*DYNAMIC, DIRECT\n{number(step)}, 1.\n"
    rows, seconds = step_of(options, mesh, BEAM, procedure, (2, ", AMPLITUDE=LOAD"), probe, "U, V")
    curve = [(0.0, 0.0, 0.0)] + [(u[0], u[2], v[2]) for u, v in zip(rows["displacements"], rows["velocities"], strict=True)]
    return curve, seconds


def at(curve, t):
    """Hermite's cubic through displacements and velocities."""
    k = min(max(bisect.bisect_left([row[0] for row in curve], t), 1), len(curve) - 1)
    (a, u0, v0), (b, u1, v1) = curve[k - 1 : k + 1]
    h, s = b - a, (t - a) / (b - a)
    return (1 + 2 * s) * (1 - s) ** 2 * u0 + s * s * (3 - 2 * s) * u1 + h * s * (1 - s) * ((1 - s) * v0 - s * v1)


def dense(curve):
    return [at(curve, t) for t in DENSE]


def run_riven(options, case, settings):
    """Rows of history.csv without its head, and CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        command = [options.riven, "run", ROOT / f"cases/space-time-fem/{case}.toml", "--threads", "1", "-o", "result"]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        _, seconds = user_seconds(command, folder)
        with open(pathlib.Path(folder, "result/history.csv")) as file:
            return list(csv.DictReader(file)), seconds


def bar_riven(options, element, nx, ny):
    rows, seconds = run_riven(options, "sheared-bar-newton", {"geometry.element": f'"{element}"', "geometry.box.elements": f"[{nx}, {ny}]"})
    return [float(rows[-1][next(name for name in rows[-1] if f"head_{axis}" in name)]) for axis in "xy"], seconds


def beam_riven(options, element, nx, ny, method, step):
    """As dense values and CPU seconds. `method`: "generalised-alpha", or a scheme of slabs."""
    settings = {"geometry.element": f'"{element}"', "geometry.box.elements": f"[{nx}, {ny}]", "solver.step": f'"{step} s"',
                "output.every": '"1 s"', "output.history_every": '"5 ms"'}
    if method == "generalised-alpha":
        settings |= {"solver.method": f'"{method}"', "solver.spectral_radius": "1.0"}
    else:
        settings["solver.scheme"] = f'"{method}"'
    rows, seconds = run_riven(options, "transverse-beam", settings)
    middle = next(name for name in rows[0] if "middle" in name)
    values = [float(row[middle]) for row in rows if float(row["time [s]"]) > 0.0025]
    if len(values) != len(DENSE):
        sys.exit(f"compare.py: {len(values)} rows of history.csv, not {len(DENSE)}")
    return values, seconds


def error(values, reference):
    """Root mean square of the difference over the peak."""
    peak = max(abs(u) for u in reference)
    return math.sqrt(statistics.mean((a - b) ** 2 for a, b in zip(values, reference, strict=True))) / peak


def sheared_bar(options):
    print("program   element  mesh      head x mm   head y mm   CPU s")

    def line(program, element, nx, ny, run):
        (x, y), seconds = run
        print(f"{program:9} {element:8} {f'{nx} x {ny}':9} {1e3 * x:9.4f}   {1e3 * y:9.4f} {seconds:7.2f}", flush=True)

    for nx in (4, 8, 16):
        line("CalculiX", "CPS8R", nx, 5 * nx, bar_ccx(options, nx, 5 * nx, False))
    for nx in (4, 8):  # 0.1 mm thick
        line("CalculiX", "C3D20R", nx, 5 * nx, bar_ccx(options, nx, 5 * nx, True))
    for element in ("q4", "q8") if options.riven else ():
        for nx in (4, 8, 16):
            line("Riven", element, nx, 5 * nx, bar_riven(options, element, nx, 5 * nx))


def seconds_at(rows, wanted):
    """CPU seconds for an error, on straight lines between the rows (error, seconds) in logarithms; None outside."""
    rows = sorted(rows)
    for (e0, s0), (e1, s1) in zip(rows, rows[1:]):
        if e0 <= wanted <= e1:
            part = math.log(wanted / e0) / math.log(e1 / e0)
            return s0 * (s1 / s0) ** part
    return None


# run(step): dense values and CPU seconds; `fine`: another run of this kind, and a step of it.
Series = collections.namedtuple("Series", "name mesh run steps fine")


def beam_series(options):
    def calculix(nx, ny):
        @functools.cache
        def run(step):
            curve, seconds = beam_ccx(options, nx, ny, step)
            return dense(curve), seconds

        return Series("CalculiX C3D20R", (nx, ny), run, [0.02, 0.01, 0.005, 0.0025], (run, 0.0025))

    def riven(element, nx, ny, method, steps):
        @functools.cache
        def run(step, by=method):
            return beam_riven(options, element, nx, ny, by, step)

        fine = functools.partial(run, by="generalised-alpha")
        return Series(f"Riven {element} {method}", (nx, ny), run, steps, (fine, 0.000625))

    series = [calculix(nx, ny) for nx, ny in ((64, 4), (32, 2))]
    for element, nx, ny in (("q4", 64, 4), ("q8", 32, 2), ("q8", 64, 4)) if options.riven else ():
        series.append(riven(element, nx, ny, "two-field", [0.04, 0.02, 0.01, 0.005]))
        series.append(riven(element, nx, ny, "generalised-alpha", [0.02, 0.01, 0.005, 0.0025, 0.00125]))
    return series


def converged(run, step):
    """The curve without steps: the error of both methods goes with the square of the step."""
    fine, coarse = run(step)[0], run(2 * step)[0]
    return [(4 * a - b) / 3 for a, b in zip(fine, coarse, strict=True)]


def timed(options, one, step):
    """Dense values and the median of the CPU seconds of several runs, fewer where one takes long."""
    runs = [one.run(step)]
    while len(runs) < options.rounds and sum(seconds for _, seconds in runs) < LONG:
        runs.append(one.run.__wrapped__(step))
    return runs[0][0], statistics.median(seconds for _, seconds in runs)


def transverse_beam(options):
    limits, found = {}, {}
    print("program, method              mesh       step  error in time     CPU")
    for one in beam_series(options):
        if not one.name.startswith(options.only):
            continue
        place = f"{one.name:27} {one.mesh[0]:3} x {one.mesh[1]}"
        kind = " ".join(one.name.split()[:2]), one.mesh
        if kind not in limits:
            limits[kind] = converged(*one.fine)
        for step in one.steps:
            values, seconds = timed(options, one, step)
            found.setdefault(place, []).append((error(values, limits[kind]), seconds))
            print(f"{place} {1e3 * step:7.2f} ms  {100 * found[place][-1][0]:9.3f} %  {seconds:8.2f} s", flush=True)
    print("CPU seconds at an error in time of".ljust(36) + "".join(f"{100 * wanted:8.1f} %" for wanted in ERRORS))
    for place, rows in found.items():
        seconds = [seconds_at(rows, wanted) for wanted in ERRORS]
        print(f"{place:36}" + "".join(f"{'-' if s is None else f'{s:.2f}':>10}" for s in seconds))
    print("without error in time, beside the first:")
    first = next(iter(limits.values()))
    for (name, (nx, ny)), values in limits.items():
        print(f"{name:16} {nx:3} x {ny}: {min(values):.5f} to {max(values):.5f} m, error of the mesh {100 * error(values, first):.2f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problem", choices=["sheared-bar", "transverse-beam"])
    parser.add_argument("--riven", type=pathlib.Path, help="Riven's program; CalculiX runs alone without it")
    parser.add_argument("--ccx", default="ccx", help="CalculiX's program")
    parser.add_argument("--rounds", type=int, default=3, help="runs of which the median counts")
    parser.add_argument("--only", default="", help="programs, elements and methods of the beam whose name begins so: \"Riven q8\"")
    options = parser.parse_args()
    options.ccx = shutil.which(options.ccx) or sys.exit(f"compare.py: {options.ccx} is not here; Debian: calculix-ccx")
    options.riven = options.riven and options.riven.resolve()
    {"sheared-bar": sheared_bar, "transverse-beam": transverse_beam}[options.problem](options)


if __name__ == "__main__":
    main()
