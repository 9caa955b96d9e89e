"""Prints the expected values of the checks of case.toml: SPH sums over a lattice, written out.

Usage: python3 reference.py

Shares nothing with the program but the equations: the modified mollifier, Elastodynamics (2.19), the approximation
(2.24) and its gradient (2.25). The function continues beyond the ends, so that all sums are over whole covers; the
gradient of a gradient is the same sum over gradients.
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "reference"))
from mollifier import weights  # noqa: E402


def value(f, x, dx, cover):
    return sum(w * f(x - m * dx) for m, w in weights(cover)[0].items())


def gradient(f, x, dx, cover):
    return sum(w * f(x - m * dx) for m, w in weights(cover)[1].items()) / dx


def polynomial(cells, cover):
    """Error of the gradient of (x - 0.5)^4 from 0 to 1: a sum over all particles, over that of the exact values."""
    points = [k / cells for k in range(cells + 1)]
    exact = [4 * (x - 0.5) ** 3 for x in points]
    found = [gradient(lambda x: (x - 0.5) ** 4, x, 1 / cells, cover) for x in points]
    return sum(abs(a - b) for a, b in zip(found, exact)) / sum(map(abs, exact))


def sine(length, cells, cover):
    """Errors for sin x: on a lattice it changes by a factor, a sum of cos(k x), and a gradient by a sum of sin(k x)."""
    dx = length / cells
    kernel, slopes = weights(cover)
    amplitude = sum(w * math.cos(m * dx) for m, w in kernel.items())
    steepness = sum(-w * math.sin(m * dx) for m, w in slopes.items()) / dx
    return {"value": abs(1 - amplitude), "slope": abs(1 - steepness), "curvature": abs(1 - steepness**2)}


def end(cover=5.5, cells=100):
    """At x = 0 without ghosts: the sum of values, and value and gradient of the sum over that of one."""
    dx = 1 / cells
    kernel, slopes = weights(cover)
    # The neighbour at a distance of m spacings to the left of a particle is missing.
    inside = [m for m in kernel if m <= 0]
    f = {m: (-m * dx - 0.5) ** 4 for m in inside}
    above, below = sum(kernel[m] * f[m] for m in inside), sum(kernel[m] for m in inside)
    rise, growth = sum(slopes[m] * f[m] for m in inside) / dx, sum(slopes[m] for m in inside) / dx
    return above, above / below, (rise * below - above * growth) / below**2


def main():
    for cover in (1.5, 2.5, 3.5, 4.5, 5.5):
        print(f"covers, support {cover}: slope.error {polynomial(100, cover):.6g}")
    for cover in (2.5, 3.5, 4.5, 5.5):
        print(f"coarse-covers, support {cover}: slope.error {polynomial(20, cover):.6g}")
    cut, scaled, steep = end()
    print(f"cut: left.approximation {cut:.6g}")
    print(f"scaled: left.approximation {scaled:.7g}")
    print(f"scaled: left.gradient.x {steep:.7g}")
    for name, cells in (("sine", 100), ("coarse-sine", 20)):
        for quantity, error in sine(3 * math.pi, cells, 5.5).items():
            print(f"{name}: {quantity}.error {error:.6f}")
    for name, cells in (("arch-covers", 100), ("coarse-arch-covers", 20)):
        for cover in (1.5, 2.5, 3.5, 4.5, 5.5):
            for quantity, error in sine(math.pi, cells, cover).items():
                print(f"{name}, support {cover}: {quantity}.error {error:.7f}")


main()
