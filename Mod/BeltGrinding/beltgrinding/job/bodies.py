"""The bodies of a job's cell, ``cell.bodies`` of job.schema.json, and the names that every cell has."""

from __future__ import annotations

from collections.abc import Sequence

from ..base.files import either
from ..base.kinds import Json
from ..engine import InputError
from ..geometry.body_names import ARMS, FORK, LINKS, PART, PLATE, ROLLERS, RUNS, STOCK, WHEEL
from . import machine as machines

OF_KIND = {  # names of a belt machine's own bodies, beside the wheel
    machines.FREE_BELT: (*ROLLERS, *RUNS, ARMS),
    machines.PLATEN: (*ROLLERS, PLATE, *RUNS, ARMS),
    machines.SMALL_WHEEL: (*RUNS, FORK),
}
RESERVED = (PART, STOCK, WHEEL, *LINKS)  # names of the bodies that every cell has


def validate(bodies: Sequence[Json], more: Sequence[str] = ()) -> None:
    """Raises InputError for what the schema cannot say of a job's bodies. ``more``: names that are taken besides."""
    names = [*RESERVED, *more]
    for i, body in enumerate(bodies):
        if ("file" in body) == ("brep" in body):
            raise InputError(
                "base.exactly_one",
                "{key}: give exactly one of {choices}",
                key=f"cell.bodies.{i}",
                choices=either("file", "brep"),
            )
        if body["name"] in names:
            raise InputError(
                "job.body_name_taken",
                "{key}: the name '{name}' is taken; give another",
                key=f"cell.bodies.{i}",
                name=body["name"],
            )
        names.append(body["name"])
