"""Whether a ground part is as wanted, in one line: what the commands that grind end with."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from ..base.kinds import Json
from ..cell import events as event_lists
from ..engine import Fact
from . import finish_zones

COUNTED = ("gouge", "collision")  # always told; of other errors, those that there are


class Outcome(NamedTuple):
    """``passed``: the verdict passes and no event is an error. ``told``: the line. ``errors``: events that are errors, by their
    kind."""

    passed: bool
    told: Fact
    errors: dict[str, int]


def outcome(verdict: Json, events: Sequence[Json], wanted: float = 1.0) -> Outcome:
    """The ``Outcome`` of a result by its ``verdict`` and its ``events`` (as verdict.json and events.json have them).
    ``wanted``: share of the inspected area that must be in tolerance; 1: the verdict's own rule, no sample out of it. A
    run at coarse resolution never passes."""
    counts = {kind: 0 for kind in COUNTED}
    for event in event_lists.complete(events):
        if event["severity"] == "error":
            counts[event["kind"]] = counts.get(event["kind"], 0) + 1
    why = _why(verdict, wanted)
    errors = dict(counts)
    passed = not any(counts.values()) and not why and _enough(verdict, wanted)
    told = _found(verdict, wanted)
    told = Fact(
        "inspection.and_gouges", "{found}; {gouges}", found=told, gouges=_gouges(counts["gouge"])
    )
    more = [_collisions(counts.pop("collision"))]
    del counts["gouge"]
    more += [
        Fact("inspection.errors_of_kind", "{count} times {kind}", count=count, kind=kind)
        for kind, count in counts.items()
    ]
    for one in more + why:
        told = Fact("inspection.one_and_other", "{one}, {other}", one=told, other=one)
    if passed:
        return Outcome(True, Fact("inspection.passed", "PASS: {found}", found=told), errors)
    return Outcome(False, Fact("inspection.failed", "FAIL: {found}", found=told), errors)


def as_json(verdict: Json, found: Outcome) -> dict[str, Any]:
    """An ``Outcome`` and the shares of the area that it is about, for programs."""
    worst = verdict["worst"]
    return {
        "pass": found.passed,
        "in_tolerance": verdict["in_share"],
        "above": verdict["above_share"],
        "below": verdict["below_share"],
        "worst": None if worst is None else {k: worst[k] for k in ("value_mm", "point_mm")},
        "errors": found.errors,
        "message": str(found.told),
    }


def _enough(verdict: Json, wanted: float) -> bool:
    if wanted >= 1.0:
        return bool(verdict["overall"] == "pass")
    return bool(verdict["in_share"] >= wanted)


def _why(verdict: Json, wanted: float) -> list[Fact]:
    """What the share in tolerance does not tell."""
    zones = verdict["zones"]
    found = []
    if verdict.get("resolution") == "coarse":
        found.append(Fact("inspection.coarse", "coarse resolution, no verdict"))
    if verdict["missed_rays"] or any(zone["worst"] is None for zone in zones):
        found.append(Fact("inspection.not_all_inspected", "not everything could be inspected"))
    if any((zone["thickness"] or {}).get("verdict", "pass") != "pass" for zone in zones):
        found.append(Fact("inspection.thickness_out", "the thickness not in tolerance"))
    if any(
        (one or {}).get("verdict", "pass") != "pass"
        for zone in zones
        for one in (zone.get("finish") or {}).values()
        if isinstance(one, dict)
    ):
        found.append(Fact("inspection.finish_out", "the finish not as called for"))
    return found


def _found(verdict: Json, wanted: float) -> Fact:
    share = Fact("inspection.all_wanted", "all wanted")
    if wanted < 1.0:
        share = Fact("inspection.share_wanted", "at least {share:g} wanted", share=100.0 * wanted)
    percent = 100.0 * verdict["in_share"]
    if verdict["above_share"] + verdict["below_share"] > 0.0:
        percent = min(percent, 99.9)  # what is not all in tolerance is never told as 100.0 %
    worst = verdict["worst"]
    if worst is None:
        return Fact(
            "inspection.none_seen",
            "{share:.1f} % in tolerance ({wanted})",
            share=percent,
            wanted=share,
        )
    x, y, z = worst["point_mm"]
    return Fact(
        "inspection.share_and_worst",
        "{share:.1f} % in tolerance ({wanted}), worst {worst:+.3f} mm at {x:.1f} {y:.1f} {z:.1f}",
        share=percent,
        wanted=share,
        worst=worst["value_mm"],
        x=x,
        y=y,
        z=z,
    )


def _gouges(count: int) -> Fact:
    if count == 1:
        return Fact("inspection.one_gouge", "1 gouge")
    return Fact("inspection.gouges", "{count} gouges", count=count)


def _collisions(count: int) -> Fact:
    if count == 1:
        return Fact("inspection.one_collision", "1 collision")
    return Fact("inspection.collisions", "{count} collisions", count=count)
