"""A chart as plain data: axes, what is drawn between them, and sheets of charts.

Points are (n, 2) arrays of x and y in the data's own units. Lengths on paper (sizes of fonts, widths
of lines, places on a sheet) are points of 1/72 inch, from the sheet's upper left corner, y downwards.
Colours are "#rrggbb". This is all that a report's charts, a section, a calibration's picture and the
charts in the window share: ``svg`` draws sheets, gui/charts paints the same charts in a widget.
"""

from dataclasses import dataclass, field
from typing import Callable

import numpy as np

INK, GRID, FRAME, PAPER = "#40454d", "#e3e5e8", "#9aa0a8", "#ffffff"
BLUE, ORANGE, GREY = "#1f5a96", "#d1701f", "#8a8f98"
LINEAR, LOGARITHMIC, ROOT = "linear", "logarithmic", "root"  # scales
START, MIDDLE, END = "start", "middle", "end"  # anchors of a text: where its place lies in it
BOX, BASE, NONE = "box", "base", "none"  # frames: all round, the line below, none
DECADE = (1.0, 2.0, 5.0)  # a logarithmic axis has its ticks there in each decade


def plain(value, decimals):
    """A number as the axes write it where nothing else is wanted; there is no -0."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}"


@dataclass(frozen=True)
class Tick:
    """A place on an axis, in the data's unit, and what stands there."""

    value: float
    text: str
    anchor: str = MIDDLE


@dataclass(frozen=True)
class Axis:
    """``low`` to ``high`` of the data."""

    low: float
    high: float
    label: str = ""
    scale: str = LINEAR
    size: float = 1.0  # of the unit that the ticks count in, in the data's unit
    count: int = 8  # steps between ticks, at most
    decade: tuple = DECADE
    ticks: tuple = None  # of Tick: these instead of round values
    number: Callable = plain  # (value, decimals) -> text, in the reader's language
    labelled: bool = True  # False: the ticks have no texts
    grid: bool = True  # lines across the chart
    gap: float = 34.0  # from the axis to the middle of its label

    @property
    def span(self):
        return self.high - self.low


@dataclass(frozen=True)
class Line:
    """Lines through points, each an (n, 2) array without NaN; ``dash``: lengths on and off."""

    lines: list
    colour: str
    width: float = 1.2
    dash: tuple = ()
    key: str = ""  # what a program calls it
    label: str = ""  # in the legend; without one it is not there


@dataclass(frozen=True)
class Band:
    """Filled polygons, each an (n, 2) array without NaN."""

    polygons: list
    colour: str
    opacity: float = 1.0
    key: str = ""
    label: str = ""


@dataclass(frozen=True)
class Bars:
    """Bars from 0 to ``heights`` between neighbouring ``edges``, each with its colour."""

    edges: np.ndarray
    heights: np.ndarray
    colours: list
    gap: float = 0.0  # between bars, as a share of a bar's width
    key: str = ""
    label: str = ""


@dataclass(frozen=True)
class Markers:
    """Points, as discs or diamonds; ``rim``: the colour around them, None for none."""

    points: np.ndarray
    colour: str
    size: float = 4.5
    shape: str = "disc"
    rim: str = None
    opacity: float = 1.0
    key: str = ""
    label: str = ""


@dataclass(frozen=True)
class Mark:
    """An upright line at a value of x across the whole chart, ``above`` and ``below`` beyond it."""

    value: float
    label: str = ""
    anchor: str = MIDDLE  # START: the label stands right of the line, END: left
    above: float = 0.0
    below: float = 0.0
    width: float = 1.0


@dataclass(frozen=True)
class Chart:
    """Series are drawn in their order, marks on top. The axes' ranges hold them all: nothing is cut off."""

    x: Axis
    y: Axis
    series: list = field(default_factory=list)
    marks: list = field(default_factory=list)
    title: str = ""
    equal: bool = False  # one scale for x and y: the ranges widen as the area needs it
    frame: str = BOX

    def one(self, key):
        """The series of that key, or None."""
        return next((one for one in self.series if one.key == key), None)


@dataclass(frozen=True)
class Panel:
    """A chart and the area between its axes on a sheet."""

    chart: Chart
    left: float
    top: float
    width: float
    height: float
    legend: bool = False  # a row above the area


@dataclass(frozen=True)
class Text:
    """A line of text; ``y``: of its baseline. ``size`` None: the sheet's."""

    x: float
    y: float
    text: str
    anchor: str = START
    size: float = None
    bold: bool = False


@dataclass(frozen=True)
class Sheet:
    """Charts and texts on one piece of paper. ``name``: short, tells apart the sheets of one page."""

    name: str
    width: float
    height: float
    panels: list
    texts: list = field(default_factory=list)
    font: float = 12.0
    paper: str = None  # its colour; None: that of what it lies on


def window(chart, width, height, seen=None):
    """(x0, y0, x1, y1) of the data in an area of that width and height; with one scale for both axes
    where the chart is ``equal``. ``seen``: (x0, y0, x1, y1) that shall be seen, by default all.
    """
    x0, y0, x1, y1 = seen or (chart.x.low, chart.y.low, chart.x.high, chart.y.high)
    if chart.equal:
        scale = min(width / max(x1 - x0, 1e-9), height / max(y1 - y0, 1e-9))
        x, y = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
        across, up = 0.5 * width / scale, 0.5 * height / scale
        x0, y0, x1, y1 = x - across, y - up, x + across, y + up
    return x0, y0, x1, y1
