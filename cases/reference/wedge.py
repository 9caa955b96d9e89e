"""An elastic wedge that enters water at a constant speed: the theory of Wagner with the modes of a beam.

Each side is a beam that is clamped at both ends, which move with the speed V. Where it is wet, |x| < c(t), the water is
that below a flat plate (Wagner): the potential phi on it is harmonic below, with phi_y = -V + w_t there and phi = 0 on
the free surface beside it. With x = c cos(s) and the velocity v(x) of the plate

    phi = sum_k b_k sin(k s),   b_k = 2 c / (pi k) int_0^pi v(c cos s) sin(s) sin(k s) ds

and p = -rho phi_t. The wet half length is where the surface meets the wedge,

    c tan(beta) - pi/2 V t + int_0^(pi/2) w(c sin a) da = 0,

and with w = sum_j a_j psi_j, M_j the mass of a mode and K_j its stiffness

    d/dt (M_j a_j' + rho int_0^c phi psi_j dx) + K_j a_j = 0.

Linear theory makes too much of the force of the water: of a rigid wedge of 10 degrees it is 249.3 rho V^3 t by the above, 209.3 by the
modified Logvinovich model, p = rho V^2/2 [pi cot(beta)/r - cos(beta)^2/r^2 - sin(beta)^2] with r^2 = 1 - x^2/c^2 where that is
above 0, and 213.98 by the exact similarity solution (Zhao and Faltinsen, J. Fluid Mech. 246, 1993). `--similarity` takes as much of the density of
the water as makes the force of the rigid wedge the exact one; `--rigid` prints the three.

`python3 wedge.py [MODES]` prints, for the aluminium wedge of 10 degrees and 30 m/s, the time in ms, the deflection of the
middle of a side in mm and c in m; `python3 wedge.py --clean` the deflection over time in m that the case is compared with."""

import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

DEADRISE, HALF, THICKNESS = np.radians(10), 0.6, 0.04
SPEED, WATER = 30.0, 1000.0
YOUNG, POISSON, DENSITY = 67.5e9, 0.34, 2700.0
LENGTH = HALF / np.cos(DEADRISE)
TERMS = 60
# The force of a rigid wedge over rho V^3 t.
EXACT = 213.98
WAGNER = np.pi**3 / 4 / np.tan(DEADRISE) ** 2
if "--similarity" in sys.argv:
    WATER *= EXACT / WAGNER


def logvinovich():
    """The force of a rigid wedge over rho V^3 t by the modified Logvinovich model."""
    cot, cos, sin = 1 / np.tan(DEADRISE), np.cos(DEADRISE), np.sin(DEADRISE)
    a = np.pi * cot  # p = 0 where sin^2 r^2 - a r + cos^2 = 0
    r = (a - np.sqrt(a**2 - 4 * sin**2 * cos**2)) / (2 * sin**2)
    x = np.sqrt(1 - r**2)
    return np.pi / 2 * cot * (a * np.arcsin(x) - cos**2 * np.arctanh(x) - sin**2 * x)


def beam(modes):
    """Shapes, masses and stiffnesses of the modes of a beam of unit width that is clamped at both ends, in plane strain."""
    about = (np.arange(1, modes + 1) + 0.5) * np.pi
    roots = [brentq(lambda z: np.cos(z) * np.cosh(z) - 1, near - 0.3, near + 0.3) for near in about]
    k = np.array(roots)[:, None] / LENGTH
    ratio = (np.cosh(k * LENGTH) - np.cos(k * LENGTH)) / (np.sinh(k * LENGTH) - np.sin(k * LENGTH))

    def shapes(x):
        z = k * x
        return np.cosh(z) - np.cos(z) - ratio * (np.sinh(z) - np.sin(z))

    node, weight = np.polynomial.legendre.leggauss(200)
    squares = shapes((node + 1) * LENGTH / 2) ** 2 @ weight * LENGTH / 2
    bending = YOUNG * THICKNESS**3 / 12 / (1 - POISSON**2)
    return shapes, DENSITY * THICKNESS * squares, bending * k[:, 0] ** 4 * squares


def entry(times, modes=8):
    """Deflection of the middle and wet half length at some times in s from the touch."""
    shapes, mass, stiffness = beam(modes)
    node, weight = np.polynomial.legendre.leggauss(200)
    angle, weight = (node + 1) * np.pi / 4, weight * np.pi / 4
    k = np.arange(1, 2 * TERMS, 2)
    sines = np.sin(np.outer(k, angle))

    def impulses(c):
        """rho int_0^c phi_i psi_j dx of unit velocities: row and column 0 are of the rigid wedge."""
        values = np.vstack([np.ones_like(angle), shapes(c * np.cos(angle))])
        moments = 2 * (values * np.sin(angle) * weight) @ sines.T
        return WATER * (2 * c / np.pi * moments / k) @ (c * moments / 2).T

    def wet(t, a):
        def gap(c):
            return c * np.tan(DEADRISE) - np.pi / 2 * SPEED * t + a @ (shapes(c * np.sin(angle)) @ weight)

        return brentq(gap, 0, HALF) if gap(HALF) > 0 else HALF

    def rate(t, state):
        a, momentum = np.split(state, 2)
        carried = impulses(max(wet(t, a), 1e-6))
        velocity = np.linalg.solve(np.diag(mass) + carried[1:, 1:], momentum + SPEED * carried[0, 1:])
        return np.concatenate([velocity, -stiffness * a])

    found = solve_ivp(rate, (0, times[-1]), np.zeros(2 * modes), t_eval=times, rtol=1e-6, atol=1e-10, max_step=5e-6)
    middle = shapes(np.array([LENGTH / 2]))[:, 0]
    return [(middle @ a, wet(t, a)) for t, a in zip(found.t, found.y[:modes].T)]


if __name__ == "__main__":
    if "--rigid" in sys.argv:
        print(f"force over rho V^3 t: Wagner {WAGNER:.1f}, Logvinovich {logvinovich():.1f}, exact {EXACT}")
    elif "--clean" in sys.argv:
        times = np.arange(0, 2.21e-3, 0.05e-3)
        print("time,deflection")
        for t, (w, _) in zip(times, entry(times)):
            print(f"{t:.5f},{w:.5e}")
    else:
        times = np.array([1.03, 1.51, 1.9, 1.98, 2.2]) * 1e-3
        modes = next((int(text) for text in sys.argv[1:] if text.isdigit()), 8)
        for t, (w, c) in zip(times, entry(times, modes)):
            print(f"{t * 1e3:.2f} ms: {w * 1e3:.2f} mm, wet to {c:.3f} m")
