"""The picture of a calibration: measured against predicted, and residuals against each input."""

from __future__ import annotations
from typing import Any
from collections.abc import Sequence

import math
from pathlib import Path

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Array, Json
from ..base.plotting import (
    BLUE,
    GREY,
    ORANGE,
    figure as new_figure,
    grid as grid_lines,
    saved,
)
from ..engine import InputError

FORMATS = (".png", ".svg", ".pdf")
LABELS = {
    "force_N": "force, N",
    "belt_speed_m_s": "belt speed, m/s",
    "time_s": "grind time, s",
    "feed_mm_s": "feed, mm/s",
    "area_mm2": "contact area, mm²",
    "pressure_MPa": "mean pressure, MPa",
    "work_J": "belt's work so far, J",
    "removed_so_far_mm3": "belt's removal so far, mm³",
    "wear": "belt's wear number",
}
COLUMNS = 4  # of residuals


def draw(report: Json, path: Path | str) -> None:
    """Draws a calibration's report into a PNG, SVG or PDF. Raises InputError."""
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise InputError(
            "calibration.plot_suffix",
            "{file}: a plot is a file {suffixes}",
            file=path,
            suffixes=", ".join(FORMATS),
        )
    content = render(report, path.suffix.lower()[1:])
    try:
        write_whole(path, content)
    except OSError as error:
        raise cannot_be_written(path, error) from None


def render(report: Json, kind: str = "png", dpi: float = 110) -> bytes:
    """The picture as bytes of a file. Raises InputError without matplotlib."""
    rows = report["rows"]
    inputs = [name for name in LABELS if _drawn(rows.get(name))]
    lines = math.ceil(len(inputs) / COLUMNS)
    figure = new_figure(10.0, 4.8 + 2.3 * lines)
    heights = [4.8] + [2.3] * lines
    grid = figure.add_gridspec(1 + lines, COLUMNS, height_ratios=heights)
    _compare(figure.add_subplot(grid[0, : COLUMNS // 2]), report)
    _tell(figure.add_subplot(grid[0, COLUMNS // 2 :]), report)
    first = None
    for k, name in enumerate(inputs):
        axes = figure.add_subplot(grid[1 + k // COLUMNS, k % COLUMNS], sharey=first)
        first = first or axes
        _residuals(axes, rows, name)
        if k % COLUMNS == 0:
            axes.set_ylabel("measured / predicted")
        else:
            axes.tick_params(labelleft=False)
    return saved(figure, kind, dpi)


def render_small(report: Json) -> bytes:
    """Measured against predicted alone, a small square PNG. Raises InputError."""
    figure = new_figure(2.6, 2.6)
    axes = figure.add_subplot()
    _compare(axes, report)
    axes.set_title("")
    axes.tick_params(labelsize=8)
    for label in (axes.xaxis.label, axes.yaxis.label):
        label.set_fontsize(8.5)
    return saved(figure, "png", 160)


def _drawn(values: Array) -> bool:
    """Whether an input has two values to draw."""
    values = np.asarray([] if values is None else values, dtype=float)
    values = values[np.isfinite(values)]
    return len(values) > 1 and np.ptp(values) > 1e-6 * np.abs(values).max()


def _number(value: float, _: object) -> str:
    return f"{value:.4g}"


def _plain(axis: Any, LogLocator: Any, NullFormatter: Any, ticks: Any = (1.0, 2.0, 5.0)) -> None:
    """A logarithmic axis with plain numbers at ``ticks`` of each decade."""
    axis.set_major_locator(LogLocator(subs=ticks))
    axis.set_major_formatter(_number)
    axis.set_minor_formatter(NullFormatter())


def _split(rows: Sequence[Json], *names: Sequence[str]) -> tuple[list[Array], list[Array]]:
    outlier = np.asarray(rows["outlier"], dtype=bool)
    columns = [np.asarray(rows[name], dtype=float) for name in names]
    return [c[~outlier] for c in columns], [c[outlier] for c in columns]


def _compare(axes: Any, report: Json) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter

    rows = report["rows"]
    unit = rows["unit"].replace("3", "³")
    inside, outside = _split(rows, "predicted", "measured")
    everything = np.concatenate([*inside, *outside])
    low, high = everything.min() / 1.3, everything.max() * 1.3
    line = np.array([low, high])
    band = math.exp(1.96 * float(np.median(rows["ln_deviation"])))
    axes.fill_between(line, line / band, line * band, color=BLUE, alpha=0.13, lw=0)
    axes.plot(line, line, color=BLUE, lw=1.2)
    axes.plot(*inside, "o", ms=4.5, color=BLUE, mec="white", mew=0.5)
    if len(outside[0]):
        axes.plot(*outside, "D", ms=5.5, color=ORANGE, mec="white", mew=0.5)
    axes.set(xscale="log", yscale="log", xlim=line, ylim=line, aspect="equal")
    for axis in (axes.xaxis, axes.yaxis):
        _plain(axis, LogLocator, NullFormatter)
    axes.set_xlabel(f"predicted removal, {unit}")
    axes.set_ylabel(f"measured removal, {unit}")
    axes.set_title("Measured against predicted; band: 95 % of new grinds", fontsize=10)
    grid_lines(axes)


def _tell(axes: Any, report: Json) -> None:
    """The parameters as text."""
    axes.axis("off")
    rows = []
    for one in report["parameters"]:
        name = one["name"].replace("_", " ")
        name = f"{name}, {one['unit'].replace('mm2', 'mm²')}" if one["unit"] else name
        interval = f"{one['low']:.3g} to {one['high']:.3g}" if one["free"] else "fixed"
        rows.append((name, f"{one['value']:.3g}", interval))
    left = report["leave_one_out"]
    at = report["references"]
    rows += [
        ("", "", ""),
        (
            "the coefficient holds at",
            "",
            ", ".join(f"{at[key]:.3g} {key}" for key in at),
        ),
        ("grinds", str(report["grinds"]), ""),
        ("left-out error, median", f"{100 * left['median']:.1f} %", ""),
        ("left-out error, 90 %", f"{100 * left['p90']:.0f} %", ""),
        ("R² of the logarithms", f"{report['r2']:.3f}", ""),
        ("outliers", str(len(report["outliers"])), ""),
    ]
    places = (0.02, 0.58, 0.63)
    for k, texts in enumerate([("parameter", "value", "95 % interval"), *rows]):
        for place, text, side in zip(places, texts, ("left", "right", "left")):
            weight = "bold" if k == 0 else "normal"
            y = 0.97 - 0.066 * k
            axes.text(place, y, text, ha=side, va="top", fontsize=8.5, weight=weight)


def _residuals(axes: Any, rows: Sequence[Json], name: str) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter

    inside, outside = _split(rows, name, "measured", "predicted")
    axes.axhline(1.0, color=GREY, lw=1.0)
    axes.plot(inside[0], inside[1] / inside[2], "o", ms=3, color=BLUE, mec="none", alpha=0.75)
    axes.plot(outside[0], outside[1] / outside[2], "D", ms=4, color=ORANGE, mec="none")
    axes.set_yscale("log")
    _plain(axes.yaxis, LogLocator, NullFormatter, (1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 6.5, 8.0))
    axes.set_xlabel(LABELS[name])
    grid_lines(axes)
    axes.locator_params(axis="x", nbins=4)
    axes.ticklabel_format(axis="x", style="sci", scilimits=(-3, 4))
