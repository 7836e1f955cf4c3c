#!/usr/bin/env python3
"""Draws what the bond-based membrane laws give, beside the exact neo-Hookean sheet: pictures of docs/theory/membranes.md.

    for l in planar uniaxial; do
        ./riven run neo-hookean-membrane/$l-plain
        ./riven run neo-hookean-membrane/$l-plain-published
        ./riven run neo-hookean-membrane/$l-plain-published --set 'model.variant="zero-residual"' \\
            -o results/neo-hookean-membrane/$l-plain-zero-residual
    done
    docs/law_pictures.py

stress.png comes from the formulas alone; deviation.png from the results. Needs the Debian package python3-matplotlib.
"""

import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = pathlib.Path("results/neo-hookean-membrane")
C1 = 0.109e9 / 6  # Pa: half the shear modulus of the cases
AREA = 0.5 * 0.01  # m^2

# Powers of the bond stretch and their coefficients in c0 (src/peridynamics/bond_law.cpp).
PUBLISHED = {
    "planar": {2: 31 / 25, -2: 89 / 81},
    "uniaxial": {2: 64 / 49, -1: 3 / 4, -4: 8 / 17},
    "compression": {2: -109 / 14, -1: -239 / 16, -4: 5 / 18},
}
ZERO_RESIDUAL = {
    "planar": {2: 1.229771, -2: 0.922169, -6: 0.102534},
    "uniaxial": {2: 1.309693, -1: 0.775530, -4: 0.460964},
    "compression": {4: 1.791331, 2: -8.337036, -1: -8.852616, -4: -0.164033},
}

# Okabe and Ito's colours and different dashes: to be told apart without colours, too.
LINES = {
    "exact": dict(color="black", lw=2.2, ls="-"),
    "published": dict(color="#D55E00", lw=1.8, ls="--"),
    "zero-residual": dict(color="#0072B2", lw=1.8, ls="-."),
}


def lateral(loading, stretch):
    return 1.0 if loading == "planar" else stretch**-0.5


def exact_stress(loading, stretch):
    """Nominal stress along x (Pa) of the sheet in plane stress."""
    return 2 * C1 * (stretch - stretch ** (-3.0 if loading == "planar" else -2.0))


def bond_stress(law, lx, ly):
    """Nominal stress along x and y (Pa) of a whole family: half the integral of f times xi, over 360 directions."""
    angle = 2 * np.pi * np.arange(360) / 360
    n = np.array([np.cos(angle), np.sin(angle)])
    y = np.array([[lx], [ly]]) * n
    s = np.hypot(*y)
    cosine2 = (np.sum(n * y, axis=0) / s) ** 2
    response = sum(0.5 * power * c * s ** (power - 2) for power, c in law.items())
    return 4 * C1 * np.mean(cosine2 * response * n * y, axis=1)


def stress_picture():
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), constrained_layout=True)
    panels = [("planar", "planar", 1, 1.6), ("uniaxial", "uniaxial, lateral stretch $\\lambda^{-1/2}$", 1, 1.6),
              ("compression", "uniaxial compression, lateral stretch $\\lambda^{-1/2}$", 0.4, 1)]
    for axis, (name, title, low, high) in zip(axes, panels):
        stretch = np.linspace(low, high, 121)
        axis.axhline(0, color="0.6", lw=0.8)
        axis.plot(stretch, [exact_stress(name, l) / 1e6 for l in stretch], label="exact", **LINES["exact"])
        for label, laws in (("published", PUBLISHED), ("zero-residual", ZERO_RESIDUAL)):
            stress = [bond_stress(laws[name], l, lateral(name, l))[0] / 1e6 for l in stretch]
            axis.plot(stretch, stress, label=label, **LINES[label])
        axis.set(title=title, xlabel="stretch $\\lambda$")
        axis.set_xlim(low, high)
    axes[0].set_ylabel("nominal stress along x [MPa]")
    axes[0].annotate("5.1 MPa at rest", (1, 5.13), (1.06, 1.5), arrowprops=dict(arrowstyle="->", color="#D55E00"))
    axes[2].set_ylim(-230, 330)
    axes[2].annotate("pulls where the\nsheet pushes back", (0.72, 95), (0.86, 220), ha="center",
                     arrowprops=dict(arrowstyle="->", color="0.3"))
    axes[0].legend(loc="lower right", frameon=False)
    figure.savefig(ROOT / "docs/pictures/stress.png", dpi=90, pil_kwargs={"optimize": True})


def history(name):
    """Columns of a result's history, without the first small load step."""
    with open(RESULTS / name / "history.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))[1:]
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def deviation_picture():
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), constrained_layout=True)
    panels = [
        ("planar", "force_x [N]", "planar, force along x", lambda l: exact_stress("planar", l)),
        ("planar", "force_y [N]", "planar, force along y", lambda l: 2 * C1 * (1 - l**-2)),
        ("uniaxial", "force_x [N]", "uniaxial, force", lambda l: exact_stress("uniaxial", l)),
    ]
    for axis, (loading, column, title, exact) in zip(axes, panels):
        for label, case, line in (("published", "-published", "published"), ("zero-residual", "-zero-residual", "zero-residual"),
                                  ("default model", "", "exact")):
            rows = history(f"{loading}-plain{case}")
            stretch = rows["stretch"]
            deviation = 100 * (rows[column] / (exact(stretch) * AREA) - 1)
            axis.plot(stretch, deviation, label=label, **LINES[line])
        axis.set(title=title, xlabel="stretch $\\lambda$", xlim=(1, 4))
    axes[0].set_ylabel("deviation of the force [%]")
    axes[0].set_ylim(-2, 20)
    axes[1].set_ylim(-70, 10)
    axes[2].set_ylim(-2, 50)
    axes[0].legend(frameon=False)
    figure.savefig(ROOT / "docs/pictures/deviation.png", dpi=90, pil_kwargs={"optimize": True})


if __name__ == "__main__":
    stress_picture()
    deviation_picture()
