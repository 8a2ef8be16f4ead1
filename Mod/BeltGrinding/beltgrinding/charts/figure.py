"""A sheet of charts as matplotlib's figure, without pyplot: nothing of it is left behind.

It looks the same whatever the user's own settings of matplotlib say.
"""

import threading
from contextlib import contextmanager

import numpy as np


from .model import (
    BASE, BOX, END, FRAME, GRID, INK, LOGARITHMIC, MIDDLE, ROOT, START,
    Band, Bars, Line, Markers, window,
)  # fmt: skip
from .ticks import library, ticks

FONT = "DejaVu Sans"  # comes with matplotlib: texts are measured alike on all machines
PADS = {"x": 8.0, "y": 6.0}  # points from an axis to its ticks' texts
ABOVE = 10.0  # points from the area to its legend
SIDES = {START: "left", MIDDLE: "center", END: "right"}
SHAPES = {"disc": "o", "diamond": "D"}
RULES = {
    "font.family": FONT,
    "text.parse_math": False,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.titleweight": "bold",
    "xtick.color": INK,
    "ytick.color": INK,
    "svg.fonttype": "none",
}
LOCK = threading.Lock()  # of matplotlib's settings, which are the whole process's


@contextmanager
def rules(**more):
    """matplotlib's settings as they come, but for ours; afterwards they are what they were."""
    style = library("style")
    with LOCK, style.context(["default", {**RULES, **more}]):
        yield


def figure(sheet):
    """The figure of a ``Sheet``; inside of ``rules``."""
    drawn = library("figure").Figure(figsize=(sheet.width / 72.0, sheet.height / 72.0), dpi=72)
    drawn.patch.set_visible(sheet.paper is not None)
    drawn.set_facecolor(sheet.paper or "none")
    for panel in sheet.panels:
        _panel(drawn, sheet, panel)
    for one in sheet.texts:
        drawn.text(
            one.x / sheet.width,
            1.0 - one.y / sheet.height,
            one.text,
            ha=SIDES[one.anchor],
            va="baseline",
            size=one.size or sheet.font,
            weight="bold" if one.bold else "normal",
        )
    return drawn


def _panel(drawn, sheet, panel):
    chart = panel.chart
    bottom = sheet.height - panel.top - panel.height
    place = (panel.left / sheet.width, bottom / sheet.height)
    size = (panel.width / sheet.width, panel.height / sheet.height)
    axes = drawn.add_axes((*place, *size))
    axes.patch.set_visible(False)
    axes.set_axisbelow(True)
    x0, y0, x1, y1 = window(chart, panel.width, panel.height)
    _axis(axes.xaxis, chart.x, x0, x1, axes.set_xscale, axes.set_xlim, sheet.font)
    _axis(axes.yaxis, chart.y, y0, y1, axes.set_yscale, axes.set_ylim, sheet.font)
    axes.set_xlabel(chart.x.label, size=sheet.font, va="center")
    axes.xaxis.set_label_coords(0.5, -chart.x.gap / panel.height)
    axes.set_ylabel(chart.y.label, size=sheet.font, va="center")
    axes.yaxis.set_label_coords(-chart.y.gap / panel.width, 0.5)
    for side, spine in axes.spines.items():
        spine.set(color=FRAME, linewidth=1.0)
        spine.set_visible(chart.frame == BOX or chart.frame == BASE and side == "bottom")
    if chart.title:
        axes.set_title(chart.title, loc="left", size=sheet.font, pad=6)
    entries = [_draw(axes, one) for one in chart.series]
    for mark in chart.marks:
        _mark(axes, panel, mark, sheet.font)
    if panel.legend:
        _legend(axes, panel, entries, chart.series, sheet.font)


