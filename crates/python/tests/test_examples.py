"""The worked examples and the examples of the page run, and say what they say."""

import doctest
import pathlib
import subprocess
import sys

import pytest

DOCS = pathlib.Path(__file__).resolve().parents[3] / "docs"
SCRIPTS = sorted((DOCS / "python").glob("*.py"))


def test_there_are_worked_examples():
    assert [script.stem for script in SCRIPTS] == ["cantilever", "convergence", "dam_break", "fit", "surface"]


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_worked_examples_run(script, tmp_path):
    """Each asserts what it says."""
    ended = subprocess.run(
        [sys.executable, script], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr
    assert "assert" in script.read_text() and ended.stdout


def test_the_pages_of_the_worked_examples_are_fresh():
    ended = subprocess.run(
        [sys.executable, DOCS / "python" / "render", "--check"], capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, ended.stderr


def test_the_page_is_true(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    failed, attempted = doctest.testfile(str(DOCS / "python.md"), module_relative=False)
    assert failed == 0 and attempted > 10
