"""The command `piola`: the program itself, with the arguments of this process."""

import sys

from . import _piola


def main() -> int:
    """Runs the program and returns its exit code."""
    return _piola.main(sys.argv)


