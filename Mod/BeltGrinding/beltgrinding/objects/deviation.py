"""The deviation in the document: a coloured mesh with its statistics as properties."""

from __future__ import annotations

import hashlib
import io
import json
from typing import Any, NamedTuple

import Mesh

from ..engine import InputError, core
from ..job.tolerances import colour_scale
from ..simulation import cell_errors
from . import preferences, shown
from .fields import field_of
from .kinds import DocumentObject, Field, Limits, MeshShape, Scale
from .properties import Output, add_outputs
from .proxy import Proxy
from .shown import BY_HAND, BY_PERCENTILE, BY_TOLERANCE, MODES, bounded, round_up

SETTINGS = (  # name, kind, first value, text
    ("Bounds", "Enumeration", [BY_HAND, BY_TOLERANCE, BY_PERCENTILE], "where the ramps end"),
    (
        "TimesTolerance",
        "Float",
        5.0,
        "by tolerance: the ramps end at so many times the wider limit",
    ),
    ("Percentile", "Float", 99.0, "by percentile: so much of the area lies between the ends, %"),
    ("Bands", "Integer", 0, "steps of each ramp; 0: without steps"),
)
OUTPUTS = (
    Output("VertexColors", "ColorList", "Deviation", "one colour per sample", True),
    Output(
        "UncertaintyLimit", "Distance", "Tolerance", "standard deviation at which its ramp ends"
    ),
    Output("ToleranceLower", "Distance", "Tolerance", "lower limit; set it at the job"),
    Output("ToleranceUpper", "Distance", "Tolerance", "upper limit; set it at the job"),
    Output("ColourLimit", "Distance", "Tolerance", "deviation at which the colour ramps end"),
    Output("OutOfDate", "Bool", "Tolerance", "an input of the simulation has changed since"),
    Output("Minimum", "Distance", "Statistics", "of the deviation; negative: below the design"),
    Output("Maximum", "Distance", "Statistics", "of the deviation; positive: stock left"),
    Output("Mean", "Distance", "Statistics", "weighted by area"),
    Output("RootMeanSquare", "Distance", "Statistics", "weighted by area"),
    Output("Percentile05", "Distance", "Statistics", "5 % of the area lie below"),
    Output("Percentile50", "Distance", "Statistics", "half of the area lies below"),
    Output("Percentile95", "Distance", "Statistics", "95 % of the area lie below"),
    Output("InTolerance", "Float", "Statistics", "share of the area in tolerance, percent"),
    Output(
        "AboveTolerance", "Float", "Statistics", "share of the area with too much left, percent"
    ),
    Output("BelowTolerance", "Float", "Statistics", "share of the area cut too deep, percent"),
    Output("UncertaintyMean", "Distance", "Statistics", "mean standard deviation of the deviation"),
    Output("Uncertainty95", "Distance", "Statistics", "95 % of the area are surer than that"),
    Output(
        "CellError95",
        "Distance",
        "Statistics",
        "95 % of the ground area are less off by the size of the contact's cells; 0: not known",
    ),
    Output("ExpectedInTolerance", "Float", "Statistics", "mean probability, percent; 0: not known"),
    Output(
        "StartTemperature", "Float", "Temperature", "of the part before it was ground, degrees C"
    ),
    Output(
        "GreatestTemperature",
        "Float",
        "Temperature",
        "likely, of the hottest sample, degrees C; 0: not computed",
    ),
    Output(
        "GreatestTemperatureAtMost",
        "Float",
        "Temperature",
        "the same, if friction and partition are the most that they may be",
    ),
    Output(
        "BurntArea", "Float", "Temperature", "share of the area likely above the limit, percent"
    ),
    Output(
        "GreatestRoughness",
        "Float",
        "Finish",
        "Ra of the roughest sample that was ground, µm; 0: not known",
    ),
    Output("MeanRoughness", "Float", "Finish", "Ra, µm, weighted by the ground area; 0: not known"),
    Output(
        "RoughnessKnown", "Float", "Finish", "share of the ground area with a known Ra, percent"
    ),
    Output(
        "CrossedArea",
        "Float",
        "Finish",
        "share of the ground area where crossed scratches stay, percent; -1: not known",
    ),
    Output("RemovedVolume", "Volume", "Statistics", "removed by grinding"),
    Output("DesignArea", "Area", "Statistics", "of the faces"),
    Output("Shown", "String", "Deviation", "which result the colours show", True),
    Output("MeshOf", "String", "Deviation", "hash of the surface that the mesh is of", True),
)
STATISTICS = {
    "Minimum": "min",
    "Maximum": "max",
    "Mean": "mean",
    "RootMeanSquare": "rms",
    "Percentile05": "p05",
    "Percentile50": "p50",
    "Percentile95": "p95",
    "RemovedVolume": "removed_volume",
    "DesignArea": "design_area",
}
SHARES = {
    "InTolerance": "in_tolerance_share",
    "AboveTolerance": "above_share",
    "BelowTolerance": "below_share",
}


