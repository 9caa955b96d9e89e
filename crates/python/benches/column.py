"""The column of the tests in free fall, for measurements."""

import copy
import pathlib
import sys

import piola

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests"))

from conftest import COLUMN  # noqa: E402


def case(spacing, end, push="-9.81"):
    """Its particles are `spacing` apart, and a body force acts along y."""
    table = copy.deepcopy(COLUMN)
    table["body"][0]["spacing"] = spacing
    del table["body"][0]["initial"], table["scheme"]["tau_velocity"], table["boundary"], table["probe"]
    table["load"] = [{"kind": "body_force", "acceleration": ["0", push]}]
    table["time"]["end"] = end
    table["output"] = {"every": end, "table_every": end}
    return piola.Case(table)
