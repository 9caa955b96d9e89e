# Fitting material constants to a curve
# =====================================
#
# A sheet is stretched by 30 %. The force and the narrowing of the sheet are measured; Young's modulus and Poisson's
# ratio of a St. Venant-Kirchhoff material are to be found.
#
# The method is Gauss-Newton: the computed values are linearised about the present constants, the linear least-squares
# problem gives the next ones, and so on. The derivatives with respect to the constants are exact, and follow from each
# state in equilibrium without another run.

import numpy as np

import piola

WIDTH = 1.0  # m

case = piola.Case(
    {
        "version": 1,
        "title": "A sheet is stretched",
        "dimension": 2,
        "parameters": {"width": WIDTH},
        "body": [
            {
                "name": "sheet",
                "shape": {"kind": "box", "min": [0, 0], "max": [1, "width"]},
                "spacing": 0.2,
                "material": {
                    "kind": "saint_venant_kirchhoff",
                    "density": 1000.0,
                    "young_modulus": 1e6,
                    "poisson_ratio": 0.3,
                    "plane": "stress",
                },
            }
        ],
        "scheme": {"kind": "dual_support", "kernel": "quintic_spline", "neighbors": 12},
        "boundary": [
            {
                "name": "foot",
                "where": {"kind": "plane", "point": [0, 0], "normal": [-1, 0]},
                "displacement": {"x": "0"},
            },
            {
                "name": "floor",
                "where": {"kind": "plane", "point": [0, 0], "normal": [0, -1]},
                "displacement": {"y": "0"},
            },
            {
                "name": "head",
                "where": {"kind": "plane", "point": [1, 0], "normal": [1, 0]},
                "displacement": {"x": "0.3 * t"},
            },
        ],
        "time": {"integrator": "static", "end": 1.0, "step": 0.1, "tolerance": 1e-11},
        "probe": [
            {
                "name": "head",
                "kind": "sum",
                "field": "reaction",
                "where": {"kind": "plane", "point": [1, 0], "normal": [1, 0]},
            },
            {"name": "top", "kind": "particle", "at": [0.5, "width"], "fields": ["displacement"]},
        ],
        "output": {"every": 1.0, "table_every": 0.1},
    }
)


PROBES = ["head.reaction.x", "top.displacement.y"]
KEYS = ["body.sheet.material.young_modulus", "body.sheet.material.poisson_ratio"]


def in_units(force, displacement):
    """Forces in kN, then narrowings in mm, of all moments but the first, at which the sheet is at rest."""
    return np.concatenate([force[1:] / 1e3, -displacement[1:] * 1e3])


def computed(constants):
    """Force and narrowing at ten stretches, and their derivatives, a column for each constant."""
    for key, value in zip(KEYS, constants):
        case.set(key, float(value))
    simulation = case.start()
    found = [[simulation.sensitivity(key).probes for key in KEYS] for _ in simulation.every(0.1)]
    slopes = [np.array([[by[probe] for by in moment] for moment in found]) for probe in PROBES]
    values = [simulation.tables.curve(probe)[1] for probe in PROBES]
    return in_units(*values), in_units(*slopes)


# The measurement is made up. For this material the exact answer is known: with the strain e = (stretch^2 - 1) / 2 the
# force is width * young * stretch * e, and the stretch across is sqrt(1 - 2 * poisson * e). Noise of 1 % of the largest
# value is added, as an instrument would have it.

TRUE = np.array([1.7e6, 0.21])
stretch = 1 + 0.03 * np.arange(1, 11)
strain = (stretch**2 - 1) / 2
exact = np.concatenate(
    [WIDTH * TRUE[0] * stretch * strain / 1e3, WIDTH * (1 - np.sqrt(1 - 2 * TRUE[1] * strain)) * 1e3]
)
scatter = np.random.default_rng(1).normal(scale=0.01, size=20)
measured = exact + scatter * np.repeat([exact[9], exact[19]], 10)

# With these constants the particles give the exact answer, with the derivatives of the formulas.

exact_slope = np.zeros((20, 2))
exact_slope[:10, 0] = exact[:10] / TRUE[0]
exact_slope[10:, 1] = WIDTH * strain / np.sqrt(1 - 2 * TRUE[1] * strain) * 1e3
values, slope = computed(TRUE)
assert np.abs(values / exact - 1).max() < 1e-6
assert np.all(np.abs(slope - exact_slope) < 1e-6 * exact_slope.max(axis=0))

# Each kind of measurement is weighted by its scatter.

weights = 1 / np.repeat([exact[9], exact[19]], 10)
constants = np.array([1e6, 0.3])
for turn in range(8):
    values, slope = computed(constants)
    slope *= weights[:, None]
    misfit = (measured - values) * weights
    step, *_ = np.linalg.lstsq(slope, misfit, rcond=None)
    constants = constants + step
    distance = np.linalg.norm(misfit)
    print(f"{turn}: young = {constants[0]:.6e} Pa, poisson = {constants[1]:.6f}, misfit {distance:.4f}")
    if np.all(np.abs(step) < 1e-7 * constants):
        break
else:
    raise AssertionError("it does not converge")

# How well the constants are known follows from the same derivatives.

deviation = 0.01 * np.sqrt(np.diag(np.linalg.inv(slope.T @ slope)))
print(f"young = {constants[0]:.4g} +- {deviation[0]:.1g} Pa, poisson = {constants[1]:.4f} +- {deviation[1]:.1g}")
assert np.all(np.abs(constants - TRUE) < 3 * deviation)

# ![Force and narrowing, measured and computed](fit.svg)
#
# The curves are those of the constants that were found.
