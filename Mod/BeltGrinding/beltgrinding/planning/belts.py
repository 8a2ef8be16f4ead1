"""Belts by the names that a person gives: a preset's, such as P80, with a calibrated law of its own where there is one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..base import schemas
from ..base.kinds import Facts, Json
from ..engine import Fact, InputError
from ..job import load as jobs
from ..presets import library

GRIT = re.compile(r"p?(\d+)")


class Belt(NamedTuple):
    """A belt for a job."""

    name: str
    preset: dict[str, Any]
    grit: float | None  # in the unit of the finish model's
    law: dict[str, Any] | None  # its own, None: the job's


def given(text: str) -> list[Belt]:
    """Such as P80=law80.json,P240: names of presets, and files that ``beltgrind calibrate`` wrote. Raises InputError."""
    found = []
    for part in text.split(","):
        name, _, file = (piece.strip() for piece in part.partition("="))
        preset = library.find("belts", name.lower())
        number = GRIT.fullmatch(preset["id"])
        grit = float(number[1]) if number else None
        if grit is None and "grit" in preset:
            grit = library.middle(preset["grit"])
        found.append(Belt(name, preset, grit, _law(Path(file)) if file else None))
    names = [one.name.lower() for one in found]
    if len(set(names)) < len(names):
        raise InputError("planning.belt_twice", "'{given}' names a belt twice", given=text)
    return found


def _law(file: Path) -> dict[str, Any]:
    rules = {**jobs.schema()["properties"]["law"], "definitions": jobs.schema()["definitions"]}
    law: dict[str, Any] = schemas.checked_file(file, rules)
    return law


def mounted(job: Json, belt: Belt) -> dict[str, Any]:
    """The validated job with a fresh belt: its tension and stiffness, its law, and its grit for the finish. Validated. Raises
    InputError."""
    found = library.apply(job, belt=belt.preset)
    found["belt_machine"] = {**found["belt_machine"]}
    found["belt_machine"].pop("belt", None)
    if belt.law is not None:
        found["law"] = belt.law
    if belt.grit is not None and found.get("finish") is not None:
        found["finish"] = {**found["finish"], "grit": belt.grit}
    return jobs.validate(found, "/")


def notes(job: Json, belts: Sequence[Belt]) -> Facts:
    """What is not known of belts for a validated job."""
    without = [one.name for one in belts if one.law is None]
    told: Facts = []
    if without:
        told.append(
            Fact(
                "planning.belt_law",
                "{belts}: no calibrated law of their own; the job's law grinds for them (beltgrind calibrate writes one, "
                "then --belts {first}=law.json)",
                belts=", ".join(without),
                first=without[0],
            )
        )
    model = (job.get("finish") or {}).get("model")
    if len(without) > 1 and not model:
        told.append(
            Fact(
                "planning.belts_alike",
                "{belts} differ in nothing that is known: the job has no finish.model, so a finer belt brings nothing here",
                belts=", ".join(without),
            )
        )
    return told
