"""Zones whose finish is not what they call for, or not known: an event each, made of the verdict on them, so that both say
the same.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias, TYPE_CHECKING, Any

from ..base.kinds import Json, known
from ..cell import motions as ways
from ..cell.events import kinds, momentary
from ..engine import core
from ..job.settings import Finish, Job, ZoneFinish
from ..job.typed import typed
from . import finish_zones
from .finish import SEEN, rest_per_pass

if TYPE_CHECKING:
    from ..cell.motions import Motions

ROUGH, LAY, UNKNOWN = "roughness_exceeded", "wrong_lay", "finish_unknown"  # kinds
# Of an event: its kind, value, limit, place (as ``finish.place`` has it) and facts.
Told: TypeAlias = "tuple[str, float, float, Json | None, list[core.Fact]]"
DIGITS = 6  # of a time, s: the same from the table of motions that a result keeps
REASONS = {  # of what is not known: (code, text) of a fact
    "not_computed": ("event.finish_not_computed", "no finish was computed"),
    "no_sample": ("event.finish_no_sample", "the zone holds no sample"),
    "no_pass": ("event.finish_no_pass", "mostly since no pass has touched it"),
    "no_model": ("event.finish_no_model", "mostly since no measurements are given"),
    "unsettled": (
        "event.finish_unsettled",
        "mostly since too much is left of what was before, which is not known",
    ),
    "pass_before": (
        "event.finish_pass_before",
        "mostly since too much is left of a pass before, which lay outside of what was measured",
    ),
    "no_direction": (
        "event.finish_no_direction",
        "mostly since the direction that is called for, or that of the belt, has no trace on the surface there",
    ),
    "no_rest": (
        "event.finish_no_rest",
        "since it is not known how much a pass leaves of the scratches before",
    ),
    "pressure": (
        "event.finish_pressure_outside",
        "mostly since the mean pressure of the last pass lies outside of what was measured",
    ),
    "belt_speed": (
        "event.finish_speed_outside",
        "mostly since the belt's speed in the last pass lies outside of what was measured",
    ),
    "feed": (
        "event.finish_feed_outside",
        "mostly since the feed of the last pass lies outside of what was measured",
    ),
    "belt_wear": (
        "event.finish_wear_outside",
        "mostly since the belt was worn further in the last pass, or less, than what was measured",
    ),
}


def renewed(
    events: Sequence[dict[str, Any]],
    job: Job | Json,
    zones: Sequence[Json],
    motions: Motions | None,
) -> list[dict[str, Any]]:
    """A list of events in which those of the finish are made anew, in order of time: of the ``zones`` of a verdict on a
    ``job``, (its ``inspection.zones``, its ``finish``). ``motions``: as ``motions.of_paths`` gives them; without their times
    there are no events of the finish.
    """
    job = typed(job)
    others = [event for event in events if event["kind"] not in (ROUGH, LAY, UNKNOWN)]
    if motions is None or not len(motions.get("time", ())):
        return others
    found = _of_zones(job, zones, motions)
    return sorted([*others, *found], key=lambda event: (event["program"], event["time"]))


def _of_zones(job: Job, zones: Sequence[Json], motions: Motions) -> list[dict[str, Any]]:
    asked = {zone.name: zone.finish for zone in job.inspection.zones if zone.finish is not None}
    known, found = kinds(), []
    for zone in zones:
        judged = zone.get("finish")
        for name, told in (("Ra", _of_roughness), ("lay", _of_lay)):
            one = judged and judged.get(name)
            if judged is None or one is None or one["verdict"] == "pass":
                continue
            event = (
                _of_unknown(zone["name"], judged["acceptance"], name, one)
                if one["verdict"] == "unknown"
                else told(job, zone["name"], judged["acceptance"], one, asked[zone["name"]])
            )
            found.append(_event(known, motions, *event))
    return found


def _event(
    known: Mapping[str, Json],
    motions: Motions,
    code: str,
    value: float,
    limit: float,
    place: Json | None,
    facts: Sequence[core.Fact],
) -> dict[str, Any]:
    """An event; ``place``: as ``finish.place`` has it, or None. Where no pass was it belongs to the end of all programs."""
    kind = known[code]
    if place is None or place["motion"] is None:
        last, line = len(motions["time"]) - 1, 0
        program, pose = int(motions["program"][last]), int(motions["pose"][last])
        time = float(motions["time"][last])
    else:
        motion = place["motion"]
        program, pose = int(motions["program"][motion]), int(motions["pose"][motion])
        line, time = int(motions["line"][motion]), ways.time_at(motions, motion, place["point_mm"])
    event = momentary(
        kind,
        code,
        facts,
        time=round(time, DIGITS),
        pose=pose,
        line=line,
        value=float(value),
        limit=float(limit),
        point=None if place is None else place["point_mm"],
        face=None if place is None else place["face"],
    )
    return {"program": program, **event}


def _of_roughness(job: Job, zone: str, acceptance: str, judged: Json, asked: ZoneFinish) -> Told:
    worst = judged["worst"]
    facts = [
        core.Fact(
            "event.roughness_exceeded",
            "zone '{zone}': Ra {worst:.3g} µm where {limit:.3g} µm are called for ({acceptance}); {percent:.3g} % of its "
            "area are above",
            zone=zone,
            worst=worst["Ra_um"],
            limit=judged["limit_um"],
            acceptance=acceptance,
            percent=100.0 * judged["above_share"],
        )
    ]
    if judged["untouched_share"] > 0.0:
        facts.append(
            core.Fact(
                "event.finish_untouched",
                "no pass has touched {percent:.3g} % of it",
                percent=100.0 * judged["untouched_share"],
            )
        )
    return ROUGH, worst["Ra_um"], judged["limit_um"], worst, facts


def _of_lay(job: Job, zone: str, acceptance: str, judged: Json, asked: ZoneFinish) -> Told:
    facts = [
        core.Fact(
            "event.wrong_lay",
            "zone '{zone}': on {percent:.3g} % of its area the scratches are not as called for ({symbol}, {acceptance})",
            zone=zone,
            percent=100.0 * judged["off_share"],
            symbol=judged["symbol"],
            acceptance=acceptance,
        ),
        _why_wrong(known(job.finish), judged, asked),
    ]
    limit = 100.0 * finish_zones.allowed_share(acceptance)
    return LAY, 100.0 * judged["off_share"], limit, judged["worst"], facts


def _why_wrong(given: Finish, judged: Json, asked: ZoneFinish) -> core.Fact:
    """What is wrong at the worst place."""
    angle, crossing = judged["worst"]["angle_deg"], judged["worst"]["crossing_deg"]
    if judged["symbol"] not in finish_zones.CROSSED:
        if angle > asked.lay_tolerance_deg:
            return core.Fact(
                "event.lay_turned",
                "at worst they lie {angle:.1f}° off, {limit:.3g}° are allowed",
                angle=angle,
                limit=asked.lay_tolerance_deg,
            )
        return core.Fact(
            "event.lay_crossed",
            "at worst those of the pass before cross them by {angle:.1f}°",
            angle=crossing,
        )
    if crossing is None:
        return core.Fact("event.lay_one_way", "at worst all run one way, that of a single pass")
    rest = rest_per_pass(given)
    assert rest is not None  # else it is not known whether they are crossed
    if rest < SEEN:
        return core.Fact(
            "event.lay_worn_off",
            "of the pass before {percent:.3g} % stay, too little to be seen ({least:.3g} %)",
            percent=100.0 * rest,
            least=100.0 * SEEN,
        )
    return core.Fact(
        "event.lay_not_crossed",
        "at worst they cross by {angle:.1f}°, {limit:.3g}° are asked for",
        angle=crossing,
        limit=given.crossing_angle_deg,
    )


def _of_unknown(zone: str, acceptance: str, name: str, judged: Json) -> Told:
    """Of what is not known. So much as is beyond already is not left to be unknown."""
    beyond = judged["above_share" if name == "Ra" else "off_share"]
    left = finish_zones.allowed_share(acceptance) - beyond
    percent = 100.0 * judged["unknown_share"]
    if name == "Ra":
        fact = core.Fact(
            "event.roughness_unknown",
            "zone '{zone}': whether Ra keeps to {limit:.3g} µm ({acceptance}) is not known on {percent:.3g} % of its area",
            zone=zone,
            limit=judged["limit_um"],
            acceptance=acceptance,
            percent=percent,
        )
    else:
        fact = core.Fact(
            "event.lay_unknown",
            "zone '{zone}': whether the scratches are as called for ({symbol}, {acceptance}) is not known on "
            "{percent:.3g} % of its area",
            zone=zone,
            symbol=judged["symbol"],
            acceptance=acceptance,
            percent=percent,
        )
    why = judged["unknown"]
    facts = [fact, core.Fact(*REASONS[why["reason"]])]
    return UNKNOWN, percent, 100.0 * left, why["place"], facts
