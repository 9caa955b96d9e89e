"""Cauchy stress along a sheet that is pulled to six times its length, Elastodynamics (5.5), over time.

Usage: python3 curves.py, or python3 curves.py --plot, which needs matplotlib

Writes curves/*.csv. Stretches are those of the ends: the static curve, which a pull from rest swings about.
With --plot it writes figure-5.2.png instead: (5.5) over the stretch of a nearly incompressible sheet.
"""

import math
import pathlib
import sys

FOLDER = pathlib.Path(__file__).parent
YOUNG, POISSON, DENSITY, LENGTH = 200e9, 0.3, 8000.0, 0.030
ROWS = 200


def lame(poisson):
    """Both constants, the shear modulus first."""
    return YOUNG / (2 * (1 + poisson)), YOUNG * poisson / ((1 + poisson) * (1 - 2 * poisson))


MU, LAMBDA = lame(POISSON)
SPEED = math.sqrt((LAMBDA + 2 * MU) / DENSITY)


def stress(along, across, mu=MU, lambda_=LAMBDA):
    """Elastodynamics (5.5) with a third stretch of 1."""
    volume = along * across
    return mu / volume * (along**2 - 1) + lambda_ / volume * math.log(volume)


def write(name, transits, along, across):
    """One curve, with the stretches as functions of the share of the time."""
    end = transits * LENGTH / SPEED
    rows = [f"{k / ROWS * end!r},{stress(along(k / ROWS), across(k / ROWS))!r}" for k in range(ROWS + 1)]
    path = FOLDER / "curves" / f"{name}.csv"
    path.write_text("\n".join(["time,stress", *rows]) + "\n")


def even(share):
    return 1 + 5 * share


def smooth(share):
    """From rest and to rest."""
    return 1 + 5 * (3 * share**2 - 2 * share**3)


def plot(poisson, name):
    """Stress over the stretch along the sheet, one curve for each stretch across."""
    from matplotlib import pyplot

    constants = lame(poisson)
    stretches = [1 + 5 * k / 500 for k in range(501)]
    figure, axes = pyplot.subplots(figsize=(8, 4.8), dpi=150, layout="constrained")
    for across in (1.0, 1.25, 1.5, 2.0, 3.0):
        stresses = [stress(along, across, *constants) / 1e9 for along in stretches]
        axes.plot(stretches, stresses, label=f"stretch across {across:g}")
    axes.set(xlim=(1, 6), xlabel="stretch along the sheet", ylabel="Cauchy stress along it [GPa]",
             title=f"Elastodynamics (5.5), Poisson's ratio {poisson:g}")
    axes.grid(color="0.85")
    axes.legend(loc="lower right")
    figure.savefig(FOLDER / name)


def main():
    if sys.argv[1:] == ["--plot"]:
        plot(0.49, "figure-5.2.png")
        return
    write("narrow", 30, even, lambda share: 1)
    write("wide", 30, even, lambda share: 2)
    write("ramp", 30, even, lambda share: 1 + share)
    write("smooth-narrow", 30, smooth, lambda share: 1)
    write("smooth-wide", 30, smooth, lambda share: 2)
    write("smooth-ramp", 30, smooth, lambda share: 1 + 3 * share**2 - 2 * share**3)


main()
