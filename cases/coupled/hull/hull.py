"""Makes the surface of a ship's hull as a binary STL, the water line at z = 0, and prints its volumes and the height
of their centre: python hull.py [length] [beam] [draught] [freeboard] [facets along] [facets down]

The sides are Wigley's with fuller ends and sections, under water

    y = +-beam/2 (1 - (2x/length)^6)(1 - (z/draught)^4),

and vertical above it, up to a flat deck."""

import sys
from math import cos, pi, sin
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
import stl

numbers = [float(text) for text in sys.argv[1:]]
length, beam, draught, freeboard, along, down = numbers + [1.2, 0.5, 0.2, 0.15, 40, 12][len(numbers) :]
along, down = int(along), int(down)


def side(i, j):
    """A corner on the side with y > 0, numbered from the bow, and from the keel to the water line and the deck."""
    across = -cos(pi * i / along)
    under = sin(pi / 2 * (1 - j / down)) if j <= down else 0.0
    y = beam / 2 * (1 - across**6) * (1 - under**4)
    return length / 2 * across, y, -draught * under if j <= down else freeboard


def other(corner):
    """The same corner on the other side."""
    return corner[0], -corner[1], corner[2]


def facets():
    """Corners counter-clockwise as seen from outside."""
    for i in range(along):
        for j in range(down + 1):
            a, b, c, d = side(i, j), side(i, j + 1), side(i + 1, j + 1), side(i + 1, j)
            for facet in (a, b, c), (a, c, d):
                yield facet
                yield tuple(map(other, reversed(facet)))
        a, b = side(i, down + 1), side(i + 1, down + 1)
        if i > 0:
            yield a, other(a), other(b)
        if i + 1 < along:
            yield a, other(b), b


def cone(facet):
    """The volume of the cone from the middle of the water line to a facet."""
    (a, b, c), (d, e, f), (g, h, i) = facet
    return (a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)) / 6


surface = stl.rounded(facets())
stl.write("hull.stl", "a hull", surface)

# The cones to what is under water fill it, as their tip is in the plane of the water line.
cones = [(cone(facet), sum(corner[2] for corner in facet) / 4) for facet in surface]
under = [(volume, height) for (volume, height), facet in zip(cones, surface) if max(corner[2] for corner in facet) <= 0]
for name, parts in ("under water", under), ("in all", cones):
    volume = sum(volume for volume, _ in parts)
    print(f"{name}: {volume:.8g} m^3, centre at z = {sum(volume * height for volume, height in parts) / volume:.6g} m")
print(len(surface), "facets")
