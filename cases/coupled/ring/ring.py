"""Makes the surface of a ring, a torus about z, as a binary STL: python ring.py [radius] [radius of its section] [facets around] [facets along]"""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
import stl

numbers = [float(text) for text in sys.argv[1:]]
radius, section, around, along = numbers + [0.5, 0.25, 48, 20][len(numbers) :]
around, along = int(around), int(along)


def corner(i, j):
    """The corner of the facets with a number around the axis and one along the section."""
    a, b = 2 * pi * (i % around) / around, 2 * pi * (j % along) / along
    out = radius + section * cos(b)
    return out * cos(a), out * sin(a), section * sin(b)


def facets():
    for i in range(around):
        for j in range(along):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            yield a, b, c
            yield a, c, d


stl.write("ring.stl", "a torus", facets())
