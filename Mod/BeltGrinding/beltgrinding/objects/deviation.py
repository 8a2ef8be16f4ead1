"""The deviation in the document: a coloured mesh with its statistics as properties."""

from __future__ import annotations

import hashlib
import io
import json
import math
from typing import Any, NamedTuple

import Mesh
import numpy as np

from ..base.kinds import Array, Floats
from ..engine import InputError, core
from ..job.tolerances import colour_scale
from . import preferences
from .fields import field_of
from .kinds import DocumentObject, Field, Limits, MeshShape, Scale
from .properties import Output, add_outputs
from .proxy import Proxy

DEVIATION, UNCERTAINTY = "deviation", "uncertainty"
MEASURED, DIFFERENCE = (
    "measured",
    "difference",
)  # of a scan: its height, and that less the predicted
TEMPERATURE, ROUGHNESS = "temperature", "roughness"
SHOWN = [DEVIATION, UNCERTAINTY, MEASURED, DIFFERENCE, TEMPERATURE, ROUGHNESS]
BY_HAND, BY_TOLERANCE, BY_PERCENTILE = "by hand", "by tolerance", "by percentile"
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
MOST_BANDS = 20
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
                "temperature: the greatest, of a job with Heat; roughness: Ra, of a job with Finish"
            )
            obj.addProperty("App::PropertyEnumeration", "ColourBy", "Deviation", text)
            obj.ColourBy = SHOWN
        if obj.getEnumerationsOfProperty("ColourBy") != SHOWN:  # an older file's
            before = obj.ColourBy
            obj.ColourBy = SHOWN
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
        shown = [*scale, obj.ColourBy, *bounds, chosen and list(chosen), scanned]
        before = json.loads(obj.Shown or "[null, null]")
        if before == [result, shown]:
            return
        field = field_of(simulation)
        if field is None:
            raise InputError(
                "objects.no_field",
                "{object}: its height field is missing; simulate again",
                object=simulation.Label,
            )
        show(obj, field, scale, before[0] != result)
        obj.Shown = json.dumps([result, shown], allow_nan=False)


def _round_up(value: float) -> float:
    """The next of 1, 2, 5, 10... above a value."""
    if value <= 0.0:
        return 0.001
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= 0.999 * value)


def bounded(obj: DocumentObject, field: Field, scale: Scale) -> Scale:
    """``scale`` with the end of the ramps as the object's ``Bounds`` say, outside of the tolerance."""
    lower, upper, limit = scale
    widest = max(abs(lower), abs(upper))
    if obj.Bounds == BY_TOLERANCE:
        limit = obj.TimesTolerance * widest
    elif obj.Bounds == BY_PERCENTILE:
        limit = percentile(field, obj.Percentile)
    return lower, upper, max(limit, 1.01 * widest, 1e-4)


def percentile(field: Field, share: float) -> float:
    """|deviation| in mm that ``share`` percent of the area lie within; missed samples are left out."""
    found = (field.flags & core.MISSED) == 0
    height, area = np.abs(field.height[found]), field.areas[found].astype(float)
    if not len(height):
        return 0.0
    order = np.argsort(height)
    so_far = np.cumsum(area[order])
    k = np.searchsorted(so_far, np.clip(share, 0.0, 100.0) / 100.0 * so_far[-1])
    return float(height[order[min(k, len(order) - 1)]])


def scan_heights(obj: DocumentObject, field: Field) -> Floats:
    """(n,) what a scan's colour mode shows, mm; NaN where the scan has nothing."""
    measured = np.array(field.measured, dtype=float)
    return measured if obj.ColourBy == MEASURED else measured - field.height


def bands_of(obj: DocumentObject) -> int:
    """The steps of each ramp; 0: none."""
    return min(max(obj.Bands, 0), MOST_BANDS)


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


def temperature_span(obj: DocumentObject) -> float:
    """K between the ends of the temperature's colours."""
    return max(obj.GreatestTemperature - obj.StartTemperature, 1.0)


