"""Python functions as loads, boundary values and initial fields."""

import threading
import traceback

import numpy as np
import pytest

import piola


def pushed(table, initial, push, floor):
    """The column with an initial velocity, a body force and a floor."""
    table["body"][0]["initial"]["velocity"] = initial
    table["load"] = [{"kind": "body_force", "acceleration": push}]
    table["boundary"][0]["velocity"]["y"] = floor
    return piola.Case(table)


def run(case):
    simulation = case.start()
    simulation.run()
    return simulation.bodies["water"]["position"]


def test_functions_are_what_expressions_are(table):
    """Products and sums are rounded the same in both; the rate of the floor is a difference quotient in one."""
    theirs = run(pushed(table, ["0.1 * y", "-1"], ["2 * x + t", "-9.81 * t"], "0.5"))
    with_functions = pushed(
        table,
        [lambda y: 0.1 * y, lambda: -1],
        [lambda x, t: 2 * x + t, lambda t: -9.81 * t],
        lambda: 0.5,
    )
    assert "@lambda_" in with_functions.toml
    ours = run(with_functions)
    assert np.array_equal(ours, theirs) and np.abs(ours).max() > 1.5
    moving = run(pushed(table, ["0", "0"], ["0", "0"], "0.5 * t^2"))
    by_function = run(pushed(table, ["0", "0"], ["0", "0"], lambda t: 0.5 * t * t))
    assert np.allclose(by_function, moving, rtol=0, atol=1e-9)


def test_set_takes_functions(table, case):
    def gravity(t):
        return -9.81

    case.set("load+", {"kind": "body_force", "acceleration": ["0", gravity]})
    assert '"@gravity_0"' in case.toml
    assert np.array_equal(run(case), run(pushed(table, ["0", "-1"], ["0", "-9.81"], "0")))


def test_values_are_asked_for_once_where_that_will_do(table):
    calls = {"place": 0, "time": 0, "both": 0}

    def place(x):
        calls["place"] += 1
        return 0.1 * x

    def time(t):
        calls["time"] += 1
        return -t

    case = pushed(table, ["0", "-1"], [place, time], "0")
    simulation = case.start()
    simulation.run()
    # There are five places along x; at each time the load is asked for 45 particles.
    assert calls["place"] == 5
    assert simulation.steps <= calls["time"] < 6 * simulation.steps


def test_functions_are_called_from_threads_that_others_do_not_wait_for(table):
    """A thread that reads meanwhile neither stops the run nor is stopped by it."""
    table["time"]["end"] = 0.5
    simulation = pushed(table, ["0", "0"], ["0", lambda x, t: -9.81], "0").start()
    done = threading.Event()
    reader = threading.Thread(
        target=lambda: [simulation.bodies["water"]["velocity"] for _ in iter(done.is_set, True)]
    )
    reader.start()
    assert simulation.run().outcome == "completed"
    done.set()
    reader.join(60)
    assert not reader.is_alive()


@pytest.mark.parametrize("with_folder", [False, True])
def test_a_function_that_raises_stops_the_run(table, tmp_path, with_folder):
    def gravity(t):
        if t > 0.1:
            raise LookupError(f"no gravity at {t}")
        return -9.81

    folder = tmp_path / "out" if with_folder else None
    simulation = pushed(table, ["0", "-1"], ["0", gravity], "0").start(folder)
    with pytest.raises(LookupError, match="no gravity at 0.1") as caught:
        simulation.run()
    assert traceback.extract_tb(caught.value.__traceback__)[-1].name == "gravity"
    # It has ended with its last good state.
    assert simulation.result is not None and 0.05 < simulation.time <= 0.11
    assert np.isfinite(simulation.bodies["water"]["position"]).all()
    if with_folder:
        assert f'timestep="{simulation.time}"' in (folder / "particles.pvd").read_text()
        assert (folder / "report.html").exists()
        assert "a function of the case has raised" in (folder / "run.json").read_text()
    assert not simulation.step()


