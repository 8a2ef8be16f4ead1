"""The verdict's dock: pass or fail, faces and zones, clusters, and the motions that did it."""

from __future__ import annotations

from typing import Any

import FreeCAD
import FreeCADGui as Gui
import numpy as np

from ...base.kinds import known
from ...engine import InputError
from ...objects import api, ground_by, raster_path, robot_path, verdict as objects
from ...objects.belt_machine import half_size
from ...objects.job_data import face_name
from ...objects.kinds import DocumentObject, Field
from ...objects.fields import forget_field
from ..common.editing import edit_in_step
from ..common.compat import QtCore, QtGui, translate
from ..common.event_texts import errors
from ..common.kinds import Array, Json, QtEvent, Widget
from ..common.theme import warning_style
from ..common.verdict_words import headline
from ..scene.cell_view import CellView
from ..scene.sight import Sight
from ..scene.verdict_scene import VerdictScene
from ..widgets.pose_walk import PoseTable
from .object_dock import ObjectDock
from .verdict_tables import (
    cluster_rows,
    doubts,
    fill,
    motion_rows,
    region_rows,
    section_rows,
    table,
)

WIDTH = 470  # pixels of the dock as it comes
SHARES = [150, 150, 230, 120, 160]  # pixels of its parts, one below the other
MOST_POINTS = 2000  # of a region that passes are laid on
AROUND = 1.5  # times a cluster's length that the camera sees
LEAST_SEEN = 10.0  # mm
WHEELS = 3.2  # radii of the wheel that are seen at a motion
COLOURS = {"pass": "#1b5e20", "fail": "#b3261e", "unknown": "#8a6d00"}


