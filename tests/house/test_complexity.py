"""The functions of src stay small enough to be read: McCabe's cyclomatic complexity, as Debian's pmccabe
counts it (a lambda counts for the function that it stands in)."""

import re
import shutil
import subprocess
from functools import lru_cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SRC = ROOT / "src"
MOST = 25
# The loop over a simulation's steps: all its lines.
LOOP = "simulation/simulation.cpp", "beltgrinding::simulate", 60
# What pmccabe cannot parse, without a line less: attributes, and numbers' separators.
FOREIGN = re.compile(r"^__attribute__\(\(.*\)\)$|(?<=\d)'(?=\d)", re.MULTILINE)

pytestmark = pytest.mark.skipif(not shutil.which("pmccabe"), reason="pmccabe is not installed")


@lru_cache(maxsize=None)
def functions(folder):
    """[(complexity, lines, file, line, name)] of all functions of src, copied to the folder."""
    for path in SRC.rglob("*"):
        if path.suffix in (".cpp", ".h"):
            copy = folder / path.relative_to(SRC)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(FOREIGN.sub("", path.read_text()))
    files = sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())
    done = subprocess.run(["pmccabe", *files], cwd=folder, capture_output=True, text=True)
    found = []
    for line in done.stdout.splitlines():
        complexity, _, _, _, lines, where = line.split("\t", 5)
        file, at, name = re.fullmatch(r"(.*)\((\d+)\): (.*)", where).groups()
        found.append((int(complexity), int(lines), file, int(at), name))
    return found


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    return functions(tmp_path_factory.mktemp("src"))


def test_no_function_is_too_complex(measured):
    assert len(measured) > 2000, "pmccabe no longer finds the functions"
    wrong = [f"src/{f}:{at}: {name}: {c}" for c, _, f, at, name in measured if c > MOST]
    assert not wrong, "find the steps in it that have a name:\n" + "\n".join(wrong)


def test_the_loop_is_read_in_a_minute(measured):
    file, loop, most = LOOP
    (lines,) = [lines for _, lines, f, _, name in measured if (f, name) == (file, loop)]
    assert lines <= most
