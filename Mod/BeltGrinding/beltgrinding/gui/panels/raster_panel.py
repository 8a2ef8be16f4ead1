"""Task panel of a raster path; the passes in the 3D view follow every change."""

from __future__ import annotations

from collections.abc import Callable

import FreeCAD
import FreeCADGui as Gui

from ...engine import Cancelled, InputError
from ...objects import raster_path, stored_facts
from ...objects.kinds import DocumentObject
from ...objects.raster_path import NO_PASS, NO_ROOM
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.kinds import Changed, Widget
from ..common.messages import error_text
from ..common.report_language import language
from ..scene.left_out import COLOURS
from ..widgets.active_programs import active_box
from ..widgets.form import Form
from ..widgets.further_passes import FurtherPasses
from .panel import Panel

WAIT = 300  # ms after the last change
SHOWN_WARNINGS = 20


class RasterPanel(Panel):
    """Edits a RasterPath."""

    def __init__(self, obj: DocumentObject) -> None:
        title = translate("BeltGrinding", "Raster path")
        super().__init__(obj, title, "BeltGrinding_RasterPath")
        self.timer = QtCore.QTimer()
        self.timer.setSingleShot(True)
        self.timer.timeout.connect(self.compute)
        self.left = QtGui.QLabel()
        self.left.setObjectName("rasterLeft")
        self.left.setWordWrap(True)
        self.left.hide()
        self.body.addWidget(self.left)
        self.add_fold("foldFaces", "GrindFaces", self._faces())
        region = self._region()
        self.add_fold("foldRegion", "Zones", region, not obj.RegionPoints, self.region.text)
        self.further = FurtherPasses(obj, self.changed)
        self.body.addWidget(self.further)
        self.passes = self._passes()
        self.add_fold("foldPasses", "RasterPath", self.passes)
        self.process = self._process()
        self.add_fold("foldProcess", "Force", self.process)
        self.posing = self._posing()
        text = self.posing.rows["WhereItCollides"][1].currentText
        self.add_fold("foldPoses", "Cell", self.posing, True, text)
        self.body.addWidget(active_box(obj, translate("BeltGrinding", "Active in runs")))
        self.warnings = QtGui.QListWidget()
        self.warnings.setObjectName("rasterWarnings")
        self.warnings.setWordWrap(True)
        self.warnings.setMaximumHeight(100)
        self.body.addWidget(self.warnings)
        self.finish()
        self.arrange()
        self.compute()

    def _faces(self) -> Widget:
        box = QtGui.QGroupBox(translate("BeltGrinding", "Faces"))
        row = QtGui.QHBoxLayout(box)
        self.faces = QtGui.QLabel()
        self.faces.setObjectName("rasterFaces")
        self.faces.setWordWrap(True)
        row.addWidget(self.faces, 1)
        button = QtGui.QPushButton(translate("BeltGrinding", "Take selected"))
        button.setObjectName("takeFaces")
        button.clicked.connect(self.take_selected)
        row.addWidget(button)
        self.name_faces()
        return box

    def _region(self) -> Widget:
        box = QtGui.QGroupBox(translate("BeltGrinding", "Region"))
        rows = QtGui.QVBoxLayout(box)
        self.region = QtGui.QLabel()
        self.region.setObjectName("rasterRegion")
        self.region.setWordWrap(True)
        rows.addWidget(self.region)
        for name, text, clicked in (
            ("regionLeft", translate("BeltGrinding", "Only what is left"), self.take_left),
            (
                "regionOthers",
                translate("BeltGrinding", "Only what other passes leave"),
                self.take_others,
            ),
            ("regionAll", translate("BeltGrinding", "Everywhere"), self.take_all),
        ):
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.clicked.connect(clicked)
            rows.addWidget(button)
        self.name_region()
        return box

    def name_region(self) -> None:
        """Shows where passes are wanted."""
        points = self.obj.RegionPoints
        text = translate("BeltGrinding", "everywhere on the faces")
        if points:
            size = FreeCAD.BoundBox()
            for point in points:
                size.add(point)
            text = translate("BeltGrinding", "near {} points within {:.0f} mm").format(
                len(points), size.DiagonalLength
            )
        self.region.setText(text)

    def take_left(self) -> None:
        """Lays passes only where the last result is above the tolerance."""
        self._take(raster_path.to_what_is_left)

    def take_others(self) -> None:
        """Lays passes only where other wheels do not get to."""
        self._take(raster_path.to_what_others_leave)

    def _take(self, region: Callable[[DocumentObject], object]) -> None:
        try:
            region(self.obj)
        except InputError as error:
            self.tell(error_text(error), True)
            return
        self.name_region()
        self.changed()

    def take_all(self) -> None:
        """Lays passes everywhere again."""
        raster_path.set_region(self.obj, [])
        self.name_region()
        self.changed()

    def _passes(self) -> Form:
        form = Form(self.obj, translate("BeltGrinding", "Passes"))
        along = {
            "u": translate("BeltGrinding", "u of each face"),
            "v": translate("BeltGrinding", "v of each face"),
            "direction": translate("BeltGrinding", "A direction"),
            "rings": translate("BeltGrinding", "Round the faces"),
            "auto": translate("BeltGrinding", "Find the best way"),
        }
        spacing = {
            "lines": translate("BeltGrinding", "Lines of the surface"),
            "even": translate("BeltGrinding", "Even on the surface"),
        }
        order = {
            "zigzag": translate("BeltGrinding", "Zigzag"),
            "one_way": translate("BeltGrinding", "One way"),
            "helix": translate("BeltGrinding", "Helix"),
        }
        form.add("Along", translate("BeltGrinding", "Along"), along)
        self.direction = DirectionField(self.obj, self.changed, self.tell)
        label = QtGui.QLabel(translate("BeltGrinding", "Direction"))
        form.layout_.addRow(label, self.direction)
        form.rows["Direction"] = (label, self.direction)
        form.add("PassSpacing", translate("BeltGrinding", "Spacing"), spacing)
        form.add("StepOver", translate("BeltGrinding", "Step-over (0: by contact)"))
        form.add("StepOverShare", translate("BeltGrinding", "Share of contact width"))
        footprints = {
            "solved": translate("BeltGrinding", "Solved along the passes"),
            "cylinder": translate("BeltGrinding", "On a cylinder"),
        }
        form.add("Footprint", translate("BeltGrinding", "Contact width"), footprints)
        form.add("Order", translate("BeltGrinding", "Order"), order)
        form.add("Repeats", translate("BeltGrinding", "Run through, times"))
        form.add("RunOut", translate("BeltGrinding", "Run-out at borders"))
        form.add("Bridge", translate("BeltGrinding", "Bridge gaps up to"))
        form.changed = self.changed
        return form

    def _process(self) -> Form:
        form = Form(self.obj, translate("BeltGrinding", "Process"))
        ways = {
            "plunge": translate("BeltGrinding", "Along the normal"),
            "arc": translate("BeltGrinding", "Tangential arc"),
        }
        entries = {
            "run_on": translate("BeltGrinding", "From outside, force grows"),
            "inside": translate("BeltGrinding", "On the border, force grows"),
            "direct": translate("BeltGrinding", "Full force at once"),
        }
        form.add("Feed", translate("BeltGrinding", "Feed"))
        form.add("Force", translate("BeltGrinding", "Force (0: machine's)"))
        form.add("Entry", translate("BeltGrinding", "Entry and exit"), entries)
        form.add("Lead", translate("BeltGrinding", "Outside by (0: by contact)"))
        form.add("Ramp", translate("BeltGrinding", "Force grows over (0: by contact)"))
        form.add("TouchForceShare", translate("BeltGrinding", "Share of force at touch"))
        form.add("EntryFeed", translate("BeltGrinding", "Entry feed (0: feed)"))
        form.add("Approach", translate("BeltGrinding", "Approach"), ways)
        form.add("ApproachLength", translate("BeltGrinding", "Approach length"))
        form.add("ApproachFeed", translate("BeltGrinding", "Approach feed"))
        form.add("Clearance", translate("BeltGrinding", "Clearance"))
        form.changed = self.changed
        return form

    def _posing(self) -> Form:
        form = Form(self.obj, translate("BeltGrinding", "Poses"))
        collisions = {
            "tilt": translate("BeltGrinding", "Tilt, else leave out"),
            "leave_out": translate("BeltGrinding", "Leave out"),
            "warn": translate("BeltGrinding", "Only warn"),
        }
        form.add("WhereItCollides", translate("BeltGrinding", "Wheel in the part"), collisions)
        form.add("MaxTilt", translate("BeltGrinding", "Tilt at most"))
        form.add("FitLimit", translate("BeltGrinding", "Rim in the part at most"))
        form.add("BeltAngle", translate("BeltGrinding", "Belt against pass"))
        form.add("Smoothing", translate("BeltGrinding", "Smooth normals over"))
        form.add("ChordError", translate("BeltGrinding", "Chord error"))
        form.add("MaxDistance", translate("BeltGrinding", "Distance at most"))
        form.add("MaxTurn", translate("BeltGrinding", "Turn at most"))
        form.add("TurnRate", translate("BeltGrinding", "Turn per mm at most (degrees)"))
        form.changed = self.changed
        return form

    def name_faces(self) -> None:
        """Shows which faces the passes lie on."""
        everything = translate("BeltGrinding", "all faces")
        texts = [
            f"{obj.Label}: {', '.join(s for s in subs if s) or everything}"
            for obj, subs in self.obj.Faces
        ]
        self.faces.setText("\n".join(texts))

    def take_selected(self) -> None:
        """Lays the passes on the faces that are selected in the 3D view."""
        links = []
        for one in Gui.Selection.getSelectionEx(self.document.Name):
            names = [s for s in one.SubElementNames if s.startswith("Face")]
            if hasattr(one.Object, "Shape") and names:
                links.append((one.Object, tuple(names)))
        if not links:
            self.tell(translate("BeltGrinding", "Select faces in the 3D view first."), True)
            return
        self.obj.Faces = links
        self.name_faces()
        self.changed()

    def arrange(self) -> None:
        """Shows the fields that the choices use."""
        hidden = set()
        if self.obj.Along != "direction":
            hidden.add("Direction")
        if self.obj.StepOver.Value > 0:
            hidden |= {"StepOverShare", "Footprint"}
        self.passes.show_rows(set(self.passes.rows) - hidden)
        unused: dict[str, set[str]] = {
            "run_on": set(),
            "inside": {"Lead"},
            "direct": {"Lead", "Ramp", "TouchForceShare", "EntryFeed"},
        }
        self.process.show_rows(set(self.process.rows) - unused[self.obj.Entry])
        tilts = self.obj.WhereItCollides == "tilt"
        self.posing.show_rows(set(self.posing.rows) - (set() if tilts else {"MaxTilt"}))

    def changed(self) -> None:
        self.arrange()
        self.timer.start(WAIT)

    def compute(self) -> None:
        """Lays the passes and shows what came out."""
        self.timer.stop()
        way = self.obj.Along
        try:
            raster_path.generate(self.obj)
        except InputError as error:
            self.tell(error_text(error), True)
            return
        except Cancelled:  # without a comparison
            self.obj.Along = "u"
            self.passes.refresh("Along")
            self.changed()
            return
        obj = self.obj
        if way == "auto":
            self.passes.refresh("Along")
            self.direction.refresh()
            self.arrange()
        obj.recompute()
        text = translate(
            "BeltGrinding", "{} passes {:.2f} mm apart, {:.0f} mm; {} poses, {:.1f} s"
        ).format(
            obj.PassCount,
            obj.StepOverUsed.Value,
            obj.GroundLength.Value,
            obj.PoseCount,
            obj.Duration,
        )
        if obj.ContactWidth.Value > 0:
            width = translate("BeltGrinding", "Contact across the pass: {:.1f} mm")
            text += "\n" + width.format(obj.ContactWidth.Value)
        text += "\n" + translate(
            "BeltGrinding", "Turn in contact: {:.1f}\u00b0 from pose to pose, {:.1f}\u00b0 per mm"
        ).format(obj.LargestTurn.getValueAs("deg").Value, obj.FastestTurn)
        if obj.PlungeShare >= 0.0:
            share = translate("BeltGrinding", "Removed while plunging: {:.1f} %")
            text += "\n" + share.format(obj.PlungeShare)
        self.tell(text)
        self._tell_left()
        self.warnings.clear()
        self.warnings.addItems(stored_facts.sentences(obj, "Warnings", language(), SHOWN_WARNINGS))
        self.warnings.setVisible(bool(obj.Warnings))

    def _tell_left(self) -> None:
        """What the passes leave out, in the colours that it has on the part."""
        words = (
            (NO_ROOM, self.obj.LeftOut, translate("BeltGrinding", "without room")),
            (NO_PASS, self.obj.NoPass, translate("BeltGrinding", "without a pass")),
        )
        lines = []
        for state, share, text in words:
            if share > 0.0:
                colour = QtGui.QColor.fromRgbF(*COLOURS[state]).name()
                lines.append(
                    f'<span style="color:{colour}">\u25a0</span> {figure(share, ".1f")} % {text}'
                )
        self.left.setText("<br>".join(lines))
        self.left.setVisible(bool(lines))

    def check(self) -> None:
        self.timer.stop()
        raster_path.generate(self.obj)
        self.obj.Proposed = False

    def close(self) -> None:
        self.timer.stop()


