#!/usr/bin/env python3
"""Draws the deformed points of results, coloured by strain energy density: pictures of README.md and docs/guide.md.

    for l in equibiaxial planar uniaxial; do
        for c in hole crack inclusion; do ./riven run neo-hookean-membrane/$l-$c; done
    done
    docs/pictures.py [LOADING ...]              # all three, unless named
    docs/pictures.py strap                      # the results strap, slit and disc of docs/guide.md

Needs the Debian package python3-matplotlib.
"""

import base64
import pathlib
import struct
import sys
import xml.etree.ElementTree as xml
import zlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import PIL.Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = pathlib.Path("results/neo-hookean-membrane")


def array(element):
    """Numbers of a compressed VTK data array: base64 of the block header, then base64 of the blocks."""
    text = "".join(element.text.split())
    blocks, _, _ = struct.unpack("<QQQ", base64.b64decode(text[:32]))
    header = 8 * (3 + blocks)
    coded = 4 * ((header + 2) // 3)
    sizes = struct.unpack(f"<{blocks}Q", base64.b64decode(text[:coded])[24:header])
    body = base64.b64decode(text[coded:])
    parts, begin = [], 0
    for size in sizes:
        parts.append(zlib.decompress(body[begin : begin + size]))
        begin += size
    numbers = np.frombuffer(b"".join(parts), dtype="<f8")
    return numbers.reshape(-1, int(element.get("NumberOfComponents", 1)))


def state(folder, stretch):
    """Undeformed positions (m), displacements (m) and strain energy density (J/m^3) of an output state."""
    series = xml.parse(folder / "fields.pvd").getroot().iter("DataSet")
    file = next(s.get("file") for s in series if abs(float(s.get("timestep")) - stretch) < 1e-9)
    root = xml.parse(folder / file).getroot()
    named = {e.get("Name"): e for e in root.iter("DataArray")}
    points = array(root.find(".//Points/DataArray"))
    return points, array(named["displacement"]), array(named["strain_energy_density"])[:, 0]


# Loading: stretch that is shown, size of the figure (inches), top of the colour scale (MJ/m^3), size of a point.
SHOWN = {
    "equibiaxial": (3, (12, 4.4), 600, 2.6),
    "planar": (2, (12, 2.8), 120, 4.5),
    "uniaxial": (2, (12, 2.6), 120, 4.5),
}


def draw(loading):
    stretch, size, top, point = SHOWN[loading]
    half = 0.25
    cases = [(f"{loading}-{name}, stretch {stretch}", RESULTS / f"{loading}-{name}") for name in ["hole", "crack", "inclusion"]]
    outline = [[-half, half, half, -half, -half], [-half, -half, half, half, -half]]
    paint(loading, cases, outline, stretch, size, top, point)


def draw_strap():
    cases = [(f"{name}, stretch 2", RESULTS.parent / name) for name in ["strap", "slit", "disc"]]
    outline = [[-0.08, 0.08, 0.08, -0.08, -0.08], [-0.04, -0.04, 0.04, 0.04, -0.04]]
    paint("strap", cases, outline, 2, (12, 2.3), 3, 7)


def paint(file_name, cases, outline, stretch, size, top, point):
    figure, axes = plt.subplots(1, 3, figsize=size, constrained_layout=True, sharey=True)
    for axis, (title, folder) in zip(axes, cases):
        x, u, energy = state(folder, stretch)
        y = x + u
        shown = axis.scatter(y[:, 0], y[:, 1], c=energy / 1e6, s=point, cmap="viridis", vmin=0, vmax=top, linewidths=0)
        axis.plot(*outline, color="black", lw=0.9, ls="--", zorder=3)
        axis.set(aspect="equal", title=title, xlabel="x [m]")
    axes[0].set_ylabel("y [m]")
    figure.colorbar(shown, ax=axes, label="strain energy\ndensity [MJ/m³]", shrink=0.9, extend="max")
    file = ROOT / f"docs/pictures/{file_name}.png"
    figure.savefig(file, dpi=90)
    picture = PIL.Image.open(file).convert("RGB")
    picture.quantize(256, method=PIL.Image.Quantize.MAXCOVERAGE).save(file, optimize=True)  # a fifth of the size


if __name__ == "__main__":
    for name in sys.argv[1:] or SHOWN:
        draw_strap() if name == "strap" else draw(name)
