"""Where motions of a program are left out: an event each, at the pose behind the gap."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..base.kinds import Array
from ..engine import core
from .events import kinds, momentary


def events(path: core.ToolPath, gaps: Array) -> list[dict[str, Any]]:
    """Events of the core.ToolPath of a program, as the core gives them; ``gaps`` (n,): as
    ``Program.path_arrays`` has them."""
    places = np.flatnonzero(gaps).tolist()
    if not places:
        return []
    kind, found = kinds()["program_gap"], []
    lines, times, contacts = path.lines(), path.times(), path.work_from_contact()
    for pose in places:
        line, first = int(lines[pose]), int(gaps[pose])
        fact = core.Fact(
            "event.program_gap",
            "motions from line {first} to line {last} are left out; nothing is ground on the way to this pose",
            first=first,
            last=line,
        )
        found.append(
            momentary(
                kind,
                "program_gap",
                [fact],
                time=float(times[pose]),
                pose=pose,
                line=line,
                point=contacts[pose, :3, 3].tolist(),
            )
        )
    return found
