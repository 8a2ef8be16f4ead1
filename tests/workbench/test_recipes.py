"""Every macro of docs/recipes.md runs as printed there and prints what the page says."""

import contextlib
import io
import re

import pytest

from support.freecad import ROOT

PAGE = (ROOT / "docs" / "recipes.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```\w+\n(.*?)\n```$", re.M | re.S)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")
NEAR = 0.03  # of a number: another Debian's CAD kernel samples the surface a little differently
SLOW = {
    "Grind a part of your own",
    "A study of what varies",
    "Feeds for the program",
    "Faces from nothing",
    "Judge a program by its file",
    "Compare a scan",
}


HEAD, *PARTS = re.split(r"^### ", PAGE, flags=re.M)
(FIRST,) = BLOCK.findall(HEAD)
RECIPES = {part.split("\n")[0]: BLOCK.findall(part) for part in PARTS}


def printed(code):
    """What a macro prints, inside FreeCAD."""
    told = io.StringIO()
    with contextlib.redirect_stdout(told):
        exec(compile(code, "recipe", "exec"), {"__name__": "recipe"})
    return told.getvalue()


def differs(told, wanted):
    """What differs: the words, or numbers that are farther apart than ``NEAR`` and half the last digit; None if nothing."""
    if NUMBER.sub("#", told.strip()) != NUMBER.sub("#", wanted):
        return f"{told!r} is printed, {wanted!r} on the page"
    for one, other in zip(NUMBER.findall(told), NUMBER.findall(wanted)):
        digits = len(other.partition("e")[0].partition(".")[2])
        last = 0.0 if "e" in other else 0.51 * 10**-digits
        if abs(float(one) - float(other)) > NEAR * abs(float(other)) + last:
            return f"{one} is printed, {other} on the page"
    return None


@pytest.mark.parametrize(
    "title",
    [pytest.param(one, marks=pytest.mark.slow if one in SLOW else ()) for one in RECIPES],
)
def test_a_recipe_prints_what_the_page_says(freecad, tmp_path, title):
    code, wanted = RECIPES[title]
    told = freecad.call(printed, f"{FIRST}\n{code}\n", folder=tmp_path)
    assert differs(told, wanted) is None


def test_there_are_twenty_short_ones():
    assert len(RECIPES) >= 20 and SLOW <= set(RECIPES)
    lengths = {title: len(code.splitlines()) for title, (code, _) in RECIPES.items()}
    assert max(lengths.values()) <= 12, lengths


def test_what_differs():
    assert differs("77 %, -0.24 mm\n", "77 %, -0.24 mm") is None
    assert differs("76 %, 2.01e-05", "77 %, 2.03e-05") is None
    assert differs("77 % of 3", "77 % in 3").startswith("'77 % of 3'")
    assert differs("70 %", "77 %") == "70 is printed, 77 on the page"
    assert differs("2.2e-05", "2.0e-05") and differs("PASS", "FAIL")
