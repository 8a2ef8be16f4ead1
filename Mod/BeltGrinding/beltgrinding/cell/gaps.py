"""Where motions of a program are left out: an event each, at the pose behind the gap."""

import numpy as np

from ..base.messages import fact_data
from ..engine import core
from .events import kinds


def events(path, gaps):
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
        time = float(times[pose])
        found.append(
            {
                "kind": "program_gap",
                "severity": kind["severity"],
                "pose": pose,
                "line": line,
                "time": time,
                "duration": 0.0,
                "worst_time": time,
                "value": 0.0,
                "limit": None,
                "unit": kind["unit"],
                "point": contacts[pose, :3, 3].tolist(),
                "face": None,
                "bodies": [],
                "message": str(fact),
                "facts": [fact_data(fact)],
                "advice": kind["advice"],
            }
        )
    return found
