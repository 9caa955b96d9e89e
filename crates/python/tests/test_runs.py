"""Runs: steps, files, failures, interruptions, threads."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import traceback

import numpy as np
import pytest

import piola

from helpers import data_of, program


def test_results_are_those_of_the_program_to_the_bit(case, tmp_path):
    (tmp_path / "case.toml").write_text(case.toml)
    shown = program("run", "case.toml", "--quiet", "--out", "theirs", cwd=tmp_path)
    assert shown.returncode == 0, shown.stderr
    run = case.start(tmp_path / "ours").run()
    ours, theirs = data_of(tmp_path / "ours"), data_of(tmp_path / "theirs")
    assert {"energy.csv", "probes.csv", "particles/frame_000002.vtp"} <= set(theirs)
    assert ours == theirs
    # Tables are their files, to the bit.
    for name in ("probes", "energy", "momentum", "steps"):
        table = run.tables[name]
        read = np.loadtxt(tmp_path / "theirs" / f"{name}.csv", delimiter=",", skiprows=1)
        assert np.array_equal(table.array, read)
        header = (tmp_path / "theirs" / f"{name}.csv").read_text().splitlines()[0].split(",")
        assert header == [f"{column} [{unit}]" for column, unit in table.units.items()]
    assert run.report == tmp_path / "ours" / "report.html" and run.report in run.files
    html = run._repr_html_()
    assert html.startswith("<iframe srcdoc=") and "a column of water" in html
    assert (run.folder, run.title, run.outcome) == (tmp_path / "ours", case.title, "completed")


def test_however_steps_are_taken_the_bits_are_the_same(case):
    whole = case.start()
    run = whole.run()
    assert run.outcome == "completed" and run.time == whole.time == 0.2
    state = whole.bodies["water"]["position"]

    by_hand = case.start()
    count = 0
    while by_hand.step():
        count += 1
        assert by_hand.steps == count
    assert by_hand.result.steps == run.steps == count + 1

    pieces = case.start()
    assert pieces.run(until=0.05) is None
    assert 0.05 <= pieces.time < 0.07
    assert pieces.run(until=0.01) is None
    pieces.run(until=1.0)

    iterated = case.start()
    for moment in iterated.every(0.03):
        moment.energy, moment.limits  # noqa: B018

    watched = case.start()
    watched.observe(0.03, lambda moment: moment.bodies["water"]["pressure"])
    watched.run()

    for other in (by_hand, pieces, iterated, watched):
        assert np.array_equal(other.bodies["water"]["position"], state)
        assert np.array_equal(other.result.tables["energy"].array, run.tables["energy"].array)
        assert not other.step()
        assert other.run() is other.result is other.finish()


def test_moments_are_those_after_multiples(case):
    simulation = case.start()
    moments = list(simulation.every(0.05))
    times = [moment.time for moment in moments]
    assert times[0] == 0.0 and times[-1] == 0.2 and len(times) == 5
    for number, moment in enumerate(moments):
        assert moment.time >= 0.05 * number * (1 - 1e-12)
        # No multiple lies between it and the step before.
        assert moment.time - moment.step_size < 0.05 * number or number == 0
    with pytest.raises(RuntimeError, match=r"this moment is at t = 0 s, and the state has changed since \(now t = 0.2 s\)"):
        moments[0].bodies  # noqa: B018
    assert list(simulation.every(0.05))[0].time == 0.2
    for interval in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="the interval must be a time above 0 in s"):
            simulation.every(interval)
        with pytest.raises(ValueError, match="the interval must be a time above 0 in s"):
            simulation.observe(interval, print)
    with pytest.raises(ValueError, match="until must be a time in s, not nan"):
        simulation.run(until=float("nan"))
    with pytest.raises(TypeError, match="an observer must be a function"):
        simulation.observe(0.1, 3)


def test_fields_of_a_moment_that_is_over_are_gone(case):
    simulation = case.start()
    moment = simulation.now()
    body = moment.bodies["water"]
    kept = body["velocity"]
    assert np.array_equal(kept[:, 1], np.where(kept[:, 1] == 0, 0.0, -1.0))
    simulation.step()
    for ask in (lambda: body["velocity"], lambda: body.ids, lambda: len(body), lambda: moment.energy, lambda: moment.limits):
        with pytest.raises(RuntimeError, match="read what you need before a step or a new value; arrays remain valid"):
            ask()
    with pytest.raises(RuntimeError, match="the state has changed since"):
        body["velocity"] = kept
    # What was read stays.
    assert kept[:, 1].min() == -1.0
    assert simulation.now().bodies["water"]["velocity"].shape == kept.shape


def test_observers_see_the_start_the_multiples_and_the_end(case):
    simulation = case.start()
    seen, late = [], []
    simulation.observe(0.05, lambda moment: seen.append((moment.time, moment.energy["kinetic"])))
    simulation.run(until=0.1)
    simulation.observe(0.08, lambda moment: late.append(moment.time))
    simulation.run()
    reference = case.start()
    assert seen == [(moment.time, moment.energy["kinetic"]) for moment in reference.every(0.05)]
    assert len(late) == 2 and 0.16 <= late[0] < late[1] == 0.2


@pytest.mark.parametrize("interval", [1e-9, 1e-300, 5e-324])
def test_intervals_shorter_than_any_step_are_every_step(case, interval):
    simulation = case.start()
    seen = []
    simulation.observe(interval, lambda moment: seen.append(moment.steps))
    simulation.run()
    assert seen == list(range(simulation.steps + 1))
    assert [moment.steps for moment in case.start().every(interval)] == seen


def test_a_run_that_fails_says_where_and_why(failing, tmp_path):
    simulation = failing.start(tmp_path / "out")
    with pytest.raises(piola.RunError) as caught:
        simulation.run()
    error = caught.value
    (tmp_path / "case.toml").write_text(failing.toml)
    shown = program("run", "case.toml", "--quiet", "--out", "theirs", cwd=tmp_path)
    assert shown.returncode == 3
    assert str(error).startswith("the run failed: particle ") and shown.stderr.startswith(f"error: {error}\n")
    assert error.kind == "too_fast" and error.run.outcome == "failed: too_fast"
    assert str(error) == f"the run failed: {error.run.message}"
    assert (error.time, error.step) == (simulation.time, simulation.steps)
    water = simulation.bodies["water"]
    (row,) = np.flatnonzero(water.ids == error.particle)
    reference = (water["position"] - water["displacement"])[row]
    assert np.allclose(error.place, reference, rtol=0, atol=1e-12)
    assert f"particle {error.particle} " in str(error)
    # The last good state is on disk, and can be read.
    assert (tmp_path / "out" / "failure.csv").exists()
    assert np.linalg.norm(water["velocity"], axis=1).max() <= 1.02
    assert not simulation.step() and simulation.run() is error.run


def test_moments_of_a_run_that_fails(failing):
    moments = failing.start().every(0.01)
    with pytest.raises(piola.RunError):
        for _ in moments:
            pass


def test_a_folder_with_other_files_is_refused(case, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    simulation = case.start(tmp_path)
    with pytest.raises(piola.RunError) as caught:
        simulation.run()
    assert caught.value.kind == "files" and caught.value.particle is None
    assert (tmp_path / "mine.txt").read_text() == "mine"
    with pytest.raises(ValueError, match="resuming a run needs the folder"):
        case.start(resume=True)


def test_a_run_can_be_ended_and_resumed_with_the_same_bits(case, tmp_path):
    whole = case.start()
    whole.run()
    with case.start(tmp_path / "out") as simulation:
        simulation.run(until=0.1)
    assert simulation.result.outcome == "interrupted" and simulation.time < 0.12
    again = case.start(tmp_path / "out", resume=True)
    assert again.time == simulation.time
    again.run()
    assert np.array_equal(again.bodies["water"]["velocity"], whole.bodies["water"]["velocity"])
    assert np.array_equal(again.tables["probes"].array, whole.tables["probes"].array)
    other = case.set("time.cfl", 0.2)
    (tmp_path / "out" / "checkpoints").mkdir(exist_ok=True)
    with pytest.raises(piola.RunError, match="checkpoint"):
        other.start(_interrupted(case, tmp_path / "third"), resume=True)


def _interrupted(case, folder):
    """The folder of a run with other steps that was broken off."""
    case.set("time.cfl", 0.3)
    with case.start(folder) as simulation:
        simulation.run(until=0.1)
    case.set("time.cfl", 0.2)
    return folder


@pytest.mark.parametrize("with_folder", [False, True])
def test_a_callback_that_raises_stops_the_run(case, tmp_path, with_folder):
    whole = case.start()
    whole.run()

    raised = []

    def broken(moment):
        if moment.time > 0.1 and not raised:
            raised.append(moment.time)
            raise LookupError(f"at {moment.time}")

    folder = tmp_path / "out" if with_folder else None
    simulation = case.start(folder)
    simulation.observe(0.05, broken)
    with pytest.raises(LookupError, match="at 0.1") as caught:
        simulation.run()
    frames = traceback.extract_tb(caught.value.__traceback__)
    assert frames[-1].name == "broken" and frames[-1].line.startswith("raise LookupError")
    assert 0.1 < simulation.time == raised[0] < 0.2
    if with_folder:
        # Its last state is on disk, and the run goes on from there.
        assert simulation.result.outcome == "failed: outside"
        assert "an exception stopped the run" in (folder / "run.json").read_text()
        assert f'timestep="{simulation.time}"' in (folder / "particles.pvd").read_text()
        simulation = case.start(folder, resume=True)
        assert simulation.time == raised[0]
    else:
        # It can go on where it is.
        assert simulation.result is None
    simulation.run()
    assert np.array_equal(simulation.bodies["water"]["position"], whole.bodies["water"]["position"])


def test_a_callback_cannot_take_steps(case):
    simulation = case.start()
    simulation.observe(0.05, lambda moment: simulation.step())
    with pytest.raises(RuntimeError, match="the simulation is taking steps already"):
        simulation.run()


def test_threads_go_on_while_steps_are_taken(long):
    simulation = long.start()
    done, problems = threading.Event(), []

    def run():
        try:
            simulation.run(until=1.0)
        except BaseException as error:  # noqa: BLE001
            problems.append(error)
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    turns, times, held = 0, set(), []
    try:
        while len(times) < 20 and not done.is_set():
            turns += 1
            times.add(simulation.time)
            # A state between two steps, while the other thread takes them.
            velocity = simulation.bodies["water"]["velocity"]
            assert np.isfinite(velocity).all()
            if len(held) < len(times):
                held.append((velocity, velocity.copy()))
        # This thread has seen the time of the other go on, and never waited for its end.
        assert len(times) == 20 and not done.is_set()
        with pytest.raises(RuntimeError, match="another thread"):
            simulation.step()
    finally:
        simulation.observe(1e-6, _stop)
        thread.join(60)
    assert [type(problem) for problem in problems] == [StopIteration]
    # None of them was written to meanwhile.
    assert all(np.array_equal(array, copy) for array, copy in held)


def _stop(moment):
    raise StopIteration


def test_progress_is_shown(case, capfd):
    simulation = case.start()
    simulation.run(progress=True)
    shown = capfd.readouterr().err
    last = shown.rstrip("\n").split("\r")[-1]
    assert last.startswith("100.0 %, 0 s left, t = 0.2 of 0.2 s, ")
    assert f"{simulation.steps} steps" in last


SCRIPT = """
    import os, signal, sys, threading, piola
    case = piola.Case.load(sys.argv[1])
    simulation = case.start(sys.argv[2] if len(sys.argv) > 2 else None)
    threading.Timer(0.7, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        simulation.run()
    except KeyboardInterrupt:
        before = simulation.time
        print("stopped", before, simulation.result and simulation.result.outcome)
        if simulation.result is None:
            simulation.step()
            assert simulation.time > before
        sys.exit(7)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals are another matter there")
@pytest.mark.parametrize("with_folder", [False, True])
def test_ctrl_c_stops_after_a_step(long, tmp_path, with_folder):
    file, out = tmp_path / "case.toml", tmp_path / "out"
    file.write_text(long.toml)
    arguments = [sys.executable, "-c", textwrap.dedent(SCRIPT), file, *([out] if with_folder else [])]
    start = time.monotonic()
    ended = subprocess.run(arguments, capture_output=True, text=True, check=False, timeout=60)
    assert ended.returncode == 7, ended.stderr
    assert time.monotonic() - start < 30
    word, reached, outcome = ended.stdout.split()
    assert word == "stopped" and float(reached) > 0
    assert outcome == ("interrupted" if with_folder else "None")
    if with_folder:
        assert piola.Case.load(file).start(out, resume=True).time == float(reached)


@pytest.mark.skipif(os.name == "nt", reason="signals are another matter there")
def test_ctrl_c_stops_the_command(long, tmp_path):
    (tmp_path / "case.toml").write_text(long.toml)
    command = [sys.executable, "-m", "piola", "run", "case.toml", "--out", "out"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    while not (tmp_path / "out" / "run.json").exists():
        time.sleep(0.05)
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    _, shown = process.communicate(timeout=60)
    assert process.returncode == 130, shown
    assert "stopping after this step" in shown and "Traceback" not in shown


def test_the_command_is_the_program(tmp_path):
    assert program("--version").stdout.startswith(f"piola {piola.__version__} (commit ")
    bad = program("rum")
    assert bad.returncode == 2 and "unrecognized subcommand" in bad.stderr
    assert program("run", "none.toml", cwd=tmp_path).returncode == 4
    script = "piola.exe" if os.name == "nt" else "piola"
    beside = os.path.join(os.path.dirname(sys.executable), script)
    shown = subprocess.run([beside, "--version"], capture_output=True, text=True, check=True)
    assert shown.stdout.startswith(f"piola {piola.__version__} (commit ")


def test_a_panic_is_an_exception_and_the_end_of_its_simulation(case, capfd):
    simulation, other = case.start(), case.start()
    before = simulation.bodies["water"]["velocity"]
    copy = before.copy()
    for ask in (simulation._panic, simulation.step, simulation.run, lambda: simulation.energy, simulation.finish):
        with pytest.raises(piola.RunError, match="piola has stopped because of a bug") as caught:
            ask()
        assert caught.value.kind == "panic"
    assert "a test has asked for it" in capfd.readouterr().err
    # What was read before stays, and others are not concerned.
    assert (before == copy).all()
    assert other.run().outcome == "completed"
