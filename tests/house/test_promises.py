"""docs/robustness.md names a test beside each promise: every file and every test it names is there."""

import re

import pytest

from support.freecad import ROOT

TEXT = (ROOT / "docs" / "robustness.md").read_text(encoding="utf-8")
ROWS = [line for line in TEXT.splitlines() if line.startswith("| ") and "---" not in line]
PROMISES = [row for row in ROWS if row != "| promise | test |"]
CPP_TEST = re.compile(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)")


def missing(row, tests):
    """What a row's last cell names and is not there; None: it names nothing."""
    cell = row.rstrip("| ").split(" | ")[-1]
    paths = re.findall(r"tests/[\w./]+", cell)
    names = re.findall(r"`([A-Z][\w.]+)`", cell)
    if not paths and not names:
        return None
    return [path for path in paths if not (ROOT / path).exists()] + sorted(set(names) - tests)


@pytest.fixture(scope="module")
def tests():
    """Names of the C++ tests, with their suite and without."""
    found = set()
    for path in (ROOT / "tests" / "core").rglob("*.cpp"):
        for suite, name in CPP_TEST.findall(path.read_text(encoding="utf-8")):
            found |= {name, f"{suite}.{name}"}
    return found


@pytest.mark.parametrize("row", PROMISES)
def test_each_promise_has_a_test_that_is_there(row, tests):
    assert missing(row, tests) == []


def test_a_row_that_names_what_is_not_there_is_found(tests):
    assert len(PROMISES) > 15
    assert missing("| It holds. | tests/none/at_all.py, `NoSuch.Test` |", tests) == [
        "tests/none/at_all.py",
        "NoSuch.Test",
    ]
    assert missing("| It holds. | believe it |", tests) is None
