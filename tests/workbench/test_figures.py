"""What commands print: lines for people, JSON for programs."""

import json
from types import SimpleNamespace

import pytest

from beltgrinding import cli
from beltgrinding.cli import figures

DATA = {
    "pieces": 2,
    "length_mm": 11.965327,
    "deviation_mm": {"min": -0.0721148, "max": None},
    "feed_mm_s": [20.0, 30.0],
    "in_tolerance_share": 0.48407,
    "closed": True,
    "faces": [{"face": 1, "area_mm2": 1.0}] * 14,
    "poses": list(range(99)),
    "notes": [],
    "fit": {"rms_mm": {"before": 1.0}, "by": "scan"},
}
LINES = (
    """\
pieces              2
length              11.97 mm
deviation           min -0.07211 mm, max not known
feed                20 mm/s, 30 mm/s
in tolerance share  48.4 %
closed              yes
faces:
"""
    + "  face 1, area 1 mm²\n" * 12
    + """\
  and 2 more
poses               99 values
notes               none
fit:
  rms  before 1 mm
  by   scan"""
)


def test_each_figure_has_its_unit_and_digits_that_mean_something():
    assert figures.lines(DATA) == LINES.split("\n")


@pytest.mark.parametrize(
    "wanted, terminal, text, shown",
    [
        (False, True, None, LINES),
        (False, True, "text", "text"),
        (False, False, "text", "text"),
        (False, False, None, json.dumps(DATA)),
        (True, True, "text", json.dumps(DATA)),
    ],
)
def test_who_gets_which(wanted, terminal, text, shown, capsys, monkeypatch):
    monkeypatch.setattr("sys.stdout.isatty", lambda: terminal, raising=False)
    figures.tell(SimpleNamespace(json=wanted), DATA, text)
    assert capsys.readouterr().out == shown + "\n"


def test_every_command_that_has_figures_prints_them_for_programs():
    without = {n for n, one in cli.command_line().commands.items() if "--json" not in one.options()}
    assert without == {"schema", "help", "completion"}
