"""A plan as files: the programs with their new feeds, the job that grinds them, what was planned."""

from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Facts, Json
from ..engine import InputError, core
from ..job.poses import program_name
from ..job.settings import Job
from ..job.typed import typed
from . import pictures, rounds as plans, written

if TYPE_CHECKING:
    from .rounds import Plan

JOB = "job.json"
PLAN = "plan.json"
FEEDS = "feeds.csv"
PICTURE = "plan.png"
RESULT = "result"


def write(
    found: Plan,
    folder: Path | str,
    read: Iterable[Path | str] = (),
    force: bool = False,
    from_file: Json | None = None,
    search: Json | None = None,
) -> tuple[list[str], Facts]:
    """Writes a ``Plan`` into ``folder``: job.json (the job with the planned programs), the programs' files with new
    feeds and nothing else changed, feeds.csv, plan.json, plan.png, and the result in the folder ``result``. Never over a file
    of ``read`` or of the job's inputs; over others only if a plan wrote them, or by ``force``. ``from_file``: what the
    written programs do, for plan.json (``from_file.Checked``); ``search``: what was searched, likewise
    (``grinding.Ground``).

    Returns (names of the program files that were written, warnings: why a program's file could not be). Such a
    program stands in job.json pose by pose. Raises InputError.
    """
    folder = Path(folder)
    sources, names = check(found.commands.job, folder, read, force)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_be_written(folder, error) from None
    programs: list[dict[str, Any]] = []
    names_written: list[str] = []
    warnings: Facts = []
    for k, (planned, source, name) in enumerate(zip(found.job["programs"], sources, names)):
        entry, reason = planned, None
        if source is not None and name is not None:
            given = found.commands.job["programs"][k]
            entry, reason = written.write_read(found, k, source, folder / name, given)
        if reason is not None:
            warnings.append(
                core.Fact(
                    "planning.not_patched",
                    "{program}: its file was not written, for not all feeds can be put into it ({reason}); {job} has "
                    "its poses with their feeds",
                    program=program_name(found.commands.job, k),
                    reason=reason,
                    job=JOB,
                )
            )
        elif name is not None:
            names_written.append(name)
        programs.append(entry)
    job = json.dumps({**found.job, "programs": programs}, indent=1, allow_nan=False)
    found.after.write(folder / RESULT, force, read)
    summary = plans.summary(found)
    if from_file is not None:
        summary["from_file"] = dict(from_file)
    if search is not None:
        summary["search"] = dict(search)
    drawn = pictures.composed(pictures.draw(found), found.why["shares"])
    for name, data in (
        (JOB, (job + "\n").encode()),
        (FEEDS, feeds_csv(found).encode()),
        (PLAN, (json.dumps(summary, indent=1, allow_nan=False) + "\n").encode()),
        (PICTURE, drawn),
    ):
        try:
            write_whole(folder / name, data)
        except OSError as error:
            raise cannot_be_written(folder / name, error) from None
    return names_written, warnings


def _names(sources: Sequence[str | None]) -> list[str | None]:
    """A name in the folder for each source, None without one; no two alike."""
    names: list[str | None] = []
    taken = {JOB, PLAN, FEEDS, PICTURE, RESULT}
    for source in sources:
        if source is None:
            names.append(None)
            continue
        stem, suffix = Path(source).stem, Path(source).suffix
        name, number = stem + suffix, 1
        while name.lower() in taken:
            number += 1
            name = f"{stem}-{number}{suffix}"
        taken.add(name.lower())
        names.append(name)
    return names


def check(
    job: Job | Json, folder: Path | str, read: Iterable[Path | str] = (), force: bool = False
) -> tuple[list[str | None], list[str | None]]:
    """Raises InputError where a plan of a job in ``folder`` would be written over what it must not be. Returns (the
    job's program files, None for poses; their names in the folder)."""
    job = typed(job)
    folder = Path(folder)
    sources = [program.file for program in job.programs]
    names = _names(sources)
    read = [*read, *filter(None, sources)]
    inputs = {os.path.realpath(path): path for path in read}
    planned = _is_plan(folder / PLAN)
    for name in (JOB, PLAN, FEEDS, PICTURE, *filter(None, names)):
        path = folder / name
        if os.path.realpath(path) in inputs:
            raise InputError(
                "planning.own_input",
                "{file}: the plan would be written over it, and reads it; choose another folder",
                file=inputs[os.path.realpath(path)],
            )
        if os.path.lexists(path) and not (planned or force):
            raise InputError(
                "planning.not_of_a_plan",
                "{file}: is there already, and no plan has written it; choose another folder, or replace it by --force",
                file=path,
            )
    return sources, names


def _is_plan(path: Path) -> bool:
    try:
        found = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return False
    return isinstance(found, dict) and {"better", "rounds", "checked"} <= set(found)


def feeds_csv(found: Plan) -> str:
    """Every command: program from 1, line, its first pose from 1, old and planned feed, mm/s, and force, N."""
    commands = found.commands
    before, after = (
        commands.written(commands.force(f)) for f in (np.ones(len(commands)), found.factors)
    )
    file = io.StringIO()
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(
        [
            "program",
            "line",
            "pose",
            "feed_mm_s",
            "planned_feed_mm_s",
            "force_N",
            "planned_force_N",
        ]
    )
    first = np.full(len(commands), -1)
    motions = np.arange(len(commands.group))
    first[commands.group[::-1]] = motions[::-1]
    begins = np.searchsorted(commands.of_program, np.arange(len(commands.arrays)))
    for k in np.argsort(first, kind="stable"):
        program = int(commands.program[k])
        rows.writerow(
            [
                program + 1,
                int(commands.lines[first[k]]),
                int(first[k] - begins[program]) + 1,
                f"{found.old[k]:.6g}",
                f"{found.new[k]:.6g}",
                f"{before[k]:.6g}",
                f"{after[k]:.6g}",
            ]
        )
    return file.getvalue()
