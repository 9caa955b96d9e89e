"""Makes the meshes of this folder: python meshes.py (needs gmsh)."""

from pathlib import Path

import gmsh

FOLDER = Path(__file__).parent
# Sizes of the quadrilaterals in m.
MESHES = {"plate": 0.05, "plate-fine": 0.04, "plate-medium": 0.045, "plate-rough": 0.06}


def plate(name, size):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    corners = [gmsh.model.geo.addPoint(x, y, 0) for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)]]
    sides = [gmsh.model.geo.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]
    surface = gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(sides)])
    gmsh.model.geo.synchronize()
    gmsh.model.addPhysicalGroup(1, [sides[0]], name="bottom")
    gmsh.model.addPhysicalGroup(1, [sides[2]], name="top")
    gmsh.model.addPhysicalGroup(2, [surface], name="plate")
    for limit in ("Min", "Max"):
        gmsh.option.setNumber(f"Mesh.MeshSize{limit}", size)
    gmsh.option.setNumber("Mesh.RecombineAll", 1)
    gmsh.option.setNumber("Mesh.Algorithm", 6)
    gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.model.mesh.generate(2)
    gmsh.write(str(FOLDER / f"{name}.msh"))
    gmsh.finalize()


for name, size in MESHES.items():
    plate(name, size)
