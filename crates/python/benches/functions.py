"""What Python functions cost: the times that `docs/python.md` has. The best of some runs, as other processes disturb."""

import time

import piola


def case(push, spacing, end):
    """A column of water that falls, with a body force along y."""
    return piola.Case(
        {
            "version": 1,
            "title": "a column of water",
            "dimension": 2,
            "body": [
                {
                    "name": "water",
                    "shape": {"kind": "box", "min": [0.0, 0.0], "max": [1.0, 2.0]},
                    "spacing": spacing,
                    "material": {"kind": "gamma_law", "density": 1000.0, "gamma": 7.0, "wave_speed": 10.0},
                }
            ],
            "scheme": {"kind": "upwind", "kernel": "cubic_spline", "smoothing_length": 0.7},
            "load": [{"kind": "body_force", "acceleration": ["0", push]}],
            "time": {"end": end, "cfl": 0.3},
            "output": {"every": end, "table_every": end},
        }
    )


def seconds(push="-9.81", spacing=0.02, end=0.02, interval=None):
    """Wall time of a step, and the number of particles."""
    best = float("inf")
    for _ in range(10):
        simulation = case(push, spacing, end).start()
        if interval:
            simulation.observe(interval, lambda moment: None)
        start = time.perf_counter()
        simulation.run()
        best = min(best, (time.perf_counter() - start) / simulation.steps)
    return best, len(simulation.bodies["water"])


step, particles = seconds("-9.81 + 0 * x * t")
for name, push in [("x", lambda x: -9.81), ("t", lambda t: -9.81), ("x and t", lambda x, t: -9.81)]:
    more = seconds(push)[0] - step
    print(f"a load of {name}: {1e9 * more / particles:.0f} ns a step and particle more than an expression")
step, _ = seconds(spacing=0.25, end=2.0)
more = seconds(spacing=0.25, end=2.0, interval=1e-9)[0] - step
print(f"a function that looks at each moment: {1e6 * more:.1f} us a call")
