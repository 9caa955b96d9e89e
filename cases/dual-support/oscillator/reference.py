"""One mass on one spring by the integrators of this case: python reference.py

The recursions of Newmark, of Hilber, Hughes and Taylor, and of Chung and Hulbert for
u'' = -omega^2 u, u(0) = 0, u'(0) = 1, written down from their papers. Prints the displacement
and the energy over the first after 50 steps, and the largest eigenvalue of a step to the power
100, by which theory says that the energy falls.
"""

import cmath
from math import pi

OMEGA, STEP, STEPS = 2 * pi, 0.1, 50


def march(alpha_m, alpha_f, beta, gamma):
    """(1 - am) a1 + am a0 + omega^2 ((1 - af) u1 + af u0) = 0, with Newmark's u and v."""
    stiffness, h = OMEGA**2, STEP

    def step(u, v, a):
        free = u + h * v + h * h * (0.5 - beta) * a
        new = -(alpha_m * a + stiffness * ((1 - alpha_f) * free + alpha_f * u)) / (
            1 - alpha_m + stiffness * (1 - alpha_f) * beta * h * h
        )
        return free + beta * h * h * new, v + h * ((1 - gamma) * a + gamma * new), new

    state = (0.0, 1.0, 0.0)
    for _ in range(STEPS):
        state = step(*state)
    columns = [step(*(float(i == k) for i in range(3))) for k in range(3)]
    matrix = [[columns[k][i] for k in range(3)] for i in range(3)]
    energy = state[1] ** 2 + stiffness * state[0] ** 2
    return state[0], energy, radius(matrix) ** (2 * STEPS)


def radius(m):
    """The largest eigenvalue of a matrix of three rows by size."""
    trace = m[0][0] + m[1][1] + m[2][2]
    minors = sum(m[i][i] * m[k][k] - m[i][k] * m[k][i] for i, k in ((0, 1), (0, 2), (1, 2)))
    determinant = (
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    )
    roots = [1.0 + 0j, cmath.exp(2j), cmath.exp(4j)]
    for _ in range(500):
        for i in range(3):
            z = roots[i]
            value = z**3 - trace * z * z + minors * z - determinant
            others = [z - root for k, root in enumerate(roots) if k != i]
            roots[i] = z - value / (others[0] * others[1])
    return max(abs(root) for root in roots)


def hilber_hughes_taylor(alpha):
    return march(0.0, alpha, (1 + alpha) ** 2 / 4, 0.5 + alpha)


def generalised_alpha(rho):
    m, f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    return march(m, f, (1 - m + f) ** 2 / 4, 0.5 - m + f)


if __name__ == "__main__":
    for name, result in [
        ("newmark", march(0.0, 0.0, 0.25, 0.5)),
        ("newmark, gamma 0.6, beta 0.3025", march(0.0, 0.0, 0.3025, 0.6)),
        ("hht_alpha 0.05", hilber_hughes_taylor(0.05)),
        ("hht_alpha 0.3", hilber_hughes_taylor(0.3)),
        ("generalised_alpha 0.8", generalised_alpha(0.8)),
        ("generalised_alpha 0.5", generalised_alpha(0.5)),
        ("generalised_alpha 0", generalised_alpha(0.0)),
    ]:
        print(f"{name}: displacement {result[0]:.10g}, energy {result[1]:.10g}, of theory {result[2]:.10g}")
