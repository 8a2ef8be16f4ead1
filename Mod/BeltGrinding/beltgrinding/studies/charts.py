"""The answers of a study as pictures, for its report and the window. Each function returns the bytes of a PNG.

``words``: a callable that gives a text in the reader's language and has ``figures(value, count)``, as
``reporting.language.Language``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import plotting
from ..base.kinds import Array, Floats, Json
from ..base.plotting import BLUE, GREEN, GREY, ORANGE, RED

if TYPE_CHECKING:
    from ..reporting.language import Language
    from .kinds import Variables

MOST_BARS = 14
COLUMNS = 3
MOST_IN_MATRIX = 6
MOST_POINTS = 3000
LETTERS = 9
INK, RANGE = "#23272e", "#dfe3e8"
VERDICT_COLOURS = {"pass": GREEN, "fail": RED, "unknown": GREY}
LEGEND = 0.3  # inches
CHOICES_SHOWN = 12  # letters of a text on an axis


def tornado(
    effects: Sequence[Json], middle: float, figure: str, words: Language, dpi: float = 110
) -> bytes:
    """``effects``: as ``effects.main_effects``, of which those that do most are drawn; ``middle``: the figure's mean over
    all runs; ``figure``: what it is called."""
    shown = sorted(effects, key=lambda one: one["range"])[-MOST_BARS:]
    drawn = plotting.figure(7.2, 1.3 + 0.46 * len(shown))
    axes = drawn.add_subplot()
    labels = []
    for row, one in enumerate(shown):
        means = [level["mean"] for level in one["levels"]]
        axes.barh(row, one["range"], left=min(means), color=RANGE, height=0.8)
        first, last = _ends(one)
        for level, colour, shift in ((first, ORANGE, 0.17), (last, BLUE, -0.17)):
            axes.barh(row + shift, level["mean"] - middle, left=middle, color=colour, height=0.3)
            if level["low"] is not None:
                axes.plot([level["low"], level["high"]], [row + shift] * 2, color=INK, lw=1.0)
        ends = f"{_span(first, words)}  →  {_span(last, words)}"
        labels.append(f"{_short(one['variable'], 34)}\n{ends}")
    axes.set_yticks(range(len(shown)), labels, fontsize=LETTERS - 0.5)
    axes.axvline(middle, color=INK, lw=1.0)
    axes.set_xlabel(figure, fontsize=LETTERS)
    entries = [(ORANGE, "first level"), (BLUE, "last level"), (RANGE, "all levels")]
    _legend(
        axes,
        [(colour, words(text)) for colour, text in entries],
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncol=3,
    )
    plotting.grid(axes, "x")
    _numbers(axes.xaxis, words)
    return plotting.saved(drawn, dpi=dpi)


def _ends(one: Json) -> tuple[Json, Json]:
    """The levels between which the swing is."""
    levels = one["levels"]
    if isinstance(levels[0]["from"], str):
        means = [level["mean"] for level in levels]
        return levels[int(np.argmin(means))], levels[int(np.argmax(means))]
    return levels[0], levels[-1]


def _span(level: Json, words: Language) -> str:
    if level["from"] == level["to"]:
        return _value(level["from"], words)
    return f"{_value(level['from'], words)} … {_value(level['to'], words)}"


def _value(value: str | float, words: Language) -> str:
    return _short(value, CHOICES_SHOWN) if isinstance(value, str) else words.figures(value, 3)


def _short(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most // 2]}…{text[1 - (most - most // 2) :]}"


def effects(
    found: Sequence[Json], middle: float, figure: str, words: Language, dpi: float = 110
) -> bytes:
    """The mean of a figure over the levels of each variable, with its interval; arguments as ``tornado``."""
    shown = sorted(found, key=lambda one: -one["range"])[: 4 * COLUMNS]
    columns = _columns(len(shown))
    rows = -(-len(shown) // columns)
    drawn = plotting.figure(0.6 + 2.6 * columns, 2.3 * rows + 0.2)
    first = None
    for k, one in enumerate(shown):
        axes = drawn.add_subplot(rows, columns, k + 1, sharey=first)
        first = first or axes
        levels = one["levels"]
        text = isinstance(levels[0]["from"], str)
        places = (
            np.arange(len(levels))
            if text
            else np.array([0.5 * (level["from"] + level["to"]) for level in levels])
        )
        means = [level["mean"] for level in levels]
        axes.axhline(middle, color=GREY, lw=0.8)
        if levels[0]["low"] is not None:
            ends = np.array([[level["low"], level["high"]] for level in levels], dtype=float)
            axes.vlines(places, ends[:, 0], ends[:, 1], color=BLUE, lw=1.2)
        axes.plot(places, means, "o" if text else "o-", color=BLUE, ms=4, lw=1.2)
        if text:
            names = [_short(level["from"], CHOICES_SHOWN) for level in levels]
            axes.set_xticks(places, names, rotation=20, ha="right")
            axes.margins(x=0.2)
        else:
            axes.locator_params(axis="x", nbins=4)
            _numbers(axes.xaxis, words)
        _small(axes, one["variable"], figure if k % columns == 0 else "")
        axes.tick_params(labelleft=k % columns == 0)
        _numbers(axes.yaxis, words)
    return plotting.saved(drawn, dpi=dpi)


def scatter(
    variables: Variables,
    values: Array,
    verdicts: Array | None,
    figure: str,
    words: Language,
    dpi: float = 110,
) -> bytes:
    """A figure against each variable, a point a run in the colour of its verdict. ``variables``: {name: (n,)};
    ``values``: (n,); ``verdicts``: (n,) "pass", "fail" or "unknown", or None."""
    names = list(variables)[: 4 * COLUMNS]
    columns = _columns(len(names))
    rows = -(-len(names) // columns)
    drawn = plotting.figure(0.6 + 2.6 * columns, 2.3 * rows + 0.5)
    first, some = None, _some(len(values))
    for k, name in enumerate(names):
        axes = drawn.add_subplot(rows, columns, k + 1, sharey=first)
        first = first or axes
        _points(axes, variables[name][some], values[some], _chosen(verdicts, some), words)
        _small(axes, name, figure if k % columns == 0 else "")
        axes.tick_params(labelleft=k % columns == 0)
    _tell_colours(drawn, verdicts, words)
    return plotting.saved(drawn, dpi=dpi)


def matrix(columns: Variables, verdicts: Array | None, words: Language, dpi: float = 110) -> bytes:
    """Each of the first six columns against each other; on the diagonal how often which value comes. ``columns``: {name:
    (n,)}; ``verdicts`` as ``scatter``."""
    names = list(columns)[:MOST_IN_MATRIX]
    count = len(names)
    drawn = plotting.figure(1.75 * count + 0.6, 1.6 * count + 0.6)
    some = _some(len(columns[names[0]]))
    for row, below in enumerate(names):
        for column, beside in enumerate(names):
            axes = drawn.add_subplot(count, count, row * count + column + 1)
            if row == column:
                values = _coded(columns[below][some])[0]
                axes.hist(values[np.isfinite(values)], bins=14, color=BLUE, alpha=0.75)
                axes.tick_params(labelleft=False, left=False)
            else:
                x, y = columns[beside][some], columns[below][some]
                _points(axes, x, y, _chosen(verdicts, some), words, 7)
            _small(
                axes,
                _short(beside, 20) if row == count - 1 else "",
                _short(below, 20) if column == 0 else "",
            )
            axes.tick_params(labelbottom=row == count - 1)
            if row != column:
                axes.tick_params(labelleft=column == 0)
            axes.xaxis.label.set_fontsize(LETTERS - 2)
            axes.yaxis.label.set_fontsize(LETTERS - 2)
            axes.tick_params(labelsize=LETTERS - 3)
            axes.locator_params(nbins=3) if not _is_text(axes) else None
    _tell_colours(drawn, verdicts, words)
    return plotting.saved(drawn, dpi=dpi)


def _is_text(axes: Any) -> bool:
    """Whether an axis has ticks of its own, which must not be counted anew."""
    from matplotlib.ticker import FixedLocator

    return any(
        isinstance(axis.get_major_locator(), FixedLocator) for axis in (axes.xaxis, axes.yaxis)
    )


def yields(rows: Sequence[tuple[str, Json]], words: Language, dpi: float = 110) -> bytes:
    """Bars of shares with their intervals. ``rows``: [(text, dict as ``share.of``)]."""
    drawn = plotting.figure(7.2, 0.9 + 0.38 * len(rows))
    axes = drawn.add_subplot()
    for place, (_, one) in enumerate(reversed(rows)):
        share = 100.0 * (one["share"] or 0.0)
        axes.barh(place, 100.0, color="#f0e3e2", height=0.62)
        axes.barh(place, share, color=GREEN, height=0.62)
        if one["low"] is not None:
            ends = [100.0 * one["low"], 100.0 * one["high"]]
            axes.plot(ends, [place, place], color=INK, lw=1.6, marker="|", ms=8)
    axes.set_yticks(range(len(rows)), [_short(text, 40) for text, _ in reversed(rows)])
    axes.tick_params(labelsize=LETTERS)
    axes.set_xlim(0.0, 100.0)
    axes.set_xlabel(words("share of the runs, %"), fontsize=LETTERS)
    plotting.grid(axes, "x")
    return plotting.saved(drawn, dpi=dpi)


def indices(
    found: Json, names: Sequence[str], figure: str, words: Language, dpi: float = 110
) -> bytes:
    """Sobol indices with their intervals. ``found``: dict(first, total), lists of (value, low, high) in the order of
    ``names``."""
    order = np.argsort([one[0] for one in found["total"]])[-MOST_BARS:]
    drawn = plotting.figure(7.2, 1.2 + 0.5 * len(order))
    axes = drawn.add_subplot()
    for kind, colour, shift in (("total", BLUE, -0.19), ("first", ORANGE, 0.19)):
        for row, k in enumerate(order):
            value, low, high = found[kind][k]
            axes.barh(row + shift, max(value, 0.0), color=colour, height=0.36)
            axes.plot([low, high], [row + shift] * 2, color=INK, lw=1.2, marker="|", ms=5)
    axes.set_yticks(range(len(order)), [_short(names[k], 34) for k in order], fontsize=LETTERS)
    axes.axvline(0.0, color=INK, lw=0.8)
    axes.set_xlabel(words("share of the variance of: {figure}", figure=figure), fontsize=LETTERS)
    _legend(
        axes,
        [(ORANGE, words("alone (first order)")), (BLUE, words("with the others (total)"))],
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncol=2,
    )
    plotting.grid(axes, "x")
    _numbers(axes.xaxis, words)
    return plotting.saved(drawn, dpi=dpi)


def _columns(count: int) -> int:
    return 2 if count == 4 else min(COLUMNS, count)


def _some(count: int) -> Array:
    """At most as many runs as can be told apart, evenly chosen."""
    return np.unique(np.linspace(0, count - 1, min(count, MOST_POINTS)).astype(int))


def _chosen(verdicts: Array | None, some: Array) -> Array | None:
    return None if verdicts is None else np.asarray(verdicts, dtype=object)[some]


def _coded(values: Array) -> tuple[Floats, list[str] | None]:
    """(numbers, texts or None): text as the number of its place among all."""
    if values.dtype.kind in "fiu":
        return values.astype(float), None
    names, number = np.unique(values.astype(str), return_inverse=True)
    return number.astype(float), names.tolist()


def _points(
    axes: Any, x: Array, y: Array, verdicts: Array | None, words: Language, size: int = 12
) -> None:
    (x, x_names), (y, y_names) = _coded(x), _coded(y)
    if verdicts is None:
        axes.scatter(x, y, s=size, color=BLUE, alpha=0.7, lw=0)
    else:
        for word, colour in VERDICT_COLOURS.items():
            at = verdicts == word
            axes.scatter(x[at], y[at], s=size, color=colour, alpha=0.7, lw=0)
    for axis, names in ((axes.xaxis, x_names), (axes.yaxis, y_names)):
        if names is not None:
            axis.set_ticks(range(len(names)), [_short(name, CHOICES_SHOWN) for name in names])
        else:
            _numbers(axis, words)
    plotting.grid(axes)


def _tell_colours(drawn: Any, verdicts: Array | None, words: Language) -> None:
    if verdicts is None:
        return
    texts = {"pass": words("passes"), "fail": words("fails"), "unknown": words("not known")}
    there = [word for word in VERDICT_COLOURS if word in set(verdicts)]
    from matplotlib.lines import Line2D

    height = drawn.get_size_inches()[1]
    drawn.get_layout_engine().set(rect=(0.0, 0.0, 1.0, 1.0 - LEGEND / height))
    marks = [Line2D([], [], ls="", marker="o", ms=5, color=VERDICT_COLOURS[w]) for w in there]
    drawn.legend(
        marks,
        [texts[word] for word in there],
        loc="upper right",
        ncol=3,
        fontsize=LETTERS,
        frameon=False,
    )


def _legend(axes: Any, entries: Sequence[tuple[str, str]], **where: object) -> None:
    from matplotlib.patches import Patch

    patches = [Patch(color=colour, label=text) for colour, text in entries]
    axes.legend(handles=patches, fontsize=LETTERS, frameon=False, **where)


def _small(axes: Any, x: str, y: str) -> None:
    axes.set_xlabel(_short(x, 34), fontsize=LETTERS - 0.5)
    axes.set_ylabel(_short(y, 34), fontsize=LETTERS - 0.5)
    axes.tick_params(labelsize=LETTERS - 1)
    plotting.grid(axes)


def _numbers(axis: Any, words: Language) -> None:
    """Numbers as the language writes them."""
    axis.set_major_formatter(lambda value, _: words.decimal(f"{value:.5g}"))
    axis.set_tick_params(labelsize=LETTERS - 1)
