"""Fields, tables and pictures as arrays."""

import gc
import weakref

import numpy as np
import pytest

import piola


def test_shapes_units_and_names(case):
    body = case.start().bodies["water"]
    assert len(body) == 45 and body.name == "water" and repr(body) == "<Body water of 45 particles>"
    assert sorted(body.ids) == list(range(45))
    shapes = {name: body[name].shape for name in ("pressure", "velocity", "deformation_gradient")}
    assert shapes == {"pressure": (45,), "velocity": (45, 2), "deformation_gradient": (45, 2, 2)}
    assert np.array_equal(body["deformation_gradient"], np.broadcast_to(np.eye(2), (45, 2, 2)))
    assert body["velocity"].dtype == np.float64
    name, unit, meaning = next(field for field in body.fields() if field[0] == "velocity")
    assert (unit, meaning) == ("m/s", "velocity v")
    assert list(body) == body.keys() == [field[0] for field in body.fields()]
    assert "velocity" in body and "temperature" not in body


def test_positions_are_the_lattice(case):
    body = case.start().bodies["water"]
    x, y = np.meshgrid(np.arange(5) * 0.25, np.arange(9) * 0.25)
    expected = np.stack([x.ravel(), y.ravel()], axis=1)
    found = body["position"][np.lexsort(body["position"].T)]
    assert np.allclose(found, expected, rtol=0, atol=1e-12)


def test_bodies_are_a_mapping(case):
    bodies = case.start().bodies
    assert list(bodies) == bodies.keys() == ["water"] and len(bodies) == 1
    assert "water" in bodies and "air" not in bodies
    with pytest.raises(KeyError, match="there is no body `air`; there are `water`"):
        bodies["air"]


def address(array):
    return array.__array_interface__["data"][0]


def test_arrays_look_at_the_memory_of_the_state(case):
    simulation = case.start()
    body = simulation.bodies["water"]
    velocity, again = body["velocity"], body["velocity"]
    assert np.shares_memory(velocity, again) and address(velocity) == address(again)
    assert np.shares_memory(velocity, simulation.particles["velocity"])
    assert not np.shares_memory(velocity, body["position"])
    field = velocity.base
    assert isinstance(field, piola.Field) and field is not again.base
    assert (field.name, field.unit, field.body, field.steps, field.time) == ("velocity", "m/s", "water", 0, 0.0)
    assert not field.is_copy and field.is_current
    # What is computed of the state is a copy, which says so.
    pressure = body["pressure"]
    assert pressure.base.is_copy and pressure.base.is_current
    assert not np.shares_memory(pressure, body["pressure"])
    assert repr(field) == "<Field velocity of water at t = 0 s>"
    assert repr(simulation.particles["pressure"].base) == "<Field pressure at t = 0 s, a copy>"


def test_arrays_stay_as_they_are_and_say_that_they_are_past(case):
    simulation = case.start()
    body = simulation.bodies["water"]
    held = {name: body[name] for name in ("velocity", "deformation_gradient", "pressure")}
    copies = {name: array.copy() for name, array in held.items()}
    moment = simulation.now()
    assert moment.is_current
    for _ in range(5):
        simulation.step()
        # Two states ago was elsewhere: the buffers take turns.
        later = body["velocity"]
        assert not np.shares_memory(held["velocity"], later)
        assert not np.array_equal(held["velocity"], later)
    assert not moment.is_current
    for name, array in held.items():
        assert np.array_equal(array, copies[name])
        assert not array.base.is_current and array.base.time == 0.0 and array.base.steps == 0
    assert repr(held["velocity"].base).endswith("at t = 0 s, past>")
    current = body["velocity"]
    assert current.base.is_current and current.base.time == simulation.time
    # A field that is set is another state.
    body["velocity"] = 2.0 * current
    assert not current.base.is_current and body["velocity"].base.is_current
    before = body["velocity"]
    kept = before.copy()
    body["velocity"] = 0.5 * before
    assert np.array_equal(before, kept) and np.array_equal(body["velocity"][:, 0], 0.5 * kept[:, 0])


def test_slices_are_traced_to_their_field(case):
    simulation = case.start()
    velocity = simulation.bodies["water"]["velocity"]
    for part in (velocity, velocity[3:, 1], velocity.T[::-1], np.asarray(velocity)):
        assert piola.field_of(part) is velocity.base
    assert piola.field_of(velocity.copy()) is None and piola.field_of(np.zeros(3)) is None
    assert piola.field_of(2.0 * velocity) is None


