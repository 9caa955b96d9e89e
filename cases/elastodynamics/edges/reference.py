"""Prints the expected values of the checks of case.toml: SPH gradients of falling edges, written out.

Usage: python3 reference.py

Shares nothing with the program but the equations: the modified mollifier, Elastodynamics (2.19), Lucy's function
(2.13) and the gradient (2.25), a row of the matrix X. The wave is constant beyond the ends.
"""

import math
import sys
from fractions import Fraction
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "reference"))
from mollifier import weights  # noqa: E402

LENGTH, CELLS, MIDDLE = 1.0, 100, 0.505
DX = LENGTH / CELLS
POINTS = [k * DX for k in range(CELLS + 1)]


def edge(x, width):
    return min(max((MIDDLE - x) / width + 0.5, 0.0), 1.0)


def gradients(width, cover):
    """(2.25) at every particle, with V = DX and the neighbour at a distance of m spacings to the left."""
    slopes = weights(cover)[1]
    return [sum(w * edge(x - m * DX, width) for m, w in slopes.items()) / DX for x in POINTS]


def error(found, height, width):
    """The sum of the differences from a slope over this width, over the sum of that slope."""
    exact = [-height / width if abs(x - MIDDLE) < width / 2 else 0.0 for x in POINTS]
    return sum(abs(a - b) for a, b in zip(found, exact)) / sum(map(abs, exact))


def lucy(cover):
    """The gradient at a jump of one between two particles, times the spacing: a sum over one side."""
    total = Fraction(0)
    for m in range(1, math.ceil(cover)):
        q = Fraction(m) / cover
        # 5/4 d/dq (1 + 3 q) (1 - q)^3 = -15 q (1 - q)^2
        total += 15 * q * (1 - q) ** 2 / cover**2
    return total


def main():
    for sweep, width in (("slow", 0.5), ("low", 0.2), ("steep", 0.06), ("jumps", 1e-9)):
        for cover in (1.5, 2.5, 3.5, 4.5, 5.5):
            found = gradients(width, cover)
            print(f"{sweep}, support {cover}: steepest.gradient.x {min(found):.6f}")
            if sweep == "slow":
                print(f"{sweep}, support {cover}: slope.error {error(found, 1, width):.6f}")
    # The mean slope of the two spacings around the jump, at the two particles beside it.
    found = gradients(1e-9, 2.5)
    print(f"jumps, support 2.5: slope.error {error(found, 1, 2 * DX):.7f}")
    steep = lucy(Fraction(3, 2)) / Fraction(1, CELLS)
    print(f"lucy-jumps, support 1.5: slope.error {steep} for 50, off by {abs(steep - 50) / 50}")


main()
