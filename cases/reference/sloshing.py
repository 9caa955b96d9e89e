"""Small waves on the water in a round vessel that is half full, without viscosity, by linear theory.

    python3 sloshing.py [n ...]

The potential of a mode is a sum of solid harmonics r^l P_l^1(cos theta) cos phi with l up to n, in units of the radius. It makes
int (grad phi)^2 dV / int phi^2 dS stationary, over the water and its surface, whose value lambda is omega^2 R / g: the condition at the
wall is the natural one. Tilted gravity, a along x, that begins suddenly, moves the water with the mean velocity
sum_n a f_n^2 omega_n / (g V) sin(omega_n t), f_n = int x phi_n dS for modes with int phi_n^2 dS = 1."""

import sys

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.linalg import eigh
from scipy.special import lpmv


def modes(n, points=80):
    """The lowest lambda, and the share a f^2 lambda / (a V) of each in the acceleration at the start."""
    nodes, weights = leggauss(points)
    r, by_r = (nodes + 1) / 2, weights / 2
    theta, by_theta = np.pi / 2 + (nodes + 1) * np.pi / 4, weights * np.pi / 4
    R, T = np.meshgrid(r, theta)
    volume = np.pi * np.outer(by_theta, by_r) * R**2 * np.sin(T)
    c, s = np.cos(T), np.sin(T)
    gradients, values = [], []
    for l in range(1, n + 1):
        p = lpmv(1, l, c)
        below = lpmv(1, l - 1, c) if l > 1 else 0
        slope = (l * c * p - (l + 1) * below) / (s * s) * s
        gradients.append(np.array([l * p, slope, p / s]) * R ** (l - 1))
        values.append(r**l * lpmv(1, l, 0.0))
    energy = np.array([[np.sum(volume * np.sum(a * b, axis=0)) for b in gradients] for a in gradients])
    surface = np.pi * np.array([[np.sum(by_r * r * a * b) for b in values] for a in values])
    # Harmonics with even l vanish on the surface: they follow the others so that the energy is least.
    odd, even = slice(0, n, 2), slice(1, n, 2)
    energy = energy[odd, odd] - energy[odd, even] @ np.linalg.solve(energy[even, even], energy[even, odd])
    lambdas, shapes = eigh(energy, surface[odd, odd])
    f = np.pi * np.array([np.sum(by_r * r * r * value) for value in values[odd]]) @ shapes
    return lambdas, lambdas * f**2 / (2 * np.pi / 3)


for n in [int(text) for text in sys.argv[1:]] or (8, 10, 12):
    lambdas, shares = modes(n)
    print(f"{n}: lambda {np.round(lambdas[:3], 6)}, shares {np.round(shares[:3], 5)} of {np.sum(shares):.5f}")