class Deviation(Proxy):
    """Proxy of the Mesh::FeaturePython; shows what its ``Simulation`` holds."""

    TYPE = "BeltGrinding::Deviation"
    VIEW = "DeviationView"

    def add_properties(self, obj: DocumentObject) -> None:
        if "Simulation" not in obj.PropertiesList:
            obj.addProperty("App::PropertyLink", "Simulation", "Deviation", "the result shown")
            obj.setEditorMode("Simulation", 1)
        if "ColourBy" not in obj.PropertiesList:
            text = (
                "what the colours show; uncertainty: of a calibrated law; measured, difference: of a scan; "
                "temperature: the greatest, of a job with Heat; roughness: Ra, of a job with Finish; "
                "error of the cells: what their size leaves open of the height"
            )
            obj.addProperty("App::PropertyEnumeration", "ColourBy", "Deviation", text)
            obj.ColourBy = MODES
        if obj.getEnumerationsOfProperty("ColourBy") != MODES:  # an older file's
            before = obj.ColourBy
            obj.ColourBy = MODES
            obj.ColourBy = before
        for name, kind, value, text in SETTINGS:
            if name not in obj.PropertiesList:
                obj.addProperty(f"App::Property{kind}", name, "Deviation", text)
                setattr(obj, name, value)
        add_outputs(obj, OUTPUTS)

    def execute(self, obj: DocumentObject) -> None:
        self.update(obj)

    def update(self, obj: DocumentObject) -> None:
        """Reads the result again if it is another one or the tolerance has changed."""
        simulation, job = obj.Simulation, obj.getParentGroup()
        if simulation is None or job is None or not simulation.Fingerprint:
            return
        if obj.OutOfDate != simulation.OutOfDate:
            obj.OutOfDate = simulation.OutOfDate
        from .job_data import inspection

        scale = colour_scale({"inspection": inspection(job)})
        scanned = getattr(simulation, "ScanFigures", "")
        result = [simulation.Fingerprint, simulation.WallTime]
        bounds = [obj.Bounds, obj.TimesTolerance, obj.Percentile, obj.Bands]
        chosen = preferences.colours()
        asked = [*scale, obj.ColourBy, *bounds, chosen and list(chosen), scanned]
        before = json.loads(obj.Shown or "[null, null]")
        if before[:2] == [result, asked]:
            return
        field = field_of(simulation)
        if field is None:
            raise InputError(
                "objects.no_field",
                "{object}: its height field is missing; simulate again",
                object=simulation.Label,
            )
        found = show(obj, field, scale, before[0] != result)
        obj.Shown = json.dumps([result, asked, found._asdict()], allow_nan=False)


class _Ready(NamedTuple):
    """What a worker has made of a field for the next ``show`` of it."""

    field: object
    surface: str  # hash
    mesh: MeshShape | None  # None where it is there already
    limits: tuple[float, ...]
    statistics: dict[str, Any]


_ready: list[_Ready] = []  # one _Ready, or none


