"""Fields of each kind of system: what can be read, and what can be set."""

import copy

import numpy as np
import pytest

import piola

WATER = {"kind": "weakly_compressible", "density": 1000.0, "wave_speed": 20.0}
STEEL = {"density": 2000.0, "young_modulus": 1e6, "poisson_ratio": 0.3}


def body(name, low, high, material, **more):
    shape = {"kind": "box", "min": low, "max": high}
    return {"name": name, "shape": shape, "spacing": 0.125, "lattice": {"on": "cells"}, "material": material, **more}


def case_of(bodies, scheme, **more):
    rest = {"time": {"end": 0.05}, "output": {"every": 0.05, "table_every": 0.05}, **copy.deepcopy(more)}
    return {"version": 1, "title": "a system", "dimension": 2, "body": copy.deepcopy(bodies), "scheme": scheme, **rest}


FLUID = body("water", [0, 0], [1, 1], WATER, initial={"velocity": ["-0.1 * x", "0"]})
FLOOR = body("floor", [-0.5, -0.5], [1.5, 0], WATER, wall={"slip": "free"})
BLOCK = body("block", [0, 0], [1, 1], {"kind": "hypoelastic", **STEEL}, initial={"velocity": ["0.1 * x", "0"]})
RUBBER = body("rubber", [0, 0], [1, 1], {"kind": "linear_elastic", **STEEL}, initial={"velocity": ["0.1 * x", "0"]})
ROUND = {"periodic": {"x": [0, 1]}}
LID = {**body("lid", [0, 1], [1, 1.5], {"kind": "linear_elastic", **STEEL}), "system": "lid"}
MOVING = {"kind": "transport_velocity"}
REFINED = {**MOVING, "refine": [{"kind": "box", "min": [0.25, 0.25], "max": [0.75, 0.75]}]}
SOLID = {"kind": "total_lagrangian"}
FEET = {"name": "feet", "where": {"kind": "half_space", "point": [0, 0.1], "normal": [0, -1]}}
BEGINS_FINE = {**FLUID, "spacing": 0.05}

CASES = {
    "fluid": case_of([FLUID, FLOOR], {**MOVING, "free_surface": True}),
    "refined": case_of([BEGINS_FINE], REFINED, domain={"periodic": {"x": [0, 1], "y": [0, 1]}}),
    "hypoelastic": case_of([BLOCK], MOVING),
    "total_lagrangian": case_of([RUBBER], SOLID),
    "static": case_of(
        [{key: value for key, value in RUBBER.items() if key != "initial"}],
        SOLID,
        boundary=[{**FEET, "displacement": {"x": "0", "y": "0"}}],
        load=[{"kind": "body_force", "acceleration": ["0", "-9.81 * t"]}],
        time={"integrator": "static", "end": 1, "step": 0.5},
        output={"every": 1},
    ),
    "coupled": case_of([FLUID, FLOOR, LID], MOVING, domain=ROUND, system=[{"name": "lid", "scheme": SOLID}]),
    "coupled_hypoelastic": case_of(
        [FLUID, FLOOR, {**LID, "material": BLOCK["material"]}],
        MOVING,
        domain=ROUND,
        system=[{"name": "lid", "scheme": MOVING}],
    ),
}
BOTH = ["velocity", "displacement"]
# By case and body: what can be set between two steps, and whether a cloud can take the place of the shape.
TABLE = [
    ("fluid", "water", ["velocity"], True),
    ("fluid", "floor", ["velocity"], False),
    ("refined", "water", [], False),
    ("hypoelastic", "block", ["velocity"], True),
    ("total_lagrangian", "rubber", BOTH, True),
    ("static", "rubber", [], True),
    ("coupled", "water", ["velocity"], True),
    ("coupled", "lid", BOTH, False),
    ("coupled_hypoelastic", "lid", ["velocity"], False),
]


