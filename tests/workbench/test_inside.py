"""Tests inside of FreeCAD: what they are given, what a failure tells, and what one that dies leaves."""

import subprocess
import sys


from support.freecad import ROOT

TESTS = """
import os

import FreeCAD
import pytest

pytestmark = pytest.mark.freecad


@pytest.fixture
def double():
    return lambda: None  # cannot be pickled


@pytest.fixture(params=[1, 2])
def number(request, tmp_path):
    (tmp_path / "given").write_text("outside")
    return 10 * request.param


@pytest.mark.parametrize("factor", [2, 3])
def test_values(number, factor, tmp_path):
    assert FreeCAD.listDocuments() == {}
    FreeCAD.newDocument("left")
    assert os.getcwd() == str(tmp_path) and open("given").read() == "outside"
    assert number * factor != 30, FreeCAD.Version()[0]


def test_text():
    print("said by FreeCAD")
    text = "first\\\\nsecond"
    assert text == "first\\\\nthird"


def test_death():
    os.kill(os.getpid(), 9)


def test_after():
    assert FreeCAD.listDocuments() == {}


def test_skipped():
    pytest.skip("a reason of its own")


@pytest.mark.freecad(fresh=True)
def test_fresh():
    FreeCAD.newDocument("fresh")


def test_what_cannot_go_over(double):
    pass
"""


def test_what_runs_inside_tells_what_it_tells_outside(tmp_path):
    (tmp_path / "conftest.py").write_text(
        'pytest_plugins = ["support.freecad", "support.inside"]\n'
    )
    file = tmp_path / "test_played.py"
    file.write_text(TESTS.replace("\\\\n", "\\n"))
    command = [sys.executable, "-m", "pytest", "-v", "-rs", "-p", "no:cacheprovider", str(file)]
    command += ["-c", str(ROOT / "pyproject.toml"), "--rootdir", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    told = done.stdout + done.stderr
    for name, outcome in (
        ("test_values[1-2]", "PASSED"),
        ("test_values[1-3]", "FAILED"),
        ("test_values[2-3]", "PASSED"),
        ("test_text", "FAILED"),
        ("test_death", "FAILED"),
        ("test_after", "PASSED"),
        ("test_skipped", "SKIPPED"),
        ("test_fresh", "PASSED"),
        ("test_what_cannot_go_over", "FAILED"),
    ):
        assert f"test_played.py::{name} {outcome}" in told, told
    for text in (
        "assert (10 * 3) != 30",  # values
        ">       assert text ==",  # the line
        "- third",
        "+ second",
        "said by FreeCAD",
        "FreeCAD died, exit status -9",
        "a reason of its own",
        "What goes into FreeCAD is pickled: ",
        '/usr/bin/python3 -m pytest "test_played.py::test_text"',
    ):
        assert text in told, (text, told)
