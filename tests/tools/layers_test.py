"""Includes go downwards only: the folders of src/ may include what LAYERS says and nothing else."""

import graphlib
import pathlib
import re
import tempfile
import unittest

SOURCES = pathlib.Path(__file__).resolve().parents[2] / "src"

BOTTOM = {"base", "geometry"}
LAYERS = {
    "base": set(),
    "geometry": {"base"},
    "linalg": {"base"},
    "material": BOTTOM,  # a law knows no body and no model
    "body": BOTTOM,
    "model": BOTTOM | {"material", "body"},
    "peridynamics": BOTTOM | {"linalg", "material", "body", "model"},
    "fem": BOTTOM | {"material", "body", "model"},
    "load": BOTTOM | {"material", "body", "model"},
    "spacetime": {"base", "linalg"},  # temporal bases and slab algebra: vectors, no models
    "solver": BOTTOM | {"linalg", "spacetime", "body", "model", "load"},  # asks the Model interface, never one model
    "output": BOTTOM,
    "input": BOTTOM | {"material"},  # keys of laws
    "verification": BOTTOM | {"material", "input", "output"},
    "report": BOTTOM | {"material", "input", "output", "verification"},  # reads results, never models
}
LAYERS["simulation"] = set(LAYERS)
LAYERS["app"] = set(LAYERS)

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')


def violations(sources):
    """Lines `file:line: what is wrong` for the tree below `sources`."""
    found = []
    for path in sorted(p for p in sources.rglob("*") if p.suffix in {".hpp", ".cpp"}):
        layer = path.relative_to(sources).parts[0]
        if layer not in LAYERS:
            found.append(f"{path}:1: give the folder {layer} a place in LAYERS")
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            include = INCLUDE.match(line)
            if not include:
                continue
            other = include[1].split("/")[0]
            if other not in LAYERS:
                found.append(f'{path}:{number}: write "{include[1]}" as a path from src/')
            elif other not in LAYERS[layer] | {layer}:
                found.append(f"{path}:{number}: {layer} must not include {other}")
    return found


class Layers(unittest.TestCase):
    def test_sources_include_downwards_only(self):
        self.assertTrue(list(SOURCES.rglob("*.hpp")))
        self.assertEqual(violations(SOURCES), [], "\nthe order of layers: CONTRIBUTING.md")

    def test_the_order_has_no_cycle(self):
        list(graphlib.TopologicalSorter(LAYERS).static_order())

    def test_planted_violations_are_found(self):
        planted = {
            "material/law.hpp": '#include "base/error.hpp"\n#  include "solver/verlet.hpp"\n',
            "body/body.cpp": '#include "../app/main.hpp"\n#include "body/body.hpp"\n#include <vector>\n',
            "misc/all.hpp": "\n",
            "app/main.cpp": '#include "simulation/simulation.hpp"\n',
        }
        with tempfile.TemporaryDirectory() as folder:
            top = pathlib.Path(folder)
            for name, text in planted.items():
                (top / name).parent.mkdir(exist_ok=True)
                (top / name).write_text(text, encoding="utf-8")
            found = [line.removeprefix(folder + "/") for line in violations(top)]
        self.assertEqual(found, [
            'body/body.cpp:1: write "../app/main.hpp" as a path from src/',
            "material/law.hpp:2: material must not include solver",
            "misc/all.hpp:1: give the folder misc a place in LAYERS",
        ])


if __name__ == "__main__":
    unittest.main()
