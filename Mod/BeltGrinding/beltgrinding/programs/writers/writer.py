"""Writes new programs: KUKA KRL, ABB RAPID, URScript, Fanuc TP, Yaskawa INFORM, CSV. The inverse of the readers.

Numbers have so many decimals that reading gives the poses within 1e-6 mm and 1e-6 degrees: 6 of mm
and 7 of degrees in KRL, 9 of a quaternion, of metres and of radians. The controllers read them all;
their own arithmetic (32 bit in KRL and RAPID) is what limits them.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ...base.kinds import Floats, Json
from .. import one_frame
from ..force_device import Given as Device, device_of
from ..problems import ordered
from ..program import Motion, Program, ProgramError
from ..registry import read_program
from . import one_base
from .frames import Frames, checked
from .pressing import late, not_set, settle
from .read_again import check_forces
from .sheet import Load, Pace, Sheet, Step
from .spline import FORMS, fit_zones
from .text import DIGITS, printable
from .turned import resolved

if TYPE_CHECKING:
    from ..program import Fact
    from .frames import Given

WRITTEN_BY = (
    "written by BeltGrinding"  # in the head: such a file may be written anew (cli/outputs.py)
)
ANY_SPEED = 100.0  # mm/s, where only zones are asked for
IN_HAND = ("held by the robot", "fixed in the room")  # as the RAPID reader says it

Written: TypeAlias = "Program | Iterable[Motion] | Iterable[Json]"  # Json: passes

WITH_LOAD = (".src", ".mod", ".modx", ".script")  # languages that set the flange's load


def write_program(
    path: Path | str,
    language: str | None,
    program: Written,
    *,
    name: str | None = None,
    comment: str = "",
    tools: Given | None = None,
    bases: Given | None = None,
    speed_mm_s: float = 100.0,
    ptp_speed_mm_s: float = 200.0,
    blend_mm: float = 1.0,
    part_in_hand: bool | None = None,
    form: str = "",
    digits: str = "fine",
    force_device: Device = None,
    pace: tuple[float, float, float] | None = None,
    joint_percent: float | None = None,
    load: Load | None = None,
) -> list[Fact]:
    """Writes a robot program to ``path``, whole or not at all. Raises ProgramError.

    language: .src, .mod, .script, .ls, .jbi, .csv or None, the suffix of ``path``.
    program: a Program; a list of Motion; or a list of passes, dicts of ``poses`` ((n, 4, 4),
    base_from_tcp in mm), ``feed_mm_s`` and, optionally, ``force_N``: the first pose of a pass is
    reached by PTP, the others by LIN.
    name: of the module, None: the stem of ``path``. comment: a text for its head.
    tools, bases: what the program sets, for all motions, or a dict by ``Motion.tool``, ``Motion.base``. One base for
    all is that of the base that most is ground in; the poses of others are written in it where the way is known.
    None: nothing; the controller must have the right one in force, and the head of the program says
    which. A name or a number: the controller's own (KRL: n of TOOL_DATA[n], BASE_DATA[n]; RAPID: the
    name of a tooldata or wobjdata that is declared there; URScript has none). A 4 x 4 in mm, tools
    being flange_from_tcp, bases robot_from_base: these numbers. "as-known": the numbers that
    the program knows of them, or ``Motion.tool``, ``Motion.base`` tell.
    speed_mm_s: of path motions without a speed; ptp_speed_mm_s: of PTP where the language has it.
    blend_mm: how far from a pose whose motion gives no zone the robot may round the corner; 0: it stops.
    part_in_hand: the poses are those of a fixed tool in the part that the robot holds (RAPID's
    robhold); None: what the words of the program's frames tell.

    form: how a controller follows the passes. "": corners as the motions say. "spline": KRL's passes are spline
    blocks, in which a sharp bend stops the robot; in other languages as "zones": corners are rounded by half the
    shorter neighbouring way at most.
    digits: "fine", and a CSV's: poses read back within 1e-6 mm and 1e-6 degrees; "robot": 0.001 mm, 0.001 degrees, 0.1 mm/s.
    force_device: what sets the pressing force (``force_device.device_of``), for path motions; None: comments tell it.
    What is written is read again then, and refused unless each motion has its force.
    pace: (acceleration along the path, mm/s2, angular acceleration, degrees/s2, speed of turning, degrees/s) that the
    program sets as far as its language can, since its feeds count on them; None: it leaves them as they are.
    joint_percent: the speed of joint motions, percent of the greatest; None: the controller's.
    load: of the flange, which KRL, RAPID and URScript set with their tool, and others say in the head; None: not set.

    A motion without a pose (a joint target, a gap) becomes a comment, and the next pose is reached
    by PTP: nothing is ground on a way that is not known.

    A CSV has all poses in the frames that most are in; those of which the way there is not known are left out.
    URScript has them in the base that most is ground in; a base of which the way there is not known is refused.

    Returns a list of Facts: which frames the program leaves to the controller, what is left out, and which poses
    are written in another base than the source's.
    """
    path = Path(path)
    suffix = (language or path.suffix).lower()
    writer = _writer(suffix, path)
    motions, turns = resolved(motions_of(program))
    left_out: list[one_frame.Place] = []
    joined: list[Fact] = []
    given: list[Fact] = []
    known = Program("", "", motions)
    if isinstance(program, Program):
        known = replace(program, motions=motions)
    if suffix == ".csv":  # a table has no frames
        motions, left_out = one_frame.motions(known)
    elif suffix == ".script":
        motions, joined = one_base.in_one_base(known, bases, "URScript")
        given = one_base.one_for_all(known, tools, "tool")
    else:
        given = one_base.one_for_all(known, bases, "base")
        if given and one_base.all_known(known, bases):
            motions, joined = one_base.in_one_base(known, bases, suffix[1:].upper())
            given = []
        given += one_base.one_for_all(known, tools, "tool")
    used = {m.base for m in motions} | {m.tool for m in motions}
    if part_in_hand is None:
        part_in_hand = any(words.endswith(IN_HAND) for words in used)
    sheet = _sheet(
        motions, Frames(tools, "tool", known.tool_frames), Frames(bases, "base", known.base_frames)
    )
    sheet.refuse_external(suffix)
    sheet.name = name or path.stem
    head = [comment] if comment else []
    if isinstance(program, Program):
        head.append(f"from {program.file} ({program.language})")
        head += [f"not followed there: {problem}" for problem in ordered(program.problems)[:20]]
    head.insert(1, WRITTEN_BY)  # the first may be the title
    head += [] if load is None or suffix in WITH_LOAD else [load.told()]
    head += [str(fact) for _, _, fact in left_out]
    head += one_base.comments(joined)
    sheet.comments = [printable(text) for text in head]
    sheet.speed_mm_s, sheet.ptp_speed_mm_s = float(speed_mm_s), float(ptp_speed_mm_s)
    sheet.blend_mm, sheet.part_in_hand = float(blend_mm), bool(part_in_hand)
    if form not in ("", *FORMS) or digits not in DIGITS:
        raise ValueError(f"form {form!r}, digits {digits!r}")
    pressed: list[Fact] = []
    if suffix != ".csv":  # which no controller follows
        sheet.form, sheet.digits, sheet.device = form, DIGITS[digits], device_of(force_device)
        sheet.pace = None if pace is None else Pace(*pace)
        sheet.joint_percent, sheet.load = joint_percent, load
        fit_zones(sheet)
        pressed = [*settle(sheet), *not_set(sheet), *late(sheet, suffix)]
    data = writer(sheet)
    if sheet.device is not None:
        check_forces(sheet, data, path.stem + suffix)
    from ...base.files import write_whole

    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, data)
    return [*pressed, *sheet.notes, *turns, *joined, *given, *(fact for _, _, fact in left_out)]


def zones_written(program: Program, name: str, form: str) -> Floats:
    """(poses,) mm, -1: not known; the zones of a Program without arcs once it is written into a file called ``name``:
    where its controller stops, rounds a corner, or passes through. Raises ProgramError."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, name)
        write_program(file, None, program, form=form, digits="robot")
        return read_program(file).path_arrays(ANY_SPEED)["zones"]


