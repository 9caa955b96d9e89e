"""Period and damping of a small standing wave on viscous water of even depth with a floor along which it slides.

    python3 standing_wave.py DEPTH WAVELENGTH VISCOSITY [GRAVITY]

Prints the roots n of the linear equations, for no stress on the surface, theory (91), and for what a Laplacian without neighbours beyond the
surface makes of it."""

import cmath
import math
import sys


def root(function, n):
    for _ in range(100):
        slope = (function(n + 1e-6) - function(n - 1e-6)) / 2e-6
        step = function(n) / slope
        n -= step
        if abs(step) < 1e-14:
            break
    return n


def main():
    depth, length, nu = map(float, sys.argv[1:4])
    g = float(sys.argv[4]) if len(sys.argv) > 4 else 9.81
    k = 2 * math.pi / length
    square = g * k * math.tanh(k * depth)

    def factor(n):
        m = cmath.sqrt(k * k + n / nu)
        return k**3 * m * math.tanh(k * depth) / cmath.tanh(m * depth)

    stress = root(lambda n: (n + 2 * nu * k * k) ** 2 + square - 4 * nu**2 * factor(n), complex(-2 * nu * k * k, square**0.5))
    gradient = root(lambda n: (n + nu * k * k) ** 2 + square - nu**2 * factor(n), complex(-nu * k * k, square**0.5))
    print(f"without viscosity: period {2 * math.pi / square**0.5:.6f} s; Lamb's damping {2 * nu * k * k:.6f} 1/s")
    for name, n in [("no stress on the surface", stress), ("no gradient across the surface", gradient)]:
        print(f"{name}: frequency {n.imag:.6f} 1/s, period {2 * math.pi / n.imag:.6f} s, damping {-n.real:.7f} 1/s")


main()
