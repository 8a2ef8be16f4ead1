"""The motions of a program in one frame: that in which it grinds most.

A pose is that of its motion's tool in its motion's base. Between two of a program's bases or tools it goes by what
the program tells of them, pose' = A^-1 B pose T^-1 S: A, B the reference's base and the motion's in the robot's
own base, S, T the tools in its flange. Where the robot holds the part, bases are in the flange and tools in the
robot's base, and the same holds.
"""

from dataclasses import replace

import numpy as np

from ..engine import Fact

SAME = 1e-6  # mm, and of a rotation's elements: frames that differ by less are one

THE_CONTROLLERS = Fact("programs.frame_in_force", "what the controller has in force")
TOOL = Fact("programs.frame_of_tool", "tool")
BASE = Fact("programs.frame_of_base", "base")


def reference(program):
    """(base, tool), the words of the frames that most of the program's feed motions are in; of all its poses
    where there is none; ("", "") without poses."""
    counts = {}
    for feeds in (True, False):
        for motion in program.motions:
            if motion.pose is not None and not motion.aux and (motion.kind != "PTP" or not feeds):
                key = (motion.base, motion.tool)
                counts[key] = counts.get(key, 0) + 1
        if counts:
            return max(counts, key=counts.get)  # the first of several
    return "", ""


def motions(program):
    """(motions, problems): the motions of a Program with their poses in its reference frame. Those in a frame
    that lies nobody knows where have none, and the problems, (file, line, Fact) each, say which and why.
    """
    chosen = reference(program)
    if all((m.base, m.tool) == chosen for m in program.motions if m.pose is not None):
        return program.motions, []
    ways, lost, found = {chosen: (None, None)}, {}, []
    for motion in program.motions:
        key = (motion.base, motion.tool)
        if motion.pose is None or key == chosen:
            found.append(motion)
            continue
        if key not in ways:
            ways[key] = _way(program, chosen, key)
        way, unknown = ways[key]
        if unknown is not None:
            first, count = lost.get(key, (motion, 0))
            lost[key] = first, count + (not motion.aux)
            found.append(replace(motion, pose=None, kind="GAP", aux=False))
            continue
        before, after = way
        pose = before @ motion.pose @ after
        found.append(replace(motion, pose=pose, base=chosen[0], tool=chosen[1]))
    problems = []
    for key, (first, count) in lost.items():
        what, words = ways[key][1]
        fact = Fact(
            "programs.other_frame",
            "{count} motions in the {what} {frame} are left out, the first here: the program is read in {reference}, "
            "and how the two lie to each other is not in it; it can be given in a values file",
            count=count,
            what=what,
            frame=words or THE_CONTROLLERS,
            reference=chosen[0 if what is BASE else 1] or THE_CONTROLLERS,
        )
        problems.append((first.file, first.line, fact))
    return found, problems


def turn_of(program, motion):
    """Rotation (3, 3) from a motion's base to the reference's; the identity where it is not known."""
    chosen = reference(program)
    way, _ = _way(program, chosen, (motion.base, chosen[1]))
    return np.eye(3) if way is None else way[0][:3, :3]


def holding_problems(program, holding):
    """[(file, line, Fact)] where the program moves the part in the robot and the cell (tool_in_hand,
    part_in_hand) the tool; else []."""
    base, _ = reference(program)
    if base not in program.held or holding != "tool_in_hand":
        return []
    first = next(m for m in program.motions if m.base == base and m.pose is not None)
    fact = Fact(
        "programs.part_in_hand",
        "the program moves the part in the robot along a tool in the room ({base}), but the cell has the tool "
        "in the robot: set cell.holding to part_in_hand",
        base=base,
    )
    return [(first.file, first.line, fact)]


def _way(program, chosen, key):
    """((what stands before a pose, what behind), None); or (None, (what is not known, its words))."""
    sides = []
    for at, what, frames in ((0, BASE, program.base_frames), (1, TOOL, program.tool_frames)):
        if key[at] == chosen[at]:
            sides.append(np.eye(4))
            continue
        mine, theirs = frames.get(chosen[at]), frames.get(key[at])
        if mine is None or theirs is None:
            return None, (what, key[at])
        sides.append(np.linalg.inv(mine) @ theirs if at == 0 else np.linalg.inv(theirs) @ mine)
    if (key[0] in program.held) != (chosen[0] in program.held):
        return None, (BASE, key[0])
    sides = [np.eye(4) if np.abs(one - np.eye(4)).max() < SAME else one for one in sides]
    return tuple(sides), None
