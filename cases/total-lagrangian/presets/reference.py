"""First period of a clamped beam after Timoshenko, in plane strain: python3 reference.py

w' = phi + Q/(k G A), phi' = M/(E' I), Q' = -rho A omega^2 w, M' = -Q - rho I omega^2 phi, with w = phi = 0 at
the clamp and M = Q = 0 at the tip. The fundamental matrix of the length is summed as a series; the root of its
determinant is found by halving.
"""

from math import pi, sqrt

L, H, E, NU, RHO = 1.0, 0.1, 1e6, 0.3, 1000.0
E_STRAIN, NU_STRAIN, G = E / (1 - NU**2), NU / (1 - NU), E / (2 * (1 + NU))
AREA, INERTIA = H, H**3 / 12


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def determinant(omega, k):
    """Zero where a motion of this frequency leaves the tip free."""
    a = [
        [0, 1, 0, 1 / (k * G * AREA)],
        [0, 0, 1 / (E_STRAIN * INERTIA), 0],
        [0, -RHO * INERTIA * omega**2, 0, -1],
        [-RHO * AREA * omega**2, 0, 0, 0],
    ]
    pieces = 64
    term = [[float(i == j) for j in range(4)] for i in range(4)]
    one = [row[:] for row in term]
    for n in range(1, 30):
        term = [[entry * L / pieces / n for entry in row] for row in product(a, term)]
        one = [[x + y for x, y in zip(p, q)] for p, q in zip(one, term)]
    for _ in range(6):
        one = product(one, one)
    return one[2][2] * one[3][3] - one[2][3] * one[3][2]


def period(k):
    low, high = 0.1, 10.0
    sign = determinant(low, k) > 0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (determinant(middle, k) > 0) == sign else (low, middle)
    return 2 * pi / low


cowper = 10 * (1 + NU_STRAIN) / (12 + 11 * NU_STRAIN)
print(f"k = {cowper:.4f} (Cowper): {period(cowper):.5f} s")
print(f"k = 5/6: {period(5 / 6):.5f} s")
print(f"rigid in shear: {period(1e9):.5f} s")
euler = 1.8751040687**2 / L**2 * sqrt(E_STRAIN * INERTIA / (RHO * AREA))
print(f"Euler and Bernoulli: {2 * pi / euler:.5f} s")
