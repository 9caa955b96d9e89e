"""Makes the mesh of this folder, half of an arch: python mesh.py [cells along] [cells across]"""

import sys
from math import pi, sin
from pathlib import Path

HALF, THICKNESS, RISE = 1.0, 0.08, 0.16  # m
ALONG, ACROSS = (int(text) for text in sys.argv[1:3]) if len(sys.argv) > 2 else (75, 6)


def node(i, j):
    return 1 + i * (ACROSS + 1) + j


nodes, quads = [], []
sides = {"wall": [], "crown": [], "top": [], "bottom": []}
for i in range(ALONG + 1):
    x = HALF * i / ALONG
    middle = RISE * sin(pi * x / (2 * HALF))
    nodes += [(x, middle + THICKNESS * (j / ACROSS - 0.5)) for j in range(ACROSS + 1)]
for i in range(ALONG):
    quads += [(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)) for j in range(ACROSS)]
    sides["bottom"].append((node(i, 0), node(i + 1, 0)))
    sides["top"].append((node(i, ACROSS), node(i + 1, ACROSS)))
for j in range(ACROSS):
    sides["wall"].append((node(0, j), node(0, j + 1)))
    sides["crown"].append((node(ALONG, j), node(ALONG, j + 1)))
lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(sides) + 1)]
lines += [f'1 {number} "{name}"' for number, name in enumerate(sides, 1)]
lines += ['2 5 "arch"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
lines += [f"{number} {x:.12g} {y:.12g} 0" for number, (x, y) in enumerate(nodes, 1)]
elements = [(1, group, ends) for group, edges in enumerate(sides.values(), 1) for ends in edges]
elements += [(3, 5, corners) for corners in quads]
lines += ["$EndNodes", "$Elements", str(len(elements))]
for number, (kind, group, corners) in enumerate(elements, 1):
    lines.append(f"{number} {kind} 2 {group} {group} {' '.join(map(str, corners))}")
lines.append("$EndElements")
(Path(__file__).parent / f"arch-{len(nodes)}.msh").write_text("\n".join(lines) + "\n")
