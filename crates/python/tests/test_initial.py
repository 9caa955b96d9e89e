"""Arrays as initial fields of a case."""

import re

import numpy as np
import pytest

import piola


@pytest.fixture
def table(table):
    """The column without its floor, which would prescribe some of what is set here."""
    table["boundary"] = []
    return table


def swirl(points):
    """A velocity that differs from particle to particle."""
    x, y = points.T
    return np.stack([0.3 * y - 0.1 * x, 0.2 * x * y - 1.0], axis=1)


def given(table, velocity, pressure="0"):
    table["body"][0]["initial"] = {"velocity": velocity, "pressure": pressure}
    return piola.Case(table)


def test_positions_are_those_of_the_particles_by_their_number(table, case):
    points = case.positions("water")
    assert points.shape == (45, 2) and points.dtype == np.float64
    water = case.start().bodies["water"]
    assert np.array_equal(water["position"], points[water.ids])
    # A cloud keeps its own order.
    order = np.random.default_rng(1).permutation(45)
    case.set("body.water.shape", piola.Cloud(points[order], 1 / 16)).set("body.water.spacing", None)
    assert np.array_equal(case.positions("water"), points[order])
    with pytest.raises(KeyError, match="there is no body `wine`; there are `water`"):
        case.positions("wine")
    with pytest.raises(piola.CaseError, match="spacing"):
        case.set("body.water.shape", {"kind": "box", "min": [0, 0], "max": [1, 1]}).positions("water")


def test_arrays_give_the_bits_of_expressions(table, case):
    """Sums and products are rounded alike in NumPy and in expressions."""
    points = case.positions("water")
    pressure = 100.0 * points[:, 1]
    theirs = given(table, ["0.3 * y - 0.1 * x", "0.2 * x * y - 1.0"], "100.0 * y").start()
    ours = given(table, swirl(points), pressure).start()
    assert np.array_equal(ours.bodies["water"]["velocity"], swirl(points)[ours.bodies["water"].ids])
    assert np.array_equal(ours.bodies["water"]["pressure"], theirs.bodies["water"]["pressure"])
    for simulation in (theirs, ours):
        simulation.run()
    for name in ("position", "velocity"):
        assert np.array_equal(ours.bodies["water"][name], theirs.bodies["water"][name])


def test_any_memory_order_and_exact_type(table, case):
    velocity = np.round(swirl(case.positions("water")) * 64)
    wide = np.zeros((45, 4))
    wide[:, ::2] = velocity
    forms = [velocity.astype(np.int32), velocity.astype(np.float32), np.asfortranarray(velocity), wide[:, ::2],
             velocity.T.copy().T, velocity[::-1].copy()[::-1], velocity.astype(">f8")]
    for form in forms:
        water = given(table, form).start().bodies["water"]
        assert np.array_equal(water["velocity"], velocity[water.ids])


def test_components_may_be_arrays_beside_expressions_and_functions(table, case):
    x, y = case.positions("water").T
    water = given(table, [0.5 * y, "-x"]).start().bodies["water"]
    assert np.array_equal(water["velocity"], np.stack([0.5 * y, -x], axis=1)[water.ids])
    water = given(table, [lambda y: 0.5 * y, -x]).start().bodies["water"]
    assert np.array_equal(water["velocity"], np.stack([0.5 * y, -x], axis=1)[water.ids])
    # A vector alone is that of all particles.
    water = given(table, np.array([0.0, -2.0])).start().bodies["water"]
    assert np.array_equal(water["velocity"], np.tile([0.0, -2.0], (45, 1)))


def test_the_second_of_two_bodies_has_rows_of_its_own(table, case):
    points = case.positions("water")
    other = {**table["body"][0], "name": "other", "shape": {"kind": "box", "min": [5, 0], "max": [6, 1]}}
    other["initial"] = {"velocity": np.stack([np.arange(25.0), np.zeros(25)], axis=1) / 100}
    table["body"].append(other)
    simulation = given(table, swirl(points)).start()
    water, other = simulation.bodies["water"], simulation.bodies["other"]
    assert np.array_equal(water["velocity"], swirl(points)[water.ids])
    assert np.array_equal(other["velocity"][:, 0], (other.ids - other.ids.min()) / 100)


def test_displacements_of_solids(table):
    table["scheme"] = {"kind": "dual_support"}
    table["body"][0]["material"] = {
        "kind": "linear_elastic", "density": 1000.0, "young_modulus": 1e6, "poisson_ratio": 0.3,
    }
    table["boundary"], table["probe"], table["time"] = [], [], {"end": 0.001}
    table["body"][0]["initial"] = {}
    points = piola.Case(table).positions("water")
    table["body"][0]["initial"] = {"displacement": 1e-3 * points, "velocity": swirl(points)}
    case = piola.Case(table)
    # Positions are those before it is displaced.
    assert np.array_equal(case.positions("water"), points)
    body = case.start().bodies["water"]
    assert np.array_equal(body["displacement"], 1e-3 * points[body.ids])
    assert np.array_equal(body["velocity"], swirl(points)[body.ids])


def test_set_takes_arrays_and_the_text_names_them(case):
    points = case.positions("water")
    assert case.set("body.water.initial.velocity", swirl(points)) is case
    first = re.findall(r"@array_[0-9a-f]{12}", case.toml)
    assert len(first) == 2 and case.faults() == []
    case.set("body.water.initial.velocity", 2 * swirl(points))
    assert not any(name in case.toml or name in repr(case) for name in first)
    water = case.start().bodies["water"]
    assert np.array_equal(water["velocity"], 2 * swirl(points)[water.ids])
    # They are called by their numbers, and copied.
    velocity = swirl(points)
    case.set("body.water.initial", {"velocity": velocity})
    velocity[:] = 7.0
    assert re.findall(r"@array_[0-9a-f]{12}", case.toml) == first
    water = case.start().bodies["water"]
    assert np.array_equal(water["velocity"], swirl(points)[water.ids])
    assert case.check().bodies[0]["particles"] == 45


