"""A verdict in a line or two, in the language of the window."""

from __future__ import annotations

from ...inspection import finish_zones
from .compat import translate
from .kinds import Json


def headline(found: Json) -> str:
    """The verdict in one line; that of a coarse run says so."""
    text = _word(found)
    if found.get("resolution") == "coarse":
        text = translate("BeltGrinding", "{} (coarse)").format(text)
    return text


def _word(found: Json) -> str:
    if found["overall"] == "pass":
        return translate("BeltGrinding", "In tolerance")
    zones = finish_zones.decides(found)
    if zones and found["overall"] == "fail":
        return translate(
            "BeltGrinding", "In tolerance, but the finish is not as called for: {} of {} zones"
        ).format(zones, sum(bool(one.get("finish")) for one in found["zones"]))
    if zones:
        return translate("BeltGrinding", "In tolerance, but the finish of a zone is not known")
    if found["overall"] == "unknown":
        return translate("BeltGrinding", "Cannot be told: not everything was inspected")
    bad = sum(one["verdict"] == "fail" for one in found["faces"])
    text = translate("BeltGrinding", "Not in tolerance: {} of {} faces").format(
        bad, len(found["faces"])
    )
    if bad == 0:
        text = translate("BeltGrinding", "Not in tolerance")
    return text


def shares(found: Json) -> str:
    """How much of the area lies in tolerance, and on which side the rest."""
    return translate(
        "BeltGrinding", "{:.2f} % in tolerance, {:.2f} % too much left, {:.2f} % cut too deep"
    ).format(100 * found["in_share"], 100 * found["above_share"], 100 * found["below_share"])