@pytest.mark.parametrize(("name", "which", "settable", "_cloud"), TABLE)
def test_which_fields_can_be_set(name, which, settable, _cloud):
    simulation = piola.Case(CASES[name]).start()
    simulation.step()
    own = simulation.bodies[which]
    only = f"only `{'` or `'.join(settable)}`" if settable else "no field of this scheme"
    assert set(settable) <= set(own)
    for field in own:
        values = own[field].copy()
        if field in settable:
            own[field] = values
        else:
            with pytest.raises(ValueError, match=f"the field `{field}` cannot be set; {only} can be set"):
                own[field] = values
        assert np.array_equal(own[field], values, equal_nan=True)


@pytest.mark.parametrize("name", CASES)
def test_systems_are_read_set_and_run(name):
    simulation = piola.Case(CASES[name]).start()
    simulation.step()
    for which in simulation.bodies:
        own = simulation.bodies[which]
        for field in own:
            assert own[field].shape[0] == len(own) > 0
    settable = {which: fields for case, which, fields, _ in TABLE if case == name}
    for which, fields in settable.items():
        own = simulation.bodies[which]
        for field in fields:
            if which == "floor":
                continue
            new = own[field] + 1e-3 * np.sin(own["position"])
            own[field] = new
            assert np.array_equal(own[field], new)
    run = simulation.run()
    assert run.outcome == "completed" and np.isfinite(simulation.energy["total"])


@pytest.mark.parametrize(("name", "which", "_settable", "cloud"), TABLE)
def test_which_bodies_can_be_clouds(name, which, _settable, cloud):
    case = piola.Case(CASES[name])
    own = case.start().bodies[which]
    spacing = next(body["spacing"] for body in CASES[name]["body"] if body["name"] == which)
    points = piola.Cloud(own["position"], np.full(len(own), spacing**2))
    for key in ("spacing", "lattice"):
        case.set(f"body.{which}.{key}", None)
    faults = case.set(f"body.{which}.shape", points).faults()
    assert (not faults) == cloud, faults
    if cloud:
        clouded = case.start()
        assert np.array_equal(np.sort(clouded.bodies[which]["position"], axis=0), np.sort(points.positions, axis=0))
        assert clouded.run().outcome == "completed"


def test_solids_take_the_spacing_of_a_fluid_that_has_one():
    """Of water that is a cloud they take that of its floor; without one, there is none."""
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(0.0625, 1, 0.125)]))
    case = piola.Case(CASES["coupled"]).set("body.water.spacing", None).set("body.water.lattice", None)
    case.set("body.water.shape", piola.Cloud(np.stack([x, y], axis=1), np.full(64, 1 / 64)))
    assert case.faults() == []
    (fault,) = case.set("body.floor", None).faults()
    assert fault.message == "points have no spacing, with which solids are walls to the fluid"


def test_initial_fields_of_systems_from_arrays_are_those_of_expressions():
    """Steps are given, and nothing shifts particles by what it remembers of the velocities before."""
    still = {**MOVING, "shifting": "none"}
    table = {**CASES["coupled"], "scheme": still, "time": {"end": 0.01, "step": 1e-3}}
    given = piola.Case(table)
    given.set("body.water.initial.velocity", ["0.1 * y", "0.2 * x"])
    given.set("body.lid.initial", {"velocity": ["0.3 * y", "0"], "displacement": ["1e-3 * x * y", "0"]})
    expressed, arrays = given.start(), piola.Case(table).start()
    water, lid = arrays.bodies["water"], arrays.bodies["lid"]
    x, y = water["position"].T
    water["velocity"] = np.stack([0.1 * y, 0.2 * x], axis=1)
    x, y = lid["position"].T
    lid["velocity"] = np.stack([0.3 * y, 0 * y], axis=1)
    lid["displacement"] = np.stack([1e-3 * x * y, 0 * y], axis=1)
    for simulation in (expressed, arrays):
        simulation.run()
    for which in ("water", "lid"):
        for field in ("position", "velocity"):
            assert np.array_equal(expressed.bodies[which][field], arrays.bodies[which][field])