ROWS = np.zeros((45, 2))


def spoilt(row, column, value):
    array = ROWS.copy()
    array[row, column] = value
    return array


@pytest.mark.parametrize(
    ("key", "value", "error", "text"),
    [
        ("velocity", spoilt(7, 1, np.nan), ValueError,
         "the array for `body.water.initial.velocity` has NaN at [7, 1], expected finite numbers"),
        ("velocity", np.asfortranarray(spoilt(7, 1, -np.inf)), ValueError, "has -inf at [7, 1]"),
        ("pressure", spoilt(9, 0, np.inf)[:, 0], ValueError,
         "the array for `body.water.initial.pressure` has inf at [9], expected finite numbers"),
        ("velocity.1", spoilt(9, 0, np.nan)[:, 0], ValueError, "`body.water.initial.velocity.1` has NaN at [9]"),
        ("velocity", ROWS[None], ValueError,
         "`body.water.initial.velocity` has the shape (particles, D), not (1, 45, 2)"),
        ("pressure", ROWS, ValueError, "`body.water.initial.pressure` has the shape (particles,), not (45, 2)"),
        ("velocity.0", ROWS, ValueError, "`body.water.initial.velocity.0` has the shape (particles,), not (45, 2)"),
        ("velocity", ROWS[:0], ValueError, "the array is empty, of the shape (0, 2)"),
        ("velocity", ROWS[:, :0], ValueError, "the array is empty, of the shape (45, 0)"),
        ("velocity", ROWS.astype(complex), TypeError, "takes 64-bit floats, not complex128"),
        ("velocity", ROWS.astype(object), TypeError, "takes 64-bit floats, not object"),
        ("velocity", ROWS.astype("U3"), TypeError, "takes 64-bit floats, not <U3"),
    ],
)
def test_bad_arrays_are_refused_at_once(case, key, value, error, text):
    before = repr(case)
    with pytest.raises(error) as caught:
        case.set(f"body.water.initial.{key}", value)
    assert text in str(caught.value)
    assert repr(case) == before


def test_arrays_that_do_not_fit_the_case(table, case):
    def fault(table, velocity):
        (fault,) = given(table, velocity).faults()
        return fault

    wrong = fault(table, ROWS[:44])
    assert wrong.message == (
        "the array for `velocity` of the body `water` has 44 rows, expected 45: one for each of its particles, in the "
        "order of creation"
    )
    assert "positions" in wrong.help and wrong.line is not None
    assert "has 2 rows, expected 45" in fault(table, ROWS[:2]).message
    # As many components as the case has dimensions.
    assert "`velocity`" in fault(table, np.zeros((45, 3))).message
    # Nowhere but in initial states.
    case.set("load+", {"kind": "body_force", "acceleration": ["0", "@array_000000000000"]})
    assert [fault.message for fault in case.faults()] == ["there is no function `@array_000000000000`"]
    with pytest.raises(piola.CaseError):
        given(table, ROWS[:44]).start()


def test_a_run_with_arrays_is_resumed_with_the_same_ones_alone(table, case, tmp_path):
    velocity = swirl(case.positions("water"))
    whole = given(table, velocity).start()
    whole.run()
    with given(table, velocity).start(tmp_path / "out") as simulation:
        simulation.run(until=0.1)
    changed = velocity.copy()
    changed[44, 1] += 1e-12
    with pytest.raises(piola.RunError):
        given(table, changed).start(tmp_path / "out", resume=True)
    again = given(table, velocity).start(tmp_path / "out", resume=True)
    assert again.time > 0
    again.run()
    assert np.array_equal(again.bodies["water"]["position"], whole.bodies["water"]["position"])
    # The program makes the page of it again, without the arrays.
    from helpers import program  # noqa: PLC0415

    assert program("report", tmp_path / "out").returncode == 0
    assert "cannot be read" not in (tmp_path / "out" / "report.html").read_text()


def test_members_of_a_sweep_have_the_array_too(table, case):
    velocity = swirl(case.positions("water"))
    table["body"][0]["initial"] = {"velocity": velocity}
    table["variant"] = [{"name": "slow", "title": "less dissipation", "set": ["scheme.tau_velocity=0.2"]}]
    water = piola.Case(table, variant="slow").start().bodies["water"]
    assert np.array_equal(water["velocity"], velocity[water.ids])


def test_particles_of_other_spacings_have_no_rows():
    from test_systems import CASES  # noqa: PLC0415

    case = piola.Case(CASES["refined"])
    count = len(case.positions("water"))
    (fault,) = case.set("body.water.initial.velocity", np.zeros((count, 2))).faults()
    assert "is an array, which has no values for particles of other spacings" in fault.message


def test_arrays_of_a_fluid_and_of_a_solid_in_it():
    from test_systems import CASES  # noqa: PLC0415

    case = piola.Case(CASES["coupled"])
    expected = {}
    for name in ("water", "lid"):
        expected[name] = 1e-3 * np.random.default_rng(7).normal(size=case.positions(name).shape)
        case.set(f"body.{name}.initial.velocity", expected[name])
    simulation = case.start()
    for name, velocity in expected.items():
        body = simulation.bodies[name]
        assert np.array_equal(body["velocity"], velocity[body.ids - body.ids.min()])
