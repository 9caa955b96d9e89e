# A dam break with a gauge
# ========================
#
# A column of water, 1 m wide and 2 m high, stands at one end of a tank 4 m long; the gate that held it is gone. A gauge
# records the height of the water 1.5 m from the left wall, and a probe the position of its front.

import numpy as np

import piola

DEPTH = 2.0  # m
GRAVITY = 9.81  # m/s^2

case = piola.Case(
    {
        "version": 1,
        "title": "A column of water collapses",
        "dimension": 2,
        "parameters": {"dx": 0.1, "depth": DEPTH, "g": GRAVITY, "speed": "sqrt(2 * g * depth)"},
        "body": [
            {
                "name": "water",
                "shape": {"kind": "box", "min": [0, 0], "max": [1.0, "depth"]},
                "spacing": "dx",
                "lattice": {"on": "cells"},
                "material": {"kind": "weakly_compressible", "density": 1000.0, "wave_speed": "10 * speed"},
                "initial": {"pressure": "1000 * g * (depth - y)"},
            },
            {
                "name": "tank",
                "shape": {
                    "kind": "difference",
                    "from": {"kind": "box", "min": ["-3 * dx", "-3 * dx"], "max": ["4 + 3 * dx", 4]},
                    "remove": [{"kind": "box", "min": [0, 0], "max": [4, 6]}],
                },
                "spacing": "dx",
                "lattice": {"on": "cells"},
                "material": {"kind": "weakly_compressible", "density": 1000.0, "wave_speed": "10 * speed"},
                "wall": {"slip": "free"},
            },
        ],
        "scheme": {"kind": "transport_velocity", "artificial_viscosity": 0.05, "free_surface": True},
        "load": [{"kind": "body_force", "acceleration": ["0", "-g"]}],
        "time": {"end": 0.6},
        "probe": [
            {"name": "gauge", "kind": "gauge", "body": "water", "from": [1.5, 0.0], "to": [1.5, 3.0]},
            {"name": "front", "kind": "extremum", "field": "position.x", "of": "largest", "body": "water"},
        ],
        "output": {"every": 0.1, "table_every": 0.01},
    }
)

# The run, moment by moment: the kinetic energy and the largest speed.

simulation = case.start()
for moment in simulation.every(0.1):
    energy = moment.energy
    speed = np.linalg.norm(moment.bodies["water"]["velocity"], axis=1).max()
    print(f"t = {moment.time:.3f} s: {energy['kinetic']:8.1f} J of kinetic energy, at most {speed:.2f} m/s")

# The gauge is dry until the front arrives.

time, elevation = simulation.tables.curve("gauge.elevation")
arrival = time[np.flatnonzero(elevation > 0.05)[0]]
print(f"the water is at the gauge after {arrival:.2f} s, and {elevation[-1]:.2f} m high there at the end")
assert np.all(elevation[time < 0.1] <= 0.05) and elevation[-1] > 0.3

# No front is faster than that of potential flow without friction, which is at 2.387 m after 0.4 s
# (`cases/reference/potential_flow.py`); the foremost particle lies half a spacing behind.
# In experiments, with friction and a gate that has to be lifted, it is beyond 2.1 m.

time, front = simulation.tables.curve("front.position.x")
reached = np.interp(0.4, time, front)
print(f"the front is at {reached:.3f} m after 0.4 s")
assert 2.1 < reached < 2.387 - 0.05

# ![The water after 0.6 s](dam_break.svg)
#
# The water after 0.6 s.

# With pandas installed, `simulation.tables["probes"].to_pandas()` gives everything that the probes recorded as a data
# frame.
