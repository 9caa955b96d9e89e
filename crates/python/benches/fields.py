"""What arrays of fields cost: the times that `docs/python.md` has. The best of some runs, as other processes disturb."""

import time

from column import case


def best(work, runs=20):
    """Least wall time of some runs in s."""
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


for spacing in (0.02, 0.005):
    simulation = case(spacing, 1.0).start()
    simulation.step()
    water = simulation.bodies["water"]
    for name in ("velocity", "deformation_gradient", "pressure"):
        what = "copied" if water[name].base.is_copy else "looked at"
        seconds = best(lambda name=name: water[name])
        print(f"{name} of {len(water)} particles, {what}: {1e6 * seconds:.1f} us")


def steps(held):
    """Ten steps, after each of which the state is held or not."""
    for _ in range(10):
        simulation.step()
        held and held.append(water["velocity"])


times = {name: [] for name in ("nothing", "each state")}
for _ in range(10):
    times["nothing"].append(best(lambda: steps([]), 1))
    times["each state"].append(best(lambda: steps([None]), 1))
ratio = min(times["each state"]) / min(times["nothing"])
print(f"a step of {len(water)} particles where each state is held: {ratio:.3f} of one where none is")