def check_suffix(path: Path | str) -> None:
    """Raises ProgramError for a file that no writer is for."""
    _writer(Path(path).suffix.lower(), Path(path))


def _writer(suffix: str, path: Path) -> Callable[[Sheet], bytes]:
    # Imported when called for, as the readers are.
    if suffix == ".src":
        from .krl import text
    elif suffix in (".mod", ".modx"):
        from .rapid import text
    elif suffix == ".script":
        from .urscript import text
    elif suffix == ".ls":
        from .fanuc import text
    elif suffix == ".jbi":
        from .inform import text
    elif suffix == ".csv":
        from .csv import text
    else:
        raise ProgramError(
            "programs.writers.suffix",
            "{file}: no program is written as '{suffix}'; known: .src, .mod, .script, .ls, .jbi, .csv",
            file=str(path),
            suffix=suffix,
        )
    return text


def motions_of(program: Written) -> list[Motion]:
    """List of Motion of a Program, of motions or of passes."""
    if isinstance(program, Program):
        return program.motions
    motions: list[Motion] = []
    for one in program:
        if isinstance(one, Motion):
            motions.append(one)
            continue
        poses = np.asarray(one["poses"], dtype=float)
        for k, pose in enumerate(poses):
            kind, speed = ("PTP", None) if k == 0 else ("LIN", float(one["feed_mm_s"]))
            motions.append(Motion(kind, pose, 0, "", speed, one.get("force_N")))
    return motions


