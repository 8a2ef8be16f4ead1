"""Charts of a report: the deviation's histogram by area, time series, the colours' legend."""

import numpy as np

from ..charts import svg

from ..charts.model import (
    BASE, END, FRAME, MIDDLE, NONE, ROOT, START,
    Axis, Band, Bars, Chart, Line, Mark, Panel, Sheet, Text, Tick,
)  # fmt: skip
from ..engine import core
from .markup import Markup

WIDTH = 720  # points; the page scales the drawing
LEFT, RIGHT = 52, 12  # margins
BINS = 80
SERIES_BINS = 360
SERIES = (  # name among a result's steps, text, unit, colour
    ("force", "Pressing force", "N", "#1f5a96"),
    ("peak_pressure", "Peak pressure", "MPa", "#7a3d9a"),
    ("removal_rate", "Removal rate", "mm³/s", "#d1701f"),
)
GOOD, BAND = "#8fae8f", "#d3e1d3"  # bars in tolerance, and what lies behind them
MISSED = "#707070"
SHARES = (0.1, 1.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0)  # %, where the histogram has lines
BESIDE = 70  # points that a limit's label takes


def rgb(packed):
    """CSS colour of 0xRRGGBBAA."""
    return f"#{int(packed) >> 8:06x}"


def _drawn(sheet, class_, label):
    return Markup(svg.svg(sheet, class_, label, standalone=False))


def histogram(field, scale, words):
    """The share of the inspected area by deviation, in the colours of ``scale`` (lower, upper, limit,
    mm), with the band drawn. The first and the last bar hold all that lies beyond.
    """
    lower, upper, limit = scale
    found = (field.flags & core.MISSED) == 0
    height, area = field.height[found], field.areas[found].astype(float)
    if not len(height) or area.sum() <= 0.0:
        return None
    low, high = max(float(height.min()), -limit), min(float(height.max()), limit)
    low, high = min(low, 1.2 * lower - 0.2 * upper), max(high, 1.2 * upper - 0.2 * lower)
    pad = max(0.02 * (high - low), 1e-6)
    edges = np.linspace(low - pad, high + pad, BINS + 1)
    middles = 0.5 * (edges[1:] + edges[:-1])
    inside = np.clip(height, edges[0], np.nextafter(edges[-1], -np.inf))
    shares = 100.0 * np.histogram(inside, edges, weights=area)[0] / area.sum()
    colours = core.colour_scale(lower, upper, limit, middles.tolist())
    colours = [GOOD if lower <= m <= upper else rgb(c) for m, c in zip(middles, colours)]
    top, above, tall = max(float(shares.max()), 1e-9), 26, 170
    wide = WIDTH - LEFT - RIGHT
    seen = np.where(shares > 0.0, np.maximum(shares, top * (0.8 / tall) ** 2), 0.0)  # 0.8 points
    x = Axis(
        float(edges[0]),
        float(edges[-1]),
        words("deviation from the design, mm"),
        count=9,
        gap=32,
        number=lambda value, decimals: words.number(value, decimals, True),
        grid=False,
    )
    lines = [Tick(v, words.number(v, int(v < 1))) for v in SHARES if v < 1.05 * top]
    # The root of the share: a peak in the band must not hide a thin tail outside of it.
    y = Axis(0.0, top, words("% of the area"), ROOT, ticks=tuple(lines), gap=40)
    marks = []
    for value, outside in ((lower, -1), (upper, 1)):
        end = x.low if outside < 0 else x.high
        room = (end - value) * outside * wide / x.span > BESIDE
        anchor = START if (outside if room else -outside) > 0 else END
        label = f"{words.number(value, 3, True)} mm"
        marks.append(Mark(value, label, anchor, above=8.0, width=1.4))
    band = Band([np.array([[lower, 0.0], [upper, 0.0], [upper, top], [lower, top]])], BAND, 0.5)
    chart = Chart(x, y, [band, Bars(edges, seen, colours, 0.07)], marks, frame=BASE)
    sheet = Sheet("histogram", WIDTH, above + tall + 44, [Panel(chart, LEFT, above, wide, tall)])
    label = words("Share of the ground area by deviation; the band is the tolerance")
    return _drawn(sheet, "chart", label)


