"""The bodies of a job's cell, ``cell.bodies`` of job.schema.json, and the names that every cell has."""

from ..base.files import either
from ..engine import InputError
from ..presets.robot_shape import LINKS
from . import fork, free_run, machine as machines

PART, STOCK, WHEEL = "part", "stock", "wheel"
ROLLERS, PLATE = ("roller_before", "roller_behind"), "platen"  # of a belt without a wheel
OF_KIND = {  # names of a belt machine's own bodies, beside the wheel
    machines.FREE_BELT: (*ROLLERS, *free_run.NAMES, free_run.ARMS),
    machines.PLATEN: (*ROLLERS, PLATE, *free_run.NAMES, free_run.ARMS),
    machines.SMALL_WHEEL: (*fork.NAMES, fork.ARMS),
}
RESERVED = (PART, STOCK, WHEEL, *LINKS)  # names of the bodies that every cell has


def validate(bodies, more=()):
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
