"""A cross-section of the result in the document: its plane, its figures, its line on the surface."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from ..base.kinds import Array, Json
from ..engine import InputError
from ..inspection import edge_profile, section as sections
from .fields import field_of
from .kinds import DocumentObject, Field
from .properties import Output, add_outputs
from .proxy import Proxy

REMOVED = 1e-3  # mm: less does not count as ground
PLANE, LINE = "plane", "line"
SETTINGS = (
    ("Cut", "Enumeration", "a plane, or the line on the surface from Start to End"),
    ("Point", "VectorDistance", "of the plane"),
    ("Normal", "Vector", "of the plane"),
    ("Start", "VectorDistance", "where the line begins"),
    ("End", "VectorDistance", "where the line ends"),
)
OUTPUTS = (
    Output("Length", "Distance", "Figures", "of the section, without gaps"),
    Output("Pieces", "Integer", "Figures", "uninterrupted lines on one face"),
    Output("Minimum", "Distance", "Figures", "of the deviation along the section"),
    Output("Maximum", "Distance", "Figures", "of the deviation along the section"),
    Output("Mean", "Distance", "Figures", "of the deviation, by length"),
    Output("RootMeanSquare", "Distance", "Figures", "of the deviation, by length"),
    Output("RemovedMean", "Distance", "Figures", "depth removed, by length"),
    Output("InTolerance", "Float", "Figures", "share of the length in tolerance, percent"),
    Output(
        "Edges", "StringList", "Figures", "radius left and chord loss at each edge that it meets"
    ),
    Output("OutOfDate", "Bool", "Figures", "an input of the simulation has changed since"),
    Output("Problem", "String", "Figures", "why there is no section; else empty"),
    Output("Line", "VectorList", "Section", "the ground profile in space", True),
    Output("LineCounts", "IntegerList", "Section", "points of each piece of it", True),
    Output("Shown", "String", "Section", "what was cut, and how", True),
)


class Section(Proxy):
    """Proxy of the App::FeaturePython; cuts what its ``Simulation`` holds."""

    TYPE = "BeltGrinding::Section"
    VIEW = "SectionView"

    def add_properties(self, obj: DocumentObject) -> None:
        if "Simulation" not in obj.PropertiesList:
            obj.addProperty("App::PropertyLink", "Simulation", "Section", "the result that is cut")
            obj.setEditorMode("Simulation", 1)
        for name, kind, text in SETTINGS:
            if name not in obj.PropertiesList:
                obj.addProperty(f"App::Property{kind}", name, "Section", text)
                if name == "Cut":
                    obj.Cut = [PLANE, LINE]
        add_outputs(obj, OUTPUTS)

    def execute(self, obj: DocumentObject) -> None:
        self.update(obj)

    def cut(self, obj: DocumentObject) -> dict[str, Any]:
        """The section as plain data (``beltgrinding.section``). Raises InputError."""
        simulation, job = obj.Simulation, obj.getParentGroup()
        if simulation is None or job is None:
            raise InputError(
                "objects.no_simulation",
                "{object}: belongs to no simulation; make a new one",
                object=obj.Label,
            )
        field = field_of(simulation)
        if field is None:
            raise InputError(
                "objects.no_field",
                "{object}: its height field is missing; simulate again",
                object=simulation.Label,
            )
        tolerance = (job.ToleranceLower.Value, job.ToleranceUpper.Value)
        if obj.Cut == LINE:
            return sections.of_field_between(field, tolerance, obj.Start, obj.End)
        return sections.of_field(field, tolerance, obj.Point, obj.Normal)

    def update(self, obj: DocumentObject) -> None:
        """Cuts again if the result, the plane or the tolerance is another one. What cannot be cut
        leaves no line, and its reason in ``Problem``.
        """
        simulation, job = obj.Simulation, obj.getParentGroup()
        if simulation is None or job is None or not simulation.Fingerprint:
            return
        if obj.OutOfDate != simulation.OutOfDate:
            obj.OutOfDate = simulation.OutOfDate
        place = (obj.Start, obj.End) if obj.Cut == LINE else (obj.Point, obj.Normal)
        tolerance = [job.ToleranceLower.Value, job.ToleranceUpper.Value]
        result = [simulation.Fingerprint, simulation.WallTime]
        shown = json.dumps([result, tolerance, obj.Cut, *map(list, place)], allow_nan=False)
        if shown == obj.Shown:
            return
        try:
            show(obj, self.cut(obj))
        except InputError as error:
            obj.Line, obj.LineCounts, obj.Problem = [], [], str(error)
        obj.Shown = shown


def show(obj: DocumentObject, section: Json) -> None:
    """Puts a section's figures and its line into the object."""
    figures = sections.summary(section)
    deviation = figures.get("deviation_mm", {})
    obj.Length, obj.Pieces = figures["length_mm"], figures["pieces"]
    obj.Minimum, obj.Maximum = deviation.get("min", 0.0), deviation.get("max", 0.0)
    obj.Mean, obj.RootMeanSquare = deviation.get("mean", 0.0), deviation.get("rms", 0.0)
    obj.RemovedMean = figures.get("removed_mean_mm", 0.0)
    obj.Edges = [edge_profile.text(edge) for edge in figures.get("edges", [])]
    obj.InTolerance = 100.0 * figures.get("in_tolerance_share", 0.0)
    lines = [
        piece["point"] + np.nan_to_num(piece["height"])[:, None] * piece["ray"]
        for piece in section["pieces"]
    ]
    obj.LineCounts = [len(line) for line in lines]
    obj.Line = [tuple(point) for point in np.vstack(lines).tolist()]
    obj.Problem = ""


def first_plane(field: Field) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """(point, normal) of a plane across the longest side of what was ground, through its middle: it always
    meets the surface.
    """
    points = field.points[ground(field)]
    axis = int(np.argmax(np.ptp(points, axis=0)))
    return middle_of_ground(field), tuple(np.eye(3)[axis].tolist())


def ground(field: Field) -> Array:
    """Indices of the samples at which something was removed; of all where nothing was."""
    found = np.flatnonzero(field.stock_height - field.height > REMOVED)
    return found if len(found) else np.arange(field.size)


def middle_of_ground(field: Field) -> tuple[float, ...]:
    """(x, y, z) of the middle of the ground area, mm; where a plane through it might miss the surface, of the
    sample nearest to it."""
    chosen = ground(field)
    points, areas = field.points[chosen], field.areas[chosen].astype(float)
    middle = (areas[:, None] * points).sum(axis=0) / max(areas.sum(), 1e-300)
    if (np.abs(points - middle).min(axis=0) > field.spacing).any():
        middle = points[np.argmin(np.linalg.norm(points - middle, axis=1))]
    return tuple(middle.tolist())
