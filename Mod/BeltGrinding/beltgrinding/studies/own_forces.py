"""Forces of the programs' own, which a varied force of the belt machine does not change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..base.kinds import Facts, Json
from ..engine import InputError, core
from ..job import poses
from ..programs.force_device import of_job

if TYPE_CHECKING:
    from .vary import Variable

KEY = "belt_machine.force_N"


def told(variables: Sequence[Variable], job: Json) -> Facts:
    """Facts for a study's variables (``vary.variables``) and its job: where a program has forces of its own at some of its
    poses, as on the ramps of raster paths. Programs that cannot be read are left to the runs."""
    keys = [getattr(variable.key, "text", None) for variable in variables]  # of a part: none
    if KEY not in keys or job["belt_machine"]["control"] != "force":
        return []
    facts = []
    for number, program in enumerate(job["programs"]):
        name = poses.program_name(job, number)
        try:
            arrays = poses.program_arrays(program, name, [], force_device=of_job(job))
        except InputError:
            continue
        slow = ~arrays["rapid"]
        own = int((slow & (arrays["forces"] >= 0.0)).sum())
        if own:
            facts.append(
                core.Fact(
                    "studies.own_forces",
                    "{key} varies, but {own} of {count} poses of {program} have a force of their own, which stays as it is",
                    key=KEY,
                    own=own,
                    count=int(slow.sum()),
                    program=name,
                )
            )
    return facts