def test_arrays_are_read_only(case):
    body = case.start().bodies["water"]
    for name in ("velocity", "pressure"):
        array = body[name]
        before = array.copy()
        for part in (array, array[:3], array.T):
            assert not part.flags.writeable
            with pytest.raises(ValueError, match="read-only"):
                part[...] = 7.0
            with pytest.raises(ValueError, match="WRITEABLE"):
                part.flags.writeable = True
        assert np.array_equal(body[name], before)
    # To work with numbers of one's own, and to set them.
    own = body["velocity"].copy()
    own[:] = 7.0
    body["velocity"] = own
    own[:] = 9.0
    assert body["velocity"].max() == 7.0


def test_memory_is_given_back(case):
    """Of a hundred states that were looked at, those are in memory that an array is left of."""
    simulation = case.set("time.end", 2.0).start()
    body = simulation.bodies["water"]
    array = body["velocity"]
    gone = weakref.ref(array.base)
    part = array[3:]
    del array
    assert gone() is not None
    del part
    gc.collect()
    assert gone() is None
    # Without an array of it the memory of a state serves a later one: three take turns.
    places = {address(body["velocity"]) for _ in range(30) if simulation.step()}
    assert len(places) == 3
    held = [body["velocity"] for _ in range(30) if simulation.step()]
    assert len({address(array) for array in held}) == 30


def test_an_array_outlives_its_simulation(case):
    simulation = case.start()
    array = simulation.bodies["water"]["velocity"]
    copy = array.copy()
    del simulation
    gc.collect()
    junk = [np.full((45, 2), 3.0) for _ in range(1000)]
    assert np.array_equal(array, copy) and len(junk) == 1000


def test_what_looks_at_a_run_changes_no_bit_of_it(case):
    plain, seen, held = case.start(), case.start(), []
    plain.run()
    for moment in seen.every(0.01):
        held.append((moment.bodies["water"]["position"], moment.bodies["water"]["position"].copy()))
    assert all(np.array_equal(array, copy) for array, copy in held)
    for name in ("position", "velocity", "deformation_gradient", "pressure"):
        assert np.array_equal(seen.bodies["water"][name], plain.bodies["water"][name])
    assert np.array_equal(seen.tables["energy"].array, plain.tables["energy"].array)


def test_tensors_have_their_axes(table):
    """States have tensors column by column."""
    table["body"][0]["initial"]["velocity"] = ["0.3 * y", "0"]
    table["boundary"] = []
    simulation = piola.Case(table).start()
    simulation.step()
    body = simulation.bodies["water"]
    tensor = body["deformation_gradient"]
    assert tensor.shape == (45, 2, 2) and not tensor.base.is_copy
    # F_xy is dv_x/dy times the time, and dv_y/dx is 0, to the first order in the step.
    middle = np.argmin(np.linalg.norm(body["position"] - [0.5, 1.0], axis=1))
    assert tensor[middle, 0, 1] > 10 * abs(tensor[middle, 1, 0])


def test_initial_fields_from_arrays(case):
    simulation = case.start()
    body = simulation.bodies["water"]
    x, y = body["position"].T
    field = np.stack([0.1 * y, -0.2 * x], axis=1)
    body["velocity"] = field
    floor = y == 0.0
    assert floor.sum() == 5
    # What is prescribed stays as it is.
    expected = field.copy()
    expected[floor, 1] = 0.0
    assert np.array_equal(body["velocity"], expected)
    volume, density = body["volume"], 1000.0
    kinetic = 0.5 * (density * volume * (expected**2).sum(axis=1)).sum()
    assert simulation.energy["kinetic"] == pytest.approx(kinetic, rel=1e-13)
    # The run starts from there, as one of a case that says so does.
    other = case.set("body.water.initial.velocity", ["0.1 * y", "-0.2 * x"]).start()
    simulation.run()
    other.run()
    assert np.array_equal(body["velocity"], other.bodies["water"]["velocity"])


def test_any_memory_order_and_exact_type(case):
    body = case.start().bodies["water"]
    field = np.arange(90.0).reshape(45, 2)
    floor = body["position"][:, 1] == 0.0
    expected = field.copy()
    expected[floor, 1] = 0.0
    wide = np.zeros((45, 4))
    wide[:, ::2] = field
    backward = field[::-1].copy()[::-1]
    forms = [field.astype(np.int32), field.astype(np.float32), np.asfortranarray(field), wide[:, ::2],
             backward, field.astype(">f8"), field.tolist()]
    for form in forms:
        body["velocity"] = np.zeros((45, 2))
        body["velocity"] = form
        assert np.array_equal(body["velocity"], expected)


