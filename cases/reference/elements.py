"""Finite elements with quadratic shape functions (Q2) for solids: laws, Newton's method, modes.

Deformation gradients are arrays of the shape (dimension, dimension, element, integration point), tangents
have two axes more in front. Nothing here is shared with piola."""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import eigsh, splu
from skfem import Basis, ElementHex1, ElementHex2, ElementQuad1, ElementQuad2, FacetBasis, LinearForm, asm


def lame(young, poisson):
    return young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))


def inverse(f):
    """Determinant and transposed inverse."""
    moved = np.moveaxis(f, (0, 1), (-2, -1))
    return np.linalg.det(moved), np.moveaxis(np.linalg.inv(moved), (-1, -2), (0, 1))


def products(f, g):
    """The tangents of F, of the transposed inverse G, and G times the trace of G^T dF."""
    one = np.eye(len(f))
    return (np.einsum("ik,jl->ijkl", one, one)[..., None, None],
            -np.einsum("il...,kj...->ijkl...", g, g), np.einsum("ij...,kl...->ijkl...", g, g))


def linear(young, poisson):
    """Hooke's law of small strains; in two dimensions plane strain."""
    lam, mu = lame(young, poisson)

    def law(f):
        one = np.eye(len(f))
        tangent = (lam * np.einsum("ij,kl->ijkl", one, one) + mu * np.einsum("ik,jl->ijkl", one, one)
                   + mu * np.einsum("il,jk->ijkl", one, one))
        h = f - one[..., None, None]
        stress = np.einsum("ijkl,kl...->ij...", tangent, h)
        return np.einsum("ij...,ij...->...", stress, h) / 2, stress, tangent[..., None, None]
    return law


def logarithmic(young, poisson, plane_stress=False):
    """psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2; in two dimensions plane strain or plane stress."""
    lam, mu = lame(young, poisson)

    def law(f):
        j, g = inverse(f)
        log, across, trace = np.log(j), np.ones_like(j), lam
        if plane_stress:
            # The stretch across is that of mu (s^2 - 1) + lambda ln (J s) = 0.
            for _ in range(40):
                across = across - (mu * (across**2 - 1) + lam * np.log(j * across)) / (2 * mu * across + lam / across)
                across = np.maximum(across, 1e-3)
            log = np.log(j * across)
            trace = lam * 2 * mu * across**2 / (2 * mu * across**2 + lam)
        energy = mu / 2 * ((f**2).sum((0, 1)) + (3 - len(f)) * across**2 - 3) - mu * log + lam / 2 * log**2
        df, dg, gg = products(f, g)
        return energy, mu * f + (lam * log - mu) * g, mu * df + (lam * log - mu) * dg + trace * gg
    return law


def neo_hookean(young, poisson):
    """psi = kappa/2 (J - 1)^2 + mu/2 (J^(-2/3) I1 - 3), in three dimensions."""
    lam, mu = lame(young, poisson)
    kappa = lam + 2 * mu / 3

    def law(f):
        j, g = inverse(f)
        stress, tangent = neo_hookean_shear(mu, f, j, g)
        _, dg, gg = products(f, g)
        p = kappa * j * (j - 1)
        energy = kappa / 2 * (j - 1) ** 2 + mu / 2 * (j ** (-2 / 3) * (f**2).sum((0, 1)) - 3)
        return energy, stress + p * g, tangent + p * dg + kappa * j * (2 * j - 1) * gg
    return law


def neo_hookean_shear(mu, f, j, g):
    """Stress and tangent of mu/2 (J^(-2/3) I1 - 3)."""
    first, m = (f**2).sum((0, 1)), mu * j ** (-2 / 3)
    df, dg, gg = products(f, g)
    fg = np.einsum("ij...,kl...->ijkl...", f, g)
    tangent = (m * df - m * first / 3 * dg + 2 / 9 * m * first * gg
               - 2 / 3 * m * (fg + np.einsum("klij...->ijkl...", fg)))
    return m * f - m * first / 3 * g, tangent


def mixed_logarithmic(young, poisson):
    """The law of `logarithmic` in plane strain with the pressure p of its own: p ln J - p^2/(2 lambda) for lambda/2 (ln J)^2."""
    lam, mu = lame(young, poisson)

    def law(f, p):
        j, g = inverse(f)
        df, dg, _ = products(f, g)
        return mu * f + (p - mu) * g, mu * df + (p - mu) * dg, np.log(j) - p / lam, g
    return law, lam


