"""The command line answers at once: it loads what a command needs only when that command runs."""

import os
import subprocess
import sys

import pytest

from support.freecad import MOD

HEAVY = ("numpy", "beltgrinding_core", "matplotlib", "PIL", "jsonschema")


def loaded_by(arguments):
    """The packages that a Python with these arguments loads, and what it prints."""
    command = [sys.executable, "-X", "importtime", *arguments]
    done = subprocess.run(
        command, env={**os.environ, "PYTHONPATH": str(MOD)}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    names = {line.split("|")[-1].strip().partition(".")[0] for line in done.stderr.splitlines()}
    return names, done.stdout


@pytest.mark.parametrize(
    "arguments", [["--help"], ["run", "--help"], ["program", "convert", "--help"]]
)
def test_help_loads_nothing_heavy(arguments):
    loaded, printed = loaded_by(["-m", "beltgrinding", *arguments])
    assert "usage: beltgrind" in printed
    assert "beltgrinding" in loaded and loaded.isdisjoint(HEAVY)


def test_the_package_itself_loads_nothing_heavy():
    """A macro's first line, and everyone's FreeCAD (gui/workbench.py), wait for it."""
    loaded, _ = loaded_by(["-c", "import beltgrinding"])
    assert "beltgrinding" in loaded and loaded.isdisjoint(HEAVY)