class VerdictDock(ObjectDock):
    """Shows a Verdict object."""

    NAME = "BeltGrinding_VerdictDock"

    def __init__(self) -> None:
        super().__init__()
        self.found: Json | None = None  # the verdict, as a job's has it
        self.field: Field | None = None
        self.cluster_of: Array | None = None  # of each sample, from 0
        self.scene: VerdictScene | None = None
        self.wheel: CellView | None = None
        self.sight: Sight | None = None
        self.shown_path: DocumentObject | None = None
        body = QtGui.QWidget()
        layout = QtGui.QVBoxLayout(body)
        self.overall = QtGui.QLabel()
        self.overall.setObjectName("overall")
        self.overall.setAlignment(QtCore.Qt.AlignCenter)
        self.figures = QtGui.QLabel()
        self.figures.setObjectName("verdictFigures")
        self.figures.setWordWrap(True)
        self.figures.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.trouble = QtGui.QLabel()
        self.trouble.setObjectName("verdictTrouble")
        self.trouble.setWordWrap(True)
        self.trouble.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.trouble.setStyleSheet(warning_style(True))
        self.trouble.hide()
        layout.addWidget(self.overall)
        layout.addWidget(self.trouble)
        layout.addWidget(self.figures)
        parts = QtGui.QSplitter(QtCore.Qt.Vertical)
        self.regions = table("regions", region_rows.titles())
        self.sections = table("sections", section_rows.titles())
        self.clusters = table("clusters", cluster_rows.titles())
        self.motions = table("motions", motion_rows.titles())
        self.clusters.setToolTip(
            translate("BeltGrinding", "Largest first. Click: go there in the 3D view")
        )
        self.motions.setToolTip(
            translate(
                "BeltGrinding", "Click: show the wheel and the line. Double click: open the program"
            )
        )
        self.poses = PoseTable()
        self.poses.hide()
        for title, widget in (
            (translate("BeltGrinding", "Zones and faces"), self.regions),
            (translate("BeltGrinding", "Sections"), self.sections),
            (translate("BeltGrinding", "Clusters out of tolerance"), self.clusters),
            (translate("BeltGrinding", "Motions of the cluster"), self.motions),
            ("", self.poses),
        ):
            parts.addWidget(_titled(title, widget))
        parts.setSizes(SHARES)
        layout.addWidget(parts, 1)
        self.here = QtGui.QPushButton(translate("BeltGrinding", "Raster path here..."))
        self.here.setObjectName("rasterHere")
        self.here.setToolTip(
            translate("BeltGrinding", "Lays passes on the chosen cluster, where too much is left")
        )
        self.here.setEnabled(False)
        self.here.clicked.connect(self.lay_here)
        layout.addWidget(self.here)
        self.setWidget(body)
        self.regions.cellClicked.connect(lambda row, _: self.go_to_region(row))
        self.clusters.currentCellChanged.connect(lambda row, *_: self.go_to_cluster(row))
        self.clusters.cellClicked.connect(lambda row, _: self.go_to_cluster(row))
        self.motions.currentCellChanged.connect(lambda row, *_: self.show_motion(row))
        self.motions.cellDoubleClicked.connect(lambda row, _: self.open_program(row))
        self.poses.chosen = self._pose_chosen
        self.place(QtCore.Qt.RightDockWidgetArea, WIDTH)
        FreeCAD.addDocumentObserver(self)

    @staticmethod
    def title() -> str:
        return translate("BeltGrinding", "Verdict")

    # What is shown

    def show_object(self, obj: DocumentObject) -> None:
        if self.obj is not obj:
            self.forget()
        super().show_object(obj)

    def preferences_changed(self) -> None:
        """The unit of deviations may be another one."""
        if self.living() is not None:
            self.refresh()

    def refresh(self) -> None:
        """Shows the object as it is now."""
        obj = self.living()
        if obj is None:
            return self.forget()
        self.found = obj.Proxy.data(obj)
        for made, rows in (
            (self.regions, region_rows),
            (self.sections, section_rows),
            (self.clusters, cluster_rows),
            (self.motions, motion_rows),
        ):
            made.setHorizontalHeaderLabels(rows.titles())  # with the unit as it is now
        self.cluster_of = None
        self._unmark()
        if self.found is None:
            self.overall.setText(translate("BeltGrinding", "No result yet."))
            self.overall.setStyleSheet("")
            for one in (self.regions, self.sections, self.clusters, self.motions):
                one.setRowCount(0)
            self.sections.parentWidget().hide()
            self.trouble.hide()
            return self.figures.setText("")
        self.overall.setText(headline(self.found))
        self.overall.setStyleSheet(
            f"background: {COLOURS[self.found['overall']]}; color: white; "
            "font-weight: bold; padding: 6px;"
        )
        trouble = errors(obj.Simulation) if obj.Simulation is not None else ""
        self.trouble.setText(trouble)
        self.trouble.setVisible(bool(trouble))
        text = doubts(self.found)
        if obj.OutOfDate:
            text = translate("BeltGrinding", "Out of date: simulate again.") + "\n" + text
        self.figures.setText(text)
        self.figures.setVisible(bool(text))
        self._fill_tables(self.found)

    def _job(self) -> DocumentObject:
        return self.shown().getParentGroup()

    def _fill_tables(self, found: Json) -> None:
        job = self._job()
        name = lambda face: face_name(job, face - 1) or f"Face{face}"  # noqa: E731
        self.shown_regions = [
            (region, cells, bad) for region, cells, bad in region_rows(found, name)
        ]
        fill(self.regions, [(cells, bad) for _, cells, bad in self.shown_regions])
        fill(self.sections, section_rows(found))
        self.sections.parentWidget().setVisible(self.sections.rowCount() > 0)
        fill(self.clusters, cluster_rows(found, name))
        self.motions.setRowCount(0)

    # Going there

    def go_to_region(self, row: int) -> None:
        """Looks at the worst place of a face or a zone."""
        if 0 <= row < len(self.shown_regions):
            worst = self.shown_regions[row][0]["worst"]
            field = None if worst is None else self._read_field()
            if field is not None:
                self._sight().at_samples(field, [worst["sample"]], LEAST_SEEN * 2.0)

    def go_to_cluster(self, row: int) -> None:
        """Looks at a cluster, marks it, and lists its motions."""
        if self.found is None or not 0 <= row < len(self.found["clusters"]):
            return
        cluster = self.found["clusters"][row]
        self.here.setEnabled(cluster["side"] == "above")
        fill(self.motions, motion_rows(cluster, self.found["programs"]))
        self._show_wheel(None, 0)
        field, obj = self._read_field(), self.shown()
        if field is None:
            return
        if self.cluster_of is None:
            field, self.cluster_of = objects.cluster_of_samples(self._job(), obj.Simulation)
            self.field = field
        if self.scene is None:
            self.scene = VerdictScene(obj.Document)
        inside = self.cluster_of == row
        self.scene.show(field, inside, cluster["worst"]["sample"])
        middle = np.mean(cluster["box_mm"], axis=0)
        size = max(AROUND * cluster["extent_mm"], LEAST_SEEN)
        samples = [cluster["worst"]["sample"], *np.flatnonzero(inside)]
        self._sight().at_samples(field, samples, size, middle)

    def lay_here(self) -> None:
        """A raster path on the cluster that is chosen, in its panel."""
        from ..common.transaction import transaction

        row = self.clusters.currentRow()
        if self.cluster_of is None or row < 0:
            return
        job = self._job()
        points = known(self.field).points[self.cluster_of == row]
        points = points[:: max(1, len(points) // MOST_POINTS)]
        text = translate("BeltGrinding", "Raster path")
        with transaction(job.Document, text, panel=True) as step:
            path = api.make_raster(job, compute=False)
            path.Along = "u"  # a small place needs no comparison
            raster_path.set_region(path, points)
        if not step.failed:
            edit_in_step(path)

    def _read_field(self) -> Field | None:
        if self.field is None:
            self.field = objects.field_of(self.shown().Simulation)
        return self.field

    def _sight(self) -> Sight:
        if self.sight is None:
            self.sight = Sight(self._job())
        return self.sight

    # Motions

    def _motion(self, row: int) -> tuple[DocumentObject | None, Any]:
        """(RobotPath or None, motion) of a row of the motions."""
        cluster = self.clusters.currentRow()
        if self.found is None or not 0 <= cluster < len(self.found["clusters"]):
            return None, None
        motions = self.found["clusters"][cluster]["motions"]
        if not 0 <= row < len(motions) or motions[row]["program"] is None:
            return None, None
        motion = motions[row]
        names = [program["name"] for program in self.found["programs"]]
        try:
            return ground_by.of_result(self._job(), names)[motion["program"]], motion
        except InputError:  # one is gone
            return None, motion

    def show_motion(self, row: int) -> None:
        """Draws the wheel at the motion's pose, and shows the pose and its line."""
        path, motion = self._motion(row)
        if path is None or motion["pose"] >= path.PoseCount:
            return self._show_wheel(None, 0)
        self._show_wheel(path, motion["pose"])
        wheel = known(self.wheel)
        contact = wheel.frames()["contact"]
        radius = 0.0 if path.Machine is None else half_size(path.Machine)
        size = max(LEAST_SEEN, WHEELS * radius)
        self._sight().at_contact(wheel, contact[:3, 3], size)
        if self.shown_path is not path:
            self.poses.show_path(path)
            self.shown_path = path
            self.poses.setCurrentIndex(1 if self.poses.isTabEnabled(1) else 0)
        self.poses.show()
        self.poses.show_pose(motion["pose"])
        from ..panels.program_panel import show_pose

        show_pose(path, motion["pose"], False)

    def _pose_chosen(self, index: int) -> None:
        if self.wheel is not None:
            self.wheel.set_pose(index)

    def _show_wheel(self, path: DocumentObject | None, pose: int) -> None:
        if self.wheel is not None:
            self.wheel.close()
            self.wheel = None
        if path is None:
            self.poses.hide()
            return
        self.wheel = CellView(self.shown().Document, path.Machine)
        arrays = robot_path.as_run(path)
        self.wheel.set_path(arrays["frames"], arrays)
        self.wheel.set_pose(pose)

    def open_program(self, row: int) -> None:
        """Opens the program's panel at the motion's pose."""
        from ..panels.program_panel import show_pose

        path, motion = self._motion(row)
        if path is not None and motion["pose"] < path.PoseCount:
            self._show_wheel(None, 0)  # the panel draws its own
            show_pose(path, motion["pose"], True)

    # What FreeCAD tells

    def slotChangedObject(self, obj: DocumentObject, name: str) -> None:
        if self.obj is not None and obj is self.obj and name in ("Shown", "OutOfDate"):
            QtCore.QTimer.singleShot(0, self.refresh)

    def slotDeletedObject(self, obj: DocumentObject) -> None:
        if self.obj is not None and obj == self.shown_path:
            self.forget()
        super().slotDeletedObject(obj)

    def closeEvent(self, event: QtEvent) -> None:
        self._unmark()
        super().closeEvent(event)

    def _unmark(self) -> None:
        if self.wheel is not None:
            self.wheel.close()
        if self.scene is not None:
            self.scene.close()
        if self.sight is not None:
            self.sight.clear()
        self.wheel = self.scene = self.shown_path = self.sight = None
        self.poses.hide()

    def forget(self) -> None:
        self._unmark()
        self.obj = self.found = self.field = self.cluster_of = None
        forget_field()
        self.overall.setText("")
        self.overall.setStyleSheet("")
        self.figures.setText("")
        for one in (self.regions, self.sections, self.clusters, self.motions):
            one.setRowCount(0)


def _titled(title: str, widget: Widget) -> Widget:
    box = QtGui.QWidget()
    layout = QtGui.QVBoxLayout(box)
    layout.setContentsMargins(0, 0, 0, 0)
    if title:
        layout.addWidget(QtGui.QLabel(title))
    layout.addWidget(widget, 1)
    return box
