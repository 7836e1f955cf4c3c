#!/usr/bin/env python3
"""Runs the cases of neo-hookean-membrane on several grids and prints the tables of docs/verification.md as Markdown.

    docs/convergence.py                  # all cases on 50, 100, 150, 200 points per side, those with a slot on 400 too: an hour on a core
    docs/convergence.py --program build/release/riven --threads 1 --keep planar-hole

Deviations are those from the `reference` expectations of the case files; fields are compared on the same reference points on every
grid, those farther than 15 mm (the horizon of 100 points) from a defect. Where a case has no reference, the forces are printed with
their limit for ever finer grids. With --keep, results that are there already are taken as they are.
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES = ROOT / "cases" / "neo-hookean-membrane"
EXCLUDED = "15 mm"
GRIDS, GRIDS_OF_SLOTS = [50, 100, 150, 200], [50, 100, 150, 200, 400]
ROUNDING = 1e-7  # relative; a deviation below it is none
NOISE = 3e-5  # of the order of the solver's tolerance: a deviation below it says nothing about the grid


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("cases", nargs="*", help="names such as planar-hole; all unless given")
    parser.add_argument("--program", default=str(ROOT / "riven"), help="the riven to run (default: %(default)s)")
    parser.add_argument("--points", help="points per side, such as 50,100 (default: as above)")
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results/convergence"))
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--keep", action="store_true", help="take results that are there already")
    options = parser.parse_args()
    options.points = [int(n) for n in options.points.split(",")] if options.points else None
    options.cases = options.cases or sorted(path.stem for path in CASES.glob("*.toml"))
    return options


def run(case, points, options):
    """Result of a case on a grid: its folder, summary, and what its log says of load steps that were halved."""
    folder = options.results / f"{case}-{points}"
    if not (options.keep and (folder / "summary.json").exists()):
        command = [options.program, "run", str(CASES / f"{case}.toml"), "--force", "-o", str(folder)]
        command += ["--set", f"geometry.box.points=[{points}, {points}]"]
        if options.threads:
            command += ["--threads", str(options.threads)]
        print(f"{case} on {points} x {points}", file=sys.stderr)
        subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    summary = json.loads((folder / "summary.json").read_text())
    halved = (folder / "riven.log").read_text().count("going on with steps of")
    return {"folder": folder, "summary": summary, "halved": halved}


def number(value):
    """Value of an expectation in SI units: a number, or a text in kN."""
    return float(value.removesuffix(" kN")) * 1e3 if isinstance(value, str) else float(value)


def references(case):
    """Reference values of metrics, {metric: {stretch: value}}, and the file of the field or None."""
    metrics, field = {}, None
    for expect in case.get("expect", []):
        if expect["kind"] != "reference":
            continue
        if "field" in expect:
            field = CASES / expect["file"]
        else:
            metrics.setdefault(expect["metric"], {})[expect["at"]] = number(expect["value"])
    return metrics, field


def values(result, metric):
    """{stretch: value} of a metric."""
    return {state["stretch"]: state["metrics"][metric]["value"] for state in result["summary"]["states"]}


def field_deviations(result, field, options):
    """{stretch: relative L2 norm of the deviation}."""
    command = [options.program, "compare", str(result["folder"]), str(field), "--exclude-within", EXCLUDED, "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return {state["value"]: state["relative_l2"] for state in json.loads(done.stdout)["states"]} if done.stdout else {}


def line(x, y):
    """Least squares y = a + b x: (a, b)."""
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    b = sum((p - mean_x) * (q - mean_y) for p, q in zip(x, y)) / sum((p - mean_x) ** 2 for p in x)
    return mean_y - b * mean_x, b


def order(points, errors):
    """Order in the spacing of the root mean square over the states: the slope over all grids."""
    sizes = [math.sqrt(sum(e * e for e in row.values()) / len(row)) for row in errors]
    if max(sizes) < ROUNDING:
        return "exact"
    if max(sizes) < NOISE:
        return "-"
    return f"{-line([math.log(n) for n in points], [math.log(s) for s in sizes])[1]:.1f}"


def limits(points, forces, slot):
    """Limits of a force for ever finer grids: by least squares over all grids with errors of order 2; for a slot, with errors of
    order 1 and of order 2 from 200 and 400 points, on which the slot's edges fall between columns of points."""
    used = [(n, f) for n, f in zip(points, forces) if not slot or n % 200 == 0]
    if len(used) < 2:
        return None
    return [line([n**-p for n, _ in used], [f for _, f in used])[0] for p in ((1, 2) if slot else (2,))]


