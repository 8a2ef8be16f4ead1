"""The bodies of a job's cell, ``cell.bodies`` of job.schema.json, and the names that every cell has."""

from ..engine import InputError

RESERVED = PART, STOCK, WHEEL = "part", "stock", "wheel"  # names of the bodies that every cell has


def validate(bodies):
    """Raises InputError for what the schema cannot say of a job's bodies."""
    names = list(RESERVED)
    for i, body in enumerate(bodies):
        if ("file" in body) == ("brep" in body):
            raise InputError(f"cell.bodies.{i}: give exactly one of 'file' or 'brep'")
        if body["name"] in names:
            raise InputError(f"cell.bodies.{i}: the name '{body['name']}' is taken; give another")
        names.append(body["name"])
