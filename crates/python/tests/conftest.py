"""What the tests share: a small case, and a case that fails."""

import copy

import pytest

import piola

# A column of water falls on nothing: 45 particles, some tens of steps.
COLUMN = {
    "version": 1,
    "title": "a column of water",
    "dimension": 2,
    "body": [
        {
            "name": "water",
            "shape": {"kind": "box", "min": [0.0, 0.0], "max": [1.0, 2.0]},
            "spacing": 0.25,
            "material": {"kind": "gamma_law", "density": 1000.0, "gamma": 7.0, "wave_speed": 10.0},
            "initial": {"velocity": ["0", "-1"]},
        }
    ],
    "scheme": {
        "kind": "upwind",
        "kernel": "cubic_spline",
        "smoothing_length": 0.7,
        "tau_velocity": 0.5,
    },
    "time": {"end": 0.2, "cfl": 0.3},
    "boundary": [
        {
            "name": "floor",
            "where": {"kind": "plane", "point": [0.0, 0.0], "normal": [0.0, -1.0]},
            "velocity": {"y": "0"},
        }
    ],
    "probe": [
        {"name": "top", "kind": "particle", "at": [0.5, 2.0], "fields": ["displacement", "velocity"]}
    ],
    "output": {"every": 0.1, "table_every": 0.01},
}


@pytest.fixture
def table():
    """The dict of the column, to be changed at will."""
    return copy.deepcopy(COLUMN)


@pytest.fixture
def case(table):
    return piola.Case(table)


@pytest.fixture
def long(table):
    """A case that runs for minutes, to be stopped."""
    table["body"][0]["spacing"] = 0.02
    table["time"]["end"] = 100.0
    table["output"] = {"every": 100.0, "table_every": 100.0}
    return piola.Case(table)


@pytest.fixture
def failing(table):
    """A case whose particles soon move faster than they may."""
    table["time"]["max_speed"] = 1.02
    return piola.Case(table)
