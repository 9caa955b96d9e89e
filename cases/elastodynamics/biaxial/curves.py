"""Cauchy stress along a sheet that is pulled to six times its length, Elastodynamics (5.5), over time.

Writes curves/*.csv. Stretches are those of the ends: the static curve, which a pull from rest swings about.
"""

import math
import pathlib

YOUNG, POISSON, DENSITY, LENGTH = 200e9, 0.3, 8000.0, 0.030
MU = YOUNG / (2 * (1 + POISSON))
LAMBDA = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
SPEED = math.sqrt((LAMBDA + 2 * MU) / DENSITY)
ROWS = 200


def stress(along, across):
    """Elastodynamics (5.5) with a third stretch of 1."""
    volume = along * across
    return MU / volume * (along**2 - 1) + LAMBDA / volume * math.log(volume)


def write(name, transits, along, across):
    """One curve, with the stretches as functions of the share of the time."""
    end = transits * LENGTH / SPEED
    rows = [f"{k / ROWS * end!r},{stress(along(k / ROWS), across(k / ROWS))!r}" for k in range(ROWS + 1)]
    path = pathlib.Path(__file__).parent / "curves" / f"{name}.csv"
    path.write_text("\n".join(["time,stress", *rows]) + "\n")


def even(share):
    return 1 + 5 * share


def smooth(share):
    """From rest and to rest."""
    return 1 + 5 * (3 * share**2 - 2 * share**3)


write("narrow", 30, even, lambda share: 1)
write("wide", 30, even, lambda share: 2)
write("ramp", 30, even, lambda share: 1 + share)
write("smooth-narrow", 30, smooth, lambda share: 1)
write("smooth-wide", 30, smooth, lambda share: 2)
write("smooth-ramp", 30, smooth, lambda share: 1 + 3 * share**2 - 2 * share**3)
