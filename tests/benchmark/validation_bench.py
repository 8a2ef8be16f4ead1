"""Writes docs/validation.md and its picture, docs/images/validation.png, from tests/support/reference_cases.py: tools/bench
validation."""

import datetime
import textwrap
from pathlib import Path

import beltgrinding
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from support.reference_cases import all_cases

DOCS = Path(__file__).resolve().parents[2] / "docs"
COLUMNS = 4
PICTURE = "validation.png"
HEAD = """# Validation

How wrong is the simulator, and where most? Each case compares it with what others say: finite elements, closed forms,
measured grinds. Version {version}, {date}. Write this page anew with `tools/bench validation`.

Elastic contact is compared with CalculiX: `approach` is the wheel's way at that force. `rows` adds up the differences
of the forces of rows of 1 mm, over the force. In a group the case that misses its aim most comes first.
"""
TAIL = """
## Curves

Blue: the simulator. Orange: the reference.

![Every case: the simulator over its reference](images/{picture})

## More references

| subject | page | repeat with |
| --- | --- | --- |
| contact: edges, layered rims, hollows, tilt, all models | [contact](contact-accuracy.md) | `tests/validation/test_contact_edges.py`, `tools/bench contact_reference` |
| free belt and platen against finite elements | [belts](belt-method.md) | `tests/core/belt` |
| noses of 0.2 and 1 mm and sharp edges in plane strain | [field](field-method.md) | `tests/validation/test_edges_plane_strain.py`, `test_sharp_edges.py` |
| heat: moving bands, plates, random materials | [heat](heat-method.md#accuracy) | `tests/core/heat`, `tests/validation/test_heat_plate.py` |
| force control at edges and ribs | [force](force-method.md) | `tests/validation/test_force_dynamics.py` |
| measured grinds that the law never saw | [calibration](calibration-method.md) | `tools/bench calibration` |
| joints and collisions of robot programs | [robot](robot-method.md) | `tools/bench robot` |
| local against global law | [paper](paper.md) | `tools/bench paper` |
| deviation against exact distances | [deviation](verification-check.md) | `tests/validation/test_deviation_check.py` |
"""


def worst(case):
    """How many times its aim the worst of a case's figures misses."""
    return max(abs(figure.error) / figure.aim for figure in case.figures)


def percent(share):
    return f"{100 * share:+.2g} %" if abs(share) >= 5e-5 else "0 %"


def page(cases):
    """The text of docs/validation.md."""
    date = datetime.date.today().isoformat()
    parts = [HEAD.format(version=beltgrinding.__version__, date=date)]
    groups = {}
    for case in cases:
        groups.setdefault(case.group, []).append(case)
    for group in sorted(groups, key=lambda name: -max(map(worst, groups[name]))):
        names = [figure.name for figure in groups[group][0].figures]
        parts.append(f"\n## {group}\n\n| case | " + " | ".join(names) + " | aim |")
        parts.append("\n| --- |" + " --- |" * (len(names) + 1) + "\n")
        for case in sorted(groups[group], key=worst, reverse=True):
            errors = " | ".join(percent(figure.error) for figure in case.figures)
            aims = ", ".join(dict.fromkeys(f"{100 * figure.aim:g} %" for figure in case.figures))
            parts.append(f"| {case.name} | {errors} | {aims} |\n")
    return "".join(parts) + TAIL.format(picture=PICTURE)


def draw(cases, path):
    """One small chart for each case."""
    rows = -(-len(cases) // COLUMNS)
    figure = Figure(figsize=(14, 2.5 * rows), dpi=90)
    FigureCanvasAgg(figure)
    charts = figure.subplots(rows, COLUMNS)
    for chart in charts.flat[len(cases) :]:
        chart.axis("off")
    for case, chart in zip(cases, charts.flat):
        chart.plot(*case.theirs, color="#e8743b", linewidth=3, alpha=0.8)
        chart.plot(
            *case.ours, "." if case.dots else "-", color="#1f5a99", linewidth=1, markersize=4
        )
        if case.dots:
            chart.set_xscale("log")
            chart.set_yscale("log")
        else:
            chart.set_ylim(bottom=0)
        chart.set_title(textwrap.fill(f"{case.group}: {case.name}", 42), fontsize=8)
        chart.set_xlabel(case.axes[0], fontsize=7)
        chart.set_ylabel(case.axes[1], fontsize=7)
        chart.tick_params(labelsize=7)
        chart.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path)


def main():
    cases = list(all_cases())
    (DOCS / "validation.md").write_text(page(cases), encoding="utf-8")
    draw(cases, DOCS / "images" / PICTURE)
    for case in cases:
        print(
            case.group, "|", case.name, "|", *(f"{f.name} {percent(f.error)}" for f in case.figures)
        )


main()
