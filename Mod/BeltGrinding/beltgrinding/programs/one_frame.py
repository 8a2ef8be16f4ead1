"""The motions of a program in one frame: that in which it grinds most.

A pose is that of its motion's tool in its motion's base. Between two of a program's bases or tools it goes by what
the program tells of them, pose' = A^-1 B pose T^-1 S: A, B the reference's base and the motion's in the robot's
own base, S, T the tools in its flange. Where the robot holds the part, bases are in the flange and tools in the
robot's base, and the same holds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Optional, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..engine import Fact


SAME = 1e-6  # mm, and of a rotation's elements: frames that differ by less are one

THE_CONTROLLERS = Fact("programs.frame_in_force", "what the controller has in force")
TOOL = Fact("programs.frame_of_tool", "tool")
BASE = Fact("programs.frame_of_base", "base")

Pose: TypeAlias = "NDArray[np.float64]"  # (4, 4), mm
Named: TypeAlias = tuple[str, str]  # the words of a base and a tool
# (What stands before a pose, what behind), None; or None, (what is not known, its words).
Way: TypeAlias = "tuple[tuple[Pose, Pose] | None, tuple[Fact, str] | None]"
Place: TypeAlias = tuple[str, int, Fact]  # file, line and what is told of it


class Motion(Protocol):
    """What is asked here of a ``program.Motion``."""

    kind: str
    pose: Optional[Pose]
    line: int
    file: str
    tool: str
    base: str
    aux: bool
    joints_deg: Optional[tuple[float, ...]]


M = TypeVar("M", bound=Motion)


class Program(Protocol[M]):
    """And of a ``program.Program``."""

    motions: list[M]
    base_frames: dict[str, Pose]
    tool_frames: dict[str, Pose]
    held: set[str]


def reference(program: Program[M]) -> Named:
    """(base, tool), the words of the frames that most of the program's feed motions are in; of all its poses
    where there is none; ("", "") without poses. Feed motions to joint targets have a tool, and no base.
    """
    counts: dict[Named, int] = {}
    for feeds in (True, False):
        for motion in program.motions:
            if motion.pose is not None and not motion.aux and (motion.kind != "PTP" or not feeds):
                key = (motion.base, motion.tool)
                counts[key] = counts.get(key, 0) + 1
        if counts and feeds:
            return max(counts, key=lambda key: counts[key])  # the first of several
    tools = [m.tool for m in program.motions if by_joints(m)]
    tool = max(dict.fromkeys(tools), key=tools.count) if tools else None
    for key in sorted(counts, key=lambda key: counts[key], reverse=True):
        if tool in (None, key[1]):
            return key
    return "", tool or ""


def by_joints(motion: Motion) -> bool:
    """Whether a feed motion goes to a joint target: only its tool is known."""
    return motion.joints_deg is not None and motion.pose is None and motion.kind != "PTP"


def motions(program: Program[M]) -> tuple[list[M], list[Place]]:
    """(motions, problems): the motions of a Program with their poses in its reference frame. Those in a frame
    that lies nobody knows where have none, and the problems, (file, line, Fact) each, say which and why.
    """
    chosen = reference(program)
    if all(
        m.tool == chosen[1] and (m.pose is None or m.base == chosen[0])
        for m in program.motions
        if m.pose is not None or by_joints(m)
    ):
        return program.motions, []
    ways: dict[Named, Way] = {chosen: (None, None)}
    lost: dict[Named, tuple[M, int]] = {}
    found: list[M] = []
    for motion in program.motions:
        joints = by_joints(motion)
        key = ("" if joints else motion.base, motion.tool)
        if motion.pose is None and not (joints and motion.tool != chosen[1]) or key == chosen:
            found.append(motion)
            continue
        # Of a joint target nothing is known in another tool: kept apart from the poses in no base.
        known = (None, (TOOL, key[1])) if joints else ways.get(key) or way(program, chosen, key)
        ways[key] = known
        if known[0] is None or motion.pose is None:
            first, count = lost.get(key, (motion, 0))
            lost[key] = first, count + (not motion.aux)
            found.append(replace(motion, pose=None, kind="GAP", aux=False, joints_deg=None))
            continue
        before, after = known[0]
        pose = before @ motion.pose @ after
        found.append(replace(motion, pose=pose, base=chosen[0], tool=chosen[1]))
    problems = []
    for key, (first, count) in lost.items():
        what, words = ways[key][1] or (BASE, "")
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


def turn_of(program: Program[M], motion: Motion) -> Pose:
    """Rotation (3, 3) from a motion's base to the reference's; the identity where it is not known."""
    chosen = reference(program)
    moved, _ = way(program, chosen, (motion.base, chosen[1]))
    return np.eye(3) if moved is None else moved[0][:3, :3]


def holding_problems(program: Program[M], holding: str | None) -> list[Place]:
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


def way(program: Program[M], chosen: Named, key: Named) -> Way:
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
    return (sides[0], sides[1]), None
