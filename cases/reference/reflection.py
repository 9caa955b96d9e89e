"""What an open boundary reflects of a pulse of sound, by a linear model of plane waves on a square lattice.

    python3 reflection.py [width ...]

Widths are in spacings. The model has the sums of the fluid over a lattice in 2D with the quintic spline, h = dx = rho0 = c = 1, its
diffusion of pressure and its kick, drift, kick; the buffers have theory (86) to (88) without Q', and a lag of p_i after Q. Printed
are the highest and the lowest pressure when both halves of a pulse of 1 have left and reflections are halfway to the middle, in
thousandths."""

import sys

import numpy as np

REACH = 3
LAYERS = 4
ROWS = np.arange(-REACH, REACH + 1)
OFFSETS = np.arange(-REACH, REACH + 1)
LAGS = (0.0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 1.0)


def quintic(q, power, factor):
    terms = ((3, 1), (2, -6), (1, 15))
    return 7 / (478 * np.pi) * factor * sum(sign * np.maximum(n - q, 0) ** power for n, sign in terms)


def sums(alpha):
    """Coefficients by the offset along x, summed over rows of the lattice: kernel, slope and diffusion."""
    x, y = np.meshgrid(OFFSETS, ROWS, indexing="ij")
    r = np.hypot(x, y)
    value, slope = quintic(r, 5, 1), quintic(r, 4, -5)
    far = np.where(r > 0, r, 1)
    diffusion = alpha / 8 * 2 / (r**2 + 0.01) * slope * r
    return value.sum(1), (slope * x / far).sum(1), diffusion.sum(1)


def pulse(width, lag, alpha=0.5, cfl=0.25, mach=0.03):
    """The highest and the lowest pressure at the end."""
    kernel, slope, diffusion = sums(alpha)
    count = 10 * width
    fluid = np.arange(LAYERS, LAYERS + count)
    x = np.arange(count + 2 * LAYERS) - LAYERS + 0.5
    p, u = np.exp(-(((x - count / 2) / width) ** 2)), np.zeros_like(x)
    step = cfl / (1 + mach)
    ends = ((-1, np.arange(LAYERS)), (1, np.arange(LAYERS) + LAYERS + count))
    mean, late = np.zeros(2), np.zeros(2)

    def fill():
        for end, (outward, buffer) in enumerate(ends):
            seen = {}
            for a in buffer:
                near = [b for b in range(a - REACH, a + REACH + 1) if b in range(LAYERS, LAYERS + count)]
                weights = np.array([kernel[a - b + REACH] for b in near])
                if weights.sum() > 1e-12:
                    seen[a] = weights @ p[near] / weights.sum()
            mean[end] = np.mean(list(seen.values()))
            if lag == 0:
                late[end] = mean[end]
            for a in buffer:
                p[a] = seen.get(a, mean[end]) - (mean[end] - late[end])
                u[a] = outward * mean[end]

    def total(coefficients, pair):
        return sum(c * pair(fluid, fluid - o) for o, c in zip(OFFSETS, coefficients) if o)

    def acceleration():
        return -total(slope, lambda a, b: p[a] + p[b])

    fill()
    a = acceleration()
    for _ in range(int(0.75 * count / step)):
        u[fluid] += step / 2 * a
        fill()
        rate = total(slope, lambda a, b: u[a] - u[b]) + total(diffusion, lambda a, b: p[a] - p[b])
        p[fluid] += step * rate
        if lag > 0:
            late += (mean - late) * min(1, step / lag)
        fill()
        a = acceleration()
        u[fluid] += step / 2 * a
    return p[fluid].max(), p[fluid].min()


if __name__ == "__main__":
    for width in [int(width) for width in sys.argv[1:]] or (8, 16, 32):
        for lag in LAGS:
            highest, lowest = pulse(width, lag)
            print(f"width {width}, lag {lag} h/c: {1e3 * highest:6.2f} {1e3 * lowest:6.2f}")
