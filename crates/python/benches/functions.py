"""What Python functions cost: the times that `docs/python.md` has. The best of some runs, as other processes disturb."""

import time

from column import case


def seconds(push="-9.81", spacing=0.02, end=0.02, interval=None):
    """Wall time of a step, and the number of particles."""
    best = float("inf")
    for _ in range(10):
        simulation = case(spacing, end, push).start()
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
