"""The deviation in the document: a coloured mesh with its statistics as properties."""

import io

import FreeCAD
import Mesh

from .. import core
from ..job import colour_scale

SCHEMA = 1
# name, type, group, what it is
PROPERTIES = (
    ("Schema", "App::PropertyInteger", "Base", "version of this object's properties"),
    ("VertexColors", "App::PropertyColorList", "Deviation", "one colour per sample"),
    ("ToleranceLower", "App::PropertyFloat", "Tolerance", "lower limit of the deviation, mm"),
    ("ToleranceUpper", "App::PropertyFloat", "Tolerance", "upper limit of the deviation, mm"),
    ("ColourLimit", "App::PropertyFloat", "Tolerance", "deviation at which the ramps end, mm"),
    ("Minimum", "App::PropertyFloat", "Statistics", "mm"),
    ("Maximum", "App::PropertyFloat", "Statistics", "mm"),
    ("Mean", "App::PropertyFloat", "Statistics", "area-weighted, mm"),
    ("RootMeanSquare", "App::PropertyFloat", "Statistics", "area-weighted, mm"),
    ("Percentile05", "App::PropertyFloat", "Statistics", "of the area, mm"),
    ("Percentile50", "App::PropertyFloat", "Statistics", "of the area, mm"),
    ("Percentile95", "App::PropertyFloat", "Statistics", "of the area, mm"),
    ("InTolerance", "App::PropertyPercent", "Statistics", "share of the area, percent"),
    ("RemovedVolume", "App::PropertyVolume", "Statistics", "removed by grinding"),
    ("DesignArea", "App::PropertyArea", "Statistics", "of the inspected faces"),
)


class Deviation:
    """Proxy; all state lives in properties."""

    def __init__(self, obj):
        obj.Proxy = self
        self.onDocumentRestored(obj)

    def onDocumentRestored(self, obj):
        """Adds what an older file does not have."""
        for name, kind, group, text in PROPERTIES:
            if name not in obj.PropertiesList:
                obj.addProperty(kind, name, group, text)
                if name != "VertexColors":
                    obj.setEditorMode(name, 1)
        obj.setEditorMode("VertexColors", 2)
        obj.Schema = SCHEMA

    def execute(self, obj):
        """Nothing: the mesh is a result."""

    def dumps(self):
        return None

    def loads(self, state):
        return None

    __getstate__ = dumps

    def __setstate__(self, state):
        return None


def make_deviation(doc, result, name="Deviation"):
    """Adds the ground surface of a ``job.Result`` to ``doc`` in colour; returns the object.

    Colours: one calm colour inside the tolerance band, a brown ramp above it, a blue one below.
    """
    obj = doc.addObject("Mesh::FeaturePython", name)
    Deviation(obj)
    if FreeCAD.GuiUp:
        from ..gui.deviation_view import DeviationView

        DeviationView(obj.ViewObject)
    show(obj, result)
    return obj


def show(obj, result):
    """Puts another result into an existing Deviation object."""
    lower, upper, limit = colour_scale(result.job)
    mesh = Mesh.Mesh()
    mesh.read(Stream=io.BytesIO(core.mesh_ply(result.field, True)), Format="PLY")
    colours = core.deviation_colours(result.field, lower, upper, limit)
    s, d = result.summary, result.summary["deviation_mm"]
    obj.ToleranceLower, obj.ToleranceUpper, obj.ColourLimit = lower, upper, limit
    obj.Minimum, obj.Maximum, obj.Mean, obj.RootMeanSquare = d["min"], d["max"], d["mean"], d["rms"]
    obj.Percentile05, obj.Percentile50, obj.Percentile95 = d["p05"], d["p50"], d["p95"]
    obj.InTolerance = round(100 * s["in_tolerance_area_share"])
    obj.RemovedVolume = s["removed_volume_mm3"]
    obj.DesignArea = s["design_area_mm2"]
    # In this order: an assignment to Mesh drops the colours.
    obj.Mesh = mesh
    obj.VertexColors = colours.tolist()
