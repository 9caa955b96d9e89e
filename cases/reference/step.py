"""Flow over a backward-facing step by Q2-Q1 finite elements and Newton's method: where it meets the floor again.

`python3 step.py REYNOLDS [n] [before] [behind]` with n elements over the step, a channel of so many steps before it (2) and behind it (20).
The channel is twice as high behind the step. The Reynolds number is that of Armaly et al. (1983): of the mean velocity and twice the height before the step."""

import sys

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import bmat
from scipy.sparse.linalg import splu
from skfem import Basis, ElementQuad1, ElementQuad2, ElementVector, MeshQuad, asm

from cavity import divergence, residual, tangent


def mesh(n, before, behind):
    """Rectangles, finer at the edge of the step and at the walls."""
    half = 0.5 * (1 - np.cos(np.pi * np.arange(n + 1) / n))
    y = np.concatenate([half, 1 + half[1:]])
    away = [0.5 / n]
    while sum(away) < max(before, behind):
        away.append(min(1.1 * away[-1], 2 / n))
    away = np.concatenate([[0], np.cumsum(away)])
    side = lambda length: away[away < length * (1 - 1e-9)].tolist() + [length]
    x = np.array([-a for a in reversed(side(before)[1:])] + side(behind))
    whole = MeshQuad.init_tensor(x, y)
    middle = whole.p[:, whole.t].mean(axis=1)
    return whole.remove_elements(np.flatnonzero((middle[0] < 0) & (middle[1] < 1)))


def step(reynolds, n, before, behind):
    """Basis and velocities, in heights of the step and mean velocities before it."""
    grid = mesh(n, before, behind)
    basis = Basis(grid, ElementVector(ElementQuad2()), intorder=5)
    pressures = basis.with_element(ElementQuad1())
    b = asm(divergence, basis, pressures)
    x, y = basis.doflocs
    left = x < -before + 1e-9
    # All of the boundary but the outlet, where the traction is zero.
    edge = np.unique(basis.get_dofs(grid.boundary_facets()).all())
    edge = edge[(x[edge] < behind - 1e-9) | (y[edge] < 1e-9) | (y[edge] > 2 - 1e-9)]
    along = np.zeros(basis.N, bool)
    along[np.concatenate([basis.nodal_dofs[0], basis.facet_dofs[0], basis.interior_dofs[0]])] = True
    u, p = np.zeros(basis.N), np.zeros(pressures.N)
    u[along & left] = (6 * (y - 1) * (2 - y))[along & left]
    free = np.concatenate([np.setdiff1d(np.arange(basis.N), edge), basis.N + np.arange(pressures.N)])
    for re in [r for r in (1, 50, 100, 200, 300, 400, 500, 600, 700) if r < reynolds] + [reynolds]:
        # The mean velocity is 1, and twice the height before the step 2.
        for _ in range(20):
            old = basis.interpolate(u)
            matrix = bmat([[asm(tangent, basis, old=old, re=re / 2), b.T], [b, None]]).tocsr()
            right = -np.concatenate([asm(residual, basis, old=old, re=re / 2) + b.T @ p, b @ u])
            change = splu(matrix[free][:, free].tocsc()).solve(right[free])
            both = np.concatenate([u, p])
            both[free] += change
            u, p = both[:basis.N], both[basis.N:]
            if np.abs(change).max() < 1e-9:
                break
    return basis, u


def zeros(basis, u, height, behind):
    """Where the velocity along the channel changes sign at a height over the floor."""
    at = lambda x: (basis.probes(np.array([[x], [height]])) @ u)[0]
    places = np.linspace(0.01, behind - 0.01, 400)
    values = (basis.probes(np.array([places, np.full(400, height)])) @ u)[:400]
    changes = np.flatnonzero(values[:-1] * values[1:] < 0)
    return [brentq(at, places[k], places[k + 1]) for k in changes]


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    reynolds, n = int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 16
    before = float(sys.argv[3]) if len(sys.argv) > 3 else 2.0
    behind = float(sys.argv[4]) if len(sys.argv) > 4 else 20.0
    basis, u = step(reynolds, n, before, behind)
    for height in (1e-4, 0.05, 0.1):
        print(f"u = 0 at {height} over the floor: " + ", ".join(f"{x:.4f}" for x in zeros(basis, u, height, behind)))