def _sheet(motions: Iterable[Motion], tool_rows: Frames, base_rows: Frames) -> Sheet:
    """Motions as Steps, poses as arrays; the rows are Frames."""
    poses: list[Floats] = []
    steps: list[Step] = []
    aux: int | None = None
    gap: list[int] = []
    for number, motion in enumerate(motions):
        if motion.pose is None:
            gap.append(motion.line)
            aux = None
            continue
        poses.append(motion.pose)
        if motion.aux:
            aux = len(poses) - 1
            continue
        if motion.kind == "CIRC" and aux is None and not gap:
            raise ProgramError(
                "programs.writers.no_auxiliary_point",
                "motion {motion}: the arc has no auxiliary point",
                motion=number,
            )
        speed = motion.speed_mm_s
        if speed is not None and not 0.0 < speed < 1e6:
            raise ProgramError(
                "programs.writers.speed",
                "motion {motion}: the speed is {speed:g} mm/s",
                motion=number,
                speed=speed,
            )
        kind, note = motion.kind, motion.note
        if gap:
            lines = ", ".join(str(line) for line in gap[:5]) + (", ..." if len(gap) > 5 else "")
            note = f"left out: no pose is known for line {lines}; the next one is reached by PTP"
            kind, aux, gap = "PTP", None, []
        step = Step(
            kind, len(poses) - 1, aux if kind == "CIRC" else None, speed, motion.force_N, 0, 0
        )
        if motion.zone_mm is not None and math.isfinite(motion.zone_mm):
            step.zone = max(0.0, motion.zone_mm)
        step.share = motion.corner_share
        step.joints, step.posture = motion.joints_deg, motion.posture
        step.external = motion.external
        step.tool, step.base, step.note = (
            tool_rows.row(motion.tool),
            base_rows.row(motion.base),
            note,
        )
        steps.append(step)
        aux = None
    if not steps:
        raise ProgramError(
            "programs.writers.no_pose", "the program has no pose; there is nothing to write"
        )
    frames = np.array(poses, dtype=float).reshape(-1, 4, 4)
    quaternions = checked(frames)
    return Sheet(
        "", [], steps, frames[:, :3, 3], quaternions, frames, tool_rows.rows, base_rows.rows,
        0.0, 0.0, 0.0, False,
    )  # fmt: skip
