"""The cross-section's dock: plane or line, plot, export."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import FreeCAD
import FreeCADGui as Gui
import numpy as np

from ...engine import InputError
from ...inspection import section as sections, section_plot
from ...objects import section as objects
from ...objects.fields import field_of, forget_field
from ...objects.kinds import DocumentObject, Point
from ...objects.living import GONE
from ...objects.proxy import type_of
from ..charts.section_chart import SectionChart
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import length_text
from ..common.kinds import QtEvent, View3D, Widget
from ..common.messages import error_text
from ..common.save_dialog import file_to_write
from ..common.theme import warning_style
from ..common.transaction import commit
from .object_dock import ObjectDock
from ..widgets.steady import steady

STEPS = 1000  # of the slider
AXES = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
HEIGHT = 330  # pixels of the dock as it comes


class SectionDock(ObjectDock):
    """Shows a Section object."""

    NAME = "BeltGrinding_SectionDock"

    def __init__(self) -> None:
        super().__init__()
        self.quiet = False
        self.picks: list[Point] = []
        self.picking: list[tuple[View3D, Any]] = []  # views, and their callbacks
        self.opened = False  # an undo step of ours
        self.low, self.high = 0.0, 0.0  # of the surface along the plane's normal, mm
        body = QtGui.QWidget()
        layout = QtGui.QHBoxLayout(body)
        controls = QtGui.QWidget()
        controls.setMaximumWidth(260)
        self.controls = QtGui.QFormLayout(controls)
        self.controls.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(controls)
        self.chart = SectionChart()
        layout.addWidget(self.chart, 1)
        self.setWidget(body)
        self._add_controls()
        self.place(QtCore.Qt.BottomDockWidgetArea, HEIGHT)
        FreeCAD.addDocumentObserver(self)

    @staticmethod
    def title() -> str:
        return translate("BeltGrinding", "Cross-section")

    def _add_controls(self) -> None:
        self.kind = self._combo(
            "sectionKind",
            [translate("BeltGrinding", "across {}").format(name) for name in AXES]
            + [
                translate("BeltGrinding", "own plane"),
                translate("BeltGrinding", "between two points"),
            ],
            translate("BeltGrinding", "Own plane: Point and Normal in the property editor"),
        )
        self.kind.currentIndexChanged.connect(self._kind_chosen)
        self.controls.addRow(translate("BeltGrinding", "Cut"), self.kind)
        self.slider = steady(QtGui.QSlider(QtCore.Qt.Horizontal))
        self.slider.setObjectName("sectionSlider")
        self.slider.setRange(0, STEPS)
        self.slider.valueChanged.connect(self._slid)
        self.slider.sliderPressed.connect(self._open)
        self.slider.sliderReleased.connect(self._released)
        self.controls.addRow(self.slider)
        self.offset = steady(QtGui.QDoubleSpinBox())
        self.offset.setObjectName("sectionOffset")
        self.offset.setDecimals(3)
        self.offset.setSuffix(" mm")
        self.offset.setKeyboardTracking(False)
        self.offset.valueChanged.connect(self._offset_typed)
        self.controls.addRow(translate("BeltGrinding", "at"), self.offset)
        self.pick = QtGui.QPushButton(translate("BeltGrinding", "Pick two points"))
        self.pick.setObjectName("sectionPick")
        self.pick.setCheckable(True)
        self.pick.setToolTip(
            translate("BeltGrinding", "Click two points on the surface in the 3D view")
        )
        self.pick.toggled.connect(self._pick_toggled)
        self.controls.addRow(self.pick)
        self.mode = self._combo(
            "sectionMode",
            [translate("BeltGrinding", "unrolled"), translate("BeltGrinding", "true shape")],
            translate(
                "BeltGrinding",
                "Unrolled: heights over the arc length. True shape: the outline in the plane, "
                "heights enlarged",
            ),
        )
        self.mode.currentIndexChanged.connect(lambda _: self.refresh())
        self.controls.addRow(translate("BeltGrinding", "Plot"), self.mode)
        self.factor = steady(QtGui.QDoubleSpinBox())
        self.factor.setObjectName("sectionFactor")
        self.factor.setRange(0.0, 1e6)
        self.factor.setDecimals(1)
        self.factor.setSpecialValueText(translate("BeltGrinding", "automatic"))
        self.factor.setToolTip(translate("BeltGrinding", "How much the heights are enlarged"))
        self.factor.valueChanged.connect(lambda _: self.refresh())
        self.controls.addRow(translate("BeltGrinding", "Heights ×"), self.factor)
        self.figures = QtGui.QLabel()
        self.figures.setObjectName("sectionFigures")
        self.figures.setWordWrap(True)
        self.controls.addRow(self.figures)
        row = QtGui.QHBoxLayout()
        for suffix in ("CSV", "SVG"):
            button = QtGui.QPushButton(translate("BeltGrinding", "Export {}").format(suffix))
            button.clicked.connect(lambda *_, kind=suffix.lower(): self.export(kind))
            row.addWidget(button)
        self.controls.addRow(row)

    def _combo(self, name: str, texts: Iterable[str], tip: str) -> Widget:
        box = steady(QtGui.QComboBox())
        box.setObjectName(name)
        box.addItems(texts)
        box.setToolTip(tip)
        return box

    # What is shown

    def show_object(self, obj: DocumentObject) -> None:
        self._stop_picking()
        super().show_object(obj)

    def refresh(self) -> None:
        """Shows the object as it is now."""
        obj = self.obj = self.living()
        for widget in (self.kind, self.slider, self.offset, self.pick, self.mode, self.factor):
            widget.setEnabled(obj is not None)
        if obj is None:
            self.chart.show_plot(None, None)
            return self.figures.setText("")
        self.quiet = True
        try:
            self._show_plane(obj)
        finally:
            self.quiet = False
        shape = self.mode.currentIndex() == 1
        self.factor.setEnabled(shape)
        try:
            section = obj.Proxy.cut(obj)
            mode = section_plot.SHAPE if shape else section_plot.UNROLLED
            plot = section_plot.plot(section, mode, self.exaggeration())
        except InputError as error:
            self.chart.show_plot(None, None)
            return self._say(error_text(error), True)
        self.chart.show_plot(section, plot)
        self._say(self.figures_text(obj), False)

    def preferences_changed(self) -> None:
        """The unit of the figures is another one."""
        if self.isVisible():
            self.refresh()

    def exaggeration(self) -> float | None:
        """The factor of the heights, None: chosen by the plot."""
        shape = self.mode.currentIndex() == 1
        return self.factor.value() if shape and self.factor.value() > 0 else None

    def figures_text(self, obj: DocumentObject) -> str:
        """The section's figures in words."""
        text = translate(
            "BeltGrinding",
            "{:.2f} mm long, {:.1f} % in tolerance\ndeviation {} to {}, mean {}\n"
            "removed {} on the mean",
        ).format(
            obj.Length.Value,
            obj.InTolerance,
            *(length_text(v.Value, 1) for v in (obj.Minimum, obj.Maximum, obj.Mean)),
            length_text(obj.RemovedMean.Value, 1, ""),
        )
        if obj.OutOfDate:
            text += "\n" + translate("BeltGrinding", "Out of date: simulate again.")
        return text

    def _say(self, text: str, error: bool) -> None:
        self.figures.setText(text)
        self.figures.setStyleSheet(warning_style(error))

    def _show_plane(self, obj: DocumentObject) -> None:
        line = obj.Cut == objects.LINE
        normal = np.array(obj.Normal, dtype=float)
        length = np.linalg.norm(normal)
        names = [k for k, axis in enumerate(AXES.values()) if np.allclose(normal, axis)]
        self.kind.setCurrentIndex(4 if line else names[0] if names else 3)
        plane = bool(not line and length > 0)  # Qt takes no bool of numpy's
        self.slider.setEnabled(plane)
        self.offset.setEnabled(plane)
        field = field_of(obj.Simulation) if obj.Simulation is not None else None
        if not plane or field is None:
            return
        normal /= length
        along = field.points @ normal
        self.low, self.high = float(along.min()), float(along.max())
        value = float(normal @ np.array(obj.Point, dtype=float))
        self.offset.setRange(min(self.low, value), max(self.high, value))
        self.offset.setSingleStep(max((self.high - self.low) / 100.0, 1e-3))
        self.offset.setValue(value)
        share = (value - self.low) / max(self.high - self.low, 1e-9)
        self.slider.setValue(int(round(STEPS * min(max(share, 0.0), 1.0))))

    # What is changed

    def _open(self) -> None:
        """Opens an undo step, unless the document has one: an open panel's, which is not ours."""
        obj = self.living()
        if obj is not None and not obj.Document.HasPendingTransaction:
            obj.Document.openTransaction(translate("BeltGrinding", "Move cross-section"))
            self.opened = True

    def _released(self) -> None:
        obj = self.living()
        if obj is not None:
            obj.Document.recompute()
            self._commit(obj)

    def _commit(self, obj: DocumentObject) -> None:
        if self.opened and not self.slider.isSliderDown():
            commit(obj.Document)
            self.opened = False

    def change(self, **values: Any) -> None:
        """Sets properties of the object, as one undo step (a drag of the slider is one, too)."""
        obj = self.living()
        if self.quiet or obj is None:
            return
        self._open()
        self.quiet = True
        try:
            for name, value in values.items():
                setattr(obj, name, value)
            if self.slider.isSliderDown():
                obj.Proxy.update(obj)  # the rest of the document when it is let go
            else:
                obj.Document.recompute()
        finally:
            self.quiet = False
        self._commit(obj)
        self.refresh()

    def _kind_chosen(self, index: int) -> None:
        obj = self.living()
        if self.quiet or obj is None:
            return
        if index < 3:
            point, normal = obj.Point, list(AXES.values())[index]
            field = field_of(obj.Simulation)
            if field is not None:
                point = objects.middle_of_ground(field)
            self.change(Cut=objects.PLANE, Point=point, Normal=normal)
        elif index == 3:
            self.change(Cut=objects.PLANE)
        else:
            self.pick.setChecked(True)

    def _slid(self, step: int) -> None:
        if not self.quiet:
            self._move_to(self.low + (self.high - self.low) * step / STEPS)

    def _offset_typed(self, value: float) -> None:
        if not self.quiet:
            self._move_to(value)

    def _move_to(self, value: float) -> None:
        obj = self.living()
        if obj is None:
            return
        normal, point = (np.array(v, dtype=float) for v in (obj.Normal, obj.Point))
        normal /= np.linalg.norm(normal)
        self.change(Point=tuple((point + (value - normal @ point) * normal).tolist()))

    # Two points in the 3D view

    def _pick_toggled(self, on: bool) -> None:
        if not on:
            return self._stop_picking()
        self.picks = []
        obj = self.living()
        if obj is None:
            return
        document = Gui.getDocument(obj.Document.Name)
        for view in document.mdiViewsOfType("Gui::View3DInventor"):
            call = view.addEventCallback(
                "SoMouseButtonEvent", lambda event, view=view: self._clicked(view, event)
            )
            self.picking.append((view, call))
        self._say(translate("BeltGrinding", "Click the first point on the surface."), False)

    def _stop_picking(self) -> None:
        for view, call in self.picking:
            try:
                view.removeEventCallback("SoMouseButtonEvent", call)
            except GONE:
                pass  # the view is closed
        self.picking = []
        if self.pick.isChecked():
            self.pick.setChecked(False)

    def _clicked(self, view: View3D, event: QtEvent) -> None:
        if event["State"] != "DOWN" or event["Button"] != "BUTTON1":
            return
        x, y = event["Position"]
        found = view.getObjectInfo((int(x), int(y)))
        if found:
            self.add_pick((found["x"], found["y"], found["z"]))

    def add_pick(self, point: Point) -> None:
        """Takes a picked point (mm); the second one cuts."""
        self.picks.append(tuple(point))
        if len(self.picks) == 1:
            return self._say(translate("BeltGrinding", "Click the second point."), False)
        start, end = self.picks
        # Not inside the view's own event: its callbacks are removed by this.
        QtCore.QTimer.singleShot(0, self._stop_picking)
        self.change(Start=start, End=end, Cut=objects.LINE)

    # Files

    def export(self, kind: str) -> None:
        """Asks for a file and writes the section as "csv" or "svg"."""
        obj = self.living()
        if obj is None:
            return
        path = file_to_write(
            translate("BeltGrinding", "Export cross-section"),
            f"{obj.Label}.{kind}",
            f"{kind.upper()} (*.{kind})",
        )
        if not path:
            return
        try:
            section = obj.Proxy.cut(obj)
            if kind == "csv":
                sections.write_csv(section, path)
            else:
                shape = self.mode.currentIndex() == 1
                mode = section_plot.SHAPE if shape else section_plot.UNROLLED
                sections.write_svg(section, path, mode, self.exaggeration())
        except InputError as error:
            return self._say(error_text(error), True)
        self._say(translate("BeltGrinding", "Written: {}").format(path), False)

    # What FreeCAD tells

    def slotChangedObject(self, obj: DocumentObject, name: str) -> None:
        if self.quiet or self.obj is None or not self.isVisible():
            return
        if type_of(obj) == objects.Section.TYPE and obj == self.obj and name == "Shown":
            QtCore.QTimer.singleShot(0, self.refresh)
        elif name == "OutOfDate" and obj == self.obj:
            QtCore.QTimer.singleShot(0, self.refresh)

    def forget(self) -> None:
        self._stop_picking()
        self.obj = None
        forget_field()
        QtCore.QTimer.singleShot(0, self.refresh)

    def closeEvent(self, event: QtEvent) -> None:
        self._stop_picking()
        forget_field()
        super().closeEvent(event)