def _show_temperatures(obj: DocumentObject, field: Field) -> None:
    stored = json.loads(getattr(obj.Simulation, "VerdictData", "") or "{}")
    heat = stored.get("verdict", {}).get("heat") if field.heat is not None else None
    obj.StartTemperature = heat["start_C"] if heat else 0.0
    obj.GreatestTemperature = heat["worst"]["temperature_C"] if heat else 0.0
    obj.GreatestTemperatureAtMost = heat["worst"]["greatest_C"] if heat else 0.0
    obj.BurntArea = 100.0 * (heat["burnt_share"] or 0.0) if heat else 0.0


def roughness_of(field: Field) -> Floats:
    """(n,) Ra of every sample, µm; NaN where it is not known."""
    return np.array(field.finish["roughness"], dtype=float)


def _roughness_colours(obj: DocumentObject, field: Field) -> Array:
    values = roughness_of(field)
    unknown = np.isnan(values)
    colours = core.magnitude_colours(np.nan_to_num(values), field.flags, roughness_span(obj))
    colours[unknown] = core.colour_scale(-1.0, 1.0, 2.0, [np.nan])[0]
    return colours


def roughness_span(obj: DocumentObject) -> float:
    """µm at which the roughness' colours end."""
    return max(obj.GreatestRoughness, 1e-3)


def _show_finish(obj: DocumentObject, field: Field) -> None:
    stored = json.loads(getattr(obj.Simulation, "VerdictData", "") or "{}")
    finish = stored.get("verdict", {}).get("finish") if field.finish is not None else None
    spread = (finish or {}).get("Ra_um")
    crossed = (finish or {}).get("crossed_share")
    obj.GreatestRoughness = spread["max"] if spread else 0.0
    obj.MeanRoughness = spread["mean"] if spread else 0.0
    obj.RoughnessKnown = 100.0 * finish["known_share"] if finish else 0.0
    obj.CrossedArea = -1.0 if crossed is None else 100.0 * crossed


def show(obj: DocumentObject, field: Field, scale: Scale, new_mesh: bool = True) -> None:
    """Shows a core.HeightField. ``scale``: lower and upper limit, end of the ramps, mm."""
    scale = bounded(obj, field, scale)
    statistics = _statistics(field, scale[:2])
    sd = statistics.get("sd_p95", 0.0)
    obj.UncertaintyMean, obj.Uncertainty95 = statistics.get("sd_mean", 0.0), sd
    obj.ExpectedInTolerance = 100.0 * statistics.get("expected_in_tolerance_share", 0.0)
    limit = obj.UncertaintyLimit = _round_up(sd)
    _show_temperatures(obj, field)
    _show_finish(obj, field)
    if obj.ColourBy == UNCERTAINTY and len(field.height_sd):
        colours = core.uncertainty_colours(field, limit)
    elif obj.ColourBy in (MEASURED, DIFFERENCE) and len(field.measured):
        colours = core.height_colours(scan_heights(obj, field), field.flags, *scale)
    elif obj.ColourBy == TEMPERATURE and field.heat is not None:
        rise = np.array(field.heat["rise"], dtype=float)
        colours = core.magnitude_colours(rise, field.flags, temperature_span(obj))
    elif obj.ColourBy == ROUGHNESS and field.finish is not None:
        colours = _roughness_colours(obj, field)
    else:
        colours = core.deviation_colours(field, *scale, bands_of(obj), preferences.colours())
    obj.ToleranceLower, obj.ToleranceUpper, obj.ColourLimit = scale
    for name, key in STATISTICS.items():
        setattr(obj, name, statistics[key])
    for name, key in SHARES.items():
        setattr(obj, name, 100.0 * statistics[key])
    if new_mesh:  # an assignment to Mesh drops the colours: it comes first
        _lay_mesh(obj, field)
    obj.VertexColors = colours.tolist()
