"""A plan's programs as files: those that were read with new feeds and forces, passes as new programs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import records
from ..base.files import cannot_be_written
from ..base.kinds import Facts, Json, known
from ..engine import Fact, InputError
from ..job import robot_time
from ..job.poses import listed_poses, program_name, rests
from ..job.typed import typed
from ..presets import robot as robots
from ..programs.force_device import ForceDevice, of_job
from ..programs.patch.patch import copy, patch
from ..programs.writers.frames import words_of_cell
from ..programs.writers.writer import write_program
from ..raster import raster_path
from . import rounds as plans

if TYPE_CHECKING:
    from .rounds import Plan


def write_passes(
    file: Path | str, laid: Json, job: Json, form: str = "", **given: Any
) -> list[Any]:
    """Writes passes (``raster_path.raster``, or ``poses.listed_poses``) as a program of a job's robot, in its controller's
    form unless another is given. ``given``: further options of ``write_program``. Returns what is to be told of it. Raises
    InputError."""
    words, robot = {}, records.plain(job)["robot"]
    if robots.given(robot):
        keys = ("base_from_robot", "flange_from_tcp")
        words = words_of_cell(*(robots.robot_frame(robot, key) for key in keys))
    options, told = robot_time.written(job, file, form)
    made = raster_path.program(laid, **words)
    try:
        return write_program(file, None, made, force_device=of_job(job), **options, **given) + told
    except OSError as error:
        raise cannot_be_written(file, error) from None


def write_made(found: Plan, number: int, file: Path | str, form: str = "") -> list[Any]:
    """Writes a program of a ``Plan`` whose poses stand in the job. Returns what is to be told of it. Raises InputError."""
    name = program_name(found.job, number)
    laid = listed_poses(known(typed(found.job).programs[number].poses), name)
    return write_passes(file, laid, found.job, form)


def write_read(
    found: Plan, number: int, source: Path | str, output: Path, entry: Json
) -> tuple[dict[str, Any], InputError | None]:
    """Writes the program file ``source`` of a ``Plan`` as ``output``, with the planned feeds and forces and nothing else
    changed. ``entry``: with what a job reads ``source``. Returns (what reads ``output``, None), or (the planned poses, why the
    file has no place for what is planned). Raises InputError where the output cannot be written."""
    wanted = changes(found, number)
    try:
        if "values" in entry and not isinstance(entry["values"], str):
            raise InputError("planning.inline_values", "its values are in the job, not in a file")
        write_changed(source, wanted, output, found.commands.device)
    except OSError as error:
        raise cannot_be_written(output, error) from None
    except InputError as error:
        return found.job["programs"][number], error
    planned = {**entry, "file": output.name}
    for key, changed in (("feed_mm_s", "speed_mm_s"), ("force_N", "force_N")):
        if any(changed in change for change in wanted):
            planned.pop(key, None)
    return planned, None


def write_changed(
    source: Path | str, wanted: Sequence[Json], output: Path, device: ForceDevice | None
) -> None:
    """Writes a program's file with ``changes``, or as it is where there are none. Raises InputError, OSError."""
    if wanted:
        patch(source, wanted, output, device)
    else:
        copy(source, output, device)


def entries(
    found: Plan, folder: Path | str, read: Sequence[Json | None], suffix: str, refused: Facts
) -> list[dict[str, Any]]:
    """Writes all programs of a ``Plan`` into ``folder`` and returns their entries in a job. ``read``: of each program the
    entry with which a job reads its file, None where its poses were made here; those become files with ``suffix``. A program
    whose file has no place for what is planned stays pose by pose, and ``refused`` becomes why. Raises InputError.
    """
    programs = []
    refused.clear()
    for number, entry in enumerate(read):
        home = Path(folder, str(number))  # two files may have one name
        home.mkdir(exist_ok=True)
        name = program_name(found.job, number)
        if entry is None:
            file = home / f"passes{suffix}"
            write_made(found, number, file)
            own = rests(found.job["programs"][number])
            programs.append({**own, "file": str(file), "name": name})
            continue
        file = home / Path(entry["file"]).name
        made, reason = write_read(found, number, entry["file"], file, entry)
        if reason is not None:
            refused.append(
                Fact(
                    "planning.not_read_back",
                    "{program}: its file cannot take the plan ({reason}); its poses were simulated in place of the file",
                    program=name,
                    reason=reason,
                )
            )
        programs.append(made if reason else {**made, "file": str(file)})
    return programs


def changes(found: Plan, number: int) -> list[dict[str, Any]]:
    """What ``patch`` is to change in a program's file: the feeds and forces that are not the file's any more."""
    commands, result = found.commands, []
    program = typed(commands.job).programs[number]
    moving = np.zeros(len(commands), dtype=bool)
    moving[commands.group[~commands.rapid]] = True
    differ, forces = plans.changed(found, files=True), commands.written(
        commands.force(found.factors)
    )
    pressed = bool((found.factors[commands.program == number] != 1.0).any())
    for k in np.flatnonzero((commands.program == number) & moving):
        if differ[k] or program.feed_mm_s is not None or (pressed and program.force_N is not None):
            change: dict[str, Any] = {
                "line": int(commands.lines[int(np.argmax(commands.group == k))])
            }
            change["speed_mm_s"] = float(found.new[k])
            if not commands.by_hand and (
                found.factors[k] != 1.0 or (pressed and program.force_N is not None)
            ):
                change["force_N"] = float(forces[k])
            result.append(change)
    return result
