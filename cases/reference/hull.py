"""A ship's hull floats in a tank with waves, by linear potential theory: surge, heave and pitch.

The potential phi of the water is harmonic; its normal derivative is d(eta)/dt on the surface, the normal velocity on
hull and piston, and 0 on floor and walls. On the surface d(phi)/dt = -g eta - s phi, s being the rate of the beach. Of
the hull d(M V + rho int phi n dA)/dt = -C x, with its masses M and hydrostatic stiffness C. Quadratic hexahedra in half
of the tank, y > 0, whose side is bent to that of the hull, y = f(x, z).

`python3 hull.py [n] [FILE]` with n elements over the draught, 4 by default, takes the numbers of cases/coupled/hull and
prints the amplitudes within some periods of the case, and those of the steady state over the wave without the hull and
over its slope, with all that piston and beach reflect; to FILE goes the heave against time."""

import sys
from dataclasses import replace

import numpy as np
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementHex2, FacetBasis, LinearForm, MeshHex, MeshHex2, asm
from skfem.helpers import dot, grad

G, RHO = 9.81, 1000.0
# The hull, where it is in the tank, the waves, and the beach with its largest rate over their angular frequency; in m.
LENGTH, BEAM, DRAUGHT, FREEBOARD = 1.2, 0.5, 0.2, 0.15
PLACE, TANK, WIDTH, DEPTH = 1.7, 4.8, 1.1, 0.5
WAVE, HEIGHT, BEACH, STRENGTH = 3.0, 0.14, 2.4, 1.5
# In periods: the growth of the waves, and what is looked at, until the end.
RAMP, WINDOW = 2.0, (3.0, 4.5)

K = 2 * np.pi / WAVE
OMEGA = np.sqrt(G * K * np.tanh(K * DEPTH))
PERIOD = 2 * np.pi / OMEGA
STROKE = HEIGHT * (np.sinh(2 * K * DEPTH) + 2 * K * DEPTH) / (4 * np.sinh(K * DEPTH) ** 2)  # Biesel's


def hydrostatics():
    """Mass, moment of inertia, and height of the centre of mass of a uniform hull; its stiffness in heave and pitch."""
    area, inertia = 6 / 7 * LENGTH * BEAM, BEAM * LENGTH**3 / 18
    under, above = 0.8 * DRAUGHT * area, FREEBOARD * area
    density = RHO * under / (under + above)
    buoyancy = -5 / 12 * DRAUGHT
    center = (under * buoyancy + above * FREEBOARD / 2) / (under + above)
    square = inertia * (0.8 * DRAUGHT + FREEBOARD) + area * (4 / 21 * DRAUGHT**3 + FREEBOARD**3 / 3)
    mass = RHO * under
    turning = density * square - mass * center**2
    stiffness = RHO * G * area, RHO * G * inertia + mass * G * (buoyancy - center)
    return mass, turning, center, stiffness


def half_beam(x, z):
    """y of the side of the hull under water, at x from its middle."""
    along, down = np.clip(1 - (2 * x / LENGTH) ** 6, 0, None), np.clip(1 - (z / DRAUGHT) ** 4, 0, None)
    return BEAM / 2 * along * down


def places(*pieces):
    """Ends of elements: from each place on, elements of about a size, up to the next place."""
    parts = [np.linspace(a, b, max(1, round((b - a) / size)) + 1)[:-1] for (a, size), (b, _) in zip(pieces, pieces[1:])]
    return np.concatenate([*parts, [pieces[-1][0]]])


def water(n, hull):
    """Nodes of the free surface, and matrices of half of the tank with or without the hull in it."""
    fine = DRAUGHT / n
    bow, stern = PLACE - LENGTH / 2, PLACE + LENGTH / 2
    along = places((0, 3 * fine), (bow, 2 * fine), (stern, 3 * fine), (TANK, 0))
    across = places((0, 2 * fine), (WIDTH / 2, 0))
    up = places((-DEPTH, 2 * fine), (-DRAUGHT, fine), (0, 0))
    straight = MeshHex2.from_mesh(MeshHex.init_tensor(along, across, up))
    x, y, z = straight.doflocs
    side = half_beam(x - PLACE, z) * hull
    mesh = replace(straight, doflocs=np.array([x, side + y * (1 - side / (WIDTH / 2)), z]))
    basis = Basis(mesh, ElementHex2())

    def face(axis, place):
        facets = straight.facets_satisfying(lambda p: np.abs(p[axis] - place) < 1e-9, True)
        return FacetBasis(mesh, ElementHex2(), facets=facets)

    top, side, piston = face(2, 0), face(1, 0), face(0, 0)
    laplace = asm(BilinearForm(lambda u, v, w: dot(grad(u), grad(v))), basis).tocsr()
    area = asm(BilinearForm(lambda u, v, w: u * v), top).tocsr()
    into = BilinearForm(lambda u, v, w: u * v * np.clip((w.x[0] - BEACH) / (TANK - BEACH), 0, None) ** 2)
    damping = STRENGTH * OMEGA * asm(into, top).tocsr()
    # What flows into hull and piston as they move; before and behind the hull the plane y = 0 has no n_x and no n_z.
    center = hydrostatics()[2]
    flows = (
        LinearForm(lambda v, w: v * w.n[0]),
        LinearForm(lambda v, w: v * w.n[2]),
        LinearForm(lambda v, w: v * ((w.x[2] - center) * w.n[0] - (w.x[0] - PLACE) * w.n[2])),
    )
    flux = np.array([asm(form, side) for form in flows] + [-asm(LinearForm(lambda v, w: v), piston)]).T
    nodes = np.flatnonzero(area.diagonal() > 1e-12)
    return basis.doflocs[:2, nodes], nodes, laplace, area, damping, flux


