"""KUKA KRL as text: a module without data list. After KUKA's System Software operating and
programming manuals; names of at most 24 characters."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from ...base.frames import to_abc
from ...base.kinds import Floats, known
from ..patch.text import decimal
from ..force_device import KRL
from ..program import Joints, Posture, ProgramError
from .frames import check_all_set, taken_for_granted
from . import pressing, spline
from .text import DIGITS, ZONE_DIGITS, Digits, rounded

if TYPE_CHECKING:
    from .frames import Frame
    from .sheet import Load, Pace, Sheet, Step

JOINT_DIGITS, LOAD_DIGITS = 6, 4  # of degrees; of kg, mm, kg m2
NAME = re.compile(r"[A-Za-z]\w{0,23}$", re.ASCII)
# A Cartesian PTP without status and turn is reached in the posture that the robot happens to have.
FIRST = [
    "; The next PTP has no status and turn (S, T): they are not known here. Add them, or put a PTP with the",
    "; joint angles of your cell's home position before it.",
]
VARIABLES = {"tool": "$TOOL", "base": "$BASE"}


def text(sheet: Sheet) -> bytes:
    """The bytes of a .src file."""
    if not NAME.match(sheet.name):
        raise ProgramError(
            "programs.writers.module_name",
            "'{name}' is no name of a KRL module: a letter, then at most 23 letters, "
            "digits or _; the file must be called as the module",
            name=sheet.name,
        )
    sheet.refuse_held("KRL")
    for frames in (sheet.bases, sheet.tools):
        check_all_set(frames, "KRL")
    left_out = [frame for frame in (sheet.bases[0], sheet.tools[0]) if frame.left_out]
    sheet.notes += taken_for_granted(left_out)
    places = [_pose(frame, sheet.digits) for frame in sheet.frames]
    lines = ["&ACCESS RVP", "&REL 1"]
    lines += [f"&COMMENT {comment}" for comment in sheet.comments[:1]]
    lines.append(f"DEF {sheet.name} ( )")
    lines += [f"; {comment}" for comment in sheet.comments[1:]]
    for frame in left_out:
        lines += _asked_for(frame)
    lines += [
        ";FOLD INI",
        "GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )",
        "INTERRUPT ON 3",
        "BAS (#INITMOV,0 )",
        f"$APO.CDIS={decimal(sheet.blend_mm, ZONE_DIGITS)}",
        *_pace(sheet.pace),
        *_joint_speed(sheet.joint_percent),
        ";ENDFOLD (INI)",
    ]
    blend = decimal(sheet.blend_mm, ZONE_DIGITS)
    pressed = pressing.before(sheet, KRL, ";")
    begins = spline.blocks(sheet)
    digits = sheet.digits.speed + 3  # of m/s
    tool = base = speed = None
    inside = rounded_before = False
    for k, step in enumerate(sheet.steps):
        head = []
        if k == 0 and step.kind == "PTP" and step.joints is None:
            head += FIRST
        if step.note:
            head.append(f"; {step.note}")
        if step.base != base:
            base = step.base
            head += _setting(sheet.bases[base])
        if step.tool != tool:
            tool = step.tool
            head += [
                *_setting(sheet.tools[tool]),
                *_load(sheet.load),
            ]  # BAS (#TOOL) sets a load, too
        last = k + 1 == len(sheet.steps)
        rounds = ""
        if step.kind in ("LIN", "CIRC") and not last:
            rounds = decimal(sheet.blend_mm if step.zone is None else step.zone, ZONE_DIGITS)
            rounds = "" if float(rounds) == 0.0 else rounds
        if rounds not in ("", blend):
            blend = rounds
            head.append(f"$APO.CDIS={blend}")
        wanted = speed if step.kind == "PTP" else decimal(sheet.speed_of(step) / 1000.0, digits)
        if inside and (
            step.kind != "SPL" or k in begins or any(not row.startswith(";") for row in head)
        ):
            lines.append("ENDSPLINE")
            inside = False
        if pressed[k]:
            plain = pressed[k].startswith(";") or not (inside or rounded_before)
            head.append(pressed[k] if plain else known(sheet.device).triggered(pressed[k], inside))
        own = ""
        if wanted is not None and wanted != speed and inside:
            own = f" WITH $VEL.CP={wanted}"
        elif wanted is not None and wanted != speed:
            speed = wanted
            head.append(f"$VEL.CP={wanted}")
        lines += head
        if step.kind == "SPL" and not inside:
            lines.append("SPLINE")
            inside = True
        rounded_before = bool(rounds)
        target = _target(step, places[step.pose])
        if step.kind == "CIRC":
            target = f"{places[known(step.aux)]},{target}"
        lines.append(f"{step.kind} {target}{own}{' C_DIS' if rounds else ''}")
    lines += ["ENDSPLINE"] if inside else []
    lines += ["END", ""]
    return "\r\n".join(lines).encode("ascii")


def _pace(pace: Pace | None) -> list[str]:
    """Statements that set the accelerations, in m/s2 and degrees/s2, and the speeds of turning."""
    if pace is None:
        return []
    angular, turning = decimal(pace.angular_acceleration_deg_s2, 3), decimal(
        pace.rotation_speed_deg_s, 3
    )
    lines = [f"$ACC.CP={decimal(pace.acceleration_mm_s2 / 1000.0, 6)}"]
    lines += [f"$ACC.ORI{k}={angular}" for k in (1, 2)]
    return lines + [f"$VEL.ORI{k}={turning}" for k in (1, 2)]


def _joint_speed(percent: float | None) -> list[str]:
    return [] if percent is None else [f"BAS (#VEL_PTP,{max(1, round(percent))} )"]


def _load(load: Load | None) -> list[str]:
    """$LOAD, whose frame is the flange; J: 0 where the inertia is not known."""
    if load is None:
        return []
    at = ",".join(f"{k} {decimal(v, LOAD_DIGITS)}" for k, v in zip("XYZ", load.centre_mm))
    about = ",".join(f"{k} {decimal(v, LOAD_DIGITS)}" for k, v in zip("XYZ", load.inertia_kg_m2))
    mass = decimal(load.mass_kg, LOAD_DIGITS)
    return [f"$LOAD={{M {mass},CM {{{at},A 0,B 0,C 0}},J {{{about}}}}}"]


def _target(step: Step, pose: str) -> str:
    """Joint angles where a PTP has them; else the pose, with status and turn where the posture is known."""
    parts = [pose[1:-1]]
    if step.joints is not None and step.kind == "PTP":
        parts = [f"A{k} {decimal(one, JOINT_DIGITS)}" for k, one in enumerate(step.joints, 1)]
    elif step.joints is not None and step.posture is not None:
        parts += ["S {},T {}".format(*status_and_turn(step.posture, step.joints))]
    parts += [f"E{k} {decimal(one, JOINT_DIGITS)}" for k, one in enumerate(step.external, 1)]
    return "{" + ",".join(parts) + "}"


def status_and_turn(posture: Posture, joints: Joints) -> tuple[int, int]:
    """S and T of a position. S: bit 0, the wrist is over or behind axis 1; bit 1, axis 3 is turned beyond the
    stretched arm; bit 2, axis 5 to a negative angle. T: a bit of each axis at a negative angle."""
    status = posture.behind + 2 * (not posture.below) + 4 * (joints[4] < 0.0)
    return status, sum(1 << k for k, one in enumerate(joints) if one < 0.0)


def _pose(frame: Floats, digits: Digits) -> str:
    names = [f"{k} %.{digits.mm}f" for k in "XYZ"] + [f"{k} %.{digits.degree}f" for k in "ABC"]
    place = rounded(frame[:3, 3], digits.mm).tolist()
    turn = rounded(to_abc(frame), digits.degree).tolist()
    return "{" + ",".join(names) % (*place, *turn) + "}"


def _frame(frame: Floats) -> str:
    return "{FRAME: " + _pose(frame, DIGITS["fine"])[1:]


def _asked_for(frame: Frame) -> list[str]:
    """Comments: a frame that the program does not set."""
    variable = VARIABLES[frame.what]
    lines = [
        f"; {variable} is not set in this program. Set it behind INI, or before, if your BAS(#INITMOV,0)",
        f"; keeps it. The poses mean: {frame.told}",
    ]
    if frame.pose is not None:
        lines.append(f";   {variable}={_frame(known(frame.pose))}")
    return lines


def _setting(frame: Frame) -> list[str]:
    """Statements that set a frame; none where it is left out."""
    if frame.left_out:
        return []
    comment = f"; {frame.what} {frame.told}"
    if frame.given:
        return [comment, f"{VARIABLES[frame.what]}={_frame(known(frame.pose))}"]
    if not re.fullmatch(r"\d{1,3}", known(frame.name), re.ASCII):
        raise ProgramError(
            "programs.writers.krl_number",
            "'{name}': KRL's frames have numbers; give the n of TOOL_DATA[n] or BASE_DATA[n], or the "
            "frame's own numbers",
            name=frame.name,
        )
    return [comment, f"BAS (#{frame.what.upper()},{int(known(frame.name))} )"]
