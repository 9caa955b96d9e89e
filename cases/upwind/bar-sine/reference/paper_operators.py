"""U1 and U6 with the operators of the paper, exact in time.

Mixed correction of kernel and gradient, Upwind (2.39) to (2.43), with volumes as weights, and forces by
the adjoint, Upwind (3.39): both problems are linear in the one moving component, m v' = -B u,
so that their modes give the motion without a step. Needs numpy. Prints the zero of the tip after four
and a half periods (U1), and the period and the largest displacement of the top (U6).
"""

import itertools
import math

import numpy as np


def cubic(q):
    """Cubic spline and its derivative at q = r / h, support 2 h, without its factor."""
    value = np.where(q < 1, 1 - 1.5 * q**2 + 0.75 * q**3, np.where(q < 2, 0.25 * (2 - q) ** 3, 0))
    slope = np.where(q < 1, -3 * q + 2.25 * q**2, np.where(q < 2, -0.75 * (2 - q) ** 2, 0))
    return value, slope


def gradients(points, volume, h):
    """G[a, b] = V_b times the corrected gradient of the corrected kernel at a."""
    count, dimension = points.shape
    result = np.zeros((count, count, dimension))
    for a in range(count):
        offset = points - points[a]
        distance = np.linalg.norm(offset, axis=1)
        value, slope = cubic(distance / h)
        ratio = np.where(distance > 0, slope / np.where(distance > 0, distance, 1) / h, 0)
        plain = -ratio[:, None] * offset
        total = volume @ value
        mixed = (plain * total - np.outer(value, volume @ plain)) / total**2
        moment = (volume[:, None] * mixed).T @ offset
        result[a] = volume[:, None] * (mixed @ np.linalg.inv(moment).T)
    return result


def modes(points, volume, h, axis, fixed, stiffness, density):
    g = gradients(points, volume, h)[:, :, axis]
    free = np.flatnonzero(~fixed)
    # dJ/dt = G v, p = -kappa (J - 1), m dv/dt = G^T V p: symmetric with the root of the mass.
    root = np.sqrt(density * volume[free])
    matrix = g[:, free].T @ (volume[:, None] * g[:, free]) * stiffness
    matrix /= np.outer(root, root)
    squares, shapes = np.linalg.eigh(matrix)
    return free, root, np.sqrt(np.maximum(squares, 0)), shapes


def motion(parts, velocity, particle, times):
    free, root, frequencies, shapes = parts
    share = shapes.T @ (root * velocity[free])
    row = shapes[list(free).index(particle)] / root[list(free).index(particle)]
    small = frequencies < 1e-9
    phase = np.outer(times, frequencies)
    swing = np.where(small, times[:, None], np.sin(phase) / np.where(small, 1, frequencies))
    return swing @ (row * share)


def zeros(times, values):
    k = np.flatnonzero(np.sign(values[1:-1]) != np.sign(values[2:])) + 1
    return times[k] + values[k] * (times[k + 1] - times[k]) / (values[k] - values[k + 1])


def lattice(lengths, cells):
    axes = [np.linspace(0, length, n + 1) for length, n in zip(lengths, cells)]
    points = np.array(list(itertools.product(*axes)))
    volume = np.ones(len(points))
    for axis, (length, n) in enumerate(zip(lengths, cells)):
        face = (points[:, axis] < 1e-9) | (points[:, axis] > length - 1e-9)
        volume *= np.where(face, 0.5, 1.0) * length / n
    return points, volume


points, volume = lattice([10.0], [39])
parts = modes(points, volume, 10 / 39, 0, points[:, 0] < 1e-9, 1e6, 1000.0)
times = np.linspace(0, 6.5, 130_001)
tip = motion(parts, np.sin(math.pi * points[:, 0] / 20), len(points) - 1, times)
print("U1: ninth zero of the tip", zeros(times, tip)[8], "largest", tip.max())

points, volume = lattice([3.0, 2.5], [9, 9])
parts = modes(points, volume, 0.58 / 3, 1, points[:, 1] < 1e-9, 1e6 / 1.4, 1000.0)
times = np.linspace(0, 2.0, 40_001)
place = int(np.argmin(np.linalg.norm(points - [1.5, 2.5], axis=1)))
top = motion(parts, -np.sin(math.pi * points[:, 1] / 5), place, times)
# As `period` of a check: crossings of the middle between the largest and the smallest value, least squares of
# their time against their number, with an offset for either direction.
crossings = zeros(times, top - 0.5 * (top.max() + top.min()))
covariance = variance = 0.0
for same in (crossings[::2], crossings[1::2]):
    number = np.arange(len(same)) - 0.5 * (len(same) - 1)
    covariance += number @ same
    variance += number @ number
period = covariance / variance
print("U6: period of the top", period, "largest", top.max(), "smallest", top.min())
