"""Makes the surface of a ring, a torus about z, as a binary STL: python ring.py [radius] [radius of its section] [facets around] [facets along]"""

import struct
import sys
from math import cos, pi, sin

numbers = [float(text) for text in sys.argv[1:]]
radius, section, around, along = numbers + [0.5, 0.25, 48, 20][len(numbers) :]
around, along = int(around), int(along)


def corner(i, j):
    """The corner of the facets with a number around the axis and one along the section."""
    a, b = 2 * pi * (i % around) / around, 2 * pi * (j % along) / along
    out = radius + section * cos(b)
    return struct.pack("<3f", out * cos(a), out * sin(a), section * sin(b))


with open("ring.stl", "wb") as file:
    file.write(b"a torus".ljust(80) + struct.pack("<I", 2 * around * along))
    for i in range(around):
        for j in range(along):
            corners = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            for facet in (0, 1, 2), (0, 2, 3):
                # The normal is that of the corners, whatever stands here.
                file.write(bytes(12) + b"".join(corners[k] for k in facet) + bytes(2))
