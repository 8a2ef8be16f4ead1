"""A plan as a picture: the part before and as planned, in the colours of the deviation, and why what is out of
tolerance stays so."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from ..base.kinds import Array, Context
from ..engine import core
from ..inspection import picture
from ..job.tolerances import colour_scale
from ..job.typed import typed
from ..job.workpiece import read_design
from . import reasons

if TYPE_CHECKING:
    from .rounds import Plan

WIDTH = 800  # pixels of one of the pictures side by side
LETTERS, ROW = 24, 36  # pixels
SMALLEST = 5e-4  # of the area, that a reason is told for
INSIDE = 0xDDE3E8FF  # in tolerance
COLOURS = {  # of the reasons, 0xRRGGBBAA: any colour vision tells them apart
    reasons.NOT_REACHED: 0x557EFFFF,
    reasons.NO_ROOM: 0x0000C9FF,
    reasons.FRINGE: 0xA55B65FF,
    reasons.BORDER: 0x77D888FF,
    reasons.SLOWEST: 0xD34013FF,
    reasons.FASTEST: 0xB28BCEFF,
    reasons.PRESSURE: 0x720000FF,
    reasons.CHANGE: 0x001420FF,
    reasons.KEPT: 0x623776FF,
    reasons.SHARED: 0xFABD26FF,
}
WORDS = {
    "before": "before",
    "after": "as planned",
    "why": "why it stays out of tolerance",
    "no_motion": "no motion removes anything there",
    "no_room": "the wheel does not fit there",
    "fringe": "beside what no motion reaches",
    "border": "along the border of the faces",
    "slowest_feed": "too much left at the least feed",
    "fastest_feed": "cut too deep at the greatest feed",
    "pressure": "too much left at the greatest pressure",
    "change": "feed or force may not change faster",
    "kept": "its motions must not be changed",
    "shared": "its motions also grind what needs the contrary",
}


class Pictures(NamedTuple):
    """(rows, columns, 3) uint8, sRGB, of the side that shows most of the ground faces, and of the other."""

    before: list[Array]
    after: list[Array]
    why: list[Array]


def draw(found: Plan, context: Context = None) -> Pictures:
    """``Pictures`` of a ``Plan``. Raises InputError, Cancelled."""
    job = typed(found.job)
    shape = read_design(job.design, context)
    scale = colour_scale(job)
    states = found.why["state"]
    colours = np.full(len(states), INSIDE, dtype=np.uint32)
    for state, colour in COLOURS.items():
        colours[states == state] = colour
    after = found.after.field

    def sides(field: core.HeightField, colours: Array) -> list[Array]:
        views = picture.Studio(field, colours, shape, context).both(context)
        return [view.pixels for view in views]

    drawn = [
        sides(found.before.field, core.deviation_colours(found.before.field, *scale)),
        sides(after, core.deviation_colours(after, *scale)),
        sides(after, colours),
    ]
    return Pictures(*_small(drawn))


def _small(drawn: list[list[Array]]) -> list[list[Array]]:
    """The same ``WIDTH`` wide, each side of one height: stock on the part may make a picture a pixel higher."""
    shapes = [side.shape for side in drawn[0]]
    sizes = [(WIDTH, max(round(rows * WIDTH / columns), 1)) for rows, columns, _ in shapes]
    return [
        [
            np.asarray(Image.fromarray(pixels).resize(size, Image.LANCZOS))
            for pixels, size in zip(sides, sizes)
        ]
        for sides in drawn
    ]


def strip(pictures: Pictures) -> bytes:
    """Bytes of a PNG: the side that shows most, before, as planned and why, from left to right."""
    return picture.png(np.hstack([side[0] for side in pictures]))


def composed(
    pictures: Pictures, shares: Mapping[str, float], words: Mapping[str, str] | None = None
) -> bytes:
    """Bytes of a PNG: before, as planned and why from left to right, the two sides one below the other, and what the
    colours of the reasons say. ``shares``: of the area, as ``reasons.find`` has them; ``words``: as ``WORDS``.
    """
    words = words or WORDS
    told = [
        (COLOURS[state], words[word], shares[word])
        for state, word in reasons.WORDS.items()
        if shares[word] > SMALLEST
    ]
    rows = [side.shape[0] for side in pictures.before]
    whole = Image.new("RGB", (3 * WIDTH, ROW + sum(rows) + ROW * len(told)), "white")
    pen, font = ImageDraw.Draw(whole), picture.font(LETTERS)
    for column, name in enumerate(("before", "after", "why")):
        pen.text((column * WIDTH + 12, 4), words[name], font=font, fill="black")
        for row, side in enumerate(getattr(pictures, name)):
            fitted = Image.fromarray(side).resize((WIDTH, rows[row]))
            whole.paste(fitted, (column * WIDTH, ROW + sum(rows[:row])))
    for row, (colour, text, share) in enumerate(sorted(told, key=lambda one: -one[2])):
        y = ROW + sum(rows) + ROW * row + 5
        rgb = tuple(colour >> shift & 0xFF for shift in (24, 16, 8))
        x = 2 * WIDTH + 12
        pen.rectangle([x, y, x + LETTERS, y + LETTERS], fill=rgb, outline="black")
        text = f"{100.0 * share:.1f} %  {text}"
        pen.text((x + LETTERS + 12, y - 2), text, font=font, fill="black")
    return picture.png(np.asarray(whole))
