"""The tolerances of a job: their check, their colours, the narrowest of them."""

from __future__ import annotations

from collections.abc import Sequence

from ..base import records
from ..base.kinds import Json
from ..engine import InputError
from .settings import Inspection, Job
from .typed import typed


def narrowest_band(inspection: Inspection | Json) -> tuple[float, float]:
    """(lower, upper) of the narrowest tolerance of a job's ``inspection``, mm."""
    inspection = records.made(Inspection, inspection)
    bands = [inspection.tolerance_mm]
    bands += [zone.tolerance_mm for zone in inspection.zones or () if zone.tolerance_mm]
    return min(bands, key=lambda band: band[1] - band[0])


NEEDED = {"=": "lay_direction", "⊥": "lay_direction", "C": "lay_centre_mm", "R": "lay_centre_mm"}


def _check_finish(asked: Json, where: str, finish: bool) -> None:
    """Of a zone; ``finish``: whether the job computes any."""
    if not finish:
        raise InputError(
            "job.zone_without_finish",
            "{key}: the job computes no finish; give it the key 'finish'",
            key=where,
        )
    symbol = asked.get("lay")
    if symbol is None and "Ra_max_um" not in asked:
        raise InputError(
            "job.zone_finish_empty", "{key}: give it the key 'Ra_max_um', 'lay' or both", key=where
        )
    if symbol == "P":
        raise InputError(
            "job.lay_particulate",
            "{key}: a particulate lay (P) has no direction, and a belt scratches along one",
            key=where,
        )
    needed = NEEDED.get(symbol) if symbol else None
    if needed is not None and needed not in asked:
        raise InputError(
            "job.lay_incomplete",
            "{key}: the lay {symbol} needs the key {needed}",
            key=where,
            symbol=symbol,
            needed=needed,
        )
    if needed == "lay_direction" and not any(asked[needed]):
        raise InputError("job.lay_direction", "{key}.lay_direction: all of it is zero", key=where)


def check_zones(zones: Sequence[Json], faces: Sequence[int], finish: bool = False) -> None:
    """Raises InputError for tolerance zones that cannot be; ``faces``: those that are ground, numbered
    from 1, none for all; ``finish``: whether the job computes any.
    """
    ground, names = set(faces), set()
    for i, zone in enumerate(zones):
        where = f"inspection.zones[{i}]"
        if zone["name"] in names:
            raise InputError(
                "job.zone_name_taken",
                "{key} '{name}': another zone has this name already; give it another",
                key=where,
                name=zone["name"],
            )
        names.add(zone["name"])
        for key in ("tolerance_mm", "thickness_mm"):
            lower, upper = zone.get(key, (0.0, 0.0))
            if lower > upper:
                raise InputError(
                    "job.zone_limits_swapped",
                    "{key} '{name}'.{limits}: the lower limit lies above the upper one",
                    key=where,
                    name=zone["name"],
                    limits=key,
                )
        if not any(key in zone for key in ("tolerance_mm", "thickness_mm", "finish")):
            raise InputError(
                "job.zone_without_limits",
                "{key} '{name}': give it the key 'tolerance_mm', 'thickness_mm' or 'finish'",
                key=where,
                name=zone["name"],
            )
        if "finish" in zone:
            _check_finish(zone["finish"], f"{where} '{zone['name']}'.finish", finish)
        for face in zone.get("faces", []):
            if ground and face not in ground:
                raise InputError(
                    "job.zone_face_not_ground",
                    "{key} '{name}'.faces: face {face} is not ground; see design.faces",
                    key=where,
                    name=zone["name"],
                    face=face,
                )


def colour_scale(job: Job | Json) -> tuple[float, float, float]:
    """(lower, upper, limit) of the job's colours, mm; the limit lies outside of the band."""
    job = typed(job)
    lower, upper = job.inspection.tolerance_mm
    limit = max(job.inspection.colour_limit_mm, 1.01 * max(abs(lower), abs(upper)))
    return lower, upper, limit
