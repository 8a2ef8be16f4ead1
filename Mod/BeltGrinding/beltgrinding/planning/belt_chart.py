"""A batch of parts over the life of its belts, as a picture: cut, feed and force, cost of each part."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeAlias

import numpy as np
from PIL import Image, ImageDraw

from ..base.kinds import Floats
from ..inspection import picture

WIDTH, ROW, LEFT, TOP, BOTTOM = 1400, 240, 110, 50, 60  # pixels
LETTERS, MARGIN = 22, 6  # pixels
INK, GRID = (34, 38, 43), (215, 218, 222)
COLOURS = ((31, 95, 168), (166, 61, 47))
BELT = (235, 239, 244)

Colour: TypeAlias = tuple[int, int, int]
Lines: TypeAlias = Sequence[tuple[str, list[float]]]  # of a chart: what, and a value a part


WORDS = {
    "title": "{} parts, {} new belts, cost {:.2f}",
    "cut": "cut of the belt, %",
    "pace": "of the program's, %",
    "feed": "feed",
    "force": "force",
    "cost": "cost of the part",
    "part": "part; a new belt where the background changes",
}


class Batch(Protocol):
    """What is drawn of a ``belt_plan.BeltPlan``."""

    @property
    def rows(self) -> Sequence[Mapping[str, Any]]:
        ...

    @property
    def cost(self) -> float:
        ...

    @property
    def belts(self) -> int:
        ...


class _Pen:
    """Where and how large it is drawn; ``share``: of the size in the manual."""

    def __init__(self, width: int, rows: int, share: float, top: float) -> None:
        self.left, self.top, self.row, self.bottom = (share * v for v in (LEFT, top, ROW, BOTTOM))
        self.right, self.share = width - 20 * share, share
        self.image = Image.new(
            "RGB", (width, int(self.top + rows * self.row + self.bottom)), "white"
        )
        self.pen, self.font = ImageDraw.Draw(self.image), picture.font(int(LETTERS * share))

    def text(self, x: float, y: float, text: str, fill: Colour = INK, right: bool = False) -> None:
        x -= self.length(text) if right else 0.0
        self.pen.text((x, y), text, font=self.font, fill=fill)

    def length(self, text: str) -> float:
        return self.pen.textlength(text, font=self.font)


def draw(
    found: Batch, words: Mapping[str, str] | None = None, width: int = WIDTH, share: float = 1.0
) -> bytes:
    """Bytes of a PNG of a ``BeltPlan``. ``words``: as ``WORDS``; ``width``: pixels; ``share``: of the size of letters and
    charts in the manual."""
    rows, words = found.rows, words or WORDS
    charts = (
        (words["cut"], (("", [100.0 * row["cut"] for row in rows]),)),
        (
            words["pace"],
            (
                (words["feed"], [100.0 * row["feed_factor"] for row in rows]),
                (words["force"], [100.0 * row["force_factor"] for row in rows]),
            ),
        ),
        (words["cost"], (("", [row["cost"] for row in rows]),)),
    )
    pen = _Pen(width, len(charts), share, TOP if words["title"] else MARGIN)
    x = pen.left + np.arange(len(rows) + 1) / max(len(rows), 1) * (pen.right - pen.left)
    end = pen.top + len(charts) * pen.row
    for k, row in enumerate(rows):  # every other belt's parts on a tinted ground
        if row["belt"] % 2 == 0:
            pen.pen.rectangle([x[k], pen.top, x[k + 1], end], fill=BELT)
    title = words["title"].format(len(rows), found.belts, found.cost)
    pen.text(pen.left, 12 * share, title)
    for k, (name, lines) in enumerate(charts):
        _chart(pen, x, pen.top + k * pen.row, name, lines)
    y = end + 8 * share
    pen.text(pen.left, y, "1")
    pen.text(pen.right, y, str(len(rows)), right=True)
    pen.text(pen.left + 40 * share, y, words["part"])
    return picture.png(np.asarray(pen.image))


def _chart(pen: _Pen, x: Floats, top: float, name: str, lines: Lines) -> None:
    most = _above(max((max(values) for _, values in lines if values), default=1.0))
    upper, lower = top + 34 * pen.share, top + pen.row - 16 * pen.share
    for share in (0.0, 0.5, 1.0):
        y = lower - share * (lower - upper)
        pen.pen.line([pen.left, y, pen.right, y], fill=GRID)
        pen.text(pen.left - 10 * pen.share, y - 13 * pen.share, f"{share * most:.3g}", right=True)
    at = pen.left
    pen.text(at, top + 4 * pen.share, name)
    at += pen.length(name) + 30 * pen.share
    for (what, values), colour in zip(lines, COLOURS):
        pen.text(at, top + 4 * pen.share, what, fill=colour)
        at += pen.length(what) + 24 * pen.share
        points = []
        for k, value in enumerate(values):
            y = lower - value / most * (lower - upper)
            points += [(x[k], y), (x[k + 1], y)]
        if len(points) > 1:
            pen.pen.line(points, fill=colour, width=max(int(3 * pen.share), 2))


def _above(value: float) -> float:
    """The next number whose half is short to write, too."""
    if not value > 0.0:
        return 1.0
    digits = 10.0 ** np.floor(np.log10(value))
    return next(k * digits for k in (1, 1.2, 1.6, 2, 3, 4, 5, 6, 8, 10) if k * digits >= value)
