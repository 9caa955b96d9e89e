"""Counts the particles on the surfaces of the case in three ways, or writes the points of its two balls.

Usage: python3 count.py [write], in this folder

- By construction: the outer layer of a cube of n^3, the points of the outermost of concentric spheres.
- Exposed: a ball of one spacing that touches the particle can be laid beside it without another particle inside, the
  rule of alpha shapes, for the directions between lattice points up to four spacings apart.
- By the equations: CTVF (42), (43) and the cone of 60 degrees, by sums over all pairs.

Shares nothing with the program but the equations. Needs NumPy.
"""

import math
import sys

import numpy as np

DX = 0.1


def spheres(last):
    """Spheres of the radii 1 to `last` spacings, each with as many points as squares of the spacing cover it, on a
    spiral."""
    golden = math.pi * (3 - math.sqrt(5))
    points = []
    for sphere in range(1, last + 1):
        count = round(4 * math.pi * sphere**2)
        for k in range(count):
            z = 1 - (2 * k + 1) / count
            across, angle = math.sqrt(1 - z * z), golden * k
            points.append([sphere * DX * c for c in (across * math.cos(angle), across * math.sin(angle), z)])
    return np.round(points, 6)


def lattice(side, inside=lambda x: True):
    """Centres of the cells of a cube of `side` cells about the origin."""
    axis = (np.arange(side) + 0.5 - side / 2) * DX
    points = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    return np.array([x for x in np.round(points, 9) if inside(x)])


def value(r):
    """The quintic spline in 3D with h of one spacing."""
    q = r / DX
    part = lambda n: np.maximum(n - q, 0) ** 5
    return (part(3) - 6 * part(2) + 15 * part(1)) / (120 * math.pi * DX**3)


def slope(r):
    q = r / DX
    part = lambda n: np.maximum(n - q, 0) ** 4
    return -5 * (part(3) - 6 * part(2) + 15 * part(1)) / (120 * math.pi * DX**4)


def around(points):
    for a, x in enumerate(points):
        d = points - x
        r = np.sqrt((d * d).sum(1))
        near = np.flatnonzero((r > 0) & (r < 3 * DX * (1 - 1e-12)))
        yield a, near, d[near], r[near]


def found(points):
    sharp = np.zeros_like(points)
    for a, _, d, r in around(points):
        s = (DX**3 * slope(r) / r) @ d
        length = np.sqrt(s @ s)
        if length >= 0.25 / DX:
            sharp[a] = s / length
    count = 0
    for a, near, d, r in around(points):
        n = sharp[a] * value(0.0) + value(r) @ sharp[near]
        length = np.sqrt(n @ n)
        alone = DX**3 * (value(0.0) + value(r).sum()) < 0.5
        # Cancelling normals leave a remainder of round-off, which is no direction.
        is_open = length > 1e-9 * value(0.0) and not (d @ n / length > 0.5 * r + 1e-12).any()
        count += alone or is_open
    return count


def exposed(points):
    steps = np.stack(np.meshgrid(*3 * [np.arange(-4, 5)]), -1).reshape(-1, 3)
    steps = steps[(steps != 0).any(1)]
    ways = np.unique(np.round(steps / np.sqrt((steps * steps).sum(1))[:, None], 9), axis=0)
    count = 0
    for _, _, d, _ in around(points):
        apart = ((d[None] - DX * ways[:, None]) ** 2).sum(2)
        count += (apart >= (0.999 * DX) ** 2).all(1).any()
    return count


BODIES = {"cube": (lattice(12), 12**3 - 10**3), "ball": (spheres(8), round(4 * math.pi * 8**2)),
          "cut": (lattice(17, lambda x: x @ x <= 0.85**2), None)}

if __name__ == "__main__":
    if sys.argv[1:] == ["write"]:
        for name, file_name, shift in (("ball", "spheres.csv", 0.0), ("cut", "cut.csv", 2.4)):
            points = BODIES[name][0] + [shift, 0.0, 0.0]
            with open(f"../{file_name}", "w") as file:
                file.write("x,y,z,volume\n")
                file.writelines(f"{x:.6g},{y:.6g},{z:.6g},{DX**3:g}\n" for x, y, z in points)
        sys.exit()
    for name, (points, outer) in BODIES.items():
        print(name, len(points), "particles, by construction", outer, "exposed", exposed(points), "found", found(points))
