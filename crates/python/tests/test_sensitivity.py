"""Derivatives of states in equilibrium."""

import numpy as np
import pytest

import piola

E, NU = 2.3e5, 0.27
KEY = "body.block.material.young_modulus"


@pytest.fixture
def block():
    """A linear block beside another one, both drawn along x by loads that grow with the load factor."""

    def body(name, left, young):
        return {
            "name": name,
            "shape": {"kind": "box", "min": [left, 0.0], "max": [left + 1.0, 0.5]},
            "spacing": 0.25,
            "material": {
                "kind": "linear_elastic", "density": 1000.0, "young_modulus": young, "poisson_ratio": NU,
            },
        }

    return {
        "version": 1,
        "title": "two blocks",
        "dimension": 2,
        "body": [body("block", 0.0, E), body("other", 5.0, 3 * E)],
        "scheme": {"kind": "dual_support"},
        "boundary": [
            {
                "name": name,
                "body": name,
                "where": {"kind": "plane", "point": [left, 0.0], "normal": [-1.0, 0.0]},
                "displacement": {"x": "0", "y": "0"},
            }
            for name, left in [("block", 0.0), ("other", 5.0)]
        ],
        "load": [{"kind": "body_force", "acceleration": ["8 * t", "-3 * x * t"]}],
        "time": {"integrator": "static", "end": 1.0, "step": 0.5, "tolerance": 1e-11},
        "probe": [
            {"name": "tip", "kind": "particle", "at": [1.0, 0.5], "fields": ["displacement", "stress"]},
            {"name": "all", "kind": "sum", "field": "reaction", "body": "block"},
        ],
        "output": {"every": 1.0, "table_every": 0.5},
    }


def test_a_linear_block_is_known_exactly(block):
    """Under dead loads du/dE = -u/E and reactions stay; the bound is the tolerance with the condition."""
    simulation = piola.Case(block).start()
    assert simulation.run().outcome == "completed"
    found = simulation.sensitivity(KEY)
    assert (found.key, found.time) == (KEY, 1.0)
    assert repr(found) == f"<Sensitivity to {KEY} at t = 1 s>"
    body, other = simulation.bodies["block"], simulation.bodies["other"]
    u, reaction = body["displacement"], body["reaction"]
    assert list(found.displacement) == list(found.reaction) == ["block", "other"]
    assert found.displacement["block"].shape == found.reaction["block"].shape == u.shape
    assert np.abs(found.displacement["block"] + u / E).max() < 1e-8 * np.abs(u).max() / E
    assert np.abs(found.reaction["block"]).max() < 1e-8 * np.abs(reaction).max() / E
    assert found.displacement["other"].shape == other["displacement"].shape
    assert not found.displacement["other"].any() and not found.reaction["other"].any()
    by_other = simulation.sensitivity("body.other.material.young_modulus").displacement
    u = other["displacement"]
    assert np.abs(by_other["other"] + u / (3 * E)).max() < 1e-8 * np.abs(u).max() / E
    assert not by_other["block"].any()


def test_probes_have_those_of_their_particles(block):
    simulation = piola.Case(block).start()
    simulation.run()
    found = simulation.sensitivity("body.block.material.poisson_ratio")
    assert sorted(found.probes) == [f"{name}.{axis}" for name in ("all.reaction", "tip.displacement") for axis in "xy"]
    body = simulation.bodies["block"]
    tip = np.argmin(np.linalg.norm(body["position"] - body["displacement"] - [1.0, 0.5], axis=1))
    for number, axis in enumerate("xy"):
        assert found.probes[f"tip.displacement.{axis}"] == found.displacement["block"][tip, number] != 0
        total = found.reaction["block"][:, number].sum()
        # Loads are dead, so that all supports together hold the same.
        assert abs(total - found.probes[f"all.reaction.{axis}"]) < 1e-12 * np.abs(found.reaction["block"]).sum()
        assert abs(total) < 1e-8 * np.abs(found.reaction["block"]).sum()


def test_it_is_of_the_state_as_it_was_and_changes_nothing(block):
    simulation, other = piola.Case(block).start(), piola.Case(block).start()
    found = [simulation.sensitivity(KEY) for _ in simulation.every(0.5)]
    assert [one.time for one in found] == [0.0, 0.5, 1.0]
    first, half, full = (one.displacement["block"] for one in found)
    assert not first.any() and np.allclose(full, 2 * half, rtol=1e-8, atol=0)
    other.run()
    for name in ("displacement", "reaction"):
        assert np.array_equal(simulation.particles[name], other.particles[name])


def test_what_has_none_is_refused(block, case):
    simulation = piola.Case(block).start()
    with pytest.raises(KeyError, match="did you mean `body.block.material.young_modulus`?"):
        simulation.sensitivity("body.block.material.young")
    with pytest.raises(KeyError, match="there is no derivative with respect to .*: expected `body.block.material"):
        simulation.sensitivity("load.0.acceleration")
    with pytest.raises(KeyError, match="this case has none"):
        case.start().sensitivity("body.water.material.gamma")
    block["time"] = {"end": 1e-3, "step": 1e-3, "integrator": "newmark"}
    for boundary in block["boundary"]:
        boundary["velocity"] = boundary.pop("displacement")
    with pytest.raises(ValueError, match=f"no derivative with respect to `{KEY}`: only states in equilibrium"):
        piola.Case(block).start().sensitivity(KEY)
