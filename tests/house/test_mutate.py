"""tools/mutate finds what may be changed, and changes that alone; nothing is built here."""

import importlib.util
from importlib.machinery import SourceFileLoader

import pytest

from support.freecad import ROOT

SOURCE = """\
#include <cmath>
// a + b is no code
double of(double a, double b) {
    const char* word = "a - b";  // nor 2.0 * 3.0
    if (a <= b && a > 0.0) return std::max(a, b) * 1.5e-3;
    return *pointer - x1.0f;
}
"""


@pytest.fixture
def mutate():
    loader = SourceFileLoader("mutate", str(ROOT / "tools" / "mutate"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
    loader.exec_module(module)
    return module


def test_operators_and_numbers_are_found_in_code_alone(mutate):
    found = mutate.mutants(SOURCE)
    assert [(line, old, new) for line, _, old, new in found] == [
        (5, "<=", "<"),
        (5, "&&", "||"),
        (5, ">", ">="),
        (5, "0.0", "1.0"),
        (5, "max", "min"),
        (5, "*", "/"),
        (5, "1.5e-3", "0.0022500000000000003"),
        (6, "-", "+"),
    ]


def test_one_mutant_changes_one_place(mutate):
    for mutant in mutate.mutants(SOURCE):
        line, column, old, new = mutant
        lines = SOURCE.split("\n")
        lines[line - 1] = lines[line - 1][:column] + new + lines[line - 1][column + len(old) :]
        assert mutate.changed(SOURCE, mutant) == "\n".join(lines) != SOURCE


def test_the_same_seed_takes_the_same_places(mutate, tmp_path):
    for room in ("heat", "python", "stock"):
        (tmp_path / "src" / room).mkdir(parents=True)
        (tmp_path / "src" / room / "one.cpp").write_text(SOURCE)
    chosen = mutate.sample(6, 7, tmp_path)
    assert chosen == mutate.sample(6, 7, tmp_path) and len(set(chosen)) == 6
    assert chosen != mutate.sample(6, 8, tmp_path)
    assert {path for path, _ in mutate.sample(99, 1, tmp_path)} == {
        "src/heat/one.cpp",
        "src/stock/one.cpp",
    }
    assert {path for path, _ in mutate.sample(99, 1, tmp_path, "heat")} == {"src/heat/one.cpp"}