def legend(scale, words):
    """The colours of the deviation, with their limits in mm, and of missed rays."""
    lower, upper, limit = scale
    left, top, bar, wide = 30, 10, 20, 530
    edges = np.linspace(-limit, limit, 282)
    values = np.linspace(-limit, limit, 281)
    colours = [rgb(c) for c in core.colour_scale(lower, upper, limit, values.tolist())]
    step = wide / (2.0 * limit)  # points per mm
    close = (upper - lower) * step < 64  # the limits' labels would run into each other
    before = {-limit: "≤ ", limit: "≥ "}
    ticks = []
    for value in (-limit, lower, upper, limit):
        text = before.get(value, "") + words.number(value, 3, True)
        anchor = MIDDLE
        if close and value in (lower, upper):
            anchor = END if value == lower else START
        ticks.append(Tick(value, text + (" mm" if value == limit else ""), anchor))
    none = Axis(0.0, 1.0, ticks=(), grid=False)
    scale = Chart(
        Axis(-limit, limit, ticks=tuple(ticks), grid=False),
        none,
        [Bars(edges, np.ones(len(colours)), colours)],
        [Mark(tick.value, below=5.0) for tick in ticks],
    )
    swatch = Chart(none, none, [Bars([0.0, 1.0], [1.0], [MISSED])], frame=NONE)
    panels = [
        Panel(scale, left, top, wide, bar),
        Panel(swatch, left + wide + 68, top, bar, bar),
    ]
    texts = [Text(left + wide + 94, top + 15, words("no stock"))]
    for value, text in (
        (0.5 * (lower - limit), words("cut too deep")),
        (0.5 * (upper + limit), words("too much left")),
        (0.5 * (lower + upper), words("good")),
    ):
        texts.append(Text(left + (value + limit) * step, top + bar + 37, text, MIDDLE, bold=True))
    sheet = Sheet("legend", WIDTH, top + bar + 44, panels, texts)
    return _drawn(sheet, "legend", words("Colours of the deviation"))


def binned(steps, count=SERIES_BINS):
    """The time series of a run in at most ``count`` bins of equal time: dict of lists, ``time`` (s, the
    bins' middles) and of every name in ``SERIES`` the greatest value in the bin (0 where there is no
    step, None for values that are not finite).
    """
    time, end = np.asarray(steps["time"], float), np.asarray(steps["duration"], float)
    if not len(time):
        return {"time": [], **{name: [] for name, *_ in SERIES}}
    whole = float((time + 0.5 * end).max())
    edges = np.linspace(0.0, max(whole, 1e-9), min(count, max(len(time), 2)) + 1)
    at = np.clip(np.searchsorted(edges, time, "right") - 1, 0, len(edges) - 2)
    found = {"time": (0.5 * (edges[1:] + edges[:-1])).tolist()}
    for name, *_ in SERIES:
        values = np.nan_to_num(np.asarray(steps[name], float))
        most = np.zeros(len(edges) - 1)
        np.maximum.at(most, at, values)
        found[name] = most.tolist()
    return found


def series(bins, words):
    """The time series of ``binned``, one chart below the other; None without any."""
    if not bins or not bins["time"]:
        return None
    time = np.array(bins["time"])
    step = time[1] - time[0] if len(time) > 1 else 2.0 * time[0]
    end = float(time[-1] + 0.5 * step)
    tall, gap, top = 64, 26, 20
    wide, panels = WIDTH - LEFT - RIGHT, []
    for name, text, unit, colour in SERIES:
        values = np.array(bins[name])
        most = float(values.max()) if values.any() else 1.0
        line = np.column_stack([time, values])
        under = np.vstack([[time[0], 0.0], line, [time[-1], 0.0]])
        last = name == SERIES[-1][0]
        chart = Chart(
            Axis(0.0, end, words("time, s") if last else "", count=9, number=words.number,
              labelled=last, grid=False, gap=29),
            Axis(0.0, 1.05 * most, count=2, number=words.number),
            [Band([under], colour, 0.2), Line([line], colour)],
            title=f"{words(text)}, {unit}",
            frame=BASE,
        )  # fmt: skip
        panels.append(Panel(chart, LEFT, top, wide, tall))
        top += tall + gap
    sheet = Sheet("series", WIDTH, top - gap + 40, panels)
    return _drawn(sheet, "chart", words("Force, pressure and removal rate over time"))
