"""Makes the mesh of this folder, a sixth of a tube: python mesh.py"""

from math import cos, pi, sin
from pathlib import Path

INNER, OUTER, ANGLE = 1.0, 2.0, pi / 3  # m, m, rad
ROUND, THROUGH = 24, 20  # cells


def node(i, j):
    return 1 + i * (THROUGH + 1) + j


def tube():
    nodes, quads = [], []
    sides = {"bottom": [], "slope": [], "inside": [], "outside": []}
    for i in range(ROUND + 1):
        angle = ANGLE * i / ROUND
        for j in range(THROUGH + 1):
            radius = INNER + (OUTER - INNER) * j / THROUGH
            nodes.append((radius * cos(angle), radius * sin(angle)))
    for i in range(ROUND):
        quads += [(node(i, j), node(i, j + 1), node(i + 1, j + 1), node(i + 1, j)) for j in range(THROUGH)]
        sides["inside"].append((node(i, 0), node(i + 1, 0)))
        sides["outside"].append((node(i, THROUGH), node(i + 1, THROUGH)))
    for j in range(THROUGH):
        sides["bottom"].append((node(0, j), node(0, j + 1)))
        sides["slope"].append((node(ROUND, j), node(ROUND, j + 1)))
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(sides) + 1)]
    lines += [f'1 {number} "{name}"' for number, name in enumerate(sides, 1)]
    lines += ['2 5 "tube"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{number} {x:.15g} {y:.15g} 0" for number, (x, y) in enumerate(nodes, 1)]
    elements = [(1, group, ends) for group, edges in enumerate(sides.values(), 1) for ends in edges]
    elements += [(3, 5, corners) for corners in quads]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for number, (kind, group, corners) in enumerate(elements, 1):
        lines.append(f"{number} {kind} 2 {group} {group} {' '.join(map(str, corners))}")
    lines.append("$EndElements")
    (Path(__file__).parent / "tube.msh").write_text("\n".join(lines) + "\n")


tube()
