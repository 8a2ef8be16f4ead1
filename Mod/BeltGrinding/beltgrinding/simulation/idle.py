"""Settings with which nothing can be ground: allowed, and hardly meant."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..base.kinds import Facts, Json
from ..engine import core
from ..job.poses import program_name
from ..job.settings import Job
from ..job.typed import typed


def warnings(job: Job | Json, paths: Sequence[core.ToolPath]) -> Facts:
    """Facts, one for each reason that the settings give for grinding nothing. ``paths``: the core.ToolPath
    of each program of the validated job."""
    job = typed(job)
    machine, law = job.belt_machine, job.law
    found = []
    if law.model != "geometric":
        if law.coefficient_mm2_per_N == 0.0:
            found.append(
                core.Fact(
                    "idle.coefficient",
                    "law.coefficient_mm2_per_N is 0: nothing is removed; measured belts have 1e-6 to "
                    "2e-4 mm2/N",
                )
            )
        if machine.belt_wear == 0.0:
            found.append(
                core.Fact(
                    "idle.belt_wear",
                    "belt_machine.belt_wear is 0: a belt that cuts no more removes nothing; a new one "
                    "has 1",
                )
            )
    if machine.control == "force":
        found += [
            core.Fact(
                "idle.force",
                "{program}: the force is 0 at every pose: nothing is pressed and nothing removed; "
                "set the program's force or belt_machine.force_N",
                program=program_name(job, index),
            )
            for index, path in enumerate(paths)
            if not np.where(path.forces() < 0.0, machine.force_N, path.forces()).any()
        ]
    return found
