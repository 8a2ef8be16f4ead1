"""Charts of a report, as SVG: the deviation's histogram by area, time series, the colours' legend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.kinds import Array, Json
from ..engine import core
from ..inspection.section_plot import ticks
from .markup import element

if TYPE_CHECKING:
    from ..inspection import picture
    from .language import Language
    from .markup import Markup

WIDTH = 720  # user units; the page scales the drawing
INK, GRID, FRAME = "#40454d", "#e3e5e8", "#9aa0a8"
BINS = 80
SERIES_BINS = 360
SERIES = (  # name among a result's steps, text, unit, colour
    ("force", "Pressing force", "N", "#1f5a96"),
    ("peak_pressure", "Peak pressure", "MPa", "#7a3d9a"),
    ("removal_rate", "Removal rate", "mm³/s", "#d1701f"),
)


def rgb(packed: int) -> str:
    """CSS colour of 0xRRGGBBAA."""
    return f"#{int(packed) >> 8:06x}"


def _svg(width: float, height: float, *children: object, **attributes: object) -> Markup:
    return element(
        "svg",
        *children,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width} {height}",
        font_family="sans-serif",
        font_size=12,
        fill=INK,
        role="img",
        **attributes,
    )


def _text(x: float, y: float, text: str, anchor: str = "start", **attributes: object) -> Markup:
    return element("text", text, x=float(x), y=float(y), text_anchor=anchor, **attributes)


def histogram(
    field: core.HeightField, scale: tuple[float, float, float], words: Language
) -> Markup | None:
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
    # By their number and range, not by their edges: what is evenly spaced is counted without a sort.
    shares = np.histogram(inside, BINS, (edges[0], edges[-1]), weights=area)[0]
    shares *= 100.0 / area.sum()
    colours = core.colour_scale(lower, upper, limit, middles.tolist())
    # The root of the share: a peak in the band must not hide a thin tail outside of it.
    top = max(float(shares.max()), 1e-9)
    left, right, above, below, tall = 52, 12, 26, 44, 170
    wide = WIDTH - left - right

    def x(value: Any) -> Any:
        return left + wide * (value - edges[0]) / (edges[-1] - edges[0])

    def y(share: Any) -> Any:
        return above + tall * (1.0 - np.sqrt(share / top))

    drawn = [
        element(
            "rect",
            x=x(lower),
            y=above,
            width=x(upper) - x(lower),
            height=tall,
            fill="#e9f0e9",
        ),
    ]
    for value in (v for v in (0.1, 1.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0) if v < 1.05 * top):
        drawn.append(element("path", d=f"M{left} {y(value):.1f}h{wide}", stroke=GRID))
        drawn.append(_text(left - 6, y(value) + 4, words.number(value, int(value < 1)), "end"))
    values, decimals = ticks(edges[0], edges[-1], 9)
    for value in values:
        drawn.append(
            _text(
                x(value),
                above + tall + 16,
                words.number(value, decimals, True),
                "middle",
            )
        )
    for share, middle, a, b, colour in zip(shares, middles, edges, edges[1:], colours):
        if share > 0.0:
            bar = max(above + tall - y(share), 0.8)
            good = lower <= middle <= upper
            drawn.append(
                element(
                    "rect",
                    x=x(a) + 0.3,
                    y=float(above + tall - bar),
                    width=x(b) - x(a) - 0.6,
                    height=float(bar),
                    fill="#8fae8f" if good else rgb(colour),
                )
            )
    room = 70  # of a limit's label, which stands outside of the band where there is room
    for value, outside in ((lower, -1), (upper, 1)):
        end = left if outside < 0 else WIDTH - right
        side = outside if (end - x(value)) * outside > room else -outside
        anchor, shift = ("start", 5) if side > 0 else ("end", -5)
        drawn.append(
            element(
                "path",
                d=f"M{x(value):.1f} {above - 8}v{tall + 8}",
                stroke=INK,
                stroke_width=1.4,
            )
        )
        label = f"{words.number(value, 3, True)} mm"
        drawn.append(_text(x(value) + shift, above - 10, label, anchor))
    drawn.append(element("path", d=f"M{left} {above + tall}h{wide}", stroke=FRAME))
    drawn.append(
        _text(
            left + wide / 2,
            above + tall + 36,
            words("deviation from the design, mm"),
            "middle",
        )
    )
    middle = above + tall / 2
    drawn.append(
        element(
            "text",
            words("% of the area"),
            transform=f"translate(12 {middle:.0f}) rotate(-90)",
            text_anchor="middle",
        )
    )
    label = words("Share of the ground area by deviation; the band is the tolerance")
    return _svg(WIDTH, above + tall + below, drawn, class_="chart", aria_label=label)


def legend(scale: tuple[float, float, float], words: Language) -> Markup:
    """The colours of the deviation, with their limits in mm, and of missed rays."""
    lower, upper, limit = scale
    left, top, bar, wide = 30, 10, 20, 530
    values = np.linspace(-limit, limit, 281)
    colours = core.colour_scale(lower, upper, limit, values.tolist())

    def x(value: Any) -> Any:
        return left + wide * (value + limit) / (2.0 * limit)

    step = wide / len(values)
    drawn = [
        element(
            "rect",
            x=left + k * step,
            y=top,
            width=step + 0.4,
            height=bar,
            fill=rgb(colour),
        )
        for k, colour in enumerate(colours)
    ]
    drawn.append(element("rect", x=left, y=top, width=wide, height=bar, fill="none", stroke=FRAME))
    places = {-limit: "≤ ", limit: "≥ "}
    for value in (-limit, lower, upper, limit):
        drawn.append(element("path", d=f"M{x(value):.1f} {top}v{bar + 5}", stroke=INK))
    close = x(upper) - x(lower) < 64  # the limits' labels would run into each other
    for value in (-limit, lower, upper, limit):
        anchor = "middle"
        if close and value in (lower, upper):
            anchor = "end" if value == lower else "start"
        text = places.get(value, "") + words.number(value, 3, True)
        text += " mm" if value == limit else ""
        drawn.append(_text(x(value), top + bar + 19, text, anchor))
    for at, text in (
        (0.5 * (x(-limit) + x(lower)), words("cut too deep")),
        (0.5 * (x(upper) + x(limit)), words("too much left")),
    ):
        drawn.append(_text(at, top + bar + 37, text, "middle", font_weight="bold"))
    drawn.append(
        _text(
            0.5 * (x(lower) + x(upper)),
            top + bar + 37,
            words("good"),
            "middle",
            font_weight="bold",
        )
    )
    missed = rgb(0x707070FF)
    drawn.append(element("rect", x=left + wide + 68, y=top, width=bar, height=bar, fill=missed))
    drawn.append(_text(left + wide + 94, top + 15, words("no stock")))
    label = words("Colours of the deviation")
    return _svg(WIDTH, top + bar + 44, drawn, class_="legend", aria_label=label)


def binned(steps: Mapping[str, Array], count: int = SERIES_BINS) -> dict[str, Any]:
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


def series(bins: Json | None, words: Language) -> Markup | None:
    """The time series of ``binned``, one chart below the other; None without any."""
    if not bins or not bins["time"]:
        return None
    time = np.array(bins["time"])
    step = time[1] - time[0] if len(time) > 1 else 2.0 * time[0]
    end = float(time[-1] + 0.5 * step)
    left, right, tall, gap = 52, 12, 64, 26
    wide, drawn, top = WIDTH - left - right, [], 20
    for name, text, unit, colour in SERIES:
        values = np.array(bins[name])
        most = max(float(values.max()), 1e-12)
        drawn.append(_text(left, top - 6, f"{words(text)}, {unit}", font_weight="bold"))
        for value, decimals in ((v, ticks(0.0, most, 2)[1]) for v in ticks(0.0, most, 2)[0]):
            y = top + tall * (1.0 - value / (1.05 * most))
            drawn.append(element("path", d=f"M{left} {y:.1f}h{wide}", stroke=GRID))
            drawn.append(_text(left - 6, y + 4, words.number(value, decimals), "end"))
        x = left + wide * time / end
        y = top + tall * (1.0 - values / (1.05 * most))
        line = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
        base = top + tall
        drawn.append(
            element("polygon", points=f"{x[0]:.1f},{base} {line} {x[-1]:.1f},{base}", fill=colour,
              fill_opacity=0.2)
        )  # fmt: skip
        drawn.append(element("polyline", points=line, fill="none", stroke=colour, stroke_width=1.2))
        drawn.append(element("path", d=f"M{left} {base}h{wide}", stroke=FRAME))
        top += tall + gap
    base = top - gap
    for value, decimals in ((v, ticks(0.0, end, 9)[1]) for v in ticks(0.0, end, 9)[0]):
        x = left + wide * value / end
        drawn.append(element("path", d=f"M{x:.1f} {base}v4", stroke=FRAME))
        drawn.append(_text(x, base + 16, words.number(value, decimals), "middle"))
    drawn.append(_text(left + wide / 2, base + 33, words("time, s"), "middle"))
    label = words("Force, pressure and removal rate over time")
    return _svg(WIDTH, base + 40, drawn, class_="chart", aria_label=label)


def marked(
    view: picture.View, uri: str, marks: Sequence[tuple[int, float, float]], alt: str
) -> Markup:
    """A picture with numbered marks. ``marks``: (number, column, row) in pixels; ``view``: its
    ``picture.View``; ``uri``: its data.
    """
    rows, columns = view.depth.shape
    size = columns / 45.0
    drawn = [element("image", href=uri, x=0, y=0, width=columns, height=rows)]
    labels = _placed(marks, columns, rows, size)
    for (_, x, y), (at, up) in zip(marks, labels):  # lines below all rings and labels
        pen = {"fill": "none", "stroke_linecap": "round"}
        line = f"M{x:.1f} {y:.1f}L{at:.1f} {up:.1f}"
        drawn.append(element("path", d=line, stroke="white", stroke_width=size / 4, **pen))
        drawn.append(element("path", d=line, stroke=INK, stroke_width=size / 10, **pen))
    for number, x, y in marks:
        drawn.append(element("circle", cx=x, cy=y, r=size / 4.2, fill=INK, stroke="white"))
    for (number, *_), (at, up) in zip(marks, labels):
        drawn.append(
            element(
                "circle",
                cx=at,
                cy=up,
                r=0.85 * size,
                fill=INK,
                stroke="white",
                stroke_width=2,
            )
        )
        drawn.append(
            element(
                "text",
                number,
                x=at,
                y=up + 0.37 * size,
                text_anchor="middle",
                fill="white",
                font_size=1.1 * size,
                font_weight="bold",
            )
        )
    return _svg(columns, rows, drawn, class_="picture", aria_label=alt)


def ringed(view: picture.View, uri: str, x: float, y: float, alt: str) -> Markup:
    """A picture with a ring around the place (column, row)."""
    rows, columns = view.depth.shape
    size = columns / 20.0
    rings = [
        element(
            "circle",
            cx=x,
            cy=y,
            r=size,
            fill="none",
            stroke=colour,
            stroke_width=size / thin,
        )
        for colour, thin in (("white", 3.2), (INK, 8.0))
    ]
    image = element("image", href=uri, x=0, y=0, width=columns, height=rows)
    return _svg(columns, rows, image, rings, class_="picture", aria_label=alt)


def _placed(marks: Sequence[Any], columns: int, rows: int, size: tuple[int, int]) -> list[Any]:
    """Where the numbers stand: at the nearer border, one below the other, in their marks' order."""
    placed = {}
    for border, side in ((1.4 * size, False), (columns - 1.4 * size, True)):
        own = sorted((m for m in marks if (m[1] > 0.5 * columns) == side), key=lambda m: m[2])
        step, low = 2.1 * size, 1.4 * size
        for k, (number, _, y) in enumerate(own):
            room = rows - 1.4 * size - step * (len(own) - 1 - k)  # for those that follow
            low = min(max(low, y), room)
            placed[number] = (border, low)
            low += step
    return [placed[number] for number, *_ in marks]
