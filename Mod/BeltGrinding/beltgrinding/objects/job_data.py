"""The settings of a job in the document, its children, and the faces that it grinds."""

from __future__ import annotations

import json
from collections.abc import ItemsView, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import Part

from ..base import schemas
from ..base.kinds import Json
from ..engine import InputError
from ..job import load as loads, tolerances
from .geometry import placed_shape
from .kinds import DocumentObject, Links, PartShape
from .properties import Key, rule, to_job
from .proxy import type_of

if TYPE_CHECKING:
    from .proxy import Proxy

KEYS = (
    Key("FlipNormals", "Bool", "Design", "design.flip_normals"),
    Key("Spacing", "Length", "Sampling", "sampling.spacing_mm"),
    Key("Precision", "Length", "Sampling", "sampling.precision_mm"),
    Key("EdgeSpacing", "Length", "Sampling", "sampling.edge_spacing_mm"),
    Key("Depth", "Length", "Sampling", "sampling.depth_mm"),
    Key("ToleranceLower", "Distance", "Tolerance", "inspection.tolerance_mm.0"),
    Key("ToleranceUpper", "Distance", "Tolerance", "inspection.tolerance_mm.1"),
    Key("ColourLimit", "Length", "Tolerance", "inspection.colour_limit_mm"),
    Key("Zones", "JSON", "Tolerance", "inspection.zones"),
    Key("Sections", "JSON", "Tolerance", "inspection.sections"),
    Key("Law", "Enumeration", "Law", "law.model"),
    Key("LawCoefficient", "Float", "Law", "law.coefficient_mm2_per_N"),
    Key("PressureThreshold", "Pressure", "Law", "law.pressure_threshold_MPa"),
    Key("PressureExponent", "Float", "Law", "law.pressure_exponent"),
    Key("ReferencePressure", "Pressure", "Law", "law.reference_pressure_MPa"),
    Key("SaturationPressure", "Pressure", "Law", "law.saturation_pressure_MPa"),
    Key("SpeedExponent", "Float", "Law", "law.speed_exponent"),
    Key("ReferenceSpeed", "Speed", "Law", "law.reference_speed_m_s", 1000.0),
    Key("FeedExponent", "Float", "Law", "law.feed_exponent"),
    Key("ReferenceFeed", "Speed", "Law", "law.reference_feed_mm_s"),
    Key("LandShare", "Float", "Law", "law.land_share"),
    Key("PressureCurve", "VectorList", "Law", "law.pressure_curve"),
    Key("SpeedCurve", "VectorList", "Law", "law.speed_curve"),
    Key("FeedCurve", "VectorList", "Law", "law.feed_curve"),
    Key("LandCurve", "VectorList", "Law", "law.land_curve"),
    Key("HeatLimit", "Float", "Law", "law.heat_limit_MPa_m_s"),
    Key("Heat", "JSON", "Law", "heat"),
    Key("Finish", "JSON", "Law", "finish"),
    Key("PressureLimit", "Pressure", "Law", "law.pressure_limit_MPa"),
    Key("Calibration", "JSON", "Law", "law.calibration"),
    Key("WearModel", "Enumeration", "Wear", "law.wear.model"),
    Key("WearVariable", "Enumeration", "Wear", "law.wear.variable"),
    Key("WearScale", "Float", "Wear", "law.wear.scale"),
    Key("WearRest", "Float", "Wear", "law.wear.rest"),
    Key("WearFirstShare", "Float", "Wear", "law.wear.first_share"),
    Key("WearFirstScale", "Float", "Wear", "law.wear.first_scale"),
    Key("WearExponent", "Float", "Wear", "law.wear.exponent"),
    Key("LoadingShare", "Float", "Wear", "law.wear.loading_share"),
    Key("LoadingScale", "Float", "Wear", "law.wear.loading_scale"),
    Key("LoadingRecovery", "Float", "Wear", "law.wear.loading_recovery_s"),
    Key("DressingRest", "Float", "Wear", "law.wear.dressing_rest"),
    Key("WearCurve", "VectorList", "Wear", "law.wear.curve"),
    Key("Resolution", "Enumeration", "Steps", "resolution.mode"),
    Key("MaxTravel", "Length", "Steps", "simulation.max_travel_mm"),
    Key("MaxAngle", "Angle", "Steps", "simulation.max_angle_deg"),
    Key("OrientationJump", "Angle", "Steps", "simulation.orientation_jump_deg"),
    Key("TiltLimit", "Angle", "Steps", "simulation.tilt_limit_deg"),
    Key("Timing", "Enumeration", "Timing", "simulation.timing"),
    Key("PathAcceleration", "Acceleration", "Timing", "simulation.path_acceleration_mm_s2"),
    Key("AngularAcceleration", "Float", "Timing", "simulation.angular_acceleration_deg_s2"),
    Key("RotationSpeed", "Float", "Timing", "simulation.rotation_speed_deg_s"),
    Key("DefaultZone", "Length", "Timing", "simulation.default_zone_mm"),
)


