"""Makes the mesh of this folder: python meshes.py (needs meshio and numpy)."""

from pathlib import Path

import meshio
import numpy as np

FOLDER = Path(__file__).parent
LENGTHS, CELLS = (8.0, 3.0), (64, 25)

nx, ny = CELLS
x, y = np.linspace(0, LENGTHS[0], nx + 1), np.linspace(-1.5, 1.5, ny + 1)
points = np.array([[a, b, 0.0] for b in y for a in x])
number = lambda i, j: i + (nx + 1) * j
quads = [
    [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)]
    for j in range(ny)
    for i in range(nx)
]
# A quarter of its cell for each node, and a spacing of 4.07 radii of the disc of this area.
volume = np.zeros(len(points))
np.add.at(volume, np.array(quads).ravel(), LENGTHS[0] * LENGTHS[1] / nx / ny / 4)
spacing = 4.07 * np.sqrt(volume / np.pi)
mesh = meshio.Mesh(
    points,
    [("quad", np.array(quads, dtype=np.int32))],
    point_data={"spacing": spacing},
)
meshio.write(FOLDER / "beam.vtu", mesh)
print(len(points), "nodes")
