"""Makes meshes of quadrilaterals with named sides: python mesh.py arch [cells along] [cells across], or python mesh.py tube"""

import sys
from math import cos, pi, sin
from pathlib import Path


def write(path, name, cells, place, sides, digits=12, is_turned=False):
    """A mesh of `cells` along two directions, whose nodes are at `place` of their numbers.

    `sides` are the names of the four sides in the order in which the file has them, each with its
    direction and its end: (0, 1) is where the first number is largest.
    """
    along, across = cells

    def node(i, j):
        return 1 + i * (across + 1) + j

    nodes = [place(i, j) for i in range(along + 1) for j in range(across + 1)]
    quads = []
    for i in range(along):
        for j in range(across):
            corners = (node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1))
            # Counter-clockwise in space, also where the two directions are a left-handed pair.
            quads.append((corners[0], *corners[:0:-1]) if is_turned else corners)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(sides) + 1)]
    lines += [f'1 {number} "{side}"' for number, side in enumerate(sides, 1)]
    lines += [f'2 5 "{name}"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{number} {x:.{digits}g} {y:.{digits}g} 0" for number, (x, y) in enumerate(nodes, 1)]
    elements = []
    for group, (direction, end) in enumerate(sides.values(), 1):
        fixed = cells[direction] * end
        line = [node(fixed, k) if direction == 0 else node(k, fixed) for k in range(cells[1 - direction] + 1)]
        elements += [(1, group, ends) for ends in zip(line, line[1:])]
    elements += [(3, 5, corners) for corners in quads]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for number, (kind, group, corners) in enumerate(elements, 1):
        lines.append(f"{number} {kind} 2 {group} {group} {' '.join(map(str, corners))}")
    path.write_text("\n".join([*lines, "$EndElements", ""]))


def arch(along=75, across=6):
    """Half of an arch of a half wave, from the wall to the crown."""
    half, thickness, rise = 1.0, 0.08, 0.16  # m

    def place(i, j):
        x = half * i / along
        return x, rise * sin(pi * x / (2 * half)) + thickness * (j / across - 0.5)

    sides = {"wall": (0, 0), "crown": (0, 1), "top": (1, 1), "bottom": (1, 0)}
    path = Path(__file__).parent / "arch" / f"arch-{(along + 1) * (across + 1)}.msh"
    write(path, "arch", (along, across), place, sides)


def tube():
    """A sixth of a tube."""
    inner, outer, span = 1.0, 2.0, pi / 3  # m, m, rad
    around, through = 24, 20

    def place(i, j):
        radius, angle = inner + (outer - inner) * j / through, span * i / around
        return radius * cos(angle), radius * sin(angle)

    sides = {"bottom": (0, 0), "slope": (0, 1), "inside": (1, 0), "outside": (1, 1)}
    write(Path(__file__).parent / "tube" / "tube.msh", "tube", (around, through), place, sides, 15, is_turned=True)


if sys.argv[1:2] == ["arch"]:
    arch(*map(int, sys.argv[2:4]))
elif sys.argv[1:] == ["tube"]:
    tube()
else:
    sys.exit(__doc__)
