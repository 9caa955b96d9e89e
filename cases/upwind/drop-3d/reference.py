"""Half an ellipsoid of incompressible fluid on a floor, free of weight: the exact motion.

A drop that starts as a ball with a linear velocity stays an ellipsoid with one: with semi-axes a_i,
velocity a_i' x_i / a_i along its axis i and pressure (rho lambda / 2) (1 - sum x_i^2 / a_i^2),
Euler's equations are

    a_i'' = lambda / a_i,   lambda = sum (a_i' / a_i)^2 / sum (1 / a_i^2),

where lambda keeps the product of the axes. The floor is a plane of symmetry. Axes 1 and 2 lie in the
floor, turned by an angle against x and y. Writes the place of a particle that starts at `POINTS`
against time, and prints what the checks compare with.
"""

from math import cos, radians, sin

RADIUS = 1.0
RATES = [0.9, 0.2, -1.1]  # 1/s, their sum is 0
ANGLE = radians(30)
END = 1.0
STEPS = 20000
POINTS = {"side": (1, 0, 0), "front": (0, 1, 0), "top": (0, 0, 1)}


def slope(state):
    a, v = state[:3], state[3:]
    factor = sum((w / b) ** 2 for w, b in zip(v, a)) / sum(1 / b**2 for b in a)
    return v + [factor / b for b in a]


def add(state, step, rate):
    return [s + step * r for s, r in zip(state, rate)]


def place(state, point):
    stretch = [b / RADIUS for b in state[:3]]
    c, s = cos(ANGLE), sin(ANGLE)
    x, y, z = point
    first, second = stretch[0] * (c * x + s * y), stretch[1] * (-s * x + c * y)
    return c * first - s * second, s * first + c * second, stretch[2] * z


def main():
    state = [RADIUS] * 3 + [RADIUS * rate for rate in RATES]
    step = END / STEPS
    rows = []
    for number in range(STEPS + 1):
        if number % (STEPS // 50) == 0:
            rows.append((number * step, state))
        one = slope(state)
        two = slope(add(state, step / 2, one))
        three = slope(add(state, step / 2, two))
        four = slope(add(state, step, three))
        mean = [(p + 2 * q + 2 * r + s) / 6 for p, q, r, s in zip(one, two, three, four)]
        state = add(state, step, mean)
    for time, state in (rows[25], rows[50]):
        print("at", time, "s: axes", state[:3], "rates", state[3:], "volume", state[0] * state[1] * state[2])
        for name, point in POINTS.items():
            now = place(state, point)
            free = place([RADIUS * (1 + rate * time) for rate in RATES], point)
            print(name, now, "of which pressure makes", [p - q for p, q in zip(now, free)])
    energy = 1000 * 4 / 3 * 3.141592653589793 / 2 / 10 * sum(v * v for v in state[3:])
    print("kinetic energy", energy, "of", 1000 * 4 / 3 * 3.141592653589793 / 2 / 10 * sum(r * r for r in RATES))


if __name__ == "__main__":
    main()