def _axis(drawn, axis, low, high, set_scale, set_limits, font):
    if axis.scale == LOGARITHMIC:
        set_scale("log")
    elif axis.scale == ROOT:
        set_scale("function", functions=(np.sqrt, np.square))
    set_limits(low, high)
    found = ticks(axis, low, high)
    drawn.set_ticks([tick.value for tick in found], labels=[tick.text for tick in found])
    drawn.set_ticks([], minor=True)
    drawn.set_tick_params(length=0, pad=PADS[drawn.axis_name], labelsize=font)
    if axis.grid:
        drawn.grid(True, color=GRID, linewidth=0.8, clip_on=False)
    for tick, label in zip(found, drawn.get_ticklabels()):
        if tick.anchor != MIDDLE:
            label.set_ha(SIDES[tick.anchor])


def _draw(axes, series):
    """Draws a series; returns what stands for it in the legend."""
    if isinstance(series, Line):
        return _lines(axes, series)
    if isinstance(series, Markers):
        (drawn,) = axes.plot(
            *np.reshape(series.points, (-1, 2)).T,
            SHAPES[series.shape],
            markersize=series.size,
            color=series.colour,
            markeredgecolor=series.rim or "none",
            markeredgewidth=0.5,
            alpha=series.opacity,
            gid=series.key or None,
            clip_on=False,
        )
        return drawn
    if isinstance(series, Band):
        return _filled(axes, series.polygons, series.colour, series.opacity, series.key)
    assert isinstance(series, Bars), series
    return _bars(axes, series)


def _lines(axes, series):
    gap = np.full((1, 2), np.nan)
    joined = [part for line in series.lines for part in (line, gap)][:-1]
    points = np.vstack(joined) if joined else gap
    (drawn,) = axes.plot(
        *points.T,
        color=series.colour,
        linewidth=series.width,
        gid=series.key or None,
        clip_on=False,
    )
    if series.dash:
        drawn.set_linestyle((0, [part / series.width for part in series.dash]))
    return drawn


def _filled(axes, polygons, colour, opacity, key):
    Path, PathPatch = library("path").Path, library("patches").PathPatch
    paths = [Path(np.vstack([one, one[:1]]), closed=True) for one in polygons]
    drawn = PathPatch(
        Path.make_compound_path(*paths) if paths else Path(np.zeros((0, 2))),
        facecolor=colour,
        edgecolor="none",
        alpha=opacity,
        gid=key or None,
        clip_on=False,
    )
    return axes.add_patch(drawn)


def _bars(axes, series):
    """Bars of one colour are one path."""
    edges, heights = np.asarray(series.edges, float), np.asarray(series.heights, float)
    aside = 0.5 * series.gap * np.diff(edges)
    same = {}
    for low, high, height, colour in zip(
        edges[:-1] + aside, edges[1:] - aside, heights, series.colours
    ):
        if height > 0.0:
            same.setdefault(colour, []).append(rectangle(low, 0.0, high, height))
    drawn = [_filled(axes, group, colour, 1.0, series.key) for colour, group in same.items()]
    return drawn[0] if drawn else None


def rectangle(x0, y0, x1, y1):
    """The corners of a rectangle."""
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]], dtype=float)


def _mark(axes, panel, mark, font):
    across = axes.get_xaxis_transform()
    ends = (-mark.below / panel.height, 1.0 + mark.above / panel.height)
    axes.plot(
        [mark.value] * 2, ends, color=INK, linewidth=mark.width, transform=across, clip_on=False
    )
    if mark.label:
        beside = {START: 5.0, MIDDLE: 0.0, END: -5.0}[mark.anchor]
        axes.annotate(
            mark.label,
            (mark.value, 1.0),
            xycoords=across,
            xytext=(beside, 10.0),
            textcoords="offset points",
            ha=SIDES[mark.anchor],
            size=font,
            annotation_clip=False,
        )


def _legend(axes, panel, entries, series, font):
    shown = [(entry, one.label) for entry, one in zip(entries, series) if entry and one.label]
    if not shown:
        return
    axes.legend(
        *zip(*shown),
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0 + ABOVE / panel.height),
        borderpad=0.0,
        borderaxespad=0.0,
        ncol=len(shown),
        frameon=False,
        fontsize=font,
        handlelength=2.2,
        handletextpad=0.5,
        columnspacing=1.6,
    )
