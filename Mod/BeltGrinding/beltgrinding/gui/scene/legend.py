"""The legend of the deviation, laid over the 3D view: what it says, and where it stands.

An end of the bar is an arrow where values beyond it have its colour, or may have.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from pivy import coin

from ...engine import core
from ...objects import preferences, shown
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.kinds import Array
from ..common.theme import theme
from . import legend_picture
from .labels import pixels
from .legend_picture import Mark, Spec

BAR_STEPS = 240
LABEL_GAP = 0.07  # of half the bar: a line of text
# Whether values lie beyond the lower end and the upper one; true, too, where that is not known.
OPEN, NOT_OPEN = (True, True), (False, False)
BORDER = 0.008  # of the view's width
CUBE, CROSS = 0.28, 0.14  # of the view's height: FreeCAD's cube in a corner, its axes in another
BETTER = 0.02  # of the part's points that another place must hide less, for the legend to go there
SAME_PLACE = 8  # pixels between two clicks of a double click
KEPT = 6  # pictures: views of other sizes, and both themes


def of(picture: shown.Shown, name: str, out_of_date: bool = False) -> Spec:
    """The ``Spec`` of what a Deviation named ``name`` shows."""
    if not picture.known:
        found = _unknown(picture.mode, out_of_date)
    elif picture.mode == shown.UNCERTAINTY:
        found = uncertainty(picture.end, out_of_date)
    elif picture.mode == shown.CELL_ERROR:
        text = translate("BeltGrinding", "error of the cells, {}")
        found = uncertainty(picture.end, out_of_date, text)
    elif picture.mode == shown.TEMPERATURE:
        found = temperature(picture.start, picture.end - picture.start, out_of_date)
    elif picture.mode == shown.ROUGHNESS:
        found = roughness(picture.end, out_of_date)
    elif picture.mode in (shown.MEASURED, shown.DIFFERENCE):
        difference = picture.mode == shown.DIFFERENCE
        found = scan(*picture.scale, out_of_date, difference, picture.beyond)
    else:
        text = translate("BeltGrinding", "deviation, {}")
        found = _deviation(
            *(*picture.scale, out_of_date, picture.bands, picture.colours),
            *(text, picture.beyond, True),
        )
    return found._replace(name=name, beyond=picture.beyond)


def _unknown(mode: str, out_of_date: bool) -> Spec:
    """Of a result that has nothing of what a mode shows."""
    titles = {
        shown.UNCERTAINTY: translate("BeltGrinding", "uncertainty"),
        shown.MEASURED: translate("BeltGrinding", "scan"),
        shown.DIFFERENCE: translate("BeltGrinding", "scan - prediction"),
        shown.TEMPERATURE: translate("BeltGrinding", "greatest temperature"),
        shown.ROUGHNESS: translate("BeltGrinding", "roughness Ra"),
        shown.CELL_ERROR: translate("BeltGrinding", "error of the cells"),
    }
    reasons = {
        shown.UNCERTAINTY: translate("BeltGrinding", "not known: the law was not calibrated"),
        shown.MEASURED: translate("BeltGrinding", "no scan: compare one"),
        shown.DIFFERENCE: translate("BeltGrinding", "no scan: compare one"),
        shown.TEMPERATURE: translate("BeltGrinding", "not computed: the job is without heat"),
        shown.ROUGHNESS: translate(
            "BeltGrinding", "not known anywhere: the belt or its wear was not measured"
        ),
        shown.CELL_ERROR: translate(
            "BeltGrinding", "not known: simulate again; a rigid tool has none"
        ),
    }
    grey = int(core.colour_scale(-1.0, 1.0, 2.0, [np.nan])[0])
    marks = (Mark(grey, reasons[mode]),)
    return Spec([], {}, titles[mode], ("", ""), NOT_OPEN, _warning(out_of_date), "", marks)


def scan(
    lower: float,
    upper: float,
    limit: float,
    out_of_date: bool = False,
    difference: bool = False,
    beyond: tuple[bool, bool] = OPEN,
) -> Spec:
    """The ``Spec`` of a scan's heights, or of their difference from the prediction; always in the
    standard colours without steps.
    """
    if difference:
        text = translate("BeltGrinding", "scan - prediction, {}")
    else:
        text = translate("BeltGrinding", "scan, {}")
    return _deviation(lower, upper, limit, out_of_date, 0, None, text, beyond, not difference)


def deviation(
    lower: float,
    upper: float,
    limit: float,
    out_of_date: bool = False,
    bands: int = 0,
    beyond: tuple[bool, bool] = OPEN,
    standard: bool = False,
) -> Spec:
    """The ``Spec`` of the deviation: (mm) tolerance band, and where the ramps end; ``bands``: steps of
    each ramp; ``beyond``: as OPEN; ``standard``: without the preferences' colours.
    """
    text = translate("BeltGrinding", "deviation, {}")
    chosen = None if standard else preferences.colours()
    return _deviation(lower, upper, limit, out_of_date, bands, chosen, text, beyond, True)


def _deviation(
    lower: float,
    upper: float,
    limit: float,
    out_of_date: bool,
    bands: int,
    choice: Any,
    text: str,
    beyond: tuple[bool, bool],
    judged: bool,
) -> Spec:
    values = [-limit + 2 * limit * (k + 0.5) / BAR_STEPS for k in range(BAR_STEPS)]
    unit = preferences.deviation_unit()
    labels = {
        _height(value, limit): figure(value / unit.size, f"+.{unit.decimals}f")
        for value in label_values(lower, upper, limit, bands)
    }
    colours = core.colour_scale(lower, upper, limit, values, bands, choice)
    words = ("", "")
    if judged:
        good = translate("BeltGrinding", "good")
        at = _height(0.5 * (lower + upper), limit)
        nearest = min(labels, key=lambda height: abs(height - at))
        if abs(nearest - at) > 0.5 * LABEL_GAP:
            labels[at] = good
        else:  # no room for a line between
            labels[nearest] += " " + good
        words = (
            translate("BeltGrinding", "cut too deep"),
            translate("BeltGrinding", "too much left"),
        )
    return Spec(
        colours.tolist(),
        labels,
        text.format(unit.symbol),
        words,
        beyond,
        _warning(out_of_date),
    )


def _warning(out_of_date: bool) -> str:
    return translate("BeltGrinding", "out of date: simulate again") if out_of_date else ""


def _height(value: float, limit: float) -> float:
    return (value + limit) / (2 * limit)


def label_values(lower: float, upper: float, limit: float, bands: int = 0) -> list[float]:
    """The deviations (mm) that are written: ends, limits, and borders of the bands or halves; none
    so near to another that they would overlap.
    """
    between = [-0.5 * limit, 0.5 * limit]
    if bands:
        steps = [k / bands for k in range(1, bands)]
        between = [upper + t * (limit - upper) for t in steps]
        between += [lower - t * (limit + lower) for t in steps]
    values: list[float] = []
    for value in (-limit, limit, lower, upper, *between):
        if all(abs(value - other) > LABEL_GAP * limit for other in values):
            values.append(value)
    return values


def uncertainty(limit: float, out_of_date: bool = False, text: str = "") -> Spec:
    """The ``Spec`` of the deviation's standard deviation, up to ``limit`` mm, or of what else ``text``, with {} for
    the unit, tells."""
    colours = core.uncertainty_scale(
        limit, [limit * (k + 0.5) / BAR_STEPS for k in range(BAR_STEPS)]
    )
    unit = preferences.deviation_unit()
    labels = {k / 4: figure(limit * k / 4 / unit.size, ".3g") for k in range(5)}
    text = (text or translate("BeltGrinding", "uncertainty, {}")).format(unit.symbol)
    return Spec(colours.tolist(), labels, text, ("", ""), (False, True), _warning(out_of_date))


def temperature(start: float, span: float, out_of_date: bool = False) -> Spec:
    """The ``Spec`` of the greatest temperature, from ``start`` degrees C to ``span`` K above."""
    colours = core.uncertainty_scale(span, [span * (k + 0.5) / BAR_STEPS for k in range(BAR_STEPS)])
    labels = {k / 4: figure(start + span * k / 4, ".0f") for k in range(5)}
    text = translate("BeltGrinding", "greatest temperature, °C")
    return Spec(colours.tolist(), labels, text, ("", ""), (False, False), _warning(out_of_date))


def roughness(span: float, out_of_date: bool = False) -> Spec:
    """The ``Spec`` of Ra, up to ``span`` µm."""
    colours = core.uncertainty_scale(span, [span * (k + 0.5) / BAR_STEPS for k in range(BAR_STEPS)])
    labels = {k / 4: figure(span * k / 4, ".2g") for k in range(5)}
    text = translate("BeltGrinding", "roughness Ra, µm")
    return Spec(colours.tolist(), labels, text, ("", ""), (False, False), _warning(out_of_date))


class Legend:
    """A legend over the 3D views: ``node`` goes into a scene, where it is not picked and not counted by
    fitAll. It takes a twelfth of a view's width and stands where it hides least of the part. ``chosen()`` follows a
    double click on it.
    """

    def __init__(self) -> None:
        self.spec: Spec | None = None
        self.points: Array = np.zeros((0, 3))
        self.beside: list[Legend] = []  # that stand between it and the view's side
        self.places: dict[tuple[float, float], int] = {}  # by a view's size: where it stood last
        # By a view's size and whether the theme is dark: size and bytes.
        self.pictures: dict[tuple[int, int, bool], tuple[tuple[int, int], bytes]] = {}
        self.drawn: tuple[int, int, bool] | None = None  # key of the picture that the image holds
        self.box: tuple[int, ...] | None = None  # left, bottom, right, top in pixels, as drawn last
        # The same by a view's size, of what is drawn there; the last click on it: when, and where.
        self.boxes: dict[tuple[int, int], tuple[int, ...]] = {}
        self.click: tuple[float, tuple[int, int]] = (0.0, (0, 0))
        self.chosen: Callable[[], object] = lambda: None  # called after a double click on it
        self.node = coin.SoType.fromName("SoSkipBoundingGroup").createInstance()
        self.node = self.node or coin.SoSeparator()
        self.node.ref()  # pivy holds none of what createInstance made: taken out of a scene, it would be gone
        watch = coin.SoCallback()
        watch.setCallback(self._watch, None)
        annotation = coin.SoAnnotation()
        annotation.renderCaching = coin.SoSeparator.OFF
        style = coin.SoPickStyle()
        style.style = coin.SoPickStyle.UNPICKABLE
        self.shift, self.image = coin.SoTranslation(), coin.SoImage()
        # No camera of its own: after one, a pick's ray would go on from there.
        for node in (style, self.shift, self.image):
            annotation.addChild(node)
        # Looked at while views of several sizes are drawn: a change must not ask for another drawing.
        for node in (annotation, self.shift, self.image):
            node.enableNotify(False)
        clicks = coin.SoEventCallback()
        clicks.addEventCallback(coin.SoMouseButtonEvent.getClassTypeId(), self._clicked)
        self.node.addChild(clicks)
        self.node.addChild(watch)
        self.node.addChild(annotation)

    @property
    def column(self) -> int:
        """How many others stand beside it."""
        return len(self.beside)

    def show(self, spec: Spec | None) -> None:
        """Shows a ``Spec``."""
        if spec != self.spec:
            self.spec = spec
            self.pictures.clear()
            self.drawn = None
            self.node.touch()

    def avoid(self, points: Array) -> None:
        """Points (n, 3) of the part, mm, that it should not hide."""
        self.points = np.asarray(points, dtype=float).reshape(-1, 3)

    def _watch(self, _: object, action: Any) -> None:
        if self.spec is None or not action.isOfType(coin.SoGLRenderAction.getClassTypeId()):
            return
        state = action.getState()
        width, height = coin.SoViewportRegionElement.get(state).getViewportSizePixels().getValue()
        seen = self._seen(state, width, height)
        key = width, height, theme().dark
        size, data = self._picture(key)
        if self.drawn != key:
            self.image.image.setValue(coin.SbVec2s(*size), 4 if data else 0, data)
            self.drawn = key
        left, bottom = self._place(seen, size, width, height)
        self.box = left, bottom, left + size[0], bottom + size[1]
        self.boxes[(width, height)] = self.box
        volume = coin.SoViewVolumeElement.get(state)
        depth = volume.getNearDist() + 0.5 * volume.getDepth()
        # Coin cuts what it projects back to whole pixels: on a border, rounding would say which.
        corner = coin.SbVec2f((left + 0.25) / width, (bottom + 0.25) / height)
        at = volume.getPlanePoint(depth, corner)
        model = coin.SoModelMatrixElement.get(state)
        self.shift.translation = model.inverse().multVecMatrix(at)

    def _clicked(self, _: object, node: Any) -> None:
        """A click into a view: the second of two on the legend chooses it. Coin tells no double clicks."""
        event, action = node.getEvent(), node.getAction()
        if not coin.SoMouseButtonEvent.isButtonPressEvent(event, coin.SoMouseButtonEvent.BUTTON1):
            return
        width, height = action.getViewportRegion().getViewportSizePixels().getValue()
        box = self.boxes.get((width, height))
        x, y = event.getPosition().getValue()
        if self.spec is None or box is None:
            return
        if not (box[0] <= x <= box[2] and box[1] <= y <= box[3]):
            return
        (before, (x0, y0)), now = self.click, time.monotonic()
        self.click = now, (x, y)
        soon = now - before < QtGui.QApplication.doubleClickInterval() / 1000.0
        if soon and abs(x - x0) + abs(y - y0) < SAME_PLACE:
            self.click = 0.0, (x, y)
            QtCore.QTimer.singleShot(0, self.chosen)  # the view is at it

    def _picture(self, key: tuple[int, int, bool]) -> tuple[tuple[int, int], bytes]:
        if key not in self.pictures:
            while len(self.pictures) >= KEPT:
                self.pictures.pop(next(iter(self.pictures)))
            drawn = legend_picture.draw(self.spec, *key[:2]) if self.spec else None
            self.pictures[key] = pixels(drawn)
        return self.pictures[key]

    def _seen(self, state: Any, width: float, height: float) -> Array:
        """(n, 2) pixels at which the part's points are drawn."""
        if not len(self.points):
            return np.zeros((0, 2))
        volume = coin.SoViewVolumeElement.get(state).getMatrix()
        model = coin.SoModelMatrixElement.get(state)
        matrix = np.array(model.getValue()).reshape(4, 4)
        matrix = matrix @ np.array(volume.getValue()).reshape(4, 4)
        clip = np.hstack([self.points, np.ones((len(self.points), 1))]) @ matrix
        inside = clip[:, 3] > 1e-9
        shares = 0.5 * (clip[inside, :2] / clip[inside, 3:] + 1.0)
        return shares * (width, height)

    def _place(
        self, seen: Array, size: Sequence[float], width: float, height: float
    ) -> tuple[int, ...]:
        """(left, bottom) in pixels: at a side, or in a corner that FreeCAD leaves free."""
        border = round(BORDER * width)
        low, high = CROSS * height, (1.0 - CUBE) * height - size[1]
        level = 0.5 * (height - size[1])
        key = int(width), int(height), theme().dark
        shift = sum(other._picture(key)[0][0] + border for other in self.beside)
        left, right = border + shift, width - border - size[0] - shift
        aside = min(max(level, low), max(high, border))  # below the cube, above the axes
        choices = [(left, level), (right, aside), (left, border), (left, height - size[1] - border)]
        hidden = [_share(seen, (x, y, x + size[0], y + size[1])) for x, y in choices]
        best = int(np.argmin(hidden))
        before = self.places.get((width, height), 0)
        if hidden[best] > hidden[before] - BETTER:
            best = before
        self.places[(width, height)] = best
        return tuple(round(x) for x in choices[best])


def _share(points: Array, box: Sequence[float]) -> float:
    """The share of points (n, 2) in a box (left, bottom, right, top)."""
    if not len(points):
        return 0.0
    inside = (points > box[:2]).all(axis=1) & (points < box[2:]).all(axis=1)
    return float(inside.mean())
