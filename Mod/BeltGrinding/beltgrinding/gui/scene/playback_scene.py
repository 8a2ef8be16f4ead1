"""What playback draws: the field at a moment, the wheel on it, the rest of the part, the legend."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from pivy import coin

from ...base.frames import work_from_frames
from ...engine import InputError
from ...job.tolerances import colour_scale
from ...objects import ground_by, job_data, job_inputs, preferences
from ...objects.belt_machine import BeltMachine
from ...objects.deviation import Deviation
from ...objects.ground_mesh import GroundMesh
from ...objects.kinds import DocumentObject, ViewObject
from ...objects.living import GONE
from ...objects.plan import Plan
from ...objects.shown import bands_of
from ..common.compat import translate
from ..common.editing import edit
from ..common.kinds import Array, Node
from . import legend, loads
from .cell_view import CellView
from .field_view import DEVIATION, FieldView
from .part_context import points_of_part, rest_of_part

if TYPE_CHECKING:
    from ...engine import core

SAME = 1e-9  # s


class Scene:
    """What is drawn: the field at a moment, the wheel on it, the rest of the part."""

    def __init__(
        self,
        job: DocumentObject,
        simulation: DocumentObject,
        recording: core.Recording,
        steps: Mapping[str, Array],
    ) -> None:
        self.recording, self.simulation, self.steps = recording, simulation, steps
        programs = ground_by.of_result(job, simulation.Programs)
        self.paths = job_inputs.tool_paths(job, programs)
        self.labels = [program.Label for program in programs]
        self.lines = [path.lines() for path in self.paths]
        self.ends = np.cumsum([path.duration() for path in self.paths])
        self.duration = recording.duration
        self.deviation = deviation = job_data.child(job, Deviation)
        machine = job_data.child(job, BeltMachine)
        self.needed = [job, simulation, machine, *programs]  # without them there is nothing to show
        self.scale = self._scale(job)
        field = simulation.Proxy.field(simulation)
        if field is None or field.size != recording.samples:
            raise InputError(
                "gui.other_recording", "The recording is of another field; simulate again."
            )
        self.field = FieldView(field)
        self.frame, self.heights = 0, recording.heights_at(0)
        self._draw()
        self.time = 0.0
        self.cell = CellView(job.Document, machine)
        self.cell.set_path(programs[0].Proxy.arrays(programs[0])["frames"])
        self.cell.root.addChild(self.field.node)
        self.legend = legend.Legend()
        self.legend.avoid(points_of_part(job))
        if deviation is not None:
            self.legend.chosen = lambda: edit(deviation)
        self._show_legend()
        self.cell.root.addChild(self.legend.node)
        self.cell.root.addChild(rest_of_part(job))
        self.hidden: list[tuple[ViewObject, Node, int]] = []  # (view, switch, what it showed)
        for obj in {part for part, _ in job.DesignFaces}:
            self._hide(obj.ViewObject, obj.ViewObject.SwitchNode)
        results = (Deviation, GroundMesh, Plan)
        self.covered = [one for kind in results for one in job_data.children(job, kind)]
        for one in self.covered:
            one.ViewObject.Proxy.cover(True)

    def _hide(self, view: ViewObject, switch: Node) -> None:
        """Turns a switch of the scene off: the property Visibility would change the document."""
        self.hidden.append((view, switch, switch.whichChild.getValue()))
        switch.whichChild = coin.SO_SWITCH_NONE

    def go(self, moment: float) -> None:
        """Shows a moment, s."""
        self.time = min(max(moment, 0.0), self.duration)
        frame = self.recording.frame_at(self.time + SAME)
        if frame != self.frame:
            samples, heights = self.recording.advance(self.frame, frame)
            self.heights[samples] = heights
            self.frame = frame
            if len(samples):
                self._draw()
        k = min(int(np.searchsorted(self.ends, self.time)), len(self.paths) - 1)
        begin = self.ends[k - 1] if k else 0.0
        base_from_tcp, pose = self.paths[k].frame_at(self.time - begin)
        # Within the program's time: beyond its ends it stands still.
        middle = min(max(self.time, begin + loads.MOMENT), self.ends[k] - loads.MOMENT) - begin
        around = [
            self.paths[k].frame_at(middle + side)[0] for side in (-loads.MOMENT, loads.MOMENT)
        ]
        ends = work_from_frames(np.array(around), **self.cell.cell())["contact"][:, :3, 3]
        self.cell.set_frame(base_from_tcp, loads.at_moment(self.steps, self.time, *ends))
        self.place = (self.labels[k], pose, int(self.lines[k][pose]))

    def _scale(self, job: DocumentObject) -> tuple[Any, ...]:
        """(lower, upper, end of the ramps, mm; bands; colours) as the Deviation is drawn."""
        scale: tuple[float, ...] = colour_scale({"inspection": job_data.inspection(job)})
        bands = 0
        if self.deviation is not None and self.deviation.ColourLimit.Value > 0:
            names = ("ToleranceLower", "ToleranceUpper", "ColourLimit")
            scale = tuple(getattr(self.deviation, name).Value for name in names)
            bands = bands_of(self.deviation)
        return (*scale, bands, preferences.colours())

    def _show_legend(self) -> None:
        lower, upper, limit, bands, _ = self.scale
        spec = legend.deviation(lower, upper, limit, bands=bands)
        self.legend.show(spec._replace(name=translate("BeltGrinding", "Playback")))

    def recolour(self, job: DocumentObject) -> None:
        """Takes the scale over anew. What a changed object has turned on is turned off again."""
        self.scale = self._scale(job)
        self._show_legend()
        self.field.colour_by(DEVIATION, *self.scale)
        for _, switch, _ in self.hidden:
            switch.whichChild = coin.SO_SWITCH_NONE

    def _draw(self) -> None:
        self.field.set_heights(self.heights)
        self.field.colour_by(DEVIATION, *self.scale)

    def close(self) -> None:
        """Leaves the 3D views as they were. The switches alone were turned, no property."""
        self.cell.close()
        for view, switch, child in self.hidden:
            try:
                if not view.Visibility:
                    continue
                switch.whichChild = child
                if child < 0 and switch == view.SwitchNode:  # shown while it was turned off here
                    view.DisplayMode = view.DisplayMode
            except GONE:
                pass  # the object is gone
        for one in self.covered:
            try:
                one.ViewObject.Proxy.cover(False)
            except (AttributeError, *GONE):
                pass  # the object is gone
        self.hidden, self.covered = [], []
