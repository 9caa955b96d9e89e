"""What steps by Hilber, Hughes and Taylor leave of the energy: python energy.py (needs numpy and scipy).

A Timoshenko beam by finite elements: the modes, the share of the energy at the start in each, and
the largest eigenvalue of a step for each mode to the power of twice the number of steps.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

sys.path.insert(0, str(Path(__file__).parent.parent / "oscillator"))
import reference as oscillator

YOUNG, POISSON, DENSITY = 30e9, 0.3, 7850.0
LENGTH, HEIGHT, WIDTH, CELLS = 8.0, 3.0, 2.0, 200
ALPHA, STEP, END = 0.3, 0.005, 0.25

area, inertia = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12
shear = 5 / 6 * YOUNG / (2 * (1 + POISSON)) * area
h = LENGTH / CELLS
stiffness, mass = np.zeros((2, 2 * CELLS + 2, 2 * CELLS + 2))
for cell in range(CELLS):
    d = np.arange(2 * cell, 2 * cell + 4)
    bent, sheared = np.array([0, -1, 0, 1]) / h, np.array([-1 / h, -0.5, 1 / h, -0.5])
    stiffness[np.ix_(d, d)] += h * (YOUNG * inertia * np.outer(bent, bent) + shear * np.outer(sheared, sheared))
    mass[np.ix_(d, d)] += DENSITY * h / 6 * np.kron([[2, 1], [1, 2]], np.diag([area, inertia]))
squares, modes = eigh(stiffness[2:, 2:], mass[2:, 2:])
start = np.zeros(2 * CELLS)
start[::2] = (np.arange(1, CELLS + 1) / CELLS) ** 2
shares = (modes.T @ mass[2:, 2:] @ start) ** 2 / (start @ mass[2:, 2:] @ start)
left = []
for omega in np.sqrt(squares[:60]):
    oscillator.OMEGA, oscillator.STEP, oscillator.STEPS = omega, STEP, round(END / STEP)
    left.append(oscillator.hilber_hughes_taylor(ALPHA)[2])
print("first period", 2 * np.pi / np.sqrt(squares[0]), "share", shares[0], "of which is left", left[0])
print("all modes", np.dot(shares[:60], left))
