"""Every entry of the C++ library that takes a HeightField refuses one that is not sound: each has a test that hands it
all faults of ``tests/core/support/unsound_fields.h``."""

import re
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PUBLIC = sorted((ROOT / "src").glob("*/include/beltgrinding/*.h"))
# A field that is about to be written is what this program made: a fault is std::logic_error.
WRITERS = {"write_hdf5": 2, "hdf5_image": 1}
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
TAKES = re.compile(r"\b(\w+)\s*\([^;{}]*?\bHeightField\s*(?:const\s*)?(?:&|\*|\b\w+\s*[,)])")


def takers(text):
    """{name: how many} of the functions and constructors in a header that take a height field."""
    return Counter(TAKES.findall(COMMENT.sub("", text)))


def bodies(text, call):
    """What stands in the braces behind each ``call(``."""
    for match in re.finditer(rf"\b{call}\b", text):
        depth, end = 0, match.end()
        while end < len(text):
            depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(text[end], 0)
            end += 1
            if depth == 0:
                break
        yield text[match.end() : end]


def handed():
    """{name: how often} of what is called within a test that hands it unsound fields."""
    found = Counter()
    for path in sorted((ROOT / "tests" / "core").glob("*/*_test.cpp")):
        text = COMMENT.sub("", path.read_text(encoding="utf-8"))
        if "expect_unsound_refused" not in text:
            continue
        for call in ("expect_unsound_refused", "Entry"):
            for body in bodies(text, call):
                found.update(re.findall(r"\b(\w+)\s*[({]", body))
    return found


def entries():
    """The functions of the public headers that take a height field."""
    found = Counter()
    for path in PUBLIC:
        found.update(takers(path.read_text(encoding="utf-8")))
    return found


def test_every_entry_of_the_library_is_handed_unsound_fields():
    known, tried = entries(), handed()
    assert known["simulate"] and known["judge"] and known["keep"], known
    missing = {name: n for name, n in known.items() if name not in WRITERS and tried[name] < n}
    assert not missing, f"no test hands them unsound fields by expect_unsound_refused: {missing}"


def test_every_writer_is_handed_unsound_fields():
    known = entries()
    assert {name: n for name, n in known.items() if "hdf5" in name} == WRITERS
    path = ROOT / "tests" / "core" / "heightfield" / "validate_test.cpp"
    text = (
        path.read_text(encoding="utf-8")
        .partition("WhatIsWrittenIsChecked")[2]
        .partition("\nTEST")[0]
    )
    assert "testing::unsound()" in text
    for name, count in WRITERS.items():
        assert len(re.findall(rf"EXPECT_THROW\({name}\(", text)) == count, name


@pytest.mark.parametrize(
    "declaration, name",
    [
        ("void f(const HeightField& field);", "f"),
        ("void f(HeightField const& field);", "f"),
        ("void f(int n,\n       HeightField & field, double d);", "f"),
        ("double g(std::vector<int> a, const HeightField*, int b = 3);", "g"),
        ("class A {\n  public:\n    explicit A(HeightField field);\n};", "A"),
    ],
)
def test_whoever_takes_a_field_is_found(declaration, name):
    assert takers(declaration) == {name: 1}


@pytest.mark.parametrize(
    "declaration",
    [
        "HeightField read(const std::string& path);",
        "// f(const HeightField& field)",
        "void f(int);",
    ],
)
def test_who_takes_none_is_not_found(declaration):
    assert not takers(declaration)
