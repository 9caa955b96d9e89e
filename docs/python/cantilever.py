# A cantilever against beam theory
# ================================
#
# A slender beam is clamped at one end and pushed down at the other. Beam theory says how far the tip goes: by
# bending, P L^3 / (3 E I), and by shear, P L / (k G A) with k = 5/6 for a rectangle. The particles know nothing of
# beams; they are a sheet of linear elastic material in equilibrium.
#
# Run the script as it is, or its parts in a notebook. The assertions check what the text claims.

import numpy as np

import piola

LENGTH, HEIGHT = 10.0, 1.0  # m
LOAD = 1000.0  # N per metre of thickness
YOUNG, POISSON = 1e9, 0.3  # Pa, 1

# A case is a dict with the [keys of a case file](../case-file.md). Parameters can be used in expressions. The load
# is a shear traction with the parabolic profile of beam theory.

case = piola.Case(
    {
        "version": 1,
        "title": "A cantilever bends",
        "dimension": 2,
        "parameters": {"L": LENGTH, "H": HEIGHT, "P": LOAD, "cells": 16},
        "body": [
            {
                "name": "beam",
                "shape": {"kind": "box", "min": [0, "-H / 2"], "max": ["L", "H / 2"]},
                "spacing": "H / cells",
                "material": {
                    "kind": "linear_elastic",
                    "density": 1000.0,
                    "young_modulus": YOUNG,
                    "poisson_ratio": POISSON,
                    "plane": "stress",
                },
            }
        ],
        "scheme": {"kind": "dual_support", "kernel": "quintic_spline", "neighbors": 12, "hourglass": 0.05},
        "boundary": [
            {
                "name": "clamp",
                "where": {"kind": "plane", "point": [0, 0], "normal": [-1, 0]},
                "displacement": {"x": "0", "y": "0"},
            }
        ],
        "load": [
            {
                "name": "shear",
                "kind": "traction",
                "where": {"kind": "plane", "point": ["L", 0], "normal": [1, 0]},
                "traction": ["0", "-t * 6 * P / H^3 * (H^2 / 4 - y^2)"],
            }
        ],
        "time": {"integrator": "static", "end": 1.0, "step": 1.0},
        "probe": [{"name": "tip", "kind": "particle", "at": ["L", 0], "fields": ["displacement"]}],
        "output": {"every": 1.0, "table_every": 1.0},
    }
)
assert case.faults() == []

# The plan says what a run will do. A notebook shows it as a table; `print(plan)` is what `piola check` prints.

plan = case.check()
print(plan.bodies[0]["particles"], "particles,", plan.steps, "step; warnings:", plan.warnings or "none")

# Here statics takes a single step, to the load factor 1.

simulation = case.start()
run = simulation.run()

# The tip, and what beam theory says:

inertia = HEIGHT**3 / 12
shear_modulus = YOUNG / (2 * (1 + POISSON))
bending = LOAD * LENGTH**3 / (3 * YOUNG * inertia)
shear = LOAD * LENGTH / (5 / 6 * shear_modulus * HEIGHT)
times, tip = run.tables.curve("tip.displacement.y")
print(f"tip: {tip[-1]:.4e} m; beam theory: {-(bending + shear):.4e} m")
assert abs(tip[-1] / -(bending + shear) - 1) < 0.01

# Fields are NumPy arrays of the state as it is now. The stress along the beam is linear over its height: at half its
# length it is M y / I, with the moment M of the load about that place.

beam = simulation.bodies["beam"]
x, y = (beam["position"] - beam["displacement"]).T
middle = np.abs(x - LENGTH / 2) < 1e-6
stress = beam["stress"][middle, 0, 0]
theory = LOAD * LENGTH / 2 * y[middle] / inertia
rows = np.round(np.stack([y[middle], stress / 1e3, theory / 1e3], axis=1), 3) + 0.0  # no zeros with a sign
for height, computed, expected in sorted(rows.tolist())[::4]:
    print(f"{height:6.3f} m: {computed:6.1f} kPa; beam theory: {expected:6.1f} kPa")
assert np.abs(stress - theory).max() < 0.03 * np.abs(theory).max()

# ![The beam, coloured by the stress along it](cantilever.svg)
#
# The beam with displacements 300 times as large.