def mixed_neo_hookean(young, poisson):
    """The law of `neo_hookean` with p (J - 1) - p^2/(2 kappa) for kappa/2 (J - 1)^2."""
    lam, mu = lame(young, poisson)
    kappa = lam + 2 * mu / 3

    def law(f, p):
        j, g = inverse(f)
        stress, tangent = neo_hookean_shear(mu, f, j, g)
        _, dg, gg = products(f, g)
        return stress + p * j * g, tangent + p * j * (dg + gg), j - 1 - p / kappa, j * g
    return law, kappa


class Solid:
    """A mesh and a law. Displacements have the shape (node, direction), flat in the vectors here."""

    def __init__(self, mesh, law):
        self.mesh, self.law, self.dim = mesh, law, mesh.dim()
        self.element = ElementQuad2() if self.dim == 2 else ElementHex2()
        self.basis = Basis(mesh, self.element, intorder=4 if self.dim == 3 else 5)
        self.places = self.basis.doflocs.T
        self.size = self.moving = self.dim * self.basis.N
        self.gradients = np.array([field[0].grad for field in self.basis.basis])
        self.shapes = np.array([np.broadcast_to(field[0].value, self.basis.dx.shape) for field in self.basis.basis])
        nodes = self.basis.element_dofs
        self.dofs = (self.dim * nodes[:, None] + np.arange(self.dim)[:, None]).reshape(-1, nodes.shape[1])

    def node(self, *place):
        return int(np.argmin(((self.places - np.array(place)) ** 2).sum(1)))

    def where(self, condition, *directions):
        """Degrees of freedom in these directions of the nodes for which the condition holds."""
        nodes = np.flatnonzero(condition(*self.places.T))
        return np.concatenate([self.dim * nodes + d for d in directions])

    def deformation(self, u, gradients=None, nodes=None):
        gradients = self.gradients if gradients is None else gradients
        nodes = self.basis.element_dofs if nodes is None else nodes
        local = u[:self.moving].reshape(-1, self.dim)[nodes]
        return np.einsum("aei,ajeq->ijeq", local, gradients) + np.eye(self.dim)[..., None, None]

    def traction(self, condition, direction, value):
        """Nodal forces of a dead traction on the facets whose middle meets the condition."""
        facets = self.mesh.facets_satisfying(condition, boundaries_only=True)
        basis = FacetBasis(self.mesh, self.element, facets=facets, intorder=6)
        force = np.zeros(self.size)
        force[direction:self.moving:self.dim] = asm(LinearForm(lambda v, w: value(*w.x) * v), basis)
        return force

    def assemble(self, values, rows=None, columns=None):
        rows = np.broadcast_to((self.dofs if rows is None else rows)[:, None], values.shape)
        columns = np.broadcast_to((self.dofs if columns is None else columns)[None], values.shape)
        return coo_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=(self.size,) * 2).tocsc()

    def internal(self, u):
        """Strain energy, nodal forces and tangent."""
        energy, stress, tangent = self.law(self.deformation(u))
        return (energy * self.basis.dx).sum(), *self.integrated(stress, tangent)

    def integrated(self, stress, tangent):
        """Nodal forces and the matrix of their changes."""
        d, (a, _, e, q) = self.dim, self.gradients.shape
        force = np.einsum("ijeq,ajeq,eq->aie", stress, self.gradients, self.basis.dx).reshape(a * d, e)
        forces = np.zeros(self.size)
        np.add.at(forces, self.dofs, force)
        g = self.gradients.transpose(2, 0, 3, 1).reshape(e, a, q * d)
        t = np.broadcast_to(tangent, (d,) * 4 + (e, q)) * self.basis.dx
        right = t.transpose(4, 5, 0, 2, 1, 3) @ self.gradients.transpose(2, 3, 1, 0)[:, :, None, None]
        right = right.transpose(0, 1, 4, 2, 3, 5).reshape(e, q * d, d * d * a)
        values = (g @ right).reshape(e, a, d, d, a).transpose(1, 2, 4, 3, 0).reshape(a * d, a * d, e)
        return forces, self.assemble(values)

    def mass(self, density):
        scalar = density * np.einsum("aeq,beq,eq->abe", self.shapes, self.shapes, self.basis.dx)
        a, _, e = scalar.shape
        values = np.einsum("abe,ik->aibke", scalar, np.eye(self.dim)).reshape(a * self.dim, a * self.dim, e)
        return self.assemble(values)

    def free(self, held):
        return np.setdiff1d(np.arange(self.size), held)

    def statics(self, load, held, path, steps, tolerance=1e-10):
        """Newton's method along a load factor t up to each of `steps`, halved where it fails.

        `path(t)` are the displacements of the degrees of freedom `held`, `load` the forces at t = 1."""
        free, u, t = self.free(held), np.zeros(self.size), 0.0
        for end in steps:
            step = end - t
            while t < end - 1e-12:
                step = min(step, end - t)
                new = self.newton(u, free, held, path(t + step) if path else 0.0, (t + step) * load, tolerance)
                if new is None:
                    step /= 2
                    assert step > 1e-6, "no equilibrium"
                else:
                    u, t, step = new, t + step, 1.5 * step
            yield t, u

    def newton(self, u, free, held, prescribed, load, tolerance):
        u = u.copy()
        change = np.zeros(self.size)
        change[held] = prescribed - u[held]
        for _ in range(14):
            _, force, tangent = self.internal(u)
            residual = (load - force - tangent @ change)[free]
            change[free] = solve(tangent[free][:, free], residual)
            u += change
            moved = np.abs(change[:self.moving]).max()
            if not np.all(np.isfinite(u)) or moved > 10 * np.abs(self.places).max() \
                    or np.linalg.det(np.moveaxis(self.deformation(u), (0, 1), (-2, -1))).min() <= 0:
                return None
            if moved < tolerance * np.abs(u[:self.moving]).max():
                return u
            change[:] = 0
        return None

    def modes(self, density, held, number=1):
        """Periods of the lowest modes."""
        free = self.free(held)
        _, _, stiffness = self.internal(np.zeros(self.size))
        values = eigsh(stiffness[free][:, free], number, self.mass(density)[free][:, free], sigma=0.0,
                       return_eigenvectors=False)
        return 2 * np.pi / np.sqrt(np.sort(values))

    def at(self, u, *place):
        """Deformation gradient and nominal stress at a node, in the first element that has it."""
        local, element = np.argwhere(self.basis.element_dofs == self.node(*place))[0]
        corner = self.element.doflocs[local][:, None]
        basis = Basis(self.mesh, self.element, quadrature=(corner, np.ones(1)), elements=np.array([element]))
        gradients = np.array([field[0].grad for field in basis.basis])
        f = self.deformation(u, gradients, self.basis.element_dofs[:, [element]])
        return f[..., 0, 0], self.law(f)[1][..., 0, 0]


