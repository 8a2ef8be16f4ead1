"""What a Deviation says at one place: the sample there, its verdict, its face."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base.kinds import Json
from ..engine import InputError, core
from .job_data import face_name
from .kinds import DocumentObject, Point
from .simulation import is_coarse

REACH = 2.0  # spacings from the nearest sample; farther away is beside the field
IN_TOLERANCE, ABOVE, BELOW, MISSED = "in tolerance", "too much left", "cut too deep", "no stock met"


class Reader:
    """Reads a Deviation's height field. Raises InputError where the result is not there."""

    def __init__(self, obj: DocumentObject) -> None:
        self.obj = obj
        self.shown: tuple[Any, ...] | None = None
        self.field: Any = None  # the core.HeightField, once it is read

    def update(self) -> None:
        """Loads the field of another result."""
        simulation = self.obj.Simulation
        shown = None if simulation is None else (simulation.Fingerprint, simulation.WallTime)
        if self.field is None or shown != self.shown:
            self.field = None if simulation is None else simulation.Proxy.field(simulation)
            if self.field is None:
                raise InputError(
                    "objects.result_missing",
                    "{object}: its result is missing; simulate again",
                    object=self.obj.Label,
                )
            self.shown = shown
            heights = self.field.height[:, None]
            self.tops = self.field.points + heights * self.field.rays

    def at(self, point: Point) -> dict[str, Any] | None:
        """The reading of the sample nearest to ``point`` (x, y, z in mm, work frame) on the ground
        surface; None more than two spacings away from every sample."""
        self.update()
        distance = np.linalg.norm(self.tops - np.asarray(point, dtype=float), axis=1)
        index = int(distance.argmin()) if len(distance) else -1
        if index < 0 or distance[index] > REACH * self.field.spacing:
            return None
        return self.sample(index)

    def sample(self, index: int) -> dict[str, Any]:
        """The reading of sample ``index``, a dict: sample, deviation (mm; None where no stock was
        met), verdict, removed and stock (mm, along the normal), uncertainty (1 sd in mm) and cell_error (mm), None if not
        known, coarse (it is a coarse run's), segment (its lower and upper end along the normal, mm), face ("Object.FaceN"), point
        (on the design), top (on the ground surface), normal; mm, work frame."""
        self.update()
        field, obj = self.field, self.obj
        height, stock = float(field.height[index]), float(field.stock_height[index])
        missed = bool(field.flags[index] & core.MISSED)
        if missed:
            verdict = MISSED
        elif height > obj.ToleranceUpper.Value:
            verdict = ABOVE
        else:
            verdict = BELOW if height < obj.ToleranceLower.Value else IN_TOLERANCE
        return {
            "sample": index,
            "coarse": obj.Simulation is not None and is_coarse(obj.Simulation),
            "deviation": None if missed else height,
            "verdict": verdict,
            "removed": max(stock - height, 0.0),
            "stock": stock,
            "uncertainty": float(field.height_sd[index]) if len(field.height_sd) else None,
            "cell_error": float(field.height_error[index]) if len(field.height_error) else None,
            "segment": (-field.depth, height),
            "face": face_name(obj.getParentGroup(), int(field.faces[index])),
            "point": tuple(field.points[index].tolist()),
            "top": tuple(self.tops[index].tolist()),
            "normal": tuple(field.normals[index].tolist()),
        }


def make_marker(obj: DocumentObject, reading: Json, lines: Sequence[str]) -> DocumentObject:
    """Leaves a reading of Deviation ``obj`` in the document: an App::AnnotationLabel with the text
    ``lines`` at its place. Returns it."""
    import FreeCAD

    marker = obj.Document.addObject("App::AnnotationLabel", "Reading")
    marker.Label = lines[0]
    marker.LabelText = lines
    top, normal = FreeCAD.Vector(*reading["top"]), FreeCAD.Vector(*reading["normal"])
    marker.BasePosition = top
    # Off the surface, so that the line to the place is seen.
    marker.TextPosition = normal * (0.05 * obj.Mesh.BoundBox.DiagonalLength)
    return marker
