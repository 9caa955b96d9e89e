"""Collapse of a column of water as potential flow: where its toe is, by boundary elements.

Incompressible, inviscid, without surface tension; the wall x = 0 and the bed y = 0 are mirrors, so that the free surface
is the only boundary. The complex potential beta = phi + i psi is linear along straight panels, and Cauchy's integral
gives psi on the surface from phi. The surface moves with the water and phi by Bernoulli's equation (mixed Eulerian and
Lagrangian), in steps of Runge-Kutta of fourth order, with new nodes after each. The upper corner is rounded.

`python3 potential_flow.py HEIGHT/WIDTH WIDTH [panels] [rounding]` prints time and toe for g = 9.81 m/s2, in m and s."""

import sys

import numpy as np
from scipy.interpolate import CubicSpline

G = 9.81


def mirrored(z, odd=None):
    """The closed curve of four images, anticlockwise from the toe, and likewise an even or an odd function."""
    if odd is None:
        return np.concatenate([z, -z[-2::-1].conj(), -z[1:], z[-2:0:-1].conj()])
    a = -1 if odd else 1
    return np.concatenate([z, a * z[-2::-1], z[1:], a * z[-2:0:-1]])


def along(z):
    """Length along the closed curve, by its polygon."""
    return np.concatenate([[0], np.cumsum(np.abs(np.diff(np.append(mirrored(z), z[0]))))])


def derivative(s, values, n):
    return CubicSpline(s, np.append(values, values[0]), bc_type="periodic")(s[:n], 1)


def stream_function(z, phi):
    """psi at the nodes, zero on wall and bed, from phi there."""
    n, full = len(z), mirrored(z)
    count = len(full)
    start, size = full, np.roll(full, -1) - full
    inner = np.arange(1, n - 1)
    to = start[None] - z[inner, None]
    rows = np.arange(len(inner))
    after = np.roll(to, -1, axis=1)
    to[rows, inner], after[rows, inner - 1] = 1, 1
    log = np.log(after / to)
    # Panels that end in the node itself leave nothing: beta is linear there.
    log[rows, inner] = log[rows, inner - 1] = 0
    share = (z[inner, None] - start[None]) / size[None]
    matrix = (1 - share) * log + np.roll(share * log, 1, axis=1)
    matrix[rows, inner] -= log.sum(1)
    index = np.concatenate([np.arange(n), np.arange(n - 2, -1, -1), np.arange(1, n), np.arange(n - 2, 0, -1)])
    sign = mirrored(np.ones(n), odd=True)
    even, odd = np.zeros((len(inner), n)), np.zeros((len(inner), n))
    np.add.at(even.T, index, matrix.real.T)
    np.add.at(odd.T, index, (matrix.imag * sign).T)
    psi = np.zeros(n)
    psi[inner] = np.linalg.solve(odd[:, inner], even @ phi)
    return psi


def rates(state):
    z, phi = state
    phi = phi.real
    s = along(z)
    n = len(z)
    beta = mirrored(phi, odd=False) + 1j * mirrored(stream_function(z, phi), odd=True)
    velocity = (derivative(s, beta, n) / derivative(s, mirrored(z), n)).conj()
    velocity[0], velocity[-1] = velocity[0].real, 1j * velocity[-1].imag
    return np.array([velocity, abs(velocity) ** 2 / 2 - G * z.imag])


def renewed(state, panels, width):
    """The same curve with nodes that are up to four times closer near the toe."""
    z, phi = state
    s, n = along(z), len(z)
    curve = CubicSpline(s, np.append(mirrored(z), z[0]), bc_type="periodic")
    potential = CubicSpline(s, np.append(mirrored(phi.real, odd=False), phi[0].real), bc_type="periodic")
    fine = np.linspace(0, s[n - 1], 4000)
    weight = 1 / (0.2 + np.minimum(fine / width, 0.6))
    count = np.concatenate([[0], np.cumsum((weight[1:] + weight[:-1]) / 2 * np.diff(fine))])
    place = np.interp(np.linspace(0, count[-1], panels + 1), count, fine)
    z, phi = curve(place), potential(place)
    z[0], z[-1] = z[0].real, 1j * z[-1].imag
    return np.array([z, phi])


def balances(state):
    """Volume and energy over density, per m across."""
    z, phi = state
    phi, dy, x = phi.real, np.diff(z.imag), z.real
    mean = lambda f: (f[1:] + f[:-1]) / 2
    kinetic = np.sum(mean(phi) * np.diff(stream_function(z, phi))) / 2
    return np.sum(mean(x) * dy), abs(kinetic) + G * np.sum(mean(x * z.imag) * dy)


def collapse(aspect, width, panels, rounding, end):
    """Rows of time and toe, and volume and energy at start and end."""
    radius, height = rounding * width, aspect * width
    angle = np.linspace(0, np.pi / 2, 200)
    corner = width - radius + 1j * (height - radius) + radius * np.exp(1j * angle)
    outline = np.concatenate([width + 1j * np.linspace(0, height - radius, 800)[:-1], corner,
                              np.linspace(width - radius, 0, 800)[1:] + 1j * height])
    length = np.concatenate([[0], np.cumsum(np.abs(np.diff(outline)))])
    pick = np.linspace(0, length[-1], 4 * panels + 1)
    z = np.interp(pick, length, outline.real) + 1j * np.interp(pick, length, outline.imag)
    state = renewed(np.array([z, 0 * z]), panels, width)
    place = np.linspace(0, len(z) - 1, panels + 1)
    t, rows, before = 0.0, [(0.0, width)], balances(state)
    while t < end:
        k1 = rates(state)
        gaps = np.abs(np.diff(state[0]))
        step = min(0.35 * (gaps / (1e-9 + np.abs(np.diff(k1[0])) + 0.15 * np.abs(k1[0][1:]))).min(),
                   0.4 * np.sqrt(gaps.min() / G), 0.01 * np.sqrt(width / G), end - t + 1e-12)
        k2 = rates(state + step / 2 * k1)
        k3 = rates(state + step / 2 * k2)
        k4 = rates(state + step * k3)
        state = renewed(state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4), panels, width)
        t += step
        rows.append((t, state[0][0].real))
    return np.array(rows), np.array([before, balances(state)])


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    aspect, width = float(sys.argv[1]), float(sys.argv[2])
    panels = int(sys.argv[3]) if len(sys.argv) > 3 else 80
    rounding = float(sys.argv[4]) if len(sys.argv) > 4 else 0.06
    end = 3.2 * np.sqrt(width / (2 * G)) if aspect > 1 else 1.0
    rows, books = collapse(aspect, width, panels, rounding, end)
    toe = CubicSpline(*rows.T)
    for t in np.arange(0.1, end + 1e-9, 0.1):
        print(f"t {t:.1f}  toe {toe(t):.4f}")
    volume, energy = books[1] / books[0] - 1
    print(f"volume {volume:+.2e}, energy {energy:+.2e} of it at the end")
