"""Energy of U1 and U6 after explicit steps without dissipation, mode by mode.

Gradient correction and whole cells as weights make central differences, whose modes share the start's
energy; a step multiplies that of a mode by 1 + z^4 / 4 (TVD-RK2) or 1 - z^4 / 12 + z^6 / 36 (SSP-RK3), z = w dt.
The column of U6 is a bar of its own height. Needs numpy.
"""

import math

import numpy as np


def growth(length, cells, speed, step, steps):
    spacing = length / cells
    volume = np.full(cells + 1, spacing)
    volume[[0, -1]] /= 2
    g = np.zeros((cells + 1, cells + 1))
    for a in range(1, cells):
        g[a, a + 1], g[a, a - 1] = 0.5 / spacing, -0.5 / spacing
    g[0, :2] = [-1 / spacing, 1 / spacing]
    g[-1, -2:] = [-1 / spacing, 1 / spacing]
    root = np.sqrt(volume[1:])
    matrix = speed**2 * g[:, 1:].T @ (volume[:, None] * g[:, 1:]) / np.outer(root, root)
    squares, shapes = np.linalg.eigh(matrix)
    place = np.linspace(0, length, cells + 1)[1:]
    share = (shapes.T @ (root * np.sin(math.pi * place / (2 * length)))) ** 2
    z = np.sqrt(np.maximum(squares, 0)) * step
    share /= share.sum()
    for name, factor in [("tvd_rk2", 1 + z**4 / 4), ("ssp_rk3", 1 - z**4 / 12 + z**6 / 36)]:
        print(f"  {name}: growth {share @ (factor**steps - 1):.10e}")


speed = math.sqrt(1000)
print("U1, 40 particles, 5 periods in steps of 1 ms")
growth(10.0, 39, speed, 0.001, math.ceil(5 * 40 / speed / 0.001 - 1e-9))
print("U6, 10 rows, 200 s in steps of 2 ms")
growth(2.5, 9, math.sqrt(1e6 / 1.4 / 1000), 0.002, 100_000)
print("U6, 10 rows, 2 s in steps of 1 ms")
growth(2.5, 9, math.sqrt(1e6 / 1.4 / 1000), 0.001, 2000)
print("U6, 10 rows, 2 s in steps of 2 ms")
growth(2.5, 9, math.sqrt(1e6 / 1.4 / 1000), 0.002, 1000)