def prepare(field: Field, tolerance: Limits, shown: str = "") -> None:
    """Makes the mesh of a core.HeightField and its statistics for (lower, upper) limits in mm, for the next
    ``show`` of it; in any thread. ``shown``: the hash of the surface whose mesh is there already, ``obj.MeshOf``.
    """
    statistics = core.deviation_statistics(field, *tolerance)
    ply, surface = _ply(field)
    mesh = None if surface == shown else _mesh(ply)
    _ready[:] = [_Ready(field, surface, mesh, tuple(tolerance), statistics)]


def forget_prepared() -> None:
    """Frees what was prepared and is not shown."""
    _ready.clear()


def _statistics(field: Field, tolerance: Limits) -> dict[str, Any]:
    for one in _ready:
        if one.field is field and one.limits == tuple(tolerance):
            return one.statistics
    return core.deviation_statistics(field, *tolerance)


def _lay_mesh(obj: DocumentObject, field: Field) -> None:
    """Gives the object the field's mesh, unless it has that already."""
    one = next((one for one in _ready if one.field is field), None)
    ply, surface = _ply(field) if one is None else (None, one.surface)
    if surface == obj.MeshOf and obj.Mesh.CountPoints == len(field.height):
        return
    mesh = None if one is None else one.mesh
    obj.Mesh = mesh or _mesh(ply or _ply(field)[0])
    obj.MeshOf = surface


def _ply(field: Field) -> tuple[bytes, str]:
    """(PLY file of the ground surface, its hash)."""
    ply = core.mesh_ply(field, True)
    return ply, hashlib.sha256(ply).hexdigest()


def _mesh(ply: bytes) -> MeshShape:
    mesh = Mesh.Mesh()
    mesh.read(Stream=io.BytesIO(ply), Format="PLY")
    return mesh


def _show_temperatures(obj: DocumentObject, field: Field) -> None:
    stored = json.loads(getattr(obj.Simulation, "VerdictData", "") or "{}")
    heat = stored.get("verdict", {}).get("heat") if field.heat is not None else None
    obj.StartTemperature = heat["start_C"] if heat else 0.0
    obj.GreatestTemperature = heat["worst"]["temperature_C"] if heat else 0.0
    obj.GreatestTemperatureAtMost = heat["worst"]["greatest_C"] if heat else 0.0
    obj.BurntArea = 100.0 * (heat["burnt_share"] or 0.0) if heat else 0.0


def _show_finish(obj: DocumentObject, field: Field) -> None:
    stored = json.loads(getattr(obj.Simulation, "VerdictData", "") or "{}")
    finish = stored.get("verdict", {}).get("finish") if field.finish is not None else None
    spread = (finish or {}).get("Ra_um")
    crossed = (finish or {}).get("crossed_share")
    obj.GreatestRoughness = spread["max"] if spread else 0.0
    obj.MeanRoughness = spread["mean"] if spread else 0.0
    obj.RoughnessKnown = 100.0 * finish["known_share"] if finish else 0.0
    obj.CrossedArea = -1.0 if crossed is None else 100.0 * crossed


def show(obj: DocumentObject, field: Field, scale: Scale, new_mesh: bool = True) -> shown.Shown:
    """Shows a core.HeightField; returns how. ``scale``: lower and upper limit, end of the ramps, mm."""
    scale = bounded(obj, field, scale)
    statistics = _statistics(field, scale[:2])
    sd = statistics.get("sd_p95", 0.0)
    obj.UncertaintyMean, obj.Uncertainty95 = statistics.get("sd_mean", 0.0), sd
    obj.ExpectedInTolerance = 100.0 * statistics.get("expected_in_tolerance_share", 0.0)
    obj.UncertaintyLimit = round_up(sd)
    obj.CellError95 = cell_errors.p95(field)
    _show_temperatures(obj, field)
    _show_finish(obj, field)
    obj.ToleranceLower, obj.ToleranceUpper, obj.ColourLimit = scale
    for name, key in STATISTICS.items():
        setattr(obj, name, statistics[key])
    for name, key in SHARES.items():
        setattr(obj, name, 100.0 * statistics[key])
    if new_mesh:  # an assignment to Mesh drops the colours: it comes first
        _lay_mesh(obj, field)
    found = shown.made(obj, field, scale, preferences.colours())
    obj.VertexColors = found.colours_of(field).tolist()
    return found
