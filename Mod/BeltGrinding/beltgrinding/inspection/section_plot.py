"""What a section looks like on paper: a chart of curves and bands, and an SVG of it.

Two modes: ``unrolled`` plots heights over the arc length, the design being the zero line; ``shape``
shows the true outline in the plane, the heights enlarged by a factor (``exaggeration``).
"""

import math
from typing import NamedTuple

import numpy as np

from ..charts import svg as drawing
from ..charts.model import BLUE, INK, ORANGE, PAPER, Axis, Band, Chart, Line, Panel, Sheet, Text
from ..engine import InputError

UNROLLED, SHAPE = "unrolled", "shape"
SHARE = 0.12  # of the outline's extent that the enlarged heights take
SURE = 1.96  # standard deviations: 95 % of a normal distribution
# Told apart by the colour-blind: blue against orange, and dashes.
LOOKS = {
    "tolerance": ("tolerance", "#c3d3c3", 0.0, ()),
    "uncertainty": ("95 % uncertainty", "#a9c4e4", 0.0, ()),
    "design": ("design", INK, 1.1, (5, 3)),
    "stock": ("stock", ORANGE, 1.4, (2, 2)),
    "ground": ("ground", BLUE, 2.0, ()),
}
WIDTH, HEIGHT, TALLEST = 960, 440, 900  # points of the SVG
LEFT, RIGHT, TOP, BOTTOM = 74, 18, 58, 50  # its margins


def axes_of(section):
    """(3, 2): unit vectors of a section's plane: along it, and out of the part."""
    normal = np.asarray(section["normal"])
    mean = np.zeros(3)
    for piece in section["pieces"]:  # the mean outward normal, by length
        step = np.diff(piece["s"])
        mean += (0.5 * (piece["normal"][1:] + piece["normal"][:-1]) * step[:, None]).sum(axis=0)
    mean -= mean.dot(normal) * normal
    if np.linalg.norm(mean) < 1e-3 * sum(p["s"][-1] - p["s"][0] for p in section["pieces"]):
        # All round: the coordinate axis that lies best in the plane is up, z before y before x.
        k = max((2, 1, 0), key=lambda k: round(1.0 - abs(normal[k]), 6))
        mean = np.eye(3)[k] - normal[k] * normal
    out = mean / np.linalg.norm(mean)
    return np.column_stack([np.cross(normal, out), out])


def auto_exaggeration(section):
    """A factor of 1, 2, 5, 10... that lets heights of ``SHARE`` of the outline's extent be seen."""
    axes = axes_of(section)
    points = np.vstack([piece["point"] for piece in section["pieces"]]) @ axes
    extent = np.ptp(points, axis=0).max()
    heights = [np.abs(section["tolerance"]).max()]
    for piece in section["pieces"]:
        for name in ("height", "stock_height"):
            heights.append(np.nanmax(np.abs(piece[name]), initial=0.0))
    wanted = SHARE * extent / max(*heights, 1e-9)
    power = 10.0 ** math.floor(math.log10(max(wanted, 1.0)))
    return max(step * power for step in (1, 2, 5) if step * power <= max(wanted, 1.0))


class Plot(NamedTuple):
    """A section's chart in mm, its ``mode`` and ``exaggeration``; ``ground``: one (n, 2) array a piece,
    NaN where not known. The chart's series have the keys of ``LOOKS``.
    """

    mode: str
    exaggeration: float
    ground: list
    chart: Chart


def plot(section, mode=UNROLLED, exaggeration=None):
    """The ``Plot`` of a section. Raises InputError for an unknown mode or a factor that is none."""
    if mode not in (UNROLLED, SHAPE):
        raise InputError(f"section: no mode '{mode}'; choose {UNROLLED} or {SHAPE}")
    if exaggeration is None:
        exaggeration = auto_exaggeration(section) if mode == SHAPE else 1.0
    if not (math.isfinite(exaggeration) and exaggeration > 0):
        raise InputError("section: the exaggeration is a factor above 0")
    axes = axes_of(section)

    def place(piece, height):
        height = np.broadcast_to(height, len(piece["s"]))
        if mode == UNROLLED:
            return np.column_stack([piece["s"], height])
        return (piece["point"] + exaggeration * height[:, None] * piece["normal"]) @ axes

    lower, upper = section["tolerance"]
    lines = {key: [] for key in LOOKS}
    ground = []
    for piece in section["pieces"]:
        lines["tolerance"].append(_between(place(piece, lower), place(piece, upper)))
        lines["design"].append(place(piece, 0.0))
        lines["stock"] += _runs(place(piece, piece["stock_height"]))
        ground.append(place(piece, piece["height"]))
        lines["ground"] += _runs(ground[-1])
        if "height_sd" in piece:
            band = SURE * piece["height_sd"]
            low, high = place(piece, piece["height"] - band), place(piece, piece["height"] + band)
            known = ~np.isnan(low[:, 0] + low[:, 1])
            for a, b in _spans(known):
                lines["uncertainty"].append(_between(low[a:b], high[a:b]))
    series = []
    for key, (label, colour, width, dash) in LOOKS.items():
        if lines[key] and width:
            series.append(Line(lines[key], colour, width, dash, key, label))
        elif lines[key]:
            series.append(Band(lines[key], colour, 0.7, key, label))
    every = np.vstack([line for group in lines.values() for line in group])
    (x0, y0), (x1, y1) = every.min(axis=0).tolist(), every.max(axis=0).tolist()
    margin = 0.06 * max(y1 - y0, 1e-3)
    by = "" if exaggeration == 1.0 else f" (heights ×{exaggeration:g})"
    x_label, y_label = "arc length, mm", "height above the design, mm"
    if mode == SHAPE:
        x_label, y_label = f"in the plane, mm{by}", "mm"
    x = Axis(x0, x1, x_label, count=9, gap=33)
    y = Axis(y0 - margin, y1 + margin, y_label, count=7, gap=LEFT - 16)
    return Plot(mode, exaggeration, ground, Chart(x, y, series, equal=mode == SHAPE))


def _between(low, high):
    return np.vstack([low, high[::-1]])


def _spans(known):
    """Begin and end of each run of True that has two values or more."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    return [(a, b) for a, b in zip(edges[::2], edges[1::2]) if b - a > 1]


def _runs(line):
    """The parts of a line without NaN."""
    return [line[a:b] for a, b in _spans(~np.isnan(line).any(axis=1))]


def title(section):
    """The section's plane in words."""

    def three(vector):
        return ", ".join(f"{value + 0.0:.4g}" for value in np.round(vector, 6))

    return f"Section at ({three(section['point'])}) mm, normal ({three(section['normal'])})"


def sheet(section, mode=UNROLLED, exaggeration=None):
    """The plot on a sheet of its own, with a title and a legend."""
    chart = plot(section, mode, exaggeration).chart
    width, height = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM
    if chart.equal:  # as high as the outline needs it
        height = min(max(height, chart.y.span * width / max(chart.x.span, 1e-9)), TALLEST)
    panel = Panel(chart, LEFT, TOP, width, height, legend=True)
    texts = [Text(LEFT, 20, title(section), size=14)]
    return Sheet("section", WIDTH, round(TOP + height + BOTTOM), [panel], texts, paper=PAPER)


def svg(section, mode=UNROLLED, exaggeration=None):
    """The plot as the text of an SVG file."""
    return drawing.svg(sheet(section, mode, exaggeration), label=title(section))
