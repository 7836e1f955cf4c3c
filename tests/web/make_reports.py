"""Reports of real runs, for the tests of the report page: make_reports.py FOLDER."""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))
from program import PROGRAM, TORN  # noqa: E402

HOLE = ROOT / "cases/neo-hookean-membrane/equibiaxial-hole.toml"
COARSE = ("--set", "geometry.box.points=[40,40]")


def riven(*words):
    subprocess.run([PROGRAM, *map(str, words)], check=True, timeout=120)


def main():
    top = pathlib.Path(sys.argv[1])
    top.mkdir(parents=True, exist_ok=True)
    torn = top / "torn.toml"
    torn.write_text(TORN, encoding="utf-8")
    riven("run", HOLE, *COARSE, "--force", "-o", top / "membrane")
    riven("run", HOLE, *COARSE, "--set", "solver.stretch=[1.5,2.5]", "--force", "-o", top / "brief")
    riven("run", torn, "--force", "-o", top / "fracture")
    for name, folders in {"membrane": ["membrane"], "fracture": ["fracture"], "pair": ["membrane", "brief"]}.items():
        riven("report", *(top / folder for folder in folders), "-o", top / f"{name}.html")


if __name__ == "__main__":
    main()