@pytest.mark.parametrize(
    ("values", "error", "text"),
    [
        (np.zeros((45, 3)), ValueError, "`velocity` of `water` has the shape (45, 2), not (45, 3)"),
        (np.zeros((2, 45)), ValueError, "has the shape (45, 2), not (2, 45)"),
        (np.zeros(90), ValueError, "has the shape (45, 2), not (90,)"),
        (0.0, ValueError, "has the shape (45, 2), not ()"),
        (np.zeros((45, 2), complex), TypeError, "takes 64-bit floats, not complex128"),
        (np.full((45, 2), "1"), TypeError, "takes 64-bit floats, not <U1"),
        (np.zeros((45, 2), object), TypeError, "takes 64-bit floats, not object"),
        (None, TypeError, "takes 64-bit floats, not object (of a `NoneType`)"),
        (np.full((45, 2), np.nan), ValueError, "the value for particle 0, component x, of the field `velocity` is NaN"),
        (np.full((45, 2), np.inf), ValueError, "the value for particle 0, component x, of the field `velocity` is inf"),
    ],
)
def test_bad_arrays_are_refused_and_change_nothing(case, values, error, text):
    simulation = case.start()
    body = simulation.bodies["water"]
    before = body["velocity"]
    with pytest.raises(error) as caught:
        body["velocity"] = values
    assert text in str(caught.value)
    assert np.array_equal(body["velocity"], before)
    moment = simulation.now()
    with pytest.raises(error):
        body["velocity"] = values
    assert np.array_equal(moment.bodies["water"]["velocity"], before)


def test_fields_that_are_not_there_or_cannot_be_set(case):
    body = case.start().bodies["water"]
    with pytest.raises(KeyError, match="the scheme `upwind` has no field `velocty`; expected `position`"):
        body["velocty"]
    with pytest.raises(KeyError, match="has no field `velocty`"):
        body["velocty"] = np.zeros((45, 2))
    with pytest.raises(ValueError, match="the field `pressure` cannot be set; only `velocity` can be set"):
        body["pressure"] = np.zeros(45)
    with pytest.raises(TypeError, match="a field cannot be deleted: `velocity`"):
        del body["velocity"]


def test_one_body_of_two_is_set_alone(table):
    other = {**table["body"][0], "name": "other"}
    other["shape"] = {"kind": "box", "min": [3.0, 0.0], "max": [4.0, 2.0]}
    table["body"].append(other)
    simulation = piola.Case(table).start()
    first, second = (simulation.bodies[name] for name in ("water", "other"))
    assert sorted([*first.ids, *second.ids]) == list(range(90))
    assert first["position"][:, 0].max() < 2 < second["position"][:, 0].min()
    before = first["velocity"]
    second["velocity"] = np.full((45, 2), 0.5)
    assert np.array_equal(first["velocity"], before)
    assert second["velocity"][:, 0].min() == 0.5


def test_bodies_among_all_particles(table):
    """Two bodies that touch share cells: rows of one do not follow each other, and it is copied."""
    table["body"][0]["initial"]["velocity"] = ["0.3 * y", "0"]
    upper = {**table["body"][0], "name": "upper"}
    table["body"][0]["shape"] = {"kind": "box", "min": [0.0, 0.0], "max": [1.0, 0.75]}
    upper["shape"] = {"kind": "box", "min": [0.0, 1.0], "max": [1.0, 2.0]}
    table["body"].append(upper)
    simulation = piola.Case(table).start()
    every = simulation.particles
    assert every.name is None and repr(every) == "<Body of 45 particles>" and len(every) == 45
    rows = [simulation.bodies[name].rows for name in ("water", "upper")]
    assert sorted(np.concatenate(rows)) == list(range(45)) and np.array_equal(every.rows, np.arange(45))
    simulation.step()
    for name, own in zip(("water", "upper"), rows, strict=True):
        body = simulation.bodies[name]
        for field in ("velocity", "deformation_gradient", "pressure"):
            array = body[field]
            assert np.array_equal(array, every[field][own])
            is_stretch = np.array_equal(own, np.arange(own[0], own[-1] + 1))
            assert array.base.is_copy == (field == "pressure" or not is_stretch)
        assert np.array_equal(body.ids, every.ids[own])
    assert not every["velocity"].base.is_copy
    gradient = every["deformation_gradient"]
    assert not np.array_equal(gradient, gradient.transpose(0, 2, 1))
    # All of them are set at once.
    every["velocity"] = np.full((45, 2), 0.25)
    assert simulation.bodies["upper"]["velocity"].max() == 0.25
    with pytest.raises(ValueError, match="`velocity` of all particles has the shape"):
        every["velocity"] = np.zeros((44, 2))


