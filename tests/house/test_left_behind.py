"""A session of tests that leaves a file in the checkout fails."""

import os
import shutil
import subprocess
import sys

import pytest

from support import left_behind
from support.freecad import ROOT

LEAVES = "from pathlib import Path\ndef test_it():\n    Path({!r}).write_text('x')\n"


@pytest.fixture
def checkout(tmp_path):
    """A repository that has the tests' conftest and its support."""
    for path in ("tests/conftest.py", "tests/support"):
        copy = shutil.copytree if (ROOT / path).is_dir() else shutil.copy
        (tmp_path / path).parent.mkdir(exist_ok=True)
        copy(ROOT / path, tmp_path / path)
    (tmp_path / ".gitignore").write_text("build/\n*.log\n__pycache__/\n")
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    return tmp_path


@pytest.mark.parametrize("workers", [[], ["-n", "2"]])
@pytest.mark.parametrize(
    "name, told", [("lanes.csv", True), ("a.log", True), ("build/a.csv", False)]
)
def test_a_file_that_is_left_is_told(checkout, name, told, workers):
    (checkout / "build").mkdir()
    (checkout / "tests" / "test_one.py").write_text(LEAVES.format(name))
    if workers:
        pytest.importorskip("xdist")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *workers, "tests"],
        cwd=checkout,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )
    assert (done.returncode != 0) == told, done.stdout + done.stderr
    assert (f"outside of build/: {name}" in done.stderr) == told


def test_what_was_there_before_is_let_be(checkout):
    (checkout / "notes.txt").write_text("x")
    before = left_behind.listing(checkout)
    assert "notes.txt" in before and left_behind.sentence(before, before) == ""


def test_where_there_is_no_checkout_nothing_is_told(tmp_path):
    assert left_behind.sentence(left_behind.listing(tmp_path), {"a"}) == ""
