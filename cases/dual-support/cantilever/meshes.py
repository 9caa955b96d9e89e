"""Makes the meshes of this folder: python meshes.py (needs gmsh, meshio and numpy)."""

from pathlib import Path

import gmsh
import meshio
import numpy as np

FOLDER = Path(__file__).parent
# Sizes of the tetrahedra in m, and the formats.
MESHES = [(0.845, "msh"), (0.5, "msh"), (0.285, "msh"), (0.143, "vtu")]


def beam(size):
    """Nodes, tetrahedra, and the triangles of the wall and of the loaded end."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.occ.addBox(0, -1.5, -1, 8, 3, 2)
    gmsh.model.occ.synchronize()
    for limit in ("Min", "Max"):
        gmsh.option.setNumber(f"Mesh.MeshSize{limit}", size)
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.optimize("Netgen")
    tags, places, _ = gmsh.model.mesh.getNodes()
    places = np.round(places.reshape(-1, 3), 5) + 0.0
    index = np.zeros(int(tags.max()) + 1, dtype=int)
    index[tags.astype(int)] = np.arange(len(tags))
    _, cells = gmsh.model.mesh.getElementsByType(4)
    cells = index[cells.astype(int)].reshape(-1, 4)
    _, faces = gmsh.model.mesh.getElementsByType(2)
    faces = index[faces.astype(int)].reshape(-1, 3)
    gmsh.finalize()
    at = lambda x: faces[np.all(places[faces][:, :, 0] == x, axis=1)]
    # Neighbours in space become neighbours in the file.
    order = np.lexsort((places[:, 2], places[:, 1], np.round(places[:, 0] / (2 * size))))
    new = np.empty(len(order), dtype=int)
    new[order] = np.arange(len(order))
    cells = new[cells]
    cells = cells[np.argsort(cells.min(axis=1), kind="stable")]
    return places[order], cells, new[at(0.0)], new[at(8.0)]


def write_msh(path, places, cells, wall, end):
    """Version 2.2: little more than the numbers."""
    with open(path, "w") as file:
        names = [(2, 1, "wall"), (2, 2, "end"), (3, 3, "beam")]
        file.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n")
        file.writelines(f'{d} {tag} "{name}"\n' for d, tag, name in names)
        file.write(f"$EndPhysicalNames\n$Nodes\n{len(places)}\n")
        file.writelines(f"{n} {x:g} {y:g} {z:g}\n" for n, (x, y, z) in enumerate(places, 1))
        rows = [(2, 1, row) for row in wall] + [(2, 2, row) for row in end]
        rows += [(4, 3, row) for row in cells]
        file.write(f"$EndNodes\n$Elements\n{len(rows)}\n")
        for number, (kind, tag, row) in enumerate(rows, 1):
            nodes = " ".join(str(node + 1) for node in row)
            file.write(f"{number} {kind} 2 {tag} {tag} {nodes}\n")
        file.write("$EndElements\n")


for size, ending in MESHES:
    places, cells, wall, end = beam(size)
    path = FOLDER / f"beam-{len(places)}.{ending}"
    if ending == "msh":
        write_msh(path, places, cells, wall, end)
    else:
        groups = {"triangle": np.concatenate([wall, end]), "tetra": cells}
        tags = [np.repeat([1, 2], [len(wall), len(end)]), np.full(len(cells), 3)]
        mesh = meshio.Mesh(
            places.astype(np.float32),
            [(kind, rows.astype(np.int32)) for kind, rows in groups.items()],
            cell_data={"group": [tag.astype(np.int32) for tag in tags]},
        )
        meshio.write(path, mesh)
    print(f"{path.name}: {len(cells)} tetrahedra")
