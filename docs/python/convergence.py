# A convergence study
# ===================
#
# A bar that is clamped at one end starts with the speed of its first mode of vibration. Its tip then moves as
# 2 L / (pi c) v sin(omega t) with omega = pi c / (2 L). How fast does the error fall with the spacing?

import numpy as np

import piola

LENGTH, WAVE_SPEED = 10.0, np.sqrt(1e6 / 1000.0)
PERIOD = 4 * LENGTH / WAVE_SPEED

case = piola.Case(
    {
        "version": 1,
        "title": "A bar vibrates in its first mode",
        "dimension": 1,
        "parameters": {"L": LENGTH, "cells": 20},
        "body": [
            {
                "name": "bar",
                "shape": {"kind": "box", "min": [0], "max": ["L"]},
                "spacing": "L / cells",
                "material": {"kind": "linear", "density": 1000.0, "bulk_modulus": 1e6},
                "initial": {"velocity": ["sin(pi * x / (2 * L))"]},
            }
        ],
        "scheme": {"kind": "upwind", "kernel": "cubic_spline", "smoothing_length": 1.0},
        "boundary": [
            {
                "name": "clamp",
                "where": {"kind": "plane", "point": [0], "normal": [-1]},
                "velocity": {"x": "0"},
            }
        ],
        "time": {"end": PERIOD, "cfl": 0.2},
        "probe": [{"name": "tip", "kind": "particle", "at": ["L"], "fields": ["displacement"]}],
        "output": {"every": PERIOD, "table_every": PERIOD / 64},
    }
)

# The error of one run:


def error(cells):
    """The largest error of the tip over a period, as a share of its amplitude."""
    run = case.set("parameters.cells", cells).start().run()
    time, tip = run.tables.curve("tip.displacement.x")
    amplitude = 2 * LENGTH / (np.pi * WAVE_SPEED)
    exact = amplitude * np.sin(2 * np.pi * time / PERIOD)
    return np.abs(tip - exact).max() / amplitude

# Each number of cells is twice the one before; second order means a quarter of the error:

counts = np.array([20, 40, 80, 160])
errors = np.array([error(cells) for cells in counts])
orders = np.log2(errors[:-1] / errors[1:])
for cells, share in zip(counts, errors):
    print(f"{cells:4d} cells: {100 * share:.4f} %")
print("orders:", np.round(orders, 2))

# The slope of a straight line through all errors, on logarithmic axes.

order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
print(f"the error falls as the spacing to the power of {order:.2f}")
assert np.all(np.diff(errors) < 0) and order > 0.9

# ![The error over the number of cells](convergence.svg)
