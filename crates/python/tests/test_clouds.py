"""Particles from arrays."""

import re

import numpy as np
import pytest

import piola


def lattice():
    """The sites of the column, and volumes that tell them apart."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(5) * 0.25, np.arange(9) * 0.25))
    return np.stack([x, y], axis=1), (1 + 1e-3 * np.arange(45)) / 16


def of(table, shape):
    table["body"][0]["shape"] = shape
    table["body"][0].pop("spacing", None)
    table["boundary"], table["probe"] = [], []
    return piola.Case(table)


def test_particles_are_those_of_the_arrays(table):
    points, volumes = lattice()
    body = of(table, piola.Cloud(points, volumes)).start().bodies["water"]
    rows = body.ids - body.ids.min()
    assert sorted(rows) == list(range(45))
    assert np.array_equal(body["position"], points[rows])
    assert np.array_equal(body["volume"], volumes[rows])


def test_arrays_give_the_bits_of_a_file(table, tmp_path):
    points, volumes = lattice()
    data = np.column_stack([points, volumes])
    np.savetxt(tmp_path / "points.csv", data, delimiter=",", header="x,y,volume", comments="", fmt="%.17g")
    ours = of(table, piola.Cloud(points, volumes)).start()
    file = of(table, {"kind": "points", "file": str(tmp_path / "points.csv")}).start()
    for simulation in (ours, file):
        simulation.run()
    for name in ("position", "velocity"):
        assert np.array_equal(ours.bodies["water"][name], file.bodies["water"][name])


def test_set_takes_clouds_and_the_text_names_them(table):
    points, volumes = lattice()
    case = of(table, {"kind": "box", "min": [0, 0], "max": [1, 2]})
    assert case.set("body.water.shape", piola.Cloud(points, volumes)) is case
    (first,) = re.findall(r'file = "(@cloud_[0-9a-f]{12})"', case.toml)
    assert case.faults() == []
    assert case.check().bodies[0]["particles"] == 45
    case.set("body.water.shape", piola.Cloud(points[:20], volumes[:20]))
    assert first not in case.toml and case.check().bodies[0]["particles"] == 20
    # It is called by its numbers, however often others have been set before.
    case.set("body.water.shape", piola.Cloud(points, volumes))
    assert f'file = "{first}"' in case.toml


def test_what_a_cloud_holds(table):
    points, volumes = lattice()
    cloud = piola.Cloud(points, volumes)
    assert len(cloud) == 45 and repr(cloud) == "<Cloud of 45 particles in 2D>"
    assert np.array_equal(cloud.positions, points) and np.array_equal(cloud.volumes, volumes)
    # It is a copy of the arrays, and gives copies.
    expected = points.copy()
    points[:] = 7.0
    cloud.positions[:] = 8.0
    assert np.array_equal(cloud.positions, expected)
    assert np.array_equal(piola.Cloud(expected, 0.5).volumes, np.full(45, 0.5))
    assert repr(piola.Cloud(np.arange(3.0)[:, None], 1)) == "<Cloud of 3 particles in 1D>"


def test_any_memory_order_and_exact_type():
    points = np.arange(12.0).reshape(6, 2)
    wide = np.zeros((6, 4))
    wide[:, ::2] = points
    forms = [points.astype(np.int32), points.astype(np.float32), np.asfortranarray(points), wide[:, ::2],
             points[::-1].copy()[::-1], points.astype(">f8"), points.tolist()]
    for form in forms:
        assert np.array_equal(piola.Cloud(form, np.ones(6, np.float32)).positions, points)


def bad(row, column, value):
    points, volumes = lattice()
    (points[:, column] if column < 2 else volumes)[row] = value
    return points, volumes


POINTS, VOLUMES = lattice()


@pytest.mark.parametrize(
    ("positions", "volumes", "error", "text"),
    [
        (*bad(7, 1, np.nan), ValueError, "particle 7: y is NaN, expected a finite number of m"),
        (*bad(3, 0, np.inf), ValueError, "particle 3: x is inf, expected a finite number of m"),
        (*bad(9, 2, np.nan), ValueError, "particle 9: the volume is NaN, expected a finite number above 0"),
        (*bad(9, 2, 0.0), ValueError, "particle 9: the volume is 0, expected a finite number above 0"),
        (*bad(9, 2, np.inf), ValueError, "particle 9: the volume is inf, expected a finite number above 0"),
        (POINTS[[0, 1, 2, 1]], np.ones(4), ValueError,
         "particles 1 and 3 are both at (0.25, 0), expected each place once"),
        (POINTS, VOLUMES[:44], ValueError, "`volumes` has the shape (45,), not (44,)"),
        (POINTS, VOLUMES[:, None], ValueError, "`volumes` has the shape (45,), not (45, 1)"),
        (POINTS.ravel(), 1.0, ValueError, "`positions` has the shape (particles, D), not (90,)"),
        (POINTS.T, 1.0, ValueError, "particles have 45 coordinates, expected 1 to 3"),
        (np.zeros((0, 2)), 1.0, ValueError, "a cloud needs at least one particle"),
        (np.zeros((5, 0)), 1.0, ValueError, "particles have 0 coordinates, expected 1 to 3"),
        (POINTS.astype(complex), 1.0, TypeError, "`positions` takes 64-bit floats, not complex128"),
        (POINTS, VOLUMES.astype(object), TypeError, "`volumes` takes 64-bit floats, not object"),
        (POINTS, None, TypeError, "`volumes` takes 64-bit floats, not object (of a `NoneType`)"),
        (POINTS, "1", TypeError, "`volumes` takes 64-bit floats, not <U1"),
    ],
)
def test_bad_arrays_are_refused(positions, volumes, error, text):
    with pytest.raises(error) as caught:
        piola.Cloud(positions, volumes)
    assert text in str(caught.value)


def test_clouds_that_do_not_fit_the_case(table):
    points, volumes = lattice()
    deep = np.column_stack([points, np.zeros(45)])
    (fault,) = of(table, piola.Cloud(deep, volumes)).faults()
    assert re.fullmatch("the cloud `@cloud_[0-9a-f]{12}` is in 3D and the case in 2D", fault.message)
    assert fault.line is not None
    (fault,) = of(table, {"kind": "points", "file": "@cloud_7"}).faults()
    assert fault.message == "there is no cloud `@cloud_7`" and "write the name of a CSV file" in fault.help
    # A thousandth of a thousandth of a spacing apart: one point to all that follows.
    points[1] = points[0] + [1e-9, 0]
    (fault,) = of(table, piola.Cloud(points, volumes)).faults()
    assert fault.label == "this cloud"
    # Other shapes cannot cut it.
    union = {"kind": "union", "of": [piola.Cloud(*lattice()), {"kind": "box", "min": [0, 0], "max": [1, 1]}]}
    table["body"][0]["shape"], table["body"][0]["spacing"] = union, 0.25
    assert any("points cannot be combined with other shapes" in fault.message for fault in piola.Case(table).faults())


def test_a_run_with_a_cloud_is_resumed_with_the_same_one_alone(table, tmp_path):
    points, volumes = lattice()
    whole = of(table, piola.Cloud(points, volumes)).start()
    whole.run()
    with of(table, piola.Cloud(points, volumes)).start(tmp_path / "out") as simulation:
        simulation.run(until=0.1)
    for other in (piola.Cloud(points + 0.5, volumes), piola.Cloud(points, 2 * volumes)):
        with pytest.raises(piola.RunError):
            of(table, other).start(tmp_path / "out", resume=True)
    again = of(table, piola.Cloud(points, volumes)).start(tmp_path / "out", resume=True)
    assert again.time > 0
    again.run()
    assert np.array_equal(again.bodies["water"]["position"], whole.bodies["water"]["position"])
    # The program makes the page of it again, without the cloud.
    from helpers import program  # noqa: PLC0415

    assert program("report", tmp_path / "out").returncode == 0
    assert "cannot be read" not in (tmp_path / "out" / "report.html").read_text()
