"""Reference numbers of the cases of solids, by quadratic finite elements: `python3 elasticity.py CASE [n]`.

CASE is one of plate, rubber, rubber-stress, rubber-incompressible, hole, cube, cube-incompressible, cantilever, clamped,
compression, vibration, modes, swing; n is the number of elements along the length named in README.md. Units are those of
the case; SI where nothing is said."""

import sys

import numpy as np
from skfem import MeshHex, MeshQuad, MeshQuad2

from elements import (Mixed, Solid, graded, linear, logarithmic, mixed_logarithmic, mixed_neo_hookean, neo_hookean,
                      solve)


def plate(n=32):
    x = graded(n, 30)
    solid = Solid(MeshQuad.init_tensor(x, graded(n, 30)), linear(2.0, 0.3))
    held = solid.where(lambda x, y: y < 1e-9, 0, 1)
    load = solid.traction(lambda x: x[1] > 1 - 1e-9, 1, lambda x, y: -0.4 + 0 * x)
    [(_, u)] = solid.statics(load, held, None, [1.0])
    u = u.reshape(-1, 2)
    show(widest_ux=u[:, 0].max(), lowest_uy=u[:, 1].min())


def rubber(n=10, plane_stress=False, incompressible=False):
    """Quarter of the sheet, in mm and MPa; forces in N per m of thickness."""
    ratio, pulls = (3, [0.5, 1]) if incompressible else (30, [0.5, 1, 2, 3, 4, 5])
    mesh = MeshQuad.init_tensor(graded(n, ratio, "end"), graded(n, ratio, "start"))
    solid = Mixed(mesh, mixed_logarithmic(0.2, 0.4999)) if incompressible \
        else Solid(mesh, logarithmic(0.2, 0.45, plane_stress))
    foot = solid.where(lambda x, y: y < 1e-9, 0, 1)
    middle = solid.where(lambda x, y: y > 1 - 1e-9, 1)
    axis = np.setdiff1d(solid.where(lambda x, y: x < 1e-9, 0), foot)
    held = np.concatenate([foot, axis, middle])
    rise = np.concatenate([np.zeros(len(foot) + len(axis)), np.ones(len(middle))])
    for pull, u in solid.statics(np.zeros(solid.size), held, lambda t: t * rise, pulls):
        show(elongation=f"{100 * pull:.0f} %", force=2000 * solid.internal(u)[1][middle].sum(),
             waist_ux=u[2 * solid.node(1, 1)])


def hole(n=32):
    """n elements along the quarter of the hole; in mm and MPa."""
    radius, side = 2.5, 10.0
    mesh = MeshQuad2.from_mesh(MeshQuad.init_tensor(graded(n, 12, "start"), np.linspace(0, 1, n + 1)))
    out, turn = mesh.doflocs
    inner = radius * np.array([np.cos(np.pi * turn / 2), np.sin(np.pi * turn / 2)])
    inner[np.abs(inner) < 1e-12] = 0
    outer = side * np.minimum(1, [2 - 2 * turn, 2 * turn])
    solid = Solid(MeshQuad2(inner + out * (outer - inner), mesh.t), logarithmic(70.0, 0.49))
    held = np.concatenate([solid.where(lambda x, y: x < 1e-9, 0), solid.where(lambda x, y: y < 1e-9, 1)])
    load = solid.traction(lambda x: x[0] > side - 1e-6, 0, lambda x, y: 5.0 + 0 * x)
    for _, u in solid.statics(load, held, None, [1.0]):
        f, nominal = solid.at(u, 0, radius)
        stress = nominal @ f.T / np.linalg.det(f)
        u = u.reshape(-1, 2)
        show(top_stress=np.linalg.eigvalsh(stress)[-1], top_uy=u[solid.node(0, radius), 1],
             side_ux=u[solid.node(radius, 0), 0],
             corner_ux=u[solid.node(side, side), 0], corner_uy=u[solid.node(side, side), 1],
             end_ux=u[solid.node(side, 0), 0], above_uy=u[solid.node(0, side), 1])


