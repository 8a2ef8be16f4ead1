"""Poses of a job's programs: as arrays for the simulator, as lists for the job file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..base import frames, records
from ..base.kinds import Array, Facts, Floats, Json, known
from ..engine import InputError, core
from ..programs.force_device import ForceDevice
from ..programs.program import ON_CURVE, PoseOf, share_of_zone, zone_of_share
from .settings import Job, Program

RESTS = ("pause_s", "dress")
DEFAULT_FEED = 100.0  # mm/s, for poses and programs that set none


def program_name(job: Job | Json, index: int) -> str:
    """How a job's program is called in messages."""
    held = job.programs if isinstance(job, Job) else job["programs"]
    program = records.made(Program, held[index])
    return program.name or program.file or f"programs[{index}]"


def rests(program: Json) -> dict[str, Any]:
    """What happens to the belt before a job's program, as its keys: for a program that takes its place."""
    return {key: program[key] for key in RESTS if key in program}


def list_poses(arrays: Mapping[str, Array]) -> list[dict[str, Any]]:
    """Arrays (as ``program_arrays`` gives them) as the job file's list of poses."""
    turns = frames.to_quaternions(arrays["frames"][:, :3, :3])
    rows = zip(
        arrays["frames"][:, :3, 3].tolist(),
        turns.tolist(),
        arrays["feeds"].tolist(),
        arrays["forces"].tolist(),
        arrays["rapid"].tolist(),
        arrays["lines"].tolist(),
        arrays["zones"].tolist(),
        arrays.get("gaps", np.zeros(len(arrays["lines"]), dtype=int)).tolist(),
    )
    poses = []
    for (x, y, z), (qw, qx, qy, qz), feed, force, rapid, line, zone, gap in rows:
        pose = {"x_mm": x, "y_mm": y, "z_mm": z, "qw": qw, "qx": qx, "qy": qy, "qz": qz}
        pose.update(feed_mm_s=feed, rapid=rapid, line=line)
        if force >= 0:
            pose["force_N"] = force
        if zone >= 0:
            pose["zone_mm"] = zone
        elif zone == ON_CURVE:
            pose["on_curve"] = True
        elif (share := share_of_zone(zone)) is not None:
            pose["corner_share"] = share
        if gap:
            pose["gap_line"] = gap
        poses.append(pose)
    return poses


def listed_poses(poses: Sequence[Json], where: str) -> dict[str, Array]:
    """Arrays of a program that is given pose by pose. Raises InputError."""
    values = np.array(
        [[p[k] for k in ("x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz")] for p in poses],
        dtype=float,
    ).reshape(-1, 7)
    try:
        matrices = frames.from_quaternions(values[:, :3], values[:, 3:])
    except InputError as error:
        raise error.within("job.in_program", "{program}: ", program=where) from None
    return {
        "frames": matrices,
        "feeds": np.array([p.get("feed_mm_s", DEFAULT_FEED) for p in poses], dtype=float),
        "forces": np.array([p.get("force_N", -1.0) for p in poses], dtype=float),
        "rapid": np.array([p.get("rapid", False) for p in poses], dtype=bool),
        "lines": np.array([p.get("line", 0) for p in poses], dtype=int),
        "zones": np.array([_zone(p) for p in poses], dtype=float),
        "gaps": np.array([p.get("gap_line", 0) for p in poses], dtype=int),
    }


def _zone(pose: Json) -> float:
    if pose.get("on_curve", False):
        return ON_CURVE
    share = pose.get("corner_share")
    return float(pose.get("zone_mm", -1.0 if share is None else zone_of_share(share)))


def program_arrays(
    program: Program | Json,
    where: str,
    warnings: Facts,
    pose_of: PoseOf | None = None,
    holding: str | None = None,
    force_device: ForceDevice | None = None,
) -> dict[str, Array]:
    """dict(frames, feeds, forces, rapid, lines, zones, gaps) of a job's program, overrides applied.
    ``pose_of``: of joint angles, as in ``Program.path_arrays``. ``holding``: cell.holding, with which a
    program must go. ``force_device``: of the job (``force_device.of_job``), by whose statements its file sets forces.
    """
    program = records.made(Program, program)
    problems: Sequence[core.Fact] = []
    if program.poses is not None and (
        program.roll is not None or program.roll_direction is not None
    ):
        raise InputError(
            "job.roll_of_poses",
            "{program}: roll is for a file of tool axes; the poses given here are whole",
            program=where,
        )
    if program.poses is not None and program.values is not None:
        raise InputError(
            "job.values_of_poses",
            "{program}: values are for a program's file; the poses given here are whole",
            program=where,
        )
    if program.poses is not None:
        arrays = listed_poses(program.poses, where)
    else:
        from ..programs.registry import read_program, told_problems

        read = read_program(
            known(program.file),
            program.roll,
            program.roll_direction,
            program.values,
            force_device=force_device,
        )
        arrays = read.path_arrays(DEFAULT_FEED, pose_of)  # may find more problems
        read.check_holding(holding)
        problems = told_problems(read, None if program.feed_mm_s is not None else DEFAULT_FEED)
    count = len(arrays["frames"])
    warnings += problems if count > 1 else problems[1:]  # the error has the first
    if count < 2:
        first = (
            core.Fact("job.first_problem", " ({problem})", problem=problems[0]) if problems else ""
        )
        raise InputError(
            "job.too_few_targets",
            "{program}: the program has {count} Cartesian targets; two at least make a path{problem}",
            program=where,
            count=count,
            problem=first,
        )
    if program.force_N is not None:
        arrays["forces"] = np.full(count, float(program.force_N))
    if program.feed_mm_s is not None:
        arrays["feeds"] = np.full(count, float(program.feed_mm_s))
    return arrays
