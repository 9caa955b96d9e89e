"""The arch of this case by finite elements: python reference.py (needs numpy and scipy).

Half of the arch, quadratic quadrilaterals of nine nodes, total Lagrangian, plane strain, the same
energy of the material. The displacement of the crown is prescribed, and the load factor is the unknown
that goes with it, so that the path has no limit. Prints the load factor at the limit and at the
valley, and displacements of the crown on the way to the limit, for three meshes.
"""

from math import pi

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

HALF, THICKNESS, RISE = 1.0, 0.08, 0.16  # m
YOUNG, POISSON, LOAD = 1e6, 0.3, 200.0  # Pa, 1, Pa at a load factor of 1
MU = YOUNG / (2 * (1 + POISSON))
LAMBDA = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
GAUSS = np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)])
WEIGHTS = np.array([5.0, 8.0, 5.0]) / 9


def line(s):
    """Quadratic shape functions on a line with their slopes."""
    return np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2]), np.array([s - 0.5, -2 * s, s + 0.5])


def mesh(nx, ny):
    x, y = np.linspace(0, HALF, 2 * nx + 1), np.linspace(0, THICKNESS, 2 * ny + 1)
    places = np.array([[a, b + RISE * np.sin(pi * a / (2 * HALF))] for b in y for a in x])
    number = lambda i, j: i + (2 * nx + 1) * j
    cells = [
        [number(2 * i + k, 2 * j + l) for l in range(3) for k in range(3)] for j in range(ny) for i in range(nx)
    ]
    top = [[number(2 * i + k, 2 * ny) for k in range(3)] for i in range(nx)]
    return places, np.array(cells), np.array(top), number(2 * nx, ny)


def path(nx, ny, levels):
    places, cells, top, crown = mesh(nx, ny)
    gradients, volumes = [], []
    for a, wa in zip(GAUSS, WEIGHTS):
        for b, wb in zip(GAUSS, WEIGHTS):
            (na, da), (nb, db) = line(a), line(b)
            slopes = np.stack([np.outer(nb, da).ravel(), np.outer(db, na).ravel()], axis=1)
            jacobian = np.einsum("end,nk->edk", places[cells], slopes)
            gradients.append(np.einsum("nk,ekd->end", slopes, np.linalg.inv(jacobian)))
            volumes.append(wa * wb * np.linalg.det(jacobian))
    g = np.concatenate(gradients)
    v = np.concatenate(volumes)
    cells = np.concatenate([cells] * 9)
    dofs = (2 * cells[:, :, None] + np.arange(2)).reshape(len(cells), -1)
    count = 2 * len(places)
    # A dead load downwards per length at rest.
    load = np.zeros(count)
    for a, wa in zip(GAUSS, WEIGHTS):
        n, d = line(a)
        length = np.linalg.norm(np.einsum("enk,n->ek", places[top], d), axis=1)
        np.add.at(load, 2 * top + 1, -LOAD * wa * length[:, None] * n)
    held = np.concatenate([2 * np.flatnonzero(places[:, 0] == 0), 2 * np.flatnonzero(places[:, 0] == 0) + 1,
                           2 * np.flatnonzero(places[:, 0] == HALF)])
    free = np.setdiff1d(np.arange(count), held)
    probe = 2 * crown + 1
    u, factor, found = np.zeros(count), 0.0, []
    for level in levels:
        for _ in range(60):
            f = np.eye(2) + np.einsum("eni,enj->eij", u.reshape(-1, 2)[cells], g)
            j = np.linalg.det(f)
            inverse = np.linalg.inv(f)
            back = np.swapaxes(inverse, 1, 2)
            stress = MU * (f - back) + (LAMBDA * np.log(j))[:, None, None] * back
            tangent = (
                MU * np.einsum("ik,jl->ijkl", np.eye(2), np.eye(2))[None]
                + LAMBDA * np.einsum("eji,elk->eijkl", inverse, inverse)
                + np.einsum("e,eli,ejk->eijkl", MU - LAMBDA * np.log(j), inverse, inverse)
            )
            inner = np.zeros(count)
            np.add.at(inner, dofs, np.einsum("e,eij,enj->eni", v, stress, g).reshape(len(cells), -1))
            block = np.einsum("e,enj,eijkl,eml->enimk", v, g, tangent, g).reshape(len(cells), 18, 18)
            rows, columns = np.repeat(dofs, 18, axis=1).ravel(), np.tile(dofs, (1, 18)).ravel()
            stiffness = coo_matrix((block.ravel(), (rows, columns)), shape=(count, count)).tocsc()
            left = (factor * load - inner)[free]
            solve = splu(stiffness[free][:, free]).solve
            along, rest = np.zeros(count), np.zeros(count)
            along[free], rest[free] = solve(load[free]), solve(left)
            change = (-level - u[probe] - rest[probe]) / along[probe]
            u += rest + change * along
            factor += change
            if np.linalg.norm(rest + change * along) < 1e-11:
                break
        else:
            raise RuntimeError(f"no equilibrium at {level}")
        found.append(factor)
    return np.array(found)


if __name__ == "__main__":
    levels = np.arange(1, 73) * 0.005
    for nx, ny in [(12, 1), (24, 2), (48, 4)]:
        factors = path(nx, ny, levels)
        curve = CubicSpline(np.append(0, levels), np.append(0, factors))
        turns = curve.derivative().roots(extrapolate=False)
        turns = turns[(turns > 0) & (turns < levels[-1])]
        print(f"{nx} x {ny} elements:", ", ".join(f"load factor {curve(t):.6f} at {t:.6f} m" for t in turns))
        for factor in (0.25, 0.5, 0.75):
            print(f"  crown at {factor} of the load: {curve.solve(factor, extrapolate=False)[0]:.6f} m" if factor < curve(turns[0]) else "")
        print("  last", levels[-1], factors[-1])
