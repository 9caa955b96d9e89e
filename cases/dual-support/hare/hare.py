"""Makes the surface of a hare, ellipsoids that run into each other, as a binary STL, and prints its volume and centroid:
python hare.py [cells over the height]"""

import sys
from math import exp, log, sqrt
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))
import stl

CELLS = int(sys.argv[1]) if len(sys.argv) > 1 else 19
SHARP = 24.0  # the larger, the less the ellipsoids run into each other, 1/m

# Centres and half axes in m: body, head, ears, tail, feet, paws.
PARTS = [
    ((0.00, 0.00, 0.34), (0.34, 0.27, 0.30)),
    ((0.26, 0.00, 0.68), (0.20, 0.17, 0.18)),
    ((0.18, 0.10, 0.96), (0.07, 0.06, 0.22)),
    ((0.18, -0.10, 0.96), (0.07, 0.06, 0.22)),
    ((-0.36, 0.00, 0.24), (0.10, 0.10, 0.10)),
    ((0.16, 0.19, 0.10), (0.26, 0.10, 0.09)),
    ((0.16, -0.19, 0.10), (0.26, 0.10, 0.09)),
    ((0.32, 0.11, 0.34), (0.09, 0.07, 0.16)),
    ((0.32, -0.11, 0.34), (0.09, 0.07, 0.16)),
]
LOW, HIGH = (-0.56, -0.38, -0.08), (0.58, 0.38, 1.26)
STEP = (HIGH[2] - LOW[2]) / CELLS
COUNTS = [round((HIGH[k] - LOW[k]) / STEP) + 1 for k in range(3)]


def depth(place):
    """About the depth in m below the surface."""
    total = 0.0
    for center, axes in PARTS:
        radius = sqrt(sum(((x - c) / a) ** 2 for x, c, a in zip(place, center, axes)))
        total += exp(min(SHARP * min(axes) * (1.0 - radius), 200.0))
    return log(total) / SHARP


def point(node):
    return tuple(LOW[k] + STEP * node[k] for k in range(3))


values = {}
for i in range(COUNTS[0]):
    for j in range(COUNTS[1]):
        for k in range(COUNTS[2]):
            values[i, j, k] = depth(point((i, j, k)))

corners = {}


def crossing(one, other):
    """Where the surface crosses an edge; the same place from either end."""
    edge = (min(one, other), max(one, other))
    if edge not in corners:
        (a, b), (x, y) = (values[edge[0]], values[edge[1]]), map(point, edge)
        # No corner of a facet comes so close to a node that the facet has no area.
        part = min(max(a / (a - b), 0.05), 0.95)
        corners[edge] = tuple(p + part * (q - p) for p, q in zip(x, y))
    return corners[edge]


def facets():
    """Those of each of the six tetrahedra of a cube, round a diagonal of it."""
    orders = [(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1), (2, 1, 0)]
    for cube in values:
        if any(cube[k] + 1 == COUNTS[k] for k in range(3)):
            continue
        for order in orders:
            tetrahedron, node = [cube], list(cube)
            for axis in order:
                node[axis] += 1
                tetrahedron.append(tuple(node))
            inside = [node for node in tetrahedron if values[node] > 0.0]
            outside = [node for node in tetrahedron if values[node] <= 0.0]
            if len(inside) in (1, 3):
                one, three = (inside[0], outside) if len(inside) == 1 else (outside[0], inside)
                cut = [[crossing(one, node) for node in three]]
            elif len(inside) == 2:
                (a, b), (c, d) = inside, outside
                ring = crossing(a, c), crossing(a, d), crossing(b, d), crossing(b, c)
                cut = [[ring[0], ring[1], ring[2]], [ring[0], ring[2], ring[3]]]
            else:
                continue
            for facet in cut:
                yield facet if faces(facet, point(inside[0])) else [facet[0], facet[2], facet[1]]


def faces(facet, inner):
    """Whether a facet faces away from a point."""
    return dot(normal(facet), [p - q for p, q in zip(facet[0], inner)]) > 0.0


def normal(facet):
    u, v = ([q - p for p, q in zip(facet[0], facet[k])] for k in (1, 2))
    return [u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3)]


def dot(u, v):
    return sum(p * q for p, q in zip(u, v))


surface = stl.rounded(facets())
stl.write("hare.stl", "a hare", surface)

# Cones from the origin to the facets.
cones = [dot(facet[0], normal([(0.0,) * 3, facet[1], facet[2]])) / 6.0 for facet in surface]
volume = sum(cones)
centroid = [
    sum(cone * sum(corner[k] for corner in facet) / 4.0 for cone, facet in zip(cones, surface)) / volume
    for k in range(3)
]
print(len(surface), "facets, volume", volume, "m^3, centroid", centroid, "m")