class Tank:
    """Water with a piston, and a hull or not, as linear equations of its surface and the hull."""

    def __init__(self, n, hull):
        self.hull = hull
        (self.x, self.y), nodes, laplace, area, damping, flux = water(n, hull)
        inside = np.setdiff1d(np.arange(laplace.shape[0]), nodes)
        solver = splu(laplace[inside][:, inside].tocsc())
        coupling = laplace[inside][:, nodes]
        followed = solver.solve(coupling.toarray())
        driven = solver.solve(flux[inside])
        lift = np.linalg.inv(area[nodes][:, nodes].toarray())
        # d(eta)/dt = rise phi + drive (V, w), rho int phi n dA = take phi + add (V, w); w is the piston's velocity.
        self.rise = lift @ (laplace[nodes][:, nodes].toarray() - coupling.T @ followed)
        self.drive = lift @ (coupling.T @ driven - flux[nodes])
        self.damp = lift @ damping[nodes][:, nodes].toarray()
        self.take = 2 * RHO * (flux[nodes] - coupling.T @ driven).T[:3]
        self.add = 2 * RHO * (flux[inside].T @ driven)[:3]
        mass, turning, _, (heave, pitch) = hydrostatics()
        self.stiffness = np.diag([0.0, heave, pitch])
        self.inverse = hull * np.linalg.inv(np.diag([mass, mass, turning]) + self.add[:, :3])

    def rates(self, states, w):
        """Rates of columns of eta, phi, momentum and position, each with a velocity of the piston."""
        count = len(self.x)
        eta, phi, momentum, place = np.split(states, [count, 2 * count, 2 * count + 3])
        velocity = self.inverse @ (momentum - self.take @ phi - self.add[:, 3:] * w)
        return np.concatenate([
            self.rise @ phi + self.drive @ np.vstack([velocity, w]),
            -G * eta - self.damp @ phi,
            -self.stiffness @ place,
            velocity,
        ])

    def steady(self):
        """Complex amplitudes of eta, and of surge, heave and pitch."""
        size = 2 * len(self.x) + 6
        matrix = self.rates(np.eye(size), np.zeros((1, size)))
        drive = self.rates(np.zeros((size, 1)), np.full((1, 1), STROKE / 2 * OMEGA))
        state = np.linalg.solve(1j * OMEGA * np.eye(size) - matrix, drive)[:, 0]
        return state[: len(self.x)], state[-3:]

    def run(self, steps=200):
        """Rows of the time, the surface beside the middle of the hull, surge, heave and pitch, by Runge and Kutta."""
        dt, state, rows = PERIOD / steps, np.zeros((2 * len(self.x) + 6, 1)), []
        for k in range(round(WINDOW[1] * steps) + 1):
            rows.append([k * dt, state[self.nearest(PLACE), 0], *state[-3:, 0]])
            start, middle, end = (piston((k + part) * dt) for part in (0.0, 0.5, 1.0))
            a = self.rates(state, start)
            b = self.rates(state + dt / 2 * a, middle)
            c = self.rates(state + dt / 2 * b, middle)
            d = self.rates(state + dt * c, end)
            state = state + dt / 6 * (a + 2 * b + 2 * c + d)
        return np.array(rows)

    def nearest(self, x):
        """The node of the surface by the wall that is nearest to x."""
        return np.argmin((self.x - x) ** 2 + (self.y - WIDTH / 2) ** 2)


def piston(t):
    """Velocity of the piston, without its second harmonic."""
    whole = RAMP * PERIOD
    ramp = (1 - np.cos(np.pi * min(t / whole, 1))) / 2
    growth = np.pi / (2 * whole) * np.sin(np.pi * t / whole) * (t < whole)
    return STROKE / 2 * (OMEGA * np.cos(OMEGA * t) * ramp + np.sin(OMEGA * t) * growth)


def amplitudes(rows):
    return np.ptp(rows[rows[:, 0] > WINDOW[0] * PERIOD][:, 1:], axis=0) / 2


if __name__ == "__main__":
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 4
    mass, turning, center, _ = hydrostatics()
    calm, tank = Tank(n, 0), Tank(n, 1)
    added = ", ".join(f"{value:.4f}" for value in np.diag(tank.add) / (mass, mass, turning))
    print(f"period {PERIOD:.5f} s, k a {K * HEIGHT / 2:.4f}, mass {mass:.4f} kg, centre of mass at z = {center:.5f} m")
    print(f"{len(tank.x)} nodes on the surface; added over own masses, without waves: {added}")
    alone, rows = calm.run(), tank.run()
    surge, heave, pitch = amplitudes(rows)[1:]
    print(f"case: wave {amplitudes(alone)[0]:.6f} m, surge {surge:.6f} m, heave {heave:.6f} m, pitch {pitch:.6f} rad")
    eta, (_, heave, pitch) = calm.steady()[0], tank.steady()[1]
    along = np.flatnonzero((abs(calm.x - PLACE) < LENGTH / 2) & (calm.y > WIDTH / 2 - 1e-9))
    slope, own = np.polyfit(calm.x[along] - PLACE, eta[along], 4)[-2:]
    print(f"steady: heave over wave {abs(heave / own):.4f}, pitch over slope {abs(pitch / slope):.4f}")
    if len(sys.argv) > 2:
        np.savetxt(sys.argv[2], rows[::2, [0, 3]], "%.5g", ",", header="time,value", comments="")
