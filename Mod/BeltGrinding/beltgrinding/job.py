"""A whole job as plain data, and how it is run. No FreeCAD in here.

The format is Resources/schema/job.schema.json; every default stands there and nowhere else.
"""

import math
import time
from pathlib import Path

import numpy as np

from . import (
    InputError,
    collision,
    core,
    events as event_lists,
    frames,
    inputs,
    law as laws,
    motions,
    robot as robots,
    schemas,
    verdict as verdicts,
)
from .poses import program_arrays, program_name
from .result import Result, colour_scale

__all__ = ["Result", "colour_scale", "load", "run", "schema", "tool_path", "validate"]

NOTES = 3  # warnings shown behind an error
MESH_SUFFIXES = {".stl", ".ply", ".obj", ".off", ".3mf"}
CELL_FRAMES = ("base_from_work", "tcp_from_contact", "tcp_from_work", "base_from_contact")


def schema():
    """The JSON Schema of a job, as a dict."""
    return schemas.schema("job")


def load(path):
    """Reads and validates a job file; its paths come back absolute. Raises InputError."""
    path = Path(path)
    job = schemas.read_json(path)
    try:
        return validate(job, path.resolve().parent)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def validate(job, folder="."):
    """A copy of ``job`` with all defaults filled in and paths absolute (relative to ``folder``).

    Raises InputError naming the key that is unknown, missing or wrong.
    """
    job = schemas.checked(job, schema(), "job")
    for holder in [job["design"], job["stock"], *job["programs"], *job["cell"]["bodies"]]:
        if "file" in holder:
            holder["file"] = str(Path(folder, holder["file"]).resolve())
    compliance = job["belt_machine"]["compliance"]
    if compliance["surrogate_file"]:
        compliance["surrogate_file"] = str(Path(folder, compliance["surrogate_file"]).resolve())
    elif compliance["model"] == "surrogate":
        raise InputError("belt_machine.compliance: a surrogate needs the key 'surrogate_file'")
    stock = job["stock"]
    if stock["kind"] == "mesh" and "file" not in stock:
        raise InputError("stock: a mesh stock needs the key 'file'")
    if stock["kind"] == "solid" and ("file" in stock) == ("brep" in stock):
        raise InputError("stock: a solid stock needs exactly one of 'file' or 'brep'")
    collision.validate(job["cell"]["bodies"])
    robots.validate(job["robot"])
    lower, upper = job["inspection"]["tolerance_mm"]
    if lower > upper:
        raise InputError("inspection.tolerance_mm: the lower limit lies above the upper one")
    check_zones(job["inspection"]["zones"], job["design"]["faces"])
    return job


def check_zones(zones, faces):
    """Raises InputError for tolerance zones that cannot be; ``faces``: those that are ground, numbered
    from 1, none for all.
    """
    ground, names = set(faces), set()
    for i, zone in enumerate(zones):
        where = f"inspection.zones[{i}] '{zone['name']}'"
        if zone["name"] in names:
            raise InputError(f"{where}: another zone has this name already; give it another")
        names.add(zone["name"])
        for key in ("tolerance_mm", "thickness_mm"):
            lower, upper = zone.get(key, (0.0, 0.0))
            if lower > upper:
                raise InputError(f"{where}.{key}: the lower limit lies above the upper one")
        if "tolerance_mm" not in zone and "thickness_mm" not in zone:
            raise InputError(f"{where}: give it the key 'tolerance_mm', 'thickness_mm' or both")
        for face in zone.get("faces", []):
            if ground and face not in ground:
                raise InputError(f"{where}.faces: face {face} is not ground; see design.faces")


class _Phases:
    """Wall time by phase, s."""

    def __init__(self):
        self.seconds = {}
        self.restart()

    def restart(self):
        self._last = time.perf_counter()

    def end(self, name):
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - self._last
        self.restart()


def run(job, context=None, recording=None):
    """Runs a validated job. Raises InputError for what the user must mend, Cancelled on cancel.
    ``recording``: an empty core.Recording that is to follow it, program after program.
    """
    warnings = []
    try:
        return _run(job, context or core.RunContext(), warnings, recording)
    except InputError as error:
        if not warnings:
            raise
        notes = "; ".join(warnings[:NOTES])  # they may well be the reason
        raise InputError(f"{error}. Note: {notes}") from None


