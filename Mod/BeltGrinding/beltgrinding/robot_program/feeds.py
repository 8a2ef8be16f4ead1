"""The feeds that a robot's joints can follow, for plans."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..base import records
from ..base.kinds import Array, Context, Floats
from ..engine import core
from ..job import poses
from ..job.settings import Job
from ..job.typed import typed
from . import whole


def greatest(
    job: Job, programs: Sequence[Mapping[str, Array]], feed: float, context: Context = None
) -> Floats:
    """(poses,) mm/s of all programs, at most ``feed``: what the joints' speeds and accelerations let each motion of the
    passes have, in the postures of the program for the whole robot; inf of rapid motions. ``programs``: of a validated
    job with a home (``whole.wanted``), as ``poses.program_arrays`` gives them. Raises InputError, Cancelled.
    """
    from ..job.workpiece import read_design

    context = context or core.RunContext()
    listed = []
    for arrays in programs:
        feeds = np.where(arrays["rapid"], arrays["feeds"], feed)
        listed.append({"poses": poses.list_poses({**arrays, "feeds": feeds}), "unresolved": 0})
    fast = typed({**records.plain(job), "programs": listed})
    shape = read_design(fast.design, context) if fast.cell.check_collisions else None
    found = [
        whole.Planner(fast, k, shape, context.part(0.0, 0.0)).feeds(context.part(0.0, 0.0))
        for k in range(len(listed))
    ]
    return np.concatenate(found)