def children(job: DocumentObject, proxy: type[Proxy]) -> list[DocumentObject]:
    """The job's children of a proxy class, in the tree's order."""
    return [obj for obj in job.Group if type_of(obj) == proxy.TYPE]


def child(job: DocumentObject, proxy: type[Proxy]) -> DocumentObject | None:
    """The job's first child of a proxy class, or None."""
    return next(iter(children(job, proxy)), None)


def required(job: DocumentObject, proxy: type[Proxy], what: str) -> DocumentObject:
    """The job's child of a proxy class. Raises InputError."""
    found = child(job, proxy)
    if found is None:
        raise InputError(
            "objects.lacks", "{object} has no {what}; add one", object=job.Label, what=what
        )
    return found


def inspection(job: DocumentObject) -> dict[str, Any]:
    """The part of a job under 'inspection'."""
    data: dict[str, Any] = {}
    to_job(job, KEYS, data)
    return data["inspection"]


def judged_by(given: Json) -> dict[str, Any]:
    """What a verdict takes of an ``inspection``; without sections as documents of 0.3 have it."""
    found = {key: given.get(key, []) for key in ("tolerance_mm", "zones")}
    return {**found, **({"sections": given["sections"]} if given.get("sections") else {})}


def set_sections(job: DocumentObject, found: Sequence[Json]) -> None:
    """Gives a job sections for its verdict. Raises InputError, and leaves the old ones, for wrong ones."""
    found = schemas.checked(list(found), rule("inspection.sections")[0], "sections")
    job.Sections = json.dumps(found, allow_nan=False) if found else ""


def zones(job: DocumentObject) -> list[dict[str, Any]]:
    """The tolerance zones of a job, as its key inspection.zones has them."""
    return inspection(job)["zones"]


def set_zones(job: DocumentObject, found: Sequence[Json]) -> None:
    """Gives a job tolerance zones. Raises InputError, and leaves the old ones, for wrong ones."""
    found = schemas.checked(list(found), rule("inspection.zones")[0], "zones")
    tolerances.check_zones(found, design(job)[1], bool(job.Finish))
    job.Zones = json.dumps(found, allow_nan=False) if found else ""


def finish_model(path: Path | str) -> dict[str, Any]:
    """A job's ``finish.model`` of the file that ``beltgrind calibrate-finish`` wrote. Raises InputError that names the
    file.
    """
    found = schemas.read_json(Path(path))
    try:
        found = schemas.checked(found, rule("finish.model")[0], "model")
        loads.check_finish({"grit": found["reference_grit"], "model": found})
    except InputError as error:
        raise InputError(
            "objects.no_finish_model",
            "{file}: is no measured roughness as beltgrind calibrate-finish writes it: {reason}",
            file=path,
            reason=error,
        ) from None
    return found


