"""Writes d'Alembert's solution at the stations of the bar, of the loads of case.toml."""

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


def pulse(t, flank=FLANK, start=START):
    return -STRESS * (smooth((t - start) / flank) - smooth((t - start - DURATION) / flank))


def stress(x, t, flank=FLANK, start=START):
    # The wave to the right, its image from the fixed end, and that from the load again.
    def delayed(way):
        return pulse(t - way / SPEED, flank, start)

    return delayed(x) + delayed(2 * LENGTH - x) - delayed(2 * LENGTH + x)


def write(name, header, rows):
    text = "\n".join([header, *(f"{t:.10g},{value:.8g}" for t, value in rows)])
    Path(__file__).with_name("reference").joinpath(f"{name}.csv").write_text(text + "\n")


TIMES = [k * 5e-8 for k in range(721)]
STATIONS = [("left", 0.0), ("near", LENGTH / 3), ("far", 2 * LENGTH / 3), ("right", LENGTH)]
for name, place in STATIONS:
    write(name, "time,stress", [(t, stress(place, t)) for t in TIMES])
    if place:
        rows = [(t, stress(place, t, 2 * FLANK, 5e-6)) for t in TIMES]
        write(f"smoother-{name}", "time,stress", rows)
write("load", "time,factor", [(t, abs(pulse(t)) / STRESS) for t in TIMES[:301]])
