#!/usr/bin/env python3
"""Stress of a viscoelastic Mooney-Rivlin rubber in uniaxial tension, from the convolution integral itself.

S = J U' C^-1 + J^(-2/3) DEV[int gamma(t - s) dD(s)], D = DEV[2 dW/dCbar], gamma = 1 - share + share exp(-t/tau),
by the midpoint rule over the changes of D, the lateral stretch without lateral stress by bisection. It shares no
formula of the update with the program: what it prints stands as reference in the cases viscoelastic-plate-*.

    cases/space-time-fem/viscoelastic-plate.py sine 0.1 0.8 12 1000      amplitude, share, seconds, steps a second
    cases/space-time-fem/viscoelastic-plate.py rate 10 0.5 0.05 40000    rate (1/s), share, seconds, steps a second
"""
import math
import sys

C10, C01, BULK, TAU = 1.0, 0.5, 500.0, 1.0  # MPa, s


def isochoric(axial, lateral):
    """D along the axis and across it."""
    j = axial * lateral * lateral
    b = [(s * j ** (-1 / 3)) ** 2 for s in (axial, lateral)]
    tau = [2 * C10 * x - 2 * C01 / x for x in b]
    mean = (tau[0] + 2 * tau[1]) / 3
    return [(t - mean) / x for t, x in zip(tau, b)]


def nominal(axial, lateral, q):
    """Stresses P along and across, from the relaxed D."""
    j = axial * lateral * lateral
    b = [(s * j ** (-1 / 3)) ** 2 for s in (axial, lateral)]
    mean = (q[0] * b[0] + 2 * q[1] * b[1]) / 3
    pressure = BULK * (j - 1) * j
    return [(x * y - mean + pressure) / s for x, y, s in zip(q, b, (axial, lateral))]


def stresses(path, share, until, steps):
    """Yields time, strain and nominal stress."""
    dt = 1 / steps
    count = round(until * steps)
    before = [0.0, 0.0]
    sums = [0.0, 0.0]  # of exp(s / tau) dD, for exp(-(t - s) / tau)
    lateral = 1.0
    for n in range(count + 1):
        t = n * dt
        axial = 1 + path(t)
        weight = math.exp((t - 0.5 * dt) / TAU) if n > 0 else 1.0

        def relaxed(d):
            return [(1 - share) * x + share * math.exp(-t / TAU) * (s + weight * (x - y))
                    for x, s, y in zip(d, sums, before)]

        low, high = 0.9 * axial ** -0.5, 1.1 * axial ** -0.5
        for _ in range(60):
            lateral = 0.5 * (low + high)
            if nominal(axial, lateral, relaxed(isochoric(axial, lateral)))[1] > 0:
                high = lateral
            else:
                low = lateral
        d = isochoric(axial, lateral)
        yield t, axial - 1, nominal(axial, lateral, relaxed(d))[0]
        sums = [s + weight * (x - y) for s, x, y in zip(sums, d, before)]
        before = d


def main():
    kind, size, share, until, steps = sys.argv[1], *map(float, sys.argv[2:6])
    path = {"sine": lambda t: size * math.sin(2 * math.pi * t), "rate": lambda t: size * t,
            "step": lambda t: size}[kind]
    rows = max(1, round(until * steps / 480))
    for n, row in enumerate(stresses(path, share, until, int(steps))):
        if n % rows == 0:
            print("%.6g %.6g %.8g" % row)


if __name__ == "__main__":
    main()
