#!/usr/bin/env python3
"""Draws the deformed points of results, coloured by strain energy density: the pictures of README.md.

    for c in hole crack inclusion; do ./riven run neo-hookean-membrane/equibiaxial-$c; done
    docs/pictures.py

Needs the Debian package python3-matplotlib.
"""

import base64
import pathlib
import struct
import xml.etree.ElementTree as xml
import zlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

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


def main():
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.4), constrained_layout=True)
    for axis, name in zip(axes, ["hole", "crack", "inclusion"]):
        x, u, energy = state(RESULTS / f"equibiaxial-{name}", 3)
        y = x + u
        shown = axis.scatter(y[:, 0], y[:, 1], c=energy / 1e6, s=2.6, cmap="viridis", vmin=0, vmax=600, linewidths=0)
        axis.plot([-0.25, 0.25, 0.25, -0.25, -0.25], [-0.25, -0.25, 0.25, 0.25, -0.25], color="0.45", lw=0.8, ls="--")
        axis.set(aspect="equal", title=f"equibiaxial-{name}, stretch 3", xlabel="x [m]")
    axes[0].set_ylabel("y [m]")
    figure.colorbar(shown, ax=axes, label="strain energy density [MJ/m³]", shrink=0.85, extend="max")
    figure.savefig(ROOT / "docs/pictures/equibiaxial.png", dpi=90, pil_kwargs={"optimize": True})


if __name__ == "__main__":
    main()