def test_energy_limits_and_tables_agree(case):
    simulation = case.start()
    assert simulation.limits == case.check().limits
    simulation.run()
    energy = simulation.energy
    table = simulation.tables["energy"]
    assert energy["total"] == sum(value for name, value in energy.items() if name != "total")
    for name, value in energy.items():
        assert table[name][-1] == value
    assert table["time"].tolist() == simulation.tables["steps"]["time"].tolist()
    assert len(table) == 21 and table.array.shape == (21, len(table.columns))
    assert table.units["total"] == "J" and "total" in table and list(table) == table.columns
    with pytest.raises(KeyError, match="there is no column `potential`; there are `time`"):
        table["potential"]
    html = table._repr_html_()
    assert html.count("<tr>") == 1 + 5 + 1 + 5 and "<th>total [J]</th>" in html


def test_histories_profiles_and_quantities(table):
    table["probe"].append(
        {"name": "axis", "kind": "line", "from": [0.5, 0.0], "to": [0.5, 2.0], "points": 9, "fields": ["pressure"]}
    )
    simulation = piola.Case(table).start()
    run = simulation.run()
    tables = run.tables
    assert list(tables) == ["probes", "energy", "momentum", "steps", "axis"]
    time, top = tables.curve("top.displacement.y")
    assert np.array_equal(time, tables["probes"]["time"])
    assert np.array_equal(top, tables["probes"]["top.displacement.y"])
    assert np.array_equal(top, run.quantity("top.displacement.y"))
    distance, pressure = tables.curve("axis.pressure")
    assert np.allclose(distance, np.linspace(0, 2, 9)) and pressure.shape == (9,)
    assert np.array_equal(tables["axis"]["axis.pressure"], pressure)
    assert {"top.displacement.y", "energy.total", "axis.pressure"} <= set(tables.curves())
    assert run.quantity("run.steps") == run.steps and run.quantity("run.outcome") == "completed"
    for ask in (lambda: tables.curve("none"), lambda: run.quantity("run.none"), lambda: tables["none"]):
        with pytest.raises(KeyError):
            ask()


def test_tables_can_be_read_while_a_run_goes(case):
    simulation = case.start()
    assert len(simulation.tables["energy"]) == 0
    simulation.run(until=0.1)
    assert len(simulation.tables["energy"]) == 11
    assert len(simulation.run().tables["energy"]) == 21


def test_pandas(case):
    pandas = pytest.importorskip("pandas")
    simulation = case.start()
    simulation.run()
    table = simulation.tables["steps"]
    frame = table.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == table.columns
    assert np.array_equal(frame.to_numpy(), table.array)


def test_pictures(table, tmp_path):
    table["picture"] = [{"field": "pressure", "times": [0.1, 0.2]}]
    run = piola.Case(table).start(tmp_path / "out").run()
    assert len(run.pictures) == 2
    for picture in run.pictures:
        assert picture._repr_png_().startswith(b"\x89PNG")
        assert picture.path.startswith(str(tmp_path / "out" / "pictures"))
    in_memory = piola.Case(table).start()
    run = in_memory.run()
    assert run.pictures == [] and run.report is None and run.folder is None and run.files == []
    assert "completed" in run._repr_html_() and in_memory._repr_html_() == run._repr_html_()


def test_simulations_in_a_notebook(case):
    simulation = case.start()
    simulation.step()
    assert simulation._repr_html_().startswith("<table><caption>a column of water</caption>")
    assert repr(case) == "<Case of a dict>"


def test_texts_have_six_digits_and_one_step(case):
    simulation = case.set("output.table_every", 0.01 / 3).start()
    simulation.step()
    time = f"t = {simulation.time:.6g}"
    assert len(time) < len(f"t = {simulation.time}")
    assert repr(simulation) == f"<Simulation at {time} s of 0.2 s, after 1 step>"
    assert repr(simulation.now()) == f"<Moment {time} s, after 1 step>"
    assert repr(simulation.bodies["water"]["velocity"].base) == f"<Field velocity of water at {time} s>"
    assert f"1, the last of {simulation.step_size:.6g} s (" in simulation._repr_html_()
    steps = simulation.run().steps
    assert repr(simulation.result) == f"<Run completed at t = 0.2 s, after {steps} steps>"
    table = simulation.tables["energy"]
    assert repr(table).startswith(f"<Table of {len(table)} rows: time, kinetic")
    assert repr(case.check()).startswith("<Plan of 45 particles, ")
