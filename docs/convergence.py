#!/usr/bin/env python3
"""Runs the cases of neo-hookean-membrane on several grids and prints the tables of docs/verification.md as Markdown.

    docs/convergence.py         # all cases on 50, 100, 150, 200 points per side, those with a slot on 400 too: an hour on a core
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
METRICS = ["force_x", "force_y", "lateral_stretch"]
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
    options.cases = options.cases or sorted(path.stem for path in CASES.glob("*.toml") if "published" not in path.stem)
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
    """{stretch: value} of a metric; nothing where the case does not have it."""
    states = result["summary"]["states"]
    return {state["stretch"]: state["metrics"][metric]["value"] for state in states if metric in state["metrics"]}


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
        text += f", {result['halved']} halved"
    if result["summary"]["status"] != "finished":
        text += f", {result['summary']['status']}"
    return text


def deviation_rows(name, grids, results, metrics, field, options):
    """A row per grid: deviations (%) of all metrics and the field at all stretches; then a row of orders."""
    columns = {}
    for metric in METRICS:
        expected, ours = metrics.get(metric, {}), [values(result, metric) for result in results]
        columns[metric] = [{at: v[at] / value - 1 for at, value in expected.items() if at in v} for v in ours]
    columns["field"] = [field_deviations(result, field, options) for result in results]
    orders = [order(grids, column) if column[0] else "" for column in columns.values()]
    if all(text in ("exact", "") for text in orders):
        return [[name, "all", *orders, ", ".join(sorted({effort(result) for result in results}))]]
    rows = []
    for n, result in enumerate(results):
        cells = [percents(column[n], metric != "field") if column[n] else "" for metric, column in columns.items()]
        rows.append([name if n == 0 else "", str(grids[n]), *cells, effort(result)])
    return [*rows, ["", "order", *orders, ""]]


def series_rows(name, grids, results, forces, slot):
    """A row per grid: forces (kN) at all stretches; then a row of their limits."""
    rows, found = [], []
    for n, result in enumerate(results):
        cells = [" / ".join(f"{v / 1e3:.2f}" for v in values(result, f).values()) if f in forces else "" for f in METRICS[:2]]
        rows.append([name if n == 0 else "", str(grids[n]), *cells, effort(result)])
    for force in METRICS[:2]:
        series = zip(*(values(result, force).values() for result in results)) if force in forces else []
        limit = [limits(grids, f, slot) for f in series]
        found.append(" / ".join(" to ".join(f"{x / 1e3:.2f}" for x in sorted(l)) for l in limit) if all(limit) else "")
    return [*rows, ["", "limit", *found, ""]]


def limit_error(grids, results, metrics, slot):
    """How far the limits of the forces are from the references: what such limits are worth."""
    worst = 0.0
    for metric in METRICS[:2]:
        for at, value in metrics.get(metric, {}).items():
            forces = [values(result, metric).get(at) for result in results]
            found = limits(grids, forces, slot) if all(forces) else None
            worst = max([worst, *(abs(limit / value - 1) for limit in found or [])])
    return worst


def main():
    options = arguments()
    deviations, series, errors = [], [], []
    for name in options.cases:
        case = tomllib.loads((CASES / f"{name}.toml").read_text())
        slot = name.endswith("-crack")
        grids = options.points or (GRIDS_OF_SLOTS if slot else GRIDS)
        results = [run(name, points, options) for points in grids]
        metrics, field = references(case)
        probes = [probe["name"] for probe in case["probe"]]
        if name.startswith("equibiaxial"):
            probes.remove("force_y")  # the same as force_x
        if metrics:
            deviations += deviation_rows(name, grids, results, metrics, field, options)
            if not name.endswith("-plain"):
                errors.append(f"{name} {100 * limit_error(grids, results, metrics, slot):.2f} %")
        else:
            series += series_rows(name, grids, results, probes, slot)
    if deviations:
        print("Deviations (%) from the references, at each stretch:\n")
        units = [f"{metric} (%)" for metric in [*METRICS, "field"]]
        print_table(["case", "points", *units, "force evaluations"], deviations)
    if series:
        print("Forces (kN) of cases without reference, at each stretch:\n")
        print_table(["case", "points", *(f"{metric} (kN)" for metric in METRICS[:2]), "force evaluations"], series)
    if errors:
        print("Limits found in the same way where there is a reference deviate from it by at most: " + ", ".join(errors))


if __name__ == "__main__":
    main()
