"""Writes the meshes of the quarter sheet: nodes along rays from the hole, graded towards it."""

import math
from pathlib import Path

SIDE, RADIUS = 0.01, 0.0025


def mesh(cells):
    """`cells` along the arc, as many along each ray."""
    nodes, quads = [], []
    growth = 3.0 ** (1 / (cells - 1))
    shares = [sum(growth**k for k in range(j)) for j in range(cells + 1)]
    shares = [share / shares[-1] for share in shares]
    for i in range(cells + 1):
        # Half of the rays end on each of the two sides, evenly spaced there.
        turn = 2 * i / cells
        end = (SIDE, SIDE * turn) if turn <= 1 else (SIDE * (2 - turn), SIDE)
        angle = 0.5 * math.pi * i / cells
        start = (RADIUS * math.cos(angle), RADIUS * math.sin(angle))
        for share in shares:
            place = [a * (1 - share) + b * share for a, b in zip(start, end)]
            nodes.append([0.0 if abs(x) < 1e-12 else x for x in place])
    row = cells + 1
    for i in range(cells):
        for j in range(cells):
            a = i * row + j + 1
            quads.append((a, a + 1, a + row + 1, a + row))
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes))]
    lines += [f"{k + 1} {x:.12g} {y:.12g} 0" for k, (x, y) in enumerate(nodes)]
    lines += ["$EndNodes", "$Elements", str(len(quads))]
    lines += [f"{k + 1} 3 2 1 1 {' '.join(map(str, quad))}" for k, quad in enumerate(quads)]
    return "\n".join([*lines, "$EndElements", ""])


for cells in (12, 20, 32):
    Path(__file__).with_name(f"sheet-{cells}.msh").write_text(mesh(cells))
