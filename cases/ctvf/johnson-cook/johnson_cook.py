"""A rod that is pulled along its axis and cannot narrow, with the flow stress of Johnson and Cook.

Elastic strain and plastic strain add up, `de_p = dE - dq / (3 G)` with `E = 2/3 ln(1 + rate t)`,
while the equivalent stress q is the flow stress at the plastic strain, its rate and the
temperature. Implicit Euler steps of that one equation, refined until nothing changes, and prints
q in Pa, the plastic strain and the temperature in K.
"""

import math

A, B, N, C, E0, M = 90e6, 292e6, 0.31, 0.025, 1.0, 1.09
T0, MELT, HEAT, SHARE = 293.15, 1356.0, 383.0, 0.9
RHO, G, RATE, END = 8960.0, 46e9, 1e5, 5e-6


def flow(strain, rate, temperature):
    heat = ((temperature - T0) / (MELT - T0)) ** M if temperature > T0 else 0.0
    return (A + B * strain**N) * (1 + C * math.log(max(rate / E0, 1.0))) * (1 - heat)


def run(steps):
    step, strain, q, temperature = END / steps, 0.0, 0.0, T0
    for k in range(steps):
        start, end = k * step, (k + 1) * step
        total = 2 / 3 * math.log((1 + RATE * end) / (1 + RATE * start))
        density = RHO / (1 + RATE * (start + end) / 2)
        low, high = 0.0, total + q / (3 * G)
        for _ in range(100):
            middle = (low + high) / 2
            # What the elastic strain leaves of the stress, and what the material bears.
            left = q + 3 * G * (total - middle)
            if left > flow(strain + middle, middle / step, temperature):
                low = middle
            else:
                high = middle
        if low < 1e-12 * total:
            q += 3 * G * total
            continue
        q += 3 * G * (total - middle)
        strain += middle
        temperature += SHARE * q * middle / (density * HEAT)
    return q, strain, temperature


if __name__ == "__main__":
    for steps in (2000, 20000):
        print(steps, *(f"{value:.7g}" for value in run(steps)))
