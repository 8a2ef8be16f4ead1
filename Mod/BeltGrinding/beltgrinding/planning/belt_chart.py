"""A batch of parts over the life of its belts, as a picture: cut, feed and force, cost of each part."""

import numpy as np
from PIL import Image, ImageDraw

from ..inspection import picture

WIDTH, ROW, LEFT, TOP, BOTTOM = 1400, 240, 150, 50, 60  # pixels
LETTERS = 22
INK, GRID = (34, 38, 43), (215, 218, 222)
COLOURS = ((31, 95, 168), (166, 61, 47))
BELT = (235, 239, 244)


def draw(found):
    """Bytes of a PNG of a ``BeltPlan``."""
    rows = found.rows
    charts = (
        ("cut of the belt, %", (("", [100.0 * row["cut"] for row in rows]),)),
        (
            "of the program's, %",
            (
                ("feed", [100.0 * row["feed_factor"] for row in rows]),
                ("force", [100.0 * row["force_factor"] for row in rows]),
            ),
        ),
        ("cost of the part", (("", [row["cost"] for row in rows]),)),
    )
    image = Image.new("RGB", (WIDTH, TOP + len(charts) * ROW + BOTTOM), "white")
    pen, font = ImageDraw.Draw(image), picture.font(LETTERS)
    x = LEFT + (np.arange(len(rows) + 1)) / max(len(rows), 1) * (WIDTH - LEFT - 20)
    _belts(pen, rows, x, TOP + len(charts) * ROW)
    text = f"{len(rows)} parts, {found.belts} new belts, cost {found.cost:.2f}"
    pen.text((LEFT, 12), text, font=font, fill=INK)
    for k, (name, lines) in enumerate(charts):
        _chart(pen, font, x, TOP + k * ROW, name, lines)
    y = TOP + len(charts) * ROW + 8
    pen.text((LEFT, y), "1", font=font, fill=INK)
    last = str(len(rows))
    pen.text((WIDTH - 20 - pen.textlength(last, font=font), y), last, font=font, fill=INK)
    pen.text((LEFT + 40, y), "part; a new belt where the background changes", font=font, fill=INK)
    return picture.png(np.asarray(image))


def _belts(pen, rows, x, bottom):
    """Every other belt's parts on a tinted ground."""
    for k, row in enumerate(rows):
        if row["belt"] % 2 == 0:
            pen.rectangle([x[k], TOP, x[k + 1], bottom], fill=BELT)


def _chart(pen, font, x, top, name, lines):
    most = _above(max((max(values) for _, values in lines if values), default=1.0))
    upper, lower = top + 34, top + ROW - 16
    for share in (0.0, 0.5, 1.0):
        y = lower - share * (lower - upper)
        pen.line([LEFT, y, WIDTH - 20, y], fill=GRID)
        text = f"{share * most:.3g}"
        pen.text((LEFT - 10 - pen.textlength(text, font=font), y - 13), text, font=font, fill=INK)
    pen.text((LEFT, top + 4), name, font=font, fill=INK)
    at = LEFT + pen.textlength(name, font=font) + 30
    for (what, values), colour in zip(lines, COLOURS):
        pen.text((at, top + 4), what, font=font, fill=colour)
        at += pen.textlength(what, font=font) + 24
        points = []
        for k, value in enumerate(values):
            y = lower - value / most * (lower - upper)
            points += [(x[k], y), (x[k + 1], y)]
        if len(points) > 1:
            pen.line(points, fill=colour, width=3)


def _above(value):
    """The next number whose half is short to write, too."""
    if not value > 0.0:
        return 1.0
    digits = 10.0 ** np.floor(np.log10(value))
    return next(k * digits for k in (1, 1.2, 1.6, 2, 3, 4, 5, 6, 8, 10) if k * digits >= value)
