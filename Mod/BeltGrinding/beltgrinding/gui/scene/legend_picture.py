"""The picture of a legend: a colour bar with numbers and words, drawn by Qt at a view's size."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from ..common.compat import QtCore, QtGui
from ..common.kinds import Colour, Image, Painter, Rectangle, Rgb
from ..common.theme import theme

SHARE = 12  # of the view's width that it takes: a twelfth
LIST_SHARE = 6  # that one of marks alone takes, whose texts are longer
LETTER = 8.4  # widths of the panel in heights of its letters, on the mean
LEAST, MOST_SHARE = 9.5, 1.0 / 30.0  # pixels; of the view's height: a letter
TALL = 0.55  # of the view's height: the bar
TALLEST = 0.94  # all
WIDER = 1.4  # than the least, where the title needs it
LINE = 1.35  # from line to line, in letters
OPACITY = 215  # of 255: the ground


class Mark(NamedTuple):
    """A colour that means one thing. ``line``: a stroke, not an area."""

    colour: int  # 0xRRGGBBAA
    text: str
    line: bool = False


class Spec(NamedTuple):
    """What a legend says. ``labels``: by height (0 to 1) along the bar, the important ones first."""

    colours: list[int]  # 0xRRGGBBAA from the bar's lower end; none: without a bar
    labels: dict[float, str]
    title: str
    words: tuple[str, str]  # below the bar and above it; "" for none
    beyond: tuple[bool, bool]  # bool: whether values lie beyond the lower end and the upper one
    warning: str
    name: str = ""  # what is shown so: the object's, and its job's where there are others
    marks: tuple[Mark, ...] = ()


def packed(colour: Rgb) -> int:
    """0xRRGGBBAA of (red, green, blue) in [0, 1]."""
    red, green, blue = (round(255 * part) for part in colour)
    return red << 24 | green << 16 | blue << 8 | 255


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
    widest = max([0.0, *(metrics.boundingRect(text).width() for text in spec.labels.values())])
    share = SHARE if spec.colours else LIST_SHARE
    inner = max(bar_width + gap + widest if spec.colours else 0.0, width / share - 2 * pad)
    whole = metrics.boundingRect(spec.title).width() + 1
    if whole <= WIDER * inner:  # a quantity and its unit on one line
        inner = max(inner, whole)
    bold = QtGui.QFont(font)
    bold.setBold(True)
    broad = QtGui.QFontMetricsF(bold)
    name = wrapped(spec.name, inner, broad)
    title = wrapped(spec.title, inner, metrics)
    above, below = (wrapped(word, inner, metrics) for word in reversed(spec.words))
    warning = wrapped(spec.warning, inner, metrics)
    texts = [*title, *above, *below, *warning]
    beside = bar_width + gap  # where a mark's text begins
    marks = [(mark, wrapped(mark.text, inner - beside, metrics)) for mark in spec.marks]
    marked = [text for _, lines in marks for text in lines]
    inner = max(
        [
            inner,
            *(metrics.boundingRect(text).width() + 1 for text in texts),
            *(broad.boundingRect(text).width() + 1 for text in name),
            *(beside + metrics.boundingRect(text).width() + 1 for text in marked),
        ]
    )
    line, tip = LINE * letter, 0.9 * letter
    fixed = 2 * pad + line * (len(texts) + len(name) + len(marked))
    if spec.colours:
        fixed += tip * sum(spec.beyond) + 0.8 * letter + 0.5 * line
    bar = min(TALL * height, TALLEST * height - fixed) if spec.colours else 0.0
    if (spec.colours and bar < 4 * letter) or fixed > height:
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

    painter.setFont(bold)
    write(name, look.text)
    painter.setFont(font)
    write(title, look.text)
    write(above, look.faint)
    if spec.colours:
        y += 0.4 * letter
        top = y + (tip if spec.beyond[1] else 0)
        _bar(painter, spec, QtCore.QRectF(pad, top, bar_width, bar), tip)
        painter.setPen(QtGui.QColor(look.text))
        for at, text in placed(spec.labels, line / bar):
            box = QtCore.QRectF(
                pad + bar_width + gap, top + (1.0 - at) * bar - 0.5 * line, widest + pad, line
            )
            painter.drawText(box, int(QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter), text)
        y = top + bar + (tip if spec.beyond[0] else 0) + 0.4 * letter
    write(below, look.faint)
    for mark, lines in marks:
        _mark(painter, mark, QtCore.QRectF(pad, y, bar_width, line))
        painter.setPen(QtGui.QColor(look.text))
        for text in lines:
            box = QtCore.QRectF(pad + beside, y, inner + pad - beside, line)
            painter.drawText(box, int(QtCore.Qt.AlignLeft | QtCore.Qt.AlignVCenter), text)
            y += line
    write(warning, look.warning)
    painter.end()
    return image


def _mark(painter: Painter, mark: Mark, box: Rectangle) -> None:
    """A mark's colour: a square, or a line."""
    high = 0.12 if mark.line else 0.6  # of the line of text
    place = QtCore.QRectF(
        box.left(), box.center().y() - 0.5 * high * box.height(), box.width(), high * box.height()
    )
    painter.fillRect(place, _opaque(mark.colour))


def _opaque(packed: int) -> Colour:
    """The QColor of 0xRRGGBBAA."""
    packed = int(packed)
    return QtGui.QColor(packed >> 24 & 255, packed >> 16 & 255, packed >> 8 & 255)


def _bar(painter: Painter, spec: Spec, box: Rectangle, tip: float) -> None:
    """The colours, and an arrow at an end beyond which values have its colour."""
    painter.setPen(QtCore.Qt.NoPen)
    colours = [_opaque(c) for c in spec.colours]
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