class DirectionField(QtGui.QWidget):
    """x, y, z of the property Direction; a selected straight edge can give them."""

    def __init__(self, obj: DocumentObject, changed: Changed, tell: Callable[..., object]) -> None:
        super().__init__()
        self.obj, self.changed, self.tell = obj, changed, tell
        grid = QtGui.QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        self.fields = []
        for k, name in enumerate("xyz"):
            line = QtGui.QLineEdit(f"{obj.Direction[k]:g}")
            line.setObjectName(f"Direction_{name}")
            line.setToolTip(f"{name}: {obj.getDocumentationOfProperty('Direction')}")
            validator = QtGui.QDoubleValidator(-1e9, 1e9, 9, line)
            validator.setLocale(QtCore.QLocale.c())
            line.setValidator(validator)
            line.setMinimumWidth(30)
            line.textChanged.connect(self._typed)
            grid.addWidget(line, 0, k)
            self.fields.append(line)
        button = QtGui.QPushButton(translate("BeltGrinding", "From selected edge"))
        button.setObjectName("takeEdge")
        button.clicked.connect(self.take_edge)
        grid.addWidget(button, 1, 0, 1, 3)

    def _typed(self, *_: object) -> None:
        if all(line.hasAcceptableInput() for line in self.fields):
            self.obj.Direction = tuple(float(line.text()) for line in self.fields)
            self.changed()

    def refresh(self) -> None:
        """Shows the property as it is."""
        for line, value in zip(self.fields, self.obj.Direction):
            line.blockSignals(True)
            line.setText(f"{value:g}")
            line.blockSignals(False)

    def take_edge(self) -> None:
        """The direction from end to end of the edge that is selected."""
        for one in Gui.Selection.getSelectionEx(self.obj.Document.Name):
            for name, sub in zip(one.SubElementNames, one.SubObjects):
                if name.startswith("Edge") and len(sub.Vertexes) == 2:
                    placement = one.Object.getGlobalPlacement()
                    local = one.Object.Placement.inverse()
                    ends = [placement * (local * vertex.Point) for vertex in sub.Vertexes]
                    way = (ends[1] - ends[0]).normalize()
                    for line, value in zip(self.fields, way):
                        line.setText(f"{value + 0.0:.6g}")
                    return
        self.tell(translate("BeltGrinding", "Select an edge in the 3D view first."), True)
