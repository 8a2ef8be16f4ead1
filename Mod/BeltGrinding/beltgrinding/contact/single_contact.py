"""Single contacts of a wheel, for people who study it: with an analytic workpiece, or at a pose."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..base import records, schemas
from ..base.files import cannot_be_written, either, in_file, write_whole
from ..base.kinds import Context, Facts, Json
from ..cell import tool_path as tool_paths
from ..engine import InputError, core
from ..job import engine_input, machine as machines
from ..job.settings import Compliance, Layer, Wheel
from ..job.workpiece import apply_stock, make_field, read_design
from ..presets import rubber

DEFAULT_MODULUS = 5.0  # MPa
LAYERED = ("wheel_rim", "elastic_foundation")  # models that a rim of several rubbers is known to


def load(path: Path | str) -> dict[str, Any]:
    """Reads and validates a contact file (contact.schema.json). Raises InputError."""
    path = Path(path)
    try:
        return validate(schemas.read_json(path), path.resolve().parent)
    except InputError as error:
        raise in_file(error, path) from None


def validate(given: Json, folder: Path | str = ".") -> dict[str, Any]:
    """A copy of ``given`` with all defaults and paths absolute (relative to ``folder``). Raises
    InputError naming the key that is wrong.
    """
    contact: dict[str, Any] = schemas.checked(given, schemas.schema("contact"), "contact")
    if ("force_N" in contact) == ("approach_mm" in contact):
        raise InputError(
            "base.exactly_one",
            "{key}: give exactly one of {choices}",
            key="contact",
            choices=either("force_N", "approach_mm"),
        )
    wheel, workpiece = contact["wheel"], contact["workpiece"]
    if "shore_a" in wheel and "youngs_modulus_MPa" in wheel:
        raise InputError(
            "contact.modulus_and_hardness",
            "{key}: give 'youngs_modulus_MPa' or 'shore_a', not both",
            key="wheel",
        )
    if wheel["layers"] and contact["model"] not in LAYERED:
        raise InputError(
            "contact.layers_of_rims_only",
            "{key}: the model '{model}' knows no 'layers'; use one of {choices}",
            key="wheel",
            model=contact["model"],
            choices=either(*LAYERED),
        )
    modulus(wheel)  # refuses a hardness for which there is no formula
    if workpiece["shape"] in ("cylinder", "sphere", "torus") and not workpiece.get("radius_mm"):
        raise InputError(
            "contact.no_radius",
            "{key}: a {shape} needs a 'radius_mm' other than 0",
            key="workpiece",
            shape=workpiece["shape"],
        )
    if workpiece["shape"] == "torus" and "ring_radius_mm" not in workpiece:
        raise InputError(
            "contact.no_ring_radius", "{key}: a torus needs a 'ring_radius_mm'", key="workpiece"
        )
    if workpiece["shape"] == "strip" and "width_mm" not in workpiece:
        raise InputError(
            "contact.no_strip_width", "{key}: a strip needs a 'width_mm'", key="workpiece"
        )
    if contact["surrogate_file"]:
        contact["surrogate_file"] = str(Path(folder, contact["surrogate_file"]).resolve())
    elif contact["model"] == "surrogate":
        raise InputError(
            "job.no_surrogate_file",
            "{key}: a surrogate needs the key 'surrogate_file'",
            key="contact",
        )
    return contact


def run(contact: Json) -> dict[str, Any]:
    """Solves a validated contact. Returns dict(x (nx,) mm along the circumference, y (ny,) mm along
    the axis, pressure (ny, nx) MPa, coverage (ny, nx), force N, approach mm, contact_area mm2,
    peak_pressure MPa, iterations, converged, time s, model, cell_area mm2, rows_beside). The pressure
    is where the rubber has moved to; ``rows_beside`` rows at either end lie beyond the wheel's side
    faces: there it is the mean over the cell.
    """
    wheel, workpiece = contact["wheel"], contact["workpiece"]
    given = {
        (key if key.endswith("_deg") else key.removesuffix("_mm")): value
        for key, value in workpiece.items()
    }
    shape = Wheel(
        radius_mm=wheel["outer_radius_mm"],
        width_mm=wheel["width_mm"],
        crown_radius_mm=wheel["crown_radius_mm"],
        profile_mm=wheel["profile_mm"],
    )
    elasticity = Compliance(
        model=contact["model"],
        youngs_modulus_MPa=modulus(wheel),
        poissons_ratio=wheel["poissons_ratio"],
        rim_thickness_mm=wheel["rim_thickness_mm"],
        belt_tension_N_per_mm=wheel["belt_tension_N_per_mm"],
        belt_bending_N_mm=wheel["belt_bending_N_mm"],
        stiffness_MPa_per_mm=wheel["stiffness_MPa_per_mm"],
        surrogate_file=contact["surrogate_file"],
        layers=tuple(records.made(Layer, layer) for layer in wheel["layers"]),
        dynamic_modulus_factor=1.0,
    )
    result = core.single_contact(
        shape,
        given,
        engine_input.elasticity_of(elasticity, shape),
        contact.get("force_N"),
        contact.get("approach_mm"),
        float(contact["spacing_mm"]),
        float(contact["tolerance"]),
    )
    return _displaced(result)


def _displaced(result: Json) -> dict[str, Any]:
    """The contact as the core gives it, with the pressure where it acts, in rows beyond the wheel's
    side faces as well. What it was is in ``undeformed``.
    """
    y, reach = result["y"], result["reach"]
    dy = result["cell_area"] / (result["x"][1] - result["x"][0])
    beyond = int(np.ceil(reach.max() / dy - 1e-9))
    own = {key: result[key] for key in ("y", "pressure", "coverage", "gap")}
    away = np.arange(1, beyond + 1)  # rows
    share = np.clip(reach[:, None, :] / dy - away[:, None] + 1, 0, 1)
    low, high = result["beside"][:, None, :] * share
    gap = result["gap"]
    with np.errstate(invalid="ignore"):
        rise = gap[[0, -1]] - gap[[1, -2]] if len(y) > 1 else 0 * gap[[0, -1]]
        gaps = [gap[end] + away[:, None] * step for end, step in zip((0, -1), rise)]
    return {
        **result,
        "y": np.concatenate([y[0] - away[::-1] * dy, y, y[-1] + away * dy]),
        "pressure": np.concatenate([low[::-1], result["displaced_pressure"], high]),
        "coverage": np.concatenate([1.0 * (low[::-1] > 0), result["coverage"], 1.0 * (high > 0)]),
        "gap": np.nan_to_num(
            np.concatenate([gaps[0][::-1], gap, gaps[1]]), nan=np.inf, posinf=np.inf
        ),
        "rows_beside": beyond,
        "undeformed": own,
    }


def at_pose(job: Json, pose: int, program: int = 1, context: Context = None) -> dict[str, Any]:
    """The contact of a validated job at a pose of a program (both numbered from 1), on the surface
    as it is when the robot gets there. Returns what ``run`` does, and gap (ny, nx), coverage.
    Raises InputError, Cancelled.
    """
    if not 1 <= program <= len(job["programs"]):
        raise InputError(
            "contact.no_such_program",
            "there is no program {program}; the job has {count}",
            program=program,
            count=len(job["programs"]),
        )
    warnings: Facts = []
    path = tool_paths.tool_path(job, program - 1, warnings)
    if not 1 <= pose <= len(path):
        raise InputError(
            "contact.no_such_pose",
            "there is no pose {pose}; the program has {count}",
            pose=pose,
            count=len(path),
        )
    context = context or core.RunContext()
    field = make_field(job, read_design(job["design"], context), warnings, context)
    apply_stock(field, job["stock"], warnings, context)
    at = engine_input.of(job)
    before = [tool_paths.tool_path(job, i, warnings) for i in range(program - 1)]
    if pose > 1:
        before.append(tool_paths.tool_path(job, program - 1, warnings, pose))
    for i, ground in enumerate(before):
        at = engine_input.at_program(at, job, i)
        without = replace(at, must_touch=False, shifted_laws=(), trace=False)
        if ground.grinds():
            at = replace(at, belt=core.simulate(field, ground, without, context)["belt"])
    start = time.perf_counter()
    result = core.contact_at(field, path, pose - 1, at)
    result["time"] = time.perf_counter() - start
    return _displaced(result)


def rim_of(wheel_radius_mm: float, elasticity: Json) -> dict[str, float]:
    """The rim that ``reference.solve`` takes. ``elasticity``: a dict with the keys of a job's
    compliance. Raises InputError for a rim of several rubbers.
    """
    if elasticity.get("layers"):
        raise InputError(
            "contact.reference_layers", "the finite-element reference knows rims of one rubber only"
        )
    return {
        "radius": float(wheel_radius_mm),
        "thickness": float(elasticity["rim_thickness_mm"]),
        "youngs_modulus": float(elasticity["youngs_modulus_MPa"]),
        "poissons_ratio": float(elasticity["poissons_ratio"]),
    }


def rim(contact: Json) -> dict[str, float]:
    """The rim of a validated contact, or of a validated job."""
    if "belt_machine" in contact:
        what = core.Fact("contact.finite_elements", "contacts are solved by finite elements")
        machines.need_wheel(contact, what)
        machine = contact["belt_machine"]
        return rim_of(machine["wheel"]["radius_mm"], machine["compliance"])
    wheel = contact["wheel"]
    return rim_of(wheel["outer_radius_mm"], {**wheel, "youngs_modulus_MPa": modulus(wheel)})


def modulus(wheel: Json) -> float:
    """Young's modulus of a contact's wheel, MPa."""
    if "shore_a" in wheel:
        return rubber.modulus(wheel["shore_a"])
    return wheel.get("youngs_modulus_MPa", DEFAULT_MODULUS)


def summary(result: Json) -> dict[str, Any]:
    """The figures of a contact, as the command line prints them."""
    return {
        "force_N": result["force"],
        "approach_mm": result["approach"],
        "peak_pressure_MPa": result["peak_pressure"],
        "contact_area_mm2": result["contact_area"],
        "iterations": result["iterations"],
        "time_ms": 1000.0 * result["time"],
        "converged": result["converged"],
        "model": result["model"],
    }


def write_csv(result: Json, path: Path | str, reference: Json | None = None) -> None:
    """Writes x_mm, y_mm, p_MPa of every cell of the footprint, and p_reference_MPa if there is one.
    Raises InputError.
    """
    x, y = np.meshgrid(result["x"], result["y"])
    columns = {"x_mm": x, "y_mm": y, "p_MPa": result["pressure"] + 0.0}
    if reference is not None:
        columns["p_reference_MPa"] = reference["pressure"] + 0.0
    rows = np.column_stack([values.ravel() for values in columns.values()])
    lines = [",".join(columns), *(",".join(f"{v:.8g}" for v in row) for row in rows.tolist()), ""]
    try:
        write_whole(Path(path), "\n".join(lines).encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None