class Mixed(Solid):
    """With continuous linear pressures (Q2-Q1, Taylor and Hood) behind the displacements, for laws of the form above."""

    def __init__(self, mesh, law):
        super().__init__(mesh, law[0])
        self.bulk = law[1]
        pressures = self.basis.with_element(ElementQuad1() if self.dim == 2 else ElementHex1())
        self.linear = np.array([np.broadcast_to(field[0].value, self.basis.dx.shape) for field in pressures.basis])
        self.pressures = self.moving + pressures.element_dofs
        self.size += pressures.N

    def internal(self, u):
        """No energy; forces, behind them what is missing of the volumes, and the matrix."""
        p = np.einsum("ae,aeq->eq", u[self.pressures], self.linear)
        stress, tangent, gap, slope = self.law(self.deformation(u), p)
        forces, matrix = self.integrated(stress, tangent)
        np.add.at(forces, self.pressures, np.einsum("aeq,eq,eq->ae", self.linear, gap, self.basis.dx))
        coupling = np.einsum("beq,ijeq,ajeq,eq->aibe", self.linear, slope, self.gradients, self.basis.dx)
        coupling = coupling.reshape(-1, *coupling.shape[2:])
        across = self.assemble(coupling, self.dofs, self.pressures)
        mass = np.einsum("aeq,beq,eq->abe", self.linear, self.linear, self.basis.dx)
        own = self.assemble(-mass / self.bulk, self.pressures, self.pressures)
        return None, forces, (matrix + across + across.T + own).tocsc()


def solve(matrix, right):
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01,
                options={"SymmetricMode": True}).solve(right)


def graded(n, ratio, ends="both"):
    """Places 0 to 1 of n + 1 nodes, finer by `ratio` at the end, at the start, or at both ends."""
    if ends == "both":
        half = graded(n // 2, ratio, "start") / 2
        return np.concatenate([half, (1 - half[::-1])[1:]])
    sizes = np.geomspace(1, ratio, n)
    places = np.concatenate([[0], np.cumsum(sizes) / sizes.sum()])
    return places if ends == "start" else 1 - places[::-1]