@pytest.mark.parametrize(
    ("function", "error", "text"),
    [
        (lambda t: float("nan"), ValueError, "the function `lambda_0` returned NaN for t = 0.0"),
        (lambda x: float("inf"), ValueError, "the function `lambda_0` returned inf for x = "),
        (lambda x, t: "much", TypeError, "the function `lambda_0` returned 'much', where a number is needed"),
        (lambda t: np.array([1.0, 2.0]), TypeError, "where a number is needed"),
        (lambda t: 1 / 0, ZeroDivisionError, "division by zero"),
    ],
)
def test_values_that_are_no_numbers_stop_the_run(table, function, error, text):
    with pytest.raises(error, match=None) as caught:
        run(pushed(table, ["0", "-1"], ["0", function], "0"))
    assert text in str(caught.value)


def test_functions_of_something_else_are_refused(table, case):
    with pytest.raises(TypeError, match="takes some of x, y, z .* not `mass`"):
        case.set("load+", {"kind": "body_force", "acceleration": ["0", lambda mass: 1.0]})
    with pytest.raises((TypeError, ValueError)):
        case.set("load+", {"kind": "body_force", "acceleration": ["0", max]})
    # Where a case has a number, and at the start, which has no time.
    (fault,) = piola.Case(table).set("time.end", lambda: 1.0).faults()
    assert fault.source == "command line"
    (fault,) = piola.Case(table).set("body.0.initial.velocity", [lambda t: 1.0, "0"]).faults()
    assert fault.message == "`velocity` is the same at all times, and `@lambda_0` is a function of t"


def test_names_of_functions_that_were_not_given(table):
    (fault,) = piola.Case(table).set("body.0.initial.velocity", ["@fast", "0"]).faults()
    assert fault.message == "there is no function `@fast`"


def test_a_function_cannot_look_at_the_simulation(table):
    kept = []

    def curious(t):
        if t > 0.05:
            assert kept[0].time >= 0.0
            return kept[0].energy["kinetic"]
        return 0.0

    kept.append(pushed(table, ["0", "-1"], ["0", curious], "0").start())
    with pytest.raises(RuntimeError, match="its own is waiting for the value"):
        kept[0].run()


def test_a_function_cannot_start_a_run(table, case):
    with pytest.raises(RuntimeError, match="nor start one"):
        run(pushed(table, ["0", "-1"], ["0", lambda t: case.check().step], "0"))


def test_a_run_with_functions_is_resumed_with_the_same_bits(table, tmp_path):
    def case():
        return pushed(table, ["0", "-1"], ["0", lambda y, t: -y * t], "0")

    whole = run(case())
    with case().start(tmp_path / "out") as simulation:
        simulation.run(until=0.1)
    again = case().start(tmp_path / "out", resume=True)
    again.run()
    assert np.array_equal(again.bodies["water"]["position"], whole)
    # The program makes the page of it again, without the functions.
    from helpers import program  # noqa: PLC0415

    assert program("report", tmp_path / "out").returncode == 0
    assert "cannot be read" not in (tmp_path / "out" / "report.html").read_text()


def test_runs_of_a_case_do_not_know_of_each_other(table):
    """What a function gives, or raises, in one run is nothing to another."""
    strength = [-9.81]

    def gravity(t):
        if strength[0] is None:
            raise LookupError("no gravity")
        return strength[0]

    case = pushed(table, ["0", "-1"], ["0", gravity], "0")
    first, second = case.start(), case.start()
    first.run(until=0.1)
    strength[0] = None
    with pytest.raises(LookupError, match="no gravity"):
        second.run()
    # The first goes on, and a third begins with the function as it is now.
    strength[0] = 9.81
    third = case.start()
    assert first.run().outcome == "completed" and third.run().outcome == "completed"
    plain = run(pushed(table, ["0", "-1"], ["0", "9.81"], "0"))
    assert np.array_equal(third.bodies["water"]["position"], plain)