def design(job: DocumentObject) -> tuple[PartShape, list[int]]:
    """(shape, numbers of its faces from 1) in the document's coordinates. Raises InputError.

    Several objects become one compound, whose faces are numbered through.
    """
    return shape_of(job.DesignFaces, job.Label)


def shape_of(links: Links, label: str) -> tuple[PartShape, list[int]]:
    """(shape, numbers of its faces from 1) of a list of (object, face names), as ``design`` gives
    them; ``label`` stands for its owner. Raises InputError.
    """
    if not links:
        raise InputError(
            "objects.no_faces_chosen",
            "{object}: no faces are chosen; select faces and add them to the job",
            object=label,
        )
    shapes, numbers, offset = [], [], 0
    for obj, subs in _by_object(links):
        shape = placed_shape(obj)
        count = len(shape.Faces)
        if count == 0:
            raise InputError(
                "objects.no_faces", "{object}: {part} has no faces", object=label, part=obj.Label
            )
        for number in _face_numbers(label, obj, subs, count):
            if number + offset not in numbers:
                numbers.append(number + offset)
        shapes.append(shape)
        offset += count
    return (shapes[0] if len(shapes) == 1 else Part.Compound(shapes)), sorted(numbers)


def face_numbers(job: DocumentObject, obj: DocumentObject, subs: Sequence[str]) -> list[int]:
    """Numbers from 1, as ``design`` has them, of faces of one of the job's objects; none of another
    object. Raises InputError.
    """
    return _numbers_in(job.DesignFaces, job.Label, obj, subs)


def flipped_faces(job: DocumentObject, links: Links | None = None) -> list[int]:
    """Numbers from 1 of the faces that the job flips, as ``shape_of(links)`` has them (default: as
    ``design``). Raises InputError.
    """
    links, numbers = job.DesignFaces if links is None else links, set()
    for obj, subs in _by_object(job.FlipFaces):
        numbers.update(_numbers_in(links, job.Label, obj, subs))
    return sorted(numbers)


def flips(job: DocumentObject, links: Links | None = None) -> dict[str, list[int]]:
    """The key design.flip_faces of a job; nothing where there are none."""
    numbers = flipped_faces(job, links)
    return {"flip_faces": numbers} if numbers else {}


def _numbers_in(links: Links, label: str, obj: DocumentObject, subs: Sequence[str]) -> list[int]:
    offset = 0
    for one, _ in _by_object(links):
        count = len(one.Shape.Faces)
        if one == obj:
            return [number + offset for number in _face_numbers(label, obj, subs, count)]
        offset += count
    return []


def face_name(job: DocumentObject, index: int) -> str:
    """Object.FaceN of the face that ``design`` numbers ``index`` + 1, '' if the job no longer has
    it."""
    for obj, _ in _by_object(job.DesignFaces):
        count = len(obj.Shape.Faces)
        if index < count:
            return f"{obj.Label}.Face{index + 1}"
        index -= count
    return ""


def _by_object(links: Links) -> ItemsView[DocumentObject, list[str]]:
    merged: dict[DocumentObject, list[str]] = {}
    for obj, subs in links:
        merged.setdefault(obj, []).extend([subs] if isinstance(subs, str) else subs)
    return merged.items()


def _face_numbers(
    label: str, obj: DocumentObject, subs: Sequence[str], count: int
) -> Sequence[int]:
    names = [sub.rpartition(".")[2] for sub in subs]
    if not any(names):
        return range(1, count + 1)
    numbers = []
    for name in names:
        if not (name.startswith("Face") and name[4:].isdigit()):
            raise InputError(
                "objects.no_face",
                "{object}: {part}.{name} is no face; choose faces",
                object=label,
                part=obj.Label,
                name=name or "(all)",
            )
        if not 1 <= int(name[4:]) <= count:
            raise InputError(
                "objects.no_such_face",
                "{object}: {part} has no {name}; it has {count} faces. Choose them again",
                object=label,
                part=obj.Label,
                name=name,
                count=count,
                face=int(name[4:]),
            )
        numbers.append(int(name[4:]))
    return numbers
