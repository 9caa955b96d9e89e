"""The column of U9 by another program: Crank-Nicolson of 10 rows and of many, and how far 10 rows are off the exact column.

Gradient correction and whole cells as weights make central differences in the reference state, one-sided at the two ends.
Steps of Crank-Nicolson (the trapezoidal rule) by Newton's method; kick-drift-kick in tiny steps for exact ones.
Prints places, and the root mean square against top.csv to 2.15 s. Needs numpy.
"""

import pathlib

import numpy as np

height, density, gamma, wave = 2.5, 1000.0, 7.0, 10.0
kappa = density * wave**2 / gamma
reference = np.loadtxt(pathlib.Path(__file__).parent / "top.csv", delimiter=",", skiprows=1)


def column(cells):
    spacing = height / cells
    volume = np.full(cells + 1, spacing)
    volume[[0, -1]] /= 2
    g = np.zeros((cells + 1, cells + 1))
    for a in range(1, cells):
        g[a, a + 1], g[a, a - 1] = 0.5 / spacing, -0.5 / spacing
    g[0, :2] = [-1 / spacing, 1 / spacing]
    g[-1, -2:] = [-1 / spacing, 1 / spacing]
    g = g[:, 1:]
    mass = density * volume[1:]
    start = -np.sin(np.pi * np.linspace(0, height, cells + 1)[1:] / (2 * height))

    def acceleration(u):
        ratio = 1 + g @ u
        return g.T @ (volume * kappa * (ratio**-gamma - 1)) / mass

    def stiffness(u):
        ratio = 1 + g @ u
        return -(g.T * (volume * kappa * gamma * ratio ** (-gamma - 1))) @ g / mass[:, None]

    return start, acceleration, stiffness


def implicit(cells, step, end):
    v, acceleration, stiffness = column(cells)
    u, rows = np.zeros_like(v), [(0.0, 0.0)]
    for k in range(1, round(end / step) + 1):
        a, new = acceleration(u), u + step * v
        for _ in range(50):
            residual = new - u - step * v - step**2 / 4 * (a + acceleration(new))
            delta = np.linalg.solve(np.eye(len(u)) - step**2 / 4 * stiffness(new), -residual)
            new = new + delta
            if np.abs(delta).max() < 1e-13:
                break
        v = 2 * (new - u) / step - v
        u = new
        rows.append((k * step, u[-1]))
    return np.array(rows)


def explicit(cells, step, every, end):
    v, acceleration, _ = column(cells)
    u, rows = np.zeros_like(v), [(0.0, 0.0)]
    for k in range(1, round(end / step) + 1):
        v = v + step / 2 * acceleration(u)
        u = u + step * v
        v = v + step / 2 * acceleration(u)
        if k % every == 0:
            rows.append((k * step, u[-1]))
    return np.array(rows)


def report(name, rows):
    """As curve_rms of a check: the straight lines between rows less those between the points of the reference."""
    end = min(rows[-1, 0], reference[-1, 0])
    times = np.union1d(rows[:, 0], reference[:, 0])
    times = times[times <= end]
    off = np.interp(times, *rows.T) - np.interp(times, *reference.T)
    square = (off[:-1] ** 2 + off[:-1] * off[1:] + off[1:] ** 2) / 3
    print(f"{name}: {(square @ np.diff(times) / end) ** 0.5:.6f} m")


if __name__ == "__main__":
    for cells in (9, 100, 200):
        case = implicit(cells, 0.1, 2.2)
        print(f"{cells + 1} rows, steps of 0.1 s: {case[2, 1]:.6f} m at 0.2 s, {case[8, 1]:.6f} m at 0.8 s")
    case = implicit(9, 0.1, 2.2)
    report("case, steps of 0.1 s", case)
    report("fine, steps of 0.005 s", implicit(9, 0.005, 2.15))
    report("explicit, time exact", explicit(9, 1e-4, 50, 2.15))
    report("refined, 37 rows, steps of 0.0025 s", implicit(36, 0.0025, 2.15))
