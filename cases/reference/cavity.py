"""The lid-driven cavity by Q2-Q1 finite elements and Newton's method: velocities on its two middle lines.

`python3 cavity.py REYNOLDS [n]` with n elements a side, finer at the walls, prints them at each 0.05 of the side."""

import sys

import numpy as np
from scipy.sparse import bmat
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuad1, ElementQuad2, ElementVector, LinearForm, MeshQuad, asm
from skfem.helpers import ddot, div, dot, grad, mul

from elements import graded


@BilinearForm
def tangent(u, v, w):
    return ddot(grad(u), grad(v)) / w["re"] + dot(mul(grad(u), w["old"]) + mul(grad(w["old"]), u), v)


@BilinearForm
def divergence(u, q, w):
    return -div(u) * q


@LinearForm
def residual(v, w):
    old = w["old"]
    return ddot(grad(old), grad(v)) / w["re"] + dot(mul(grad(old), old), v)


def cavity(reynolds, n):
    """Basis and velocities at each of the Reynolds numbers on the way."""
    places = graded(n, 4)
    mesh = MeshQuad.init_tensor(places, places)
    basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=5)
    pressures = basis.with_element(ElementQuad1())
    b = asm(divergence, basis, pressures)
    x, y = basis.doflocs
    edge = np.flatnonzero((np.minimum(x, y) < 1e-9) | (np.maximum(x, y) > 1 - 1e-9))
    # Velocities are numbered alternately at each node; the lid has all of its edge but the corners.
    along = np.zeros(basis.N, bool)
    along[np.concatenate([basis.nodal_dofs[0], basis.facet_dofs[0], basis.interior_dofs[0]])] = True
    u, p = np.zeros(basis.N), np.zeros(pressures.N)
    u[along & (y > 1 - 1e-9) & (x > 1e-9) & (x < 1 - 1e-9)] = 1
    free = np.concatenate([np.setdiff1d(np.arange(basis.N), edge), basis.N + np.arange(1, pressures.N)])
    for re in [r for r in (100, 400, 700) if r < reynolds] + [reynolds]:
        for _ in range(20):
            old = basis.interpolate(u)
            matrix = bmat([[asm(tangent, basis, old=old, re=re), b.T], [b, None]]).tocsr()
            right = -np.concatenate([asm(residual, basis, old=old, re=re) + b.T @ p, b @ u])
            change = splu(matrix[free][:, free].tocsc()).solve(right[free])
            both = np.concatenate([u, p])
            both[free] += change
            u, p = both[:basis.N], both[basis.N:]
            if np.abs(change).max() < 1e-10:
                break
    return basis, u


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    basis, u = cavity(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 32)
    places = np.linspace(0, 1, 21)
    middle = np.full(21, 0.5)
    values = basis.probes(np.concatenate([[middle, places], [places, middle]], axis=1)) @ u
    # Both directions of all places, the first direction first.
    values = values.reshape(2, 42)
    for k, s in enumerate(places):
        print(f"{s:.2f}  u on x = 0.5: {values[0, k]:+.6f}  v on y = 0.5: {values[1, 21 + k]:+.6f}")