def cube(n=8, incompressible=False):
    """n elements along an edge; half of the cube, x from 0 to its middle. A dead pressure on y < 1/2."""
    half, whole = np.linspace(0, 0.5, n // 2 + 1), np.linspace(0, 1, n + 1)
    mesh = MeshHex.init_tensor(half, whole, whole)
    solid = Mixed(mesh, mixed_neo_hookean(10.0, 0.4999)) if incompressible else Solid(mesh, neo_hookean(10.0, 0.3))
    foot = solid.where(lambda x, y, z: z < 1e-9, 0, 1, 2)
    held = np.union1d(foot, solid.where(lambda x, y, z: x > 0.5 - 1e-9, 0))
    load = solid.traction(lambda x: (x[2] > 1 - 1e-9) & (x[1] < 0.5), 2, lambda x, y, z: -2.0 + 0 * x)
    for t, u in solid.statics(load, held, None, [0.25, 0.5] if incompressible else [0.25, 0.5, 0.75, 1.0]):
        u = u[:solid.moving].reshape(-1, 3)
        show(load=t, lowest_uz=u[:, 2].min(), corner_uz=u[solid.node(0, 0, 1), 2], corner_uy=u[solid.node(0, 0, 1), 1])


def cantilever(n=4):
    """n elements along half of the width; the half z > 0."""
    length, height, p, young, nu = 8.0, 3.0, 1000.0, 30e9, 0.3
    inertia = height**3 / 12
    mesh = MeshHex.init_tensor(length * graded(4 * n, 4), height * (graded(3 * n, 4) - 0.5), graded(n, 4, "end"))
    solid = Solid(mesh, linear(young, nu))
    wall = lambda x, y, z: x < 1e-9
    y = solid.places[np.flatnonzero(wall(*solid.places.T)), 1]
    held = [solid.where(wall, 0), solid.where(wall, 1), solid.where(lambda x, y, z: z < 1e-9, 2)]
    ux = -p * y / (6 * young * inertia) * (2 + nu) * (y**2 - height**2 / 4)
    uy = p / (6 * young * inertia) * 3 * nu * y**2 * length
    given = np.concatenate([ux, uy, np.zeros(len(held[2]))])
    load = solid.traction(lambda x: x[0] > length - 1e-9, 1, lambda x, y, z: p / (2 * inertia) * (height**2 / 4 - y**2))
    for _, u in solid.statics(load, np.concatenate(held), lambda t: t * given, [1.0]):
        energy = solid.internal(u)[0]
        show(tip_uy=u.reshape(-1, 3)[solid.node(length, 0, 0), 1], energy=2 * energy)


def clamped(n=4):
    """n elements over the thickness of an aluminium plate that is clamped at both ends, half of it, under 2 m of water."""
    weight, pressure = 2700 * 9.81, 2 * 1000 * 9.81
    solid = Solid(MeshQuad.init_tensor(0.5 * graded(5 * n, 30, "start"), np.linspace(-0.05, 0, n + 1)),
                  linear(67.5e9, 0.34))
    held = np.concatenate([solid.where(lambda x, y: x < 1e-9, 0, 1), solid.where(lambda x, y: x > 0.5 - 1e-9, 0)])
    load = solid.traction(lambda x: x[1] > -1e-9, 1, lambda x, y: -pressure + 0 * x)
    nodal = (solid.mass(1.0) @ np.ones(solid.size))[1::2]
    load[1::2] -= weight * nodal
    [(_, u)] = solid.statics(load, held, None, [1.0])
    u = u.reshape(-1, 2)
    show(middle=u[solid.node(0.5, -0.025), 1], top=u[solid.node(0.5, 0), 1], below=u[solid.node(0.5, -0.05), 1])


def compression(n=16):
    """n elements along half of the width; a quarter of the block. Rates of stress at the centre, Pa/s."""
    young, nu, half, rise, rate = 7.5e9, 0.398, 0.041, 0.07, 0.00075
    solid = Solid(MeshQuad.init_tensor(half * graded(n, 30, "end"), rise * graded(2 * n, 30, "end")), linear(young, nu))
    for name, directions in (("frictionless", [1]), ("bonded", [0, 1])):
        top = [solid.where(lambda x, y: y > rise - 1e-9, d) for d in directions]
        sides = [solid.where(lambda x, y: y < 1e-9, 1), np.setdiff1d(solid.where(lambda x, y: x < 1e-9, 0), top[0])]
        held = np.concatenate(sides + top)
        given = np.where(np.isin(held, solid.where(lambda x, y: y > rise - 1e-9, 1)), -rate, 0.0)
        for _, u in solid.statics(np.zeros(solid.size), held, lambda t: t * given, [1.0]):
            s = solid.at(u, 0, 0)[1]
            across = nu * np.trace(s)
            mises = np.sqrt((s[0, 0] - s[1, 1]) ** 2 / 2 + (s[1, 1] - across) ** 2 / 2 + (across - s[0, 0]) ** 2 / 2
                            + 3 * s[0, 1] ** 2)
            show(platens=name, stress_yy=s[1, 1], von_mises=mises)


def vibration(n=4):
    """n elements along half of the height; the quarter y > 0, z > 0, of the mode that bends along y."""
    mesh = MeshHex.init_tensor(8.0 * graded(4 * n, 6, "start"), 1.5 * graded(n, 4, "end"), graded(n, 4, "end"))
    solid = Solid(mesh, linear(30e9, 0.3))
    held = [solid.where(lambda x, y, z: x < 1e-9, 0, 1, 2), solid.where(lambda x, y, z: y < 1e-9, 0, 2),
            solid.where(lambda x, y, z: z < 1e-9, 2)]
    show(period=solid.modes(7850.0, np.unique(np.concatenate(held)))[0])


def beam(height, n, law):
    mesh = MeshQuad.init_tensor(0.2 * graded(8 * n, 8, "start"), height * (graded(n, 4) - 0.5))
    solid = Solid(mesh, law(2e6, 0.3975))
    return solid, solid.where(lambda x, y: x < 1e-9, 0, 1)


def modes(n=8):
    """n elements through the thickness, plane strain."""
    for height in (0.02, 0.01):
        solid, held = beam(height, n, linear)
        show(height=height, period=solid.modes(1000.0, held)[0])


def swing(n=4, steps=600):
    """The same plate with large displacements, by the trapezoidal rule, from the first mode of a thin beam."""
    solid, held = beam(0.02, n, logarithmic)
    free, mass = solid.free(held), solid.mass(1000.0)
    mass = mass[free][:, free]
    k = 1.875104
    c, s = np.cos(k) + np.cosh(k), np.sin(k) - np.sinh(k)
    form = lambda a: c * (np.cosh(a) - np.cos(a)) + s * (np.sinh(a) - np.sin(a))
    speed = 0.01 * np.sqrt(2e6 / (3 * (1 - 2 * 0.3975) * 1000))
    u, v = np.zeros(solid.size), np.zeros(solid.size)
    v[1::2] = speed * form(k * solid.places[:, 0] / 0.2) / form(k)
    v, tip, step = v[free], 2 * solid.node(0.2, 0) + 1, 0.13 / steps
    rows, acceleration = [0.0], solve(mass, -solid.internal(u)[1][free])
    while rows[-1] >= 0 and len(rows) < steps + 2:
        old = u[free].copy()
        u[free] += step * v
        for _ in range(9):
            _, force, tangent = solid.internal(u)
            new = 4 / step**2 * (u[free] - old - step * v) - acceleration
            change = solve(4 / step**2 * mass + tangent[free][:, free], -force[free] - mass @ new)
            u[free] += change
            if np.abs(change).max() < 1e-11:
                break
        new = 4 / step**2 * (u[free] - old - step * v) - acceleration
        v, acceleration = v + step / 2 * (acceleration + new), new
        rows.append(u[tip])
    last = len(rows) - 1
    top = int(np.argmax(rows))
    left, mid, right = rows[top - 1:top + 2]
    show(amplitude=mid + (left - right) ** 2 / (16 * mid - 8 * left - 8 * right),
         first_return=step * (last - rows[-1] / (rows[-1] - rows[-2])))


def show(**numbers):
    print("  ".join(f"{name} {value:.7g}" if not isinstance(value, str) else f"{name} {value}"
                    for name, value in numbers.items()), flush=True)


CASES = {"plate": plate, "rubber": rubber, "rubber-stress": lambda *n: rubber(*(n or (10,)), plane_stress=True),
         "rubber-incompressible": lambda *n: rubber(*(n or (10,)), incompressible=True),
         "hole": hole, "cube": cube, "cube-incompressible": lambda *n: cube(*(n or (8,)), incompressible=True), "cantilever": cantilever, "clamped": clamped, "compression": compression, "vibration": vibration,
         "modes": modes, "swing": swing}

if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] not in CASES:
        sys.exit(__doc__)
    CASES[sys.argv[1]](*map(int, sys.argv[2:]))
