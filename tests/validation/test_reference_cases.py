"""The figures of docs/validation.md: each within its aim, but for those that are known to miss it."""

import pytest
from support import reference_cases
from support.freecad import ROOT

# Share by which a figure may be off where it misses its aim: a linear rim under large strain.
KNOWN = {
    ("cylinder of 50 mm along the feed, ν 0.49, linear, 201 N", "approach"): 0.03,
    ("rib of 5 mm, ν 0.45, neo-Hookean, 145 N", "approach"): 0.04,
    ("rib of 5 mm, ν 0.45, neo-Hookean, 145 N", "rows"): 0.05,
    ("rib of 5 mm, ν 0.45, neo-Hookean, 384 N", "approach"): 0.075,
    ("rib of 5 mm, ν 0.45, neo-Hookean, 384 N", "rows"): 0.22,
    ("steel, 40 mm/s", "middle"): 0.012,
    ("titanium, 40 mm/s", "middle"): 0.0125,
    ("titanium, 40 mm/s", "side"): 0.035,
}


@pytest.fixture(scope="module")
def cases():
    found = list(reference_cases.all_cases())
    assert len({case.name for case in found}) == len(found) >= 8
    return found


def test_every_figure_is_within_its_aim_or_known_to_miss_it(cases):
    wrong = [
        f"{case.name}: {figure.name} off by {100 * figure.error:+.2f} %"
        for case in cases
        for figure in case.figures
        if not abs(figure.error) <= KNOWN.get((case.name, figure.name), figure.aim)
    ]
    assert wrong == []


def test_what_is_known_to_miss_its_aim_does(cases):
    """Else it has become better, and KNOWN says less than is true."""
    errors = {(case.name, f.name): abs(f.error) / f.aim for case in cases for f in case.figures}
    assert [key for key in KNOWN if key in errors and errors[key] <= 1.0] == []


def test_the_page_says_what_is_so(cases):
    page = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
    assert [case.name for case in cases if f"| {case.name} |" not in page] == []
