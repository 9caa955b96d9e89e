"""Writes d'Alembert's solution at three stations of the bar, of the load of case.toml."""

import math
from pathlib import Path

LENGTH, SPEED, STRESS = 0.15, math.sqrt(200e9 * 0.7 / (1.3 * 0.4) / 8000), 100e3
DURATION, FLANK, START = 4e-6, 2e-6, 3e-6
INTERVALS = 2000


def bell(x):
    return math.exp(-1 / (1 - x * x)) * (1 - x * x) ** 8 if abs(x) < 1 else 0.0


def simpson(end):
    h = end / INTERVALS
    terms = (bell(k * h) * (4 if k % 2 else 2) for k in range(1, INTERVALS))
    return (bell(0) + sum(terms) + bell(end)) * h / 3


HALF = simpson(1.0)


def smooth(x):
    return 0.5 + 0.5 * (math.copysign(1, x) if abs(x) >= 1 else simpson(x) / HALF)


def pulse(t):
    return -STRESS * (smooth((t - START) / FLANK) - smooth((t - START - DURATION) / FLANK))


def stress(x, t):
    # The wave to the right, its image from the fixed end, and that from the load again.
    back = pulse(t - (2 * LENGTH - x) / SPEED) - pulse(t - (2 * LENGTH + x) / SPEED)
    return pulse(t - x / SPEED) + back


for name, place in [("left", 0.0), ("near", LENGTH / 3), ("far", 2 * LENGTH / 3)]:
    rows = ["time,stress"]
    for k in range(601):
        t = k * 5e-8
        rows.append(f"{t:.10g},{stress(place, t):.8g}")
    Path(__file__).with_name("reference").joinpath(f"{name}.csv").write_text("\n".join(rows) + "\n")

rows = ["time,factor"]
for k in range(301):
    t = k * 5e-8
    rows.append(f"{t:.10g},{abs(pulse(t)) / STRESS:.8g}")
Path(__file__).with_name("reference").joinpath("load.csv").write_text("\n".join(rows) + "\n")
