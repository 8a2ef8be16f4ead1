"""The way of the wheel over the work that a job's program commands."""

from __future__ import annotations

import weakref
from typing import Any

from ..base import kept, records
from ..base.kinds import Array, Facts, Json
from ..engine import InputError, core
from ..job.engine_input import time_law
from ..job.poses import program_arrays, program_name
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import frame_of
from ..presets import robot as robots
from ..programs.force_device import of_job

_made_from: weakref.WeakKeyDictionary[
    core.ToolPath, dict[str, Any]
] = weakref.WeakKeyDictionary()  # of every core.ToolPath: what it was made from
CELL_FRAMES = ("base_from_work", "tcp_from_contact", "tcp_from_work", "base_from_contact")


def tool_path(
    job: Job | Json,
    index: int,
    warnings: Facts,
    count: int | None = None,
    gaps: list[Array] | None = None,
) -> core.ToolPath:
    """core.ToolPath of the job's program number ``index``; of its first ``count`` poses. ``gaps``: a list
    that its gaps are added to, as ``Program.path_arrays`` has them."""
    job = typed(job)
    where = program_name(job, index)
    arrays = program_arrays(
        job.programs[index],
        where,
        warnings,
        robots.pose_function(records.plain(job.robot)),
        job.cell.holding,
        of_job(job),
    )
    left_out = arrays.pop("gaps")
    if gaps is not None:
        gaps.append(left_out)
    arrays = {name: values[:count] for name, values in arrays.items()}
    cell = {name: frame_of(getattr(job.cell, name), f"cell.{name}") for name in CELL_FRAMES}
    given: dict[str, Any] = {
        **arrays,
        **cell,
        "holding": job.cell.holding,
        "time_law": time_law(job.simulation),
    }
    try:
        path = core.ToolPath(**given)
    except InputError as error:
        raise error.within("job.in_program", "{program}: ", program=where) from None
    _made_from[path] = given
    return path


def motions(path: core.ToolPath) -> dict[str, Array]:
    """What a core.ToolPath that ``tool_path`` made was made from: dict of feeds, forces, rapid and more, an entry a pose."""
    return _made_from[path]


def digests(path: core.ToolPath) -> tuple[str, str] | tuple[None, None]:
    """(digest of all that a core.ToolPath was made from but its forces, the same of what its way depends on,
    whatever time it takes), for ``kept``; None, None for a path that ``tool_path`` has not made."""
    given = _made_from.get(path)
    if given is None:
        return None, None
    timed = {name: value for name, value in given.items() if name != "forces"}
    # At constant feed the tool goes straight from pose to pose; else speeds decide how corners are rounded.
    straight = given["time_law"]["timing"] == "constant_feed"
    way = {name: value for name, value in timed.items() if not straight or name != "feeds"}
    return kept.digest(timed), kept.digest(way)
