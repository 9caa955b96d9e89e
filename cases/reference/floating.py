"""Heave of a box that floats in a tank of water, by linear potential theory: natural periods and the motion after release.

The water is incompressible and has small waves. With the surface elevation eta and the heave z of the box as
coordinates, its kinetic energy is that of the harmonic potential whose normal derivative is d(eta)/dt on the surface and dz/dt below
the box, and the potential energy is rho g/2 (int eta^2 dA + A z^2). Quadratic hexahedra on a quarter of the tank.

`python3 floating.py LENGTH DEPTH EDGE DRAUGHT [n]` with lengths in m, the edge of a square box in the middle of a square tank
and n elements over half of it prints periods in s, and the heave of a box that is let go 1 m too high (the problem is linear)."""

import sys

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementHex2, FacetBasis, LinearForm, MeshHex, asm
from skfem.helpers import dot, grad

G = 9.81


def joined(middle, end, n):
    """Places from 0 to the end in n elements up to the middle, and as long ones behind it."""
    behind = max(1, round(n * (end - middle) / middle))
    return np.concatenate([np.linspace(0, middle, round(n) + 1), np.linspace(middle, end, behind + 1)[1:]])


def matrices(length, depth, box, draught, n):
    """Nodes of the free surface, and for unit fluxes at them and at the bottom of the box the potential there."""
    half = box / 2
    across = joined(half, length / 2, n)
    low = depth - draught
    up = joined(low, depth, n * low / half)
    mesh = MeshHex.init_tensor(across, across, up)
    middle = mesh.p[:, mesh.t].mean(1)
    solid = (middle[2] > low) & (middle[0] < half) & (middle[1] < half)
    mesh = mesh.remove_elements(np.flatnonzero(solid))
    element = ElementHex2()
    basis = Basis(mesh, element)
    laplace = asm(BilinearForm(lambda u, v, w: dot(grad(u), grad(v))), basis).tocsc()
    surface = FacetBasis(mesh, element, facets=mesh.facets_satisfying(lambda x: x[2] > depth - 1e-9, True))
    bottom = FacetBasis(mesh, element, facets=mesh.facets_satisfying(
        lambda x: (np.abs(x[2] - low) < 1e-9) & (x[0] < half) & (x[1] < half), True))
    area = asm(BilinearForm(lambda u, v, w: u * v), surface).tocsc()
    nodes = np.flatnonzero(area.diagonal() > 1e-12 * area.diagonal().max())
    push = asm(LinearForm(lambda v, w: 1.0 * v), bottom)
    return laplace, area[nodes][:, nodes].toarray(), nodes, push


def modes(length, depth, box, draught, n):
    """Periods of the modes that keep the volume, and their shares in the heave after release."""
    laplace, area, nodes, push = matrices(length, depth, box, draught, n)
    count = len(nodes)
    # Fluxes of each coordinate; downwards into the box where it rises, so that the water follows.
    flux = np.zeros((laplace.shape[0], count + 1))
    flux[nodes, :count] = area
    flux[:, count] = push
    # Motions that keep the volume: the box goes where the water leaves room.
    totals = flux.sum(0)
    basis = np.vstack([np.eye(count), -totals[:count] / totals[count]])
    # The potential is free by a constant: nothing flows, so that a node may be held.
    held = coo_matrix(([abs(laplace).max()], ([0], [0])), shape=laplace.shape)
    potential = splu((laplace + held).tocsc()).solve(flux @ basis)
    kinetic = (flux @ basis).T @ potential
    section = totals[count]
    mass = section * draught
    kinetic += mass * np.outer(basis[count], basis[count])
    stiffness = G * (basis[:count].T @ area @ basis[:count] + section * np.outer(basis[count], basis[count]))
    values, shapes = eigh(stiffness, (kinetic + kinetic.T) / 2)
    start = np.zeros(count + 1)
    # Let go: the box 1 m high, the surface flat and so much lower.
    start[count] = 1.0
    start[:count] = -section / totals[:count].sum()
    amplitudes = shapes.T @ stiffness @ start[:count] / values
    return 2 * np.pi / np.sqrt(values), amplitudes * (basis[count] @ shapes)


if __name__ == "__main__":
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    length, depth, box, draught = map(float, sys.argv[1:5])
    n = int(sys.argv[5]) if len(sys.argv) > 5 else 2
    periods, shares = modes(length, depth, box, draught, n)
    order = np.argsort(-abs(shares))[:6]
    print("modes with the largest shares of the heave:")
    for k in order:
        print(f"  period {periods[k]:.5f} s, share {shares[k]:.5f}")
    t = np.linspace(0, 12, 12001)
    z = (shares[:, None] * np.cos(2 * np.pi * t / periods[:, None])).sum(0)
    turns = np.flatnonzero((z[1:-1] - z[:-2]) * (z[2:] - z[1:-1]) < 0) + 1
    print("sum of shares", shares.sum())
    print("extrema:", ", ".join(f"{z[k]:.4f} at {t[k]:.3f} s" for k in turns[:6]))
