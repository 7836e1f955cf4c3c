#!/usr/bin/env python3
"""The symmetric path of the arch by other means: Reissner's beam, extensible and shearable, at any rotation, by shooting.

    python3 arch.py            # displacement of the crown (mm), force on it (N), thrust (N)

Half of the arch, from the left pin to the crown, where it stays level and moves straight down. Linear elastic, so that it knows nothing of how the rubber's modulus
changes with strain (by some 1 % here). Runge and Kutta's method along the beam, Newton's for the rotation and the force at the pin. mm, N.
"""

import math

YOUNG, SHEAR = 9000 / 7, 600.0  # MPa, of C10 = 1000, C01 = -700 and k = 500 MPa at small strain
DEPTH, THICKNESS, SPAN, RISE = 2.0, 1.0, 100.0, 10.0
AXIAL, BENDING = YOUNG * DEPTH * THICKNESS, YOUNG * THICKNESS * DEPTH**3 / 12
SHEARING = 5 / 6 * SHEAR * DEPTH * THICKNESS
HALF = 2 * math.atan(2 * RISE / SPAN)
RADIUS = (SPAN**2 / 4 + RISE**2) / (2 * RISE)
PIECES = 400


def slope(s, state, thrust, lift):
    """Of place, rotation and moment along the undeformed length; thrust and lift: the pin's force on the arch."""
    _, _, rotation, _ = state
    angle = HALF - s / RADIUS + rotation
    cos, sin = math.cos(angle), math.sin(angle)
    stretch = 1 - (thrust * cos + lift * sin) / AXIAL
    shear = (thrust * sin - lift * cos) / SHEARING
    dx, dy = stretch * cos - shear * sin, stretch * sin + shear * cos
    return dx, dy, state[3] / BENDING, lift * dx - thrust * dy


def crown(rotation, thrust, lift):
    """Place and rotation at the crown, for what is assumed at the pin."""
    state, step = [-SPAN / 2, 0.0, rotation, 0.0], RADIUS * HALF / PIECES
    for n in range(PIECES):
        s = n * step
        ahead = lambda k, part: [a + part * step * b for a, b in zip(state, k)]
        k1 = slope(s, state, thrust, lift)
        k2 = slope(s + step / 2, ahead(k1, 0.5), thrust, lift)
        k3 = slope(s + step / 2, ahead(k2, 0.5), thrust, lift)
        k4 = slope(s + step, ahead(k3, 1), thrust, lift)
        state = [a + step / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(state, k1, k2, k3, k4)]
    return state[:3]


def solved(rows):
    """Of three equations, each with its right side behind, by elimination."""
    for i in range(3):
        best = max(range(i, 3), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        for k in range(3):
            if k != i:
                factor = rows[k][i] / rows[i][i]
                rows[k] = [a - factor * b for a, b in zip(rows[k], rows[i])]
    return [rows[i][3] / rows[i][i] for i in range(3)]


def at_pin(down, guess):
    """Rotation, thrust and lift at the pin for which the crown goes down so far, from a guess."""
    for _ in range(30):
        miss = lambda p: [a - b for a, b in zip(crown(*p), (0, RISE - down, 0))]
        here = miss(guess)
        if max(map(abs, here)) < 1e-10:
            return guess
        columns = [[(a - b) / 1e-6 for a, b in zip(miss([g + 1e-6 * (i == j) for i, g in enumerate(guess)]), here)] for j in range(3)]
        guess = [g + d for g, d in zip(guess, solved([[columns[j][i] for j in range(3)] + [-here[i]] for i in range(3)]))]
    raise SystemExit(f"no equilibrium found at {down} mm")


def main():
    path = [at_pin(0, [0, 0.01, 0.01])]
    for n in range(1, 191):
        guess = [2 * a - b for a, b in zip(path[-1], path[-2])] if n > 1 else path[-1]
        path.append(at_pin(0.1 * n, guess))
        if n % 10 == 0:
            print(f"{0.1 * n:4.0f}  {2 * path[-1][2]:8.5f}  {path[-1][1]:8.5f}")
    peak = max(range(len(path)), key=lambda n: path[n][2])
    print(f"largest force {2 * path[peak][2]:.5f} N at {0.1 * peak:.1f} mm")


main()
