"""The picture of a legend: a colour bar with numbers and words, drawn by Qt at a view's size."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from ..common.compat import QtCore, QtGui
from ..common.kinds import Colour, Image, Painter, Rectangle
from ..common.theme import theme

SHARE = 12  # of the view's width that it takes: a twelfth
LETTER = 8.4  # widths of the panel in heights of its letters, on the mean
LEAST, MOST_SHARE = 9.5, 1.0 / 30.0  # pixels; of the view's height: a letter
TALL = 0.55  # of the view's height: the bar
TALLEST = 0.94  # all
LINE = 1.35  # from line to line, in letters
OPACITY = 215  # of 255: the ground


class Spec(NamedTuple):
    """What a legend says. ``labels``: by height (0 to 1) along the bar, the important ones first."""

    colours: list[int]  # 0xRRGGBBAA from the bar's lower end
    labels: dict[float, str]
    title: str
    words: tuple[str, str]  # below the bar and above it; "" for none
    beyond: tuple[bool, bool]  # bool: whether values lie beyond the lower end and the upper one
    warning: str


def draw(spec: Spec, width: float, height: float, ratio: float = 1.0) -> Image | None:
    """The QImage of a ``Spec`` for a view of ``width`` x ``height`` pixels; None where that is too small.

    ratio: device pixels of one of the screen's.
    """
    letter = max(min(width / (SHARE * LETTER), height * MOST_SHARE), LEAST * ratio)
    font = QtGui.QFont(QtGui.QApplication.font())
    font.setPixelSize(max(round(letter), 1))
    # For pixels of the picture, whatever the screen's density.
    metrics = QtGui.QFontMetricsF(font)
    pad, bar_width, gap = 0.7 * letter, 1.4 * letter, 0.4 * letter
    widest = max(metrics.boundingRect(text).width() for text in spec.labels.values())
    inner = max(bar_width + gap + widest, width / SHARE - 2 * pad)
    title = wrapped(spec.title, inner, metrics)
    above, below = (wrapped(word, inner, metrics) for word in reversed(spec.words))
    warning = wrapped(spec.warning, inner, metrics)
    texts = [*title, *above, *below, *warning]
    inner = max([inner, *(metrics.boundingRect(text).width() + 1 for text in texts)])
    line, tip = LINE * letter, 0.9 * letter
    fixed = 2 * pad + line * (len(texts) + 0.5)
    fixed += tip * sum(spec.beyond) + 0.8 * letter
    bar = min(TALL * height, TALLEST * height - fixed)
    if bar < 4 * letter:
        return None
    size = QtCore.QSize(round(inner + 2 * pad), round(fixed + bar))
    image = QtGui.QImage(size, QtGui.QImage.Format_RGBA8888)
    image.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(image)
    painter.setRenderHint(QtGui.QPainter.Antialiasing)
    painter.setFont(font)
    look = theme()
    ground = QtGui.QColor(look.ground)
    ground.setAlpha(OPACITY)
    painter.setPen(QtCore.Qt.NoPen)
    painter.setBrush(ground)
    painter.drawRoundedRect(QtCore.QRectF(0, 0, size.width(), size.height()), pad, pad)
    y = pad

    def write(lines: Iterable[str], colour: Colour) -> None:
        nonlocal y
        painter.setPen(QtGui.QColor(colour))
        for text in lines:
            box = QtCore.QRectF(pad, y, inner + pad, line)
            painter.drawText(box, int(QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter), text)
            y += line

    write(title, look.text)
    write(above, look.faint)
    y += 0.4 * letter
    _bar(painter, spec, QtCore.QRectF(pad, y + (tip if spec.beyond[1] else 0), bar_width, bar), tip)
    top = y + (tip if spec.beyond[1] else 0)
    painter.setPen(QtGui.QColor(look.text))
    for share, text in placed(spec.labels, line / bar):
        box = QtCore.QRectF(
            pad + bar_width + gap, top + (1.0 - share) * bar - 0.5 * line, widest + pad, line
        )
        painter.drawText(box, int(QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter), text)
    y = top + bar + (tip if spec.beyond[0] else 0) + 0.4 * letter
    write(below, look.faint)
    write(warning, look.warning)
    painter.end()
    return image


def _bar(painter: Painter, spec: Spec, box: Rectangle, tip: float) -> None:
    """The colours, and an arrow at an end beyond which values have its colour."""
    painter.setPen(QtCore.Qt.NoPen)
    colours = [
        QtGui.QColor(int(c) >> 24 & 255, int(c) >> 16 & 255, int(c) >> 8 & 255)
        for c in spec.colours
    ]
    step = box.height() / len(colours)
    painter.setRenderHint(QtGui.QPainter.Antialiasing, False)
    for k, colour in enumerate(colours):
        # One over the next, from below: no seam between.
        top = box.bottom() - (k + 1) * step
        painter.fillRect(QtCore.QRectF(box.left(), top, box.width(), step + 1.0), colour)
    painter.setRenderHint(QtGui.QPainter.Antialiasing, True)
    ends = ((box.bottom(), tip, colours[0]), (box.top(), -tip, colours[-1]))
    for there, (end, way, colour) in zip(spec.beyond, ends):
        if there:
            painter.setBrush(colour)
            corners = ((box.left(), end), (box.right(), end), (box.center().x(), end + way))
            painter.drawPolygon(QtGui.QPolygonF([QtCore.QPointF(*c) for c in corners]))


def placed(labels: Mapping[float, str], apart: float) -> list[tuple[float, str]]:
    """[(height, text)] of the labels for which there is room; the first ones of the dict go first."""
    kept: list[tuple[float, str]] = []
    for height, text in labels.items():
        if all(abs(height - other) >= 0.85 * apart for other, _ in kept):
            kept.append((height, text))
    return kept


def wrapped(text: str, width: float, metrics: Any) -> list[str]:
    """The lines of a text that is broken between words where it is wider."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and metrics.boundingRect(longer).width() <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
