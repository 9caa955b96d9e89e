"""Counts the particles that CTVF (42), (43) and the cone of 60 degrees find, by sums over all pairs.

Usage: python3 cone.py, in this folder

Shares nothing with the program but the equations: no neighbour lists, no kernels of it. It also counts, of the
particles of the ring cut from a lattice, those that have nobody in the cone around the exact normal.
"""

import csv
import math

DX = 0.1
REACH = 3 * DX


def value(r):
    """The quintic spline in 2D with h of one spacing."""
    q = r / DX
    sum_ = (max(3 - q, 0) ** 5 - 6 * max(2 - q, 0) ** 5 + 15 * max(1 - q, 0) ** 5)
    return 7 / (478 * math.pi * DX**2) * sum_


def slope(r):
    q = r / DX
    sum_ = (max(3 - q, 0) ** 4 - 6 * max(2 - q, 0) ** 4 + 15 * max(1 - q, 0) ** 4)
    return -5 * 7 / (478 * math.pi * DX**3) * sum_


def lattice(x0, x1, y0, y1, inside=lambda x, y: True):
    n, m = round((x1 - x0) / DX), round((y1 - y0) / DX)
    points = ((x0 + (i + 0.5) * DX, y0 + (j + 0.5) * DX) for i in range(n) for j in range(m))
    return [p for p in points if inside(*p)]


def around(a, points):
    for x, y in points:
        d = (x - a[0], y - a[1])
        r = math.hypot(*d)
        if 0 < r < REACH * (1 - 1e-12):
            yield d, r, (x, y)


def unit(v):
    length = math.hypot(*v)
    return (v[0] / length, v[1] / length) if length > 0 else (0.0, 0.0)


def sharp(a, everything):
    """CTVF (42): the unit normal where the sum is at least 1/(4h), or none."""
    s = [0.0, 0.0]
    for d, r, _ in around(a, everything):
        # grad W at a is along r_a - r_b = -d.
        weight = DX**2 * slope(r) / r
        s[0] += weight * d[0]
        s[1] += weight * d[1]
    return unit(s) if math.hypot(*s) >= 0.25 / DX else (0.0, 0.0)


def is_open(a, normal, everything):
    return not any(d[0] * normal[0] + d[1] * normal[1] > 0.5 * r + 1e-12
                   for d, r, _ in around(a, everything))


def found(fluid, wall=()):
    everything = list(fluid) + list(wall)
    normals = {a: sharp(a, everything) for a in fluid}
    count = 0
    for a in fluid:
        n = [c * value(0.0) for c in normals[a]]
        density = DX**2 * value(0.0)
        for _, r, b in around(a, everything):
            density += DX**2 * value(r)
            for axis in (0, 1):
                n[axis] += normals.get(b, (0.0, 0.0))[axis] * value(r)
        alone = density < 0.5
        # Cancelling normals leave a remainder of round-off, which is no direction.
        count += alone or (math.hypot(*n) > 1e-9 * value(0.0)
                           and is_open(a, unit(n), everything))
    return count


square = lattice(-1.0, 1.0, 1.0, 3.0)
cut = lattice(6.0, 11.0, -0.5, 4.5, lambda x, y: 0.95 <= math.hypot(x - 8.5, y - 2) <= 2.05)
patch = lattice(12.0, 14.0, 0.0, 1.0)
floor = lattice(11.0, 15.0, -3 * DX, 0.0)
tank = lattice(3.0 - 3 * DX, 11.0 + 3 * DX, -6.0 - 3 * DX, -2.0,
               lambda x, y: not (3.0 < x < 11.0 and y > -6.0))


def read(name):
    with open(name) as file:
        return [(float(row["x"]), float(row["y"])) for row in csv.DictReader(file)]


rings, dam = read("../rings.csv"), read("../dam.csv")


def exact(p):
    d = unit((p[0] - 8.5, p[1] - 2.0))
    sign = 1 if math.hypot(p[0] - 8.5, p[1] - 2.0) > 1.5 else -1
    return (sign * d[0], sign * d[1])


print("square", found(square), "of", len(square))
print("rings", found(rings), "of", len(rings))
print("cut", found(cut), "of", len(cut), "- with the exact normals",
      sum(is_open(p, exact(p), cut) for p in cut))
print("patch", found(patch, floor), "of", len(patch))
print("dam", found(dam, tank), "of", len(dam))
