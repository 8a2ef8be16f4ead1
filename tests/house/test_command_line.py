"""The command line answers at once: it loads what a command needs only when that command runs."""

import os
import subprocess
import sys

import pytest

from support.freecad import MOD

HEAVY = ("numpy", "beltgrinding_core", "matplotlib", "PIL", "jsonschema")


@pytest.mark.parametrize(
    "arguments", [["--help"], ["run", "--help"], ["program", "convert", "--help"]]
)
def test_help_loads_nothing_heavy(arguments):
    command = [sys.executable, "-X", "importtime", "-m", "beltgrinding", *arguments]
    done = subprocess.run(
        command, env={**os.environ, "PYTHONPATH": str(MOD)}, capture_output=True, text=True
    )
    assert done.returncode == 0 and done.stdout.startswith("usage: beltgrind")
    loaded = {line.split("|")[-1].strip().partition(".")[0] for line in done.stderr.splitlines()}
    assert "beltgrinding" in loaded
    assert loaded.isdisjoint(HEAVY)
