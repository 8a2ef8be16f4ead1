"""The moment of an event in the 3D view: the cell there and then, a mark on the part, the camera."""

from __future__ import annotations

from typing import TYPE_CHECKING

import FreeCADGui as Gui
import numpy as np
from pivy import coin

from ...geometry.body_names import PART, STOCK
from ...objects import ground_by, job_data, job_inputs
from ...objects.belt_machine import BeltMachine, half_size
from ...objects.kinds import DocumentObject, Event, Point
from ...objects.living import named
from ...objects.simulation import Simulation
from ..common import event_texts
from ..common.compat import QtGui
from ..common.event_texts import COLOURS
from ..common.kinds import Array, Colour, Node, View3D, Widget
from ..scene.cell_view import CellView
from ..scene.labels import label
from ..scene.sight import Sight

if TYPE_CHECKING:
    from ...engine import core

LEAST_SIZE, WHEELS = 20.0, 3.2  # mm; radii of the wheel that the view shows


class EventMoment:
    """Shows events of a job's simulation; ``close`` leaves the 3D view as it was."""

    def __init__(self, job: DocumentObject) -> None:
        self.document, self.name = job.Document, job.Name
        self.cell: CellView | None = None
        self.mark: tuple[Node, list[Node]] | None = None  # the node, and the scenes that it is in
        self.tinted: list[CellView] = []
        self.programs: list[DocumentObject] = []  # of the result that the events are of
        self.paths: list[core.ToolPath] | None = None
        self.sight = Sight(job)

    def job(self) -> DocumentObject | None:
        """The job, or None if it or its document is no longer there."""
        return named(self.document, self.name)

    def show(self, event: Event) -> None:
        """Shows the moment at which an event was worst. Raises InputError if the job has changed so
        that there is none."""
        job = self.job()
        if job is None:
            return
        if self.paths is None:
            simulation = job_data.child(job, Simulation)
            names = [] if simulation is None else simulation.Programs
            self.programs = ground_by.of_result(job, names)
            self.paths = job_inputs.tool_paths(job, self.programs)
        dock = playback(job)
        if dock is not None:
            self._drop_cell()
            dock.scrub(event["worst_time"])
            cell = dock.scene.cell
        else:
            cell = self._own_cell(job)
            if event["program"] >= len(self.paths):
                return
            begin = sum(path.duration() for path in self.paths[: event["program"]])
            frame, _ = self.paths[event["program"]].frame_at(event["worst_time"] - begin)
            cell.set_frame(frame)
        self.untint()
        cell.tint([name for name in event["bodies"] if name not in (PART, STOCK)])
        self.tinted = [cell]
        contact = cell.frames()["contact"]
        point = contact[:3, 3] if event["point"] is None else np.array(event["point"])
        self._mark(event, point)
        radius = half_size(job_data.child(job, BeltMachine))
        self.sight.at_contact(cell, point, max(LEAST_SIZE, WHEELS * radius))

    def _own_cell(self, job: DocumentObject) -> CellView:
        if self.cell is None:
            self.cell = CellView(job.Document, job_data.child(job, BeltMachine))
            program = self.programs[0]
            self.cell.set_path(program.Proxy.arrays(program)["frames"])
        return self.cell

    def _drop_cell(self) -> None:
        if self.cell is not None:
            self.cell.close()
            self.cell = None

    def _views(self) -> list[View3D]:
        return Gui.getDocument(self.document.Name).mdiViewsOfType("Gui::View3DInventor")

    def _mark(self, event: Event, point: Array) -> None:
        self._unmark()
        node = pin(point.tolist(), COLOURS[event["severity"]], event_texts.title(event))
        self.mark = node, [view.getSceneGraph() for view in self._views()]
        for scene in self.mark[1]:
            scene.addChild(node)

    def _unmark(self) -> None:
        if self.mark is not None:
            node, scenes = self.mark
            for scene in scenes:
                if scene.findChild(node) >= 0:
                    scene.removeChild(node)
            self.mark = None

    def untint(self) -> None:
        """Bodies get their own colours back."""
        for cell in self.tinted:
            cell.tint(())
        self.tinted = []

    def forget(self) -> None:
        """Takes everything out of the 3D views, and the paths and the part anew: they may be others."""
        self.close()
        self.paths = None
        self.sight.part = None

    def close(self) -> None:
        """Takes everything out of the 3D views."""
        self.sight.clear()
        self.untint()
        self._unmark()
        self._drop_cell()


def playback(job: DocumentObject) -> Widget | None:
    """The playback dock that shows a recording of the job; None if there is none."""
    for dock in Gui.getMainWindow().findChildren(QtGui.QDockWidget, "BeltGrinding_PlaybackDock"):
        if dock.isVisible() and dock.scene is not None and dock.job() is job:
            return dock
    return None


def pin(point: Point, colour: Colour, text: str) -> Node:
    """A dot with a text at ``point`` (3,), over everything, not picked, not counted by fitAll."""
    root = coin.SoType.fromName("SoSkipBoundingGroup").createInstance() or coin.SoSeparator()
    top = coin.SoAnnotation()
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    place = coin.SoTranslation()
    place.translation = [float(x) for x in point]
    dots = coin.SoCoordinate3()
    dots.point.setValues(0, 1, [(0.0, 0.0, 0.0)])
    for node in (style, light, place, dots):
        top.addChild(node)
    filled = QtGui.QColor(colour).getRgbF()[:3]
    shapes = ((1.0, 1.0, 1.0), "CIRCLE_FILLED_9_9"), (filled, "CIRCLE_FILLED_7_7")
    for rgb, name in shapes:
        tone = coin.SoBaseColor()
        tone.rgb = rgb
        marker = coin.SoMarkerSet()
        marker.markerIndex = getattr(coin.SoMarkerSet, name)
        top.addChild(tone)
        top.addChild(marker)
    top.addChild(label(text, colour))
    root.addChild(top)
    return root
