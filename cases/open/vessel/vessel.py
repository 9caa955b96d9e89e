"""Makes the surface of a vessel, a sphere, as a binary STL: python vessel.py [radius] [facets around]"""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
import stl

numbers = [float(text) for text in sys.argv[1:]]
radius, around = numbers + [0.5, 48][len(numbers) :]
around = 2 * int(around / 2)
along = around // 2


def corner(i, j):
    """The corner of the facets with a number around the axis and one from the lowest point up."""
    a, b = 2 * pi * (i % around) / around, pi * j / along
    out = radius * sin(b) if 0 < j < along else 0.0
    return out * cos(a), out * sin(a), -radius * cos(b)


def facets():
    for i in range(around):
        for j in range(along):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            if j > 0:
                yield a, b, c
            if j < along - 1:
                yield a, c, d


def enclosed():
    """The volume that the facets enclose."""
    total = 0.0
    for (ax, ay, az), (bx, by, bz), (cx, cy, cz) in stl.rounded(facets()):
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6


stl.write("vessel.stl", "a sphere", facets())
print(f"half of the volume: {enclosed() / 2:.7f} m^3")