def row(cells):
    return "| " + " | ".join(cells) + " |"


def percents(deviations, signed=True):
    """The deviations at the states of one grid, as one cell."""
    size = max((abs(d) for d in deviations.values()), default=0)
    if size < ROUNDING:
        return "0"
    digits = 3 if size < 0.01 else 2
    return " / ".join(f"{100 * d:{'+' if signed else ''}.{digits}f}" for d in deviations.values())


def print_table(head, rows):
    print(row(head), row(["---"] * len(head)), *(row(r) for r in rows), "", sep="\n")


def effort(result):
    text = str(result["summary"]["timing"]["iterations"])
    if result["halved"]:
        text += f", {result['halved']} steps halved"
    if result["summary"]["status"] != "finished":
        text += f", {result['summary']['status']}"
    return text


def deviation_table(points, results, metrics, field, options):
    """A grid per row: deviations (%) at all stretches; then the order of each column."""
    columns = {}
    for metric, expected in metrics.items():
        ours = [values(result, metric) for result in results]
        columns[metric] = [{at: v[at] / value - 1 for at, value in expected.items() if at in v} for v in ours]
    if field:
        columns["field"] = [field_deviations(result, field, options) for result in results]
    rows = []
    for n, result in enumerate(results):
        cells = [percents(column[n], name != "field") for name, column in columns.items()]
        rows.append([str(points[n]), *cells, effort(result)])
    orders = [order(points, column) for column in columns.values()]
    rows.append(["order", *orders, ""])
    print_table(["points", *(f"{name} (%)" for name in columns), "force evaluations"], rows)


def series_table(points, results, metrics, slot):
    """A grid per row: forces (kN) at all stretches; then their limits."""
    rows = [[str(n)] + [" / ".join(f"{v / 1e3:.2f}" for v in values(r, m).values()) for m in metrics] + [effort(r)]
            for n, r in zip(points, results)]
    cells = []
    for metric in metrics:
        series = [list(values(result, metric).values()) for result in results]
        found = [limits(points, forces, slot) for forces in zip(*series)]
        cells.append(" / ".join(" to ".join(f"{f / 1e3:.2f}" for f in sorted(limit)) for limit in found) if all(found) else "-")
    rows.append(["limit", *cells, ""])
    print_table(["points", *(f"{name} (kN)" for name in metrics), "force evaluations"], rows)


def print_limit_check(points, results, metrics, slot):
    """How far the limits of the forces are from the references: what such limits are worth."""
    worst = None
    for metric, expected in metrics.items():
        if not metric.startswith("force"):
            continue
        for at, value in expected.items():
            forces = [values(result, metric).get(at) for result in results]
            found = limits(points, forces, slot) if all(forces) else None
            for limit in found or ():
                worst = max(worst or 0, abs(limit / value - 1))
    if worst is not None:
        print(f"Limits of the forces, found as for cases without reference, deviate by at most {100 * worst:.2f} %.\n")


def main():
    options = arguments()
    for name in options.cases:
        case = tomllib.loads((CASES / f"{name}.toml").read_text())
        slot = name.endswith("-crack")
        grids = options.points or (GRIDS_OF_SLOTS if slot else GRIDS)
        results = [run(name, points, options) for points in grids]
        metrics, field = references(case)
        print(f"#### {name}\n\nStretch {' / '.join(f'{s:g}' for s in case['solver']['stretch'])}.\n")
        if metrics:
            deviation_table(grids, results, metrics, field, options)
            if not name.endswith("-plain"):
                print_limit_check(grids, results, metrics, slot)
        else:
            forces = [p["name"] for p in case["probe"] if p["name"].startswith("force")]
            if name.startswith("equibiaxial"):
                forces = forces[:1]  # the other one is the same
            series_table(grids, results, forces, slot)


if __name__ == "__main__":
    main()
