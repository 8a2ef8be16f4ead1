"""A whole job as plain data, and how it is run. No FreeCAD in here.

The format is Resources/schema/job.schema.json; every default stands there and nowhere else.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..base import schemas
from ..base.files import absolute, in_file
from ..base.kinds import Json
from ..engine import InputError
from ..presets import external_axes, robot as robots
from . import bodies as job_bodies, machine
from .law import check_calibration
from .tolerances import check_zones
from .typed import typed as typed  # for macros

# Heat capacity times density of a material, J/(m3 K): from near absolute zero to more than any metal's.
STORED = (1e3, 1e7)


def schema() -> dict[str, Any]:
    """The JSON Schema of a job, as a dict."""
    return schemas.schema("job")


def check_stored(heat: Json | None) -> None:
    """Refuses a job's ``heat`` (or None) whose material stores what none does. Raises InputError."""
    if heat is None:
        return
    stored = heat["heat_capacity_J_kgK"] * heat["density_kg_m3"]
    least, most = STORED
    if not least <= stored <= most:
        raise InputError(
            "job.heat_stored",
            "{key}: times the density it is {stored:.3g} J/(m3 K); materials have {least:.3g} to {most:.3g}",
            key="heat.heat_capacity_J_kgK",
            stored=stored,
            least=least,
            most=most,
        )


def load(path: Path | str) -> dict[str, Any]:
    """Reads and validates a job file; its paths come back absolute. Raises InputError."""
    path = Path(path)
    job = schemas.read_json(path)
    try:
        return validate(job, Path(absolute(".", path)).parent)
    except InputError as error:
        raise in_file(error, path) from None


def validate(job: Json, folder: Path | str = ".") -> dict[str, Any]:
    """A copy of ``job`` with all defaults filled in and paths absolute (relative to ``folder``).

    Raises InputError naming the key that is unknown, missing or wrong.
    """
    checked: dict[str, Any] = schemas.checked(job, schema(), "job")
    _complete(checked, folder)
    return checked


def _complete(job: dict[str, Any], folder: Path | str) -> None:
    """Fills in what the schema cannot say, and refuses what it cannot refuse."""
    cell, robot, stock = job["cell"], job["robot"], job["stock"]
    for holder in [job["design"], stock, *job["programs"], *cell["bodies"]]:
        if "file" in holder:
            holder["file"] = absolute(folder, holder["file"])
    if "left_by" in stock:
        stock["left_by"] = absolute(folder, stock["left_by"])
    for i, program in enumerate(job["programs"]):
        if isinstance(program.get("values"), dict):
            from ..programs.registry import check_values

            check_values(program["values"], f"programs.{i}.values")
        elif "values" in program:
            program["values"] = absolute(folder, program["values"])
    for name in ("friction", "partition"):
        if "heat" in job and job["heat"][name][0] > job["heat"][name][1]:
            raise InputError(
                "job.heat_span",
                "{key}: the least value is more than the greatest",
                key=f"heat.{name}",
            )
    check_stored(job.get("heat"))
    machine.filled(job["belt_machine"], schema()["properties"]["belt_machine"])
    machine.check(job)
    check_calibration(job["law"]["calibration"])
    check_finish(job.get("finish"))
    compliance = job["belt_machine"]["compliance"]
    if compliance["surrogate_file"]:
        compliance["surrogate_file"] = absolute(folder, compliance["surrogate_file"])
    elif compliance["model"] == "surrogate":
        raise InputError(
            "job.no_surrogate_file",
            "{key}: a surrogate needs the key 'surrogate_file'",
            key="belt_machine.compliance",
        )
    if stock["kind"] == "mesh" and "file" not in stock:
        raise InputError(
            "job.no_mesh_file", "{key}: a mesh stock needs the key 'file'", key="stock"
        )
    if stock["kind"] == "left" and "left_by" not in stock:
        raise InputError(
            "job.no_left_by",
            "{key}: what an earlier run left needs the key 'left_by', its heightfield.h5",
            key="stock",
        )
    if stock["kind"] == "solid" and ("file" in stock) == ("brep" in stock):
        raise InputError(
            "job.no_solid",
            "{key}: a solid stock needs exactly one of 'file' or 'brep'",
            key="stock",
        )
    more = job_bodies.OF_KIND.get(machine.kind(job["belt_machine"]), ())
    job_bodies.validate(cell["bodies"], more)
    if robot["model"]["urdf"]:
        robot["model"]["urdf"] = absolute(folder, robot["model"]["urdf"])
    robot["packages"] = [absolute(folder, one) for one in robot["packages"]]
    robots.validate(robot)
    external_axes.refuse_held(robot["external_axes"], cell["holding"])
    lower, upper = job["inspection"]["tolerance_mm"]
    if lower > upper:
        raise InputError(
            "job.limits_swapped",
            "{key}: the lower limit lies above the upper one",
            key="inspection.tolerance_mm",
        )
    check_zones(job["inspection"]["zones"], job["design"]["faces"], "finish" in job)


def check_finish(finish: Json | None) -> None:
    """Raises InputError for a job's ``finish`` (None: none) that cannot be, though the schema takes it."""
    model = None if finish is None else finish.get("model")
    if finish is None or model is None:
        return
    if "grit" not in finish:
        raise InputError(
            "job.finish_without_grit",
            "{key}: a roughness needs the key 'grit', the grain of the belt",
            key="finish",
        )
    for name, (low, high) in model["ranges"].items():
        if low > high:
            raise InputError(
                "job.finish_range",
                "{key}: the least value is more than the greatest",
                key=f"finish.model.ranges.{name}",
            )
