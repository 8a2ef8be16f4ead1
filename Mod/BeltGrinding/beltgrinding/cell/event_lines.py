"""The events of a run in a few lines: one for each kind, how often, and where it is worst."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.kinds import Json
from ..engine import Fact
from ..job.poses import program_name
from ..job.settings import Job
from ..job.typed import typed
from . import events

if TYPE_CHECKING:
    from ..engine import core

RAPID = "_rapid"  # ends the code of a fact that tells of a rapid motion


def lines(found: Sequence[Json], job: Job | Json) -> list[tuple[str, core.Fact]]:
    """[(severity, Fact)] of events (dicts, as events.json has them), errors first, else in the order of the
    manual; a kind in rapid motions is a line of its own, before that in feed motions. ``job``: as data.
    """
    job = typed(job)
    kinds = events.kinds()
    groups: dict[tuple[str, bool], list[dict[str, Any]]] = {}
    for event in events.complete(found):
        groups.setdefault((event["kind"], _rapid(event)), []).append(event)
    order = list(kinds)

    def place(key: tuple[str, bool]) -> tuple[Any, ...]:
        kind, rapid = key
        severity = groups[key][0]["severity"]
        return (
            events.SEVERITIES.index(severity) if severity in events.SEVERITIES else 1,
            order.index(kind) if kind in kinds else len(order),
            not rapid,
        )

    return [
        (groups[key][0]["severity"], _line(groups[key], kinds.get(key[0], {}), job))
        for key in sorted(groups, key=place)
    ]


def _rapid(event: Json) -> bool:
    return any(fact["code"].endswith(RAPID) for fact in event["facts"])


def _line(group: Sequence[Json], kind: Json, job: Job) -> core.Fact:
    larger = kind.get("larger_is_worse", True)
    worst = (max if larger else min)(group, key=lambda event: event["value"])
    told = {"kind": worst["kind"], "told": _told(worst), "place": _place(worst, job)}
    if len(group) == 1:
        return Fact("cell.event_once", "{kind}: {place}: {told}", **told)
    return Fact(
        "cell.event_often",
        "{kind}, {count} times, the worst: {place}: {told}",
        count=len(group),
        **told,
    )


def _told(event: Json) -> core.Fact | str:
    """What happened, as one Fact or a sentence of an older result."""
    facts = event["facts"]
    if not facts:
        return event["message"]
    first = facts[0]
    return Fact(first["code"], first["text"], **first["arguments"])


def _place(event: Json, job: Job) -> core.Fact:
    program = Path(program_name(job, event["program"])).name
    if event["line"]:
        return Fact(
            "cell.at_line", "{program}, line {number}", program=program, number=event["line"]
        )
    return Fact(
        "cell.at_pose", "{program}, pose {number}", program=program, number=event["pose"] + 1
    )