def _run(job, context, warnings, recording):
    phases = _Phases()
    digests = inputs.digests(job)
    phases.end("hash")
    wheel, compliance, law, options = engine_arguments(job)
    core.check_wheel(wheel)
    paths = [tool_path(job, i, warnings) for i in range(len(job["programs"]))]
    unresolved = len(warnings) + sum(program["unresolved"] for program in job["programs"])
    ways = motions.of_paths(paths)
    phases.end("programs")
    reached = robots.job_reach(job, paths, context.part(0.0, 0.0))
    phases.end("reach")
    shape = read_design(job["design"])
    warnings += shape.warnings()
    phases.end("read")
    field = make_field(job, shape, warnings, context.part(0.0, 0.2))
    phases.end("sample")
    apply_stock(field, job["stock"], warnings, context.part(0.2, 0.27))
    phases.end("stock")
    met = collision.check(job, shape, paths, warnings, context.part(0.27, 0.3))
    phases.end("collisions")

    options.update(first_motion=0, lower_limits=verdicts.lower_limits(job, field))
    shifts = np.zeros((field.size, len(options["shifted_laws"])))
    found, steps, process_time, models = [], None, 0.0, {}
    for i, path in enumerate(paths):
        share = 0.7 / len(paths)
        part = context.part(0.3 + i * share, 0.3 + (i + 1) * share)
        try:
            result = core.simulate(field, path, wheel, compliance, law, options, part, recording)
        except InputError as error:
            raise InputError(f"{program_name(job, i)}: {error}") from None
        lists = [one[i]["events"] for one in (reached, met) if one]
        found.append((i, process_time, sum(lists, result["events"])))
        rows = result["steps"]
        rows["program"] = np.full(len(rows["time"]), i, dtype=np.uint32)
        rows["time"] = rows["time"] + process_time
        steps = rows if steps is None else {k: np.concatenate([steps[k], rows[k]]) for k in rows}
        process_time += result["process_time"]
        options["belt"] = result["belt"]
        options["first_motion"] += len(path)
        shifts += result["shifts"]
        models = {key: result[key] for key in ("compliance", "law")}
        for name, seconds in result["wall"].items():
            phases.seconds[name] = phases.seconds.get(name, 0.0) + seconds
    phases.restart()
    if shifts.shape[1]:
        field.set_height_sd(np.sqrt((shifts**2).sum(axis=1)))
    events = event_lists.merge(found)
    summary = summarise(job, field, events)
    phases.end("inspect")
    summary.update(
        steps=len(steps["time"]),
        process_time_s=process_time,
        wall_time_s=phases.seconds,
        warnings=warnings,
        inputs=digests,
        models=models,
        belt={
            **laws.job_belt(options["belt"]),
            "remaining_cut": remaining_cut(job, options["belt"]),
        },
        robot=robots.summary(job["robot"], reached),
        clearances=collision.summary(met, paths),
        unresolved_motions=unresolved,
    )
    result = Result(job, field, summary, events, steps, recording)
    result.motions = ways
    phases.restart()
    result.verdict = verdicts.of_result(result, shape, context=context.part(1.0, 1.0))
    phases.end("verdict")
    return result


def remaining_cut(job, belt):
    """k_t of a belt that has done ``belt`` (as the engine has it), on the job's machine."""
    return job["belt_machine"]["belt_wear"] * core.belt_remaining(
        laws.engine_wear(job["law"]), belt
    )


def summarise(job, field, events):
    """The figures of a ground field, as summary.json has them."""
    lower, upper = job["inspection"]["tolerance_mm"]
    s = core.deviation_statistics(field, lower, upper)
    uncertainty = {}
    if "sd_mean" in s:
        uncertainty = {
            "deviation_sd_mm": {"mean": s["sd_mean"], "p95": s["sd_p95"]},
            "expected_in_tolerance_area_share": s["expected_in_tolerance_share"],
        }
    return {
        "samples": s["samples"],
        "design_area_mm2": s["design_area"],
        "stock_volume_mm3": s["stock_volume"],
        "removed_volume_mm3": s["removed_volume"],
        "deviation_mm": {k: s[k] for k in ("min", "max", "mean", "rms", "p05", "p50", "p95")},
        "in_tolerance_area_share": s["in_tolerance_share"],
        "above_tolerance_area_share": s["above_share"],
        "below_tolerance_area_share": s["below_share"],
        **uncertainty,
        "missed_rays": s["missed"],
        "defective_samples": s["defective"],
        "events": event_lists.count(events),
        "versions": core.versions(),
    }


def read_design(design):
    """The design's core.Shape; a mesh becomes a faceted B-rep."""
    if "brep" in design:
        return core.Shape.from_brep(design["brep"], "design")
    if Path(design["file"]).suffix.lower() in MESH_SUFFIXES:
        return core.shape_from_mesh(core.read_mesh(design["file"], design["unit_mm"]))
    return core.Shape.read(design["file"])


def make_field(job, shape, warnings, context):
    """The height field of the job's faces, without stock."""
    faces = job["design"]["faces"]
    for face in faces:
        if face > shape.face_count:
            raise InputError(
                f"design.faces: there is no face {face}; the shape has {shape.face_count}"
            )
    field, report = core.sample_faces(
        shape,
        [face - 1 for face in faces],
        job["sampling"]["spacing_mm"],
        job["design"]["flip_normals"],
        job["sampling"]["depth_mm"],
        context=context,
    )
    warnings += report["warnings"]
    return field


