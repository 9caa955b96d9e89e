"""Steady waves on water of even depth, by Fenton's Fourier method: Rienecker and Fenton (1981), Fenton (1988).

    python3 steady.py LENGTH HEIGHT [PARTICLES]

in depths. Prints the coefficients of the velocity u = sum_j U_j cosh(j k y) / cosh(j k d) cos(j k (x - c t)), v with sinh and
sin, in sqrt(g d), the speed in a frame without mean current, crest and trough, and energies. With a number of particles over the depth it
writes the points of a case: columns of particles up to the surface."""

import math
import sys


def solve(matrix, right):
    """Gauss elimination with pivots."""
    n = len(right)
    rows = [row[:] + [right[i]] for i, row in enumerate(matrix)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(i + 1, n):
            factor = rows[r][i] / rows[i][i]
            if factor:
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][j] * x[j] for j in range(i + 1, n))) / rows[i][i]
    return x


class Wave:
    """Depth and gravity are 1. Unknowns: surface at N + 1 places of half a wavelength, B_1 to B_N, mean speed, Q, R."""

    def __init__(self, length, height, terms=12):
        self.k, self.n = 2 * math.pi / length, terms
        k, n = self.k, terms
        speed = math.sqrt(math.tanh(k) / k)
        first = 0.01 * height
        z = [1 + 0.5 * first * math.cos(m * math.pi / n) for m in range(n + 1)]
        z += [0.5 * first / (speed * math.tanh(k)) * 1.0] + [0.0] * (n - 1)
        z += [speed, speed, 1 + 0.5 * speed**2]
        for part in (0.01, 0.2, 0.4, 0.6, 0.8, 1.0):
            for _ in range(30):
                f = self.residual(z, part * height)
                jacobian = []
                for j in range(len(z)):
                    y = z[:]
                    y[j] += 1e-7
                    jacobian.append([(a - b) / 1e-7 for a, b in zip(self.residual(y, part * height), f)])
                step = solve([list(row) for row in zip(*jacobian)], [-v for v in f])
                z = [a + b for a, b in zip(z, step)]
                if max(abs(v) for v in step) < 1e-12:
                    break
        self.eta, self.b, self.speed = z[: n + 1], z[n + 1 : 2 * n + 1], z[2 * n + 1]
        self.bernoulli = z[2 * n + 3]
        self.u = [(j + 1) * k * b for j, b in enumerate(self.b)]

    def residual(self, z, height):
        n, k = self.n, self.k
        eta, b, (speed, q, r) = z[: n + 1], z[n + 1 : 2 * n + 1], z[2 * n + 1 :]
        out = []
        for m in range(n + 1):
            psi, u, v = -speed * eta[m], -speed, 0.0
            for j in range(1, n + 1):
                s, c = math.sinh(j * k * eta[m]) / math.cosh(j * k), math.cosh(j * k * eta[m]) / math.cosh(j * k)
                angle = j * m * math.pi / n
                psi += b[j - 1] * s * math.cos(angle)
                u += j * k * b[j - 1] * c * math.cos(angle)
                v += j * k * b[j - 1] * s * math.sin(angle)
            out += [psi + q, 0.5 * (u * u + v * v) + eta[m] - r]
        mean = (0.5 * (eta[0] + eta[n]) + sum(eta[1:n])) / n
        return out + [mean - 1, eta[0] - eta[n] - height]

    def surface(self, x):
        """By the cosine series through the places."""
        n = self.n
        total = 0.0
        for j in range(n + 1):
            a = sum(
                (0.5 if m in (0, n) else 1.0) * self.eta[m] * math.cos(j * m * math.pi / n) for m in range(n + 1)
            ) * 2 / n
            total += (0.5 if j in (0, n) else 1.0) * a * math.cos(j * self.k * x)
        return total

    def velocity(self, x, y):
        u = v = 0.0
        for j in range(1, self.n + 1):
            a, k = self.u[j - 1] / math.cosh(j * self.k), j * self.k
            u += a * math.cosh(k * y) * math.cos(k * x)
            v += a * math.sinh(k * y) * math.sin(k * x)
        return u, v

    def kinetic(self, over=200):
        """Of a wavelength, for a density of 1."""
        length, total = 2 * math.pi / self.k, 0.0
        for i in range(over):
            x = (i + 0.5) * length / over
            eta = self.surface(x)
            for j in range(over):
                u, v = self.velocity(x, (j + 0.5) * eta / over)
                total += 0.5 * (u * u + v * v) * eta / over * length / over
        return total


def main():
    length, height = float(sys.argv[1]), float(sys.argv[2])
    wave = Wave(length, height)
    print("speed", f"{wave.speed:.8f}", "Bernoulli", f"{wave.bernoulli:.8f}")
    print("crest, trough", f"{wave.eta[0]:.8f} {wave.eta[-1]:.8f}")
    print("U", " ".join(f"{u:.8f}" for u in wave.u))
    energy, less = wave.kinetic(), Wave(length, 0.98 * height).kinetic()
    print("kinetic energy", f"{energy:.8f}", "at 0.98 of the height", f"{less / energy:.6f} of it")
    if len(sys.argv) > 3:
        over = int(sys.argv[3])
        dx = 1 / over
        with open(f"points-{over}.csv", "w") as file:
            file.write("x,y,volume\n")
            for i in range(round(length / dx)):
                x = (i + 0.5) * dx
                eta = wave.surface(x)
                n = round(eta / dx)
                for j in range(n):
                    file.write(f"{x:.7g},{(j + 0.5) * eta / n:.5f},{dx * eta / n:.5e}\n")


main()
