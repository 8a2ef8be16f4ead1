"""The types of the Python package: mypy finds nothing in the rooms that pyproject.toml names, the stubs say
what the compiled modules do, and no room loses an annotation."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "Mod" / "BeltGrinding" / "beltgrinding"
# Percent of a room's functions with a type for each argument and for what they return; of another room
# none. A room may be a pattern of its files. Raise it where it has risen.
SHARE = {
    "base": 100,
    "engine": 100,
    "geometry": 100,
    "job": 100,
    "cell": 100,
    "inspection": 100,
    "simulation": 100,
    "raster": 100,
    "__init__.py": 100,
    "presets": 100,
    "contact": 100,
    "scan": 100,
    "planning": 100,
    "studies": 100,
    "reporting": 100,
    "calibration": 100,
    "programs": 100,
    "objects": 100,
    "gui": 100,
}


def annotated(function):
    given = function.args
    arguments = given.posonlyargs + given.args + given.kwonlyargs
    arguments += [one for one in (given.vararg, given.kwarg) if one]
    return function.returns is not None and all(
        one.annotation or one.arg in ("self", "cls") for one in arguments
    )


def share(room):
    """Percent of a room's functions that are annotated, and the others."""
    bare, count = [], 0
    for path in sorted(PACKAGE.glob(room if room.endswith(".py") else f"{room}/**/*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                count += 1
                if not annotated(node):
                    bare.append(f"{path.relative_to(ROOT)}:{node.lineno}: {node.name}")
    return 100 * (count - len(bare)) / count, bare


def test_mypy_finds_nothing():
    done = subprocess.run(["mypy", "--no-error-summary"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_stubs_say_what_the_modules_do():
    done = subprocess.run(
        [sys.executable, "tools/stubs.py", "--check"], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("room", SHARE)
def test_no_room_loses_annotations(room):
    reached, bare = share(room)
    assert reached >= SHARE[room], "\n".join(bare)