def apply_stock(field, stock, warnings, context):
    """Puts the stock on the field."""
    if stock["kind"] == "allowance":
        report = core.apply_allowance(field, stock["allowance_mm"])
    else:
        if stock["kind"] == "mesh":
            placement = _frame(stock.get("placement"), "stock.placement")
            mesh = core.read_mesh(stock["file"], stock["unit_mm"], placement)
        else:
            shape = read_design(stock)
            warnings += [f"stock: {text}" for text in shape.warnings()]
            mesh = core.triangulate(shape, stock["deflection_mm"], context)
        report = core.apply_mesh(
            field, mesh, stock["search_above_mm"], stock["search_below_mm"], context
        )
    warnings += report["warnings"]


def _frame(data, where):
    try:
        return frames.from_data(data)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None


def tool_path(job, index, warnings, count=None):
    """core.ToolPath of the job's program number ``index``; of its first ``count`` poses."""
    where = program_name(job, index)
    arrays = program_arrays(
        job["programs"][index], where, warnings, robots.pose_function(job["robot"])
    )
    arrays = {name: values[:count] for name, values in arrays.items()}
    cell = {name: _frame(job["cell"].get(name), f"cell.{name}") for name in CELL_FRAMES}
    try:
        return core.ToolPath(
            **arrays, holding=job["cell"]["holding"], **cell, time_law=time_law(job["simulation"])
        )
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def time_law(simulation):
    """The dict that core.ToolPath takes for a job's ``simulation``: mm, s, rad."""
    return {
        "timing": simulation["timing"],
        "acceleration": float(simulation["path_acceleration_mm_s2"]),
        "angular_acceleration": math.radians(simulation["angular_acceleration_deg_s2"]),
        "rotation_speed": math.radians(simulation["rotation_speed_deg_s"]),
        "default_zone": float(simulation["default_zone_mm"]),
    }


def compliance_arguments(compliance, wheel):
    """The dict that core takes for the elasticity of a wheel (dict of radius, width, crown_radius,
    mm). Raises InputError for a surrogate's file that does not fit.
    """
    if compliance["model"] == "surrogate":
        from . import surrogate

        asked = {
            **compliance,
            "outer_radius_mm": wheel["radius"],
            "width_mm": wheel["width"],
            "crown_radius_mm": wheel["crown_radius"],
            "profile_mm": wheel["profile"],
        }
        return surrogate.arguments(compliance["surrogate_file"], asked)
    names = {
        "youngs_modulus_MPa": "youngs_modulus",
        "poissons_ratio": "poissons_ratio",
        "rim_thickness_mm": "rim_thickness",
        "belt_tension_N_per_mm": "belt_tension",
        "belt_bending_N_mm": "belt_bending",
        "stiffness_MPa_per_mm": "stiffness",
    }
    result = {name: float(compliance[key]) for key, name in names.items()}
    result["model"] = compliance["model"]
    result["layers"] = [
        {
            "thickness": float(layer["thickness_mm"]),
            "youngs_modulus": float(layer["youngs_modulus_MPa"]),
            "poissons_ratio": float(layer["poissons_ratio"]),
        }
        for layer in compliance["layers"]
    ]
    return result


def engine_arguments(job):
    """(wheel, compliance, law, options) as core.simulate takes them: mm, N, s, rad."""
    machine = job["belt_machine"]
    wheel = {name[:-3]: value for name, value in machine["wheel"].items()}
    if job["law"]["model"] == "geometric":
        compliance = {"model": "geometric"}
    else:
        compliance = compliance_arguments(machine["compliance"], wheel)
    law = laws.engine_law(job["law"])
    options = {
        "force_control": machine["control"] == "force",
        "force": float(machine["force_N"]),
        "force_travel": float(machine["force_travel_mm"]),
        "robot_stiffness": float(machine["robot_stiffness_N_per_mm"]),
        "belt_speed": 1000.0 * machine["belt_speed_m_s"],
        "belt_wear": float(machine["belt_wear"]),
        "wear": laws.engine_wear(job["law"]),
        "belt": laws.engine_belt(machine["belt"]),
        "heat_limit": 1000.0 * job["law"]["heat_limit_MPa_m_s"],
        "pressure_limit": float(job["law"]["pressure_limit_MPa"]),
        "orientation_jump": math.radians(job["simulation"]["orientation_jump_deg"]),
        "tilt_limit": math.radians(job["simulation"]["tilt_limit_deg"]),
        "shifted_laws": laws.shifted_laws(job["law"]),
        "contact_spacing": float(machine["contact_spacing_mm"]),
        "contact_tolerance": float(machine["contact_tolerance"]),
        "max_travel": float(job["simulation"]["max_travel_mm"]),
        "max_angle": math.radians(job["simulation"]["max_angle_deg"]),
    }
    return wheel, compliance, law, options
