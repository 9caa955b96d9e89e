"""The confined column of a fluid of the gamma law (cases piston-gamma): where its top is, by a chain of elements.

rho u_tt = dP/dY with P = -kappa ((du/dY + 1)^-gamma - 1); linear elements, lumped mass, Crank-Nicolson.
`python3 column.py [elements]` prints the top at the steps of 0.1 s of the cases, and the first extremes with short steps."""

import sys

import numpy as np
from scipy.linalg import solve_banded

HEIGHT, RHO, GAMMA, SPEED = 2.5, 1000.0, 7.0, 10.0
KAPPA = RHO * SPEED**2 / GAMMA


def chain(n, step, end):
    """Times and displacements of the top; n linear elements and Crank-Nicolson's steps."""
    size = HEIGHT / n
    mass = np.full(n, RHO * size)
    mass[-1] /= 2
    y = size * np.arange(1, n + 1)
    u, v = np.zeros(n), -np.sin(np.pi * y / (2 * HEIGHT))

    def forces(u):
        stretch = 1 + np.diff(u, prepend=0.0) / size
        stress, slope = -KAPPA * (stretch**-GAMMA - 1), KAPPA * GAMMA * stretch ** (-GAMMA - 1) / size
        return -stress + np.append(stress[1:], 0), slope

    times, top = [0.0], [0.0]
    force = forces(u)[0]
    while times[-1] < end - 1e-9:
        known, new = u + step * v + step**2 / 4 * force / mass, u + step * v
        for _ in range(50):
            after, slope = forces(new)
            residual = mass * (new - known) - step**2 / 4 * after
            c = step**2 / 4
            bands = np.zeros((3, n))
            bands[1] = mass + c * (slope + np.append(slope[1:], 0))
            bands[0, 1:] = bands[2, :-1] = -c * slope[1:]
            change = solve_banded((1, 1), bands, residual)
            new = new - change
            if np.abs(change).max() < 1e-13:
                break
        after = forces(new)[0]
        v = v + step / 2 * (force + after) / mass
        u, force = new, after
        times.append(times[-1] + step)
        top.append(u[-1])
    return np.array(times), np.array(top)


def extremes(times, top):
    """Extremes by the parabola through three rows."""
    for k in range(1, len(top) - 1):
        a, b, c = top[k - 1:k + 2]
        if (b - a) * (c - b) < 0:
            shift = (a - c) / (2 * (a - 2 * b + c))
            yield times[k] + shift * (times[1] - times[0]), b - (a - c) * shift / 4


if __name__ == "__main__":
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 400
    times, top = chain(n, 0.1, 1.0)
    for t, u in zip(times, top):
        print(f"steps of 0.1 s: t {t:.1f}  top {u:.6f}")
    for t, u in extremes(*chain(n, 0.0005, 1.3)):
        print(f"steps of 0.5 ms: extreme at {t:.4f}  top {u:.6f}")
