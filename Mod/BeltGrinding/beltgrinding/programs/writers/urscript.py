"""URScript as text: one routine. After Universal Robots' "The URScript Programming Language"."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ...base.frames import to_quaternions
from ...base.kinds import Floats, known
from ..patch.text import decimal
from ..force_device import URSCRIPT
from ..program import ProgramError
from .frames import WHAT, check_all_set, taken_for_granted, undeclared
from . import pressing
from .text import DIGITS, identifier, rounded

if TYPE_CHECKING:
    from .frames import Frame
    from .sheet import Load, Sheet

ACCELERATION = 1.2  # m/s2, the manual's default
JOINT_ACCELERATION = 1.4  # rad/s2, likewise
JOINT_SPEED = 1.05  # rad/s, likewise
FASTEST = 3.14  # rad/s, of the joints of all models but the large ones' first two
BLEND_SHARE = 0.4  # of the way to a neighbour; circles of neighbouring blends must not meet
MOST = 64  # characters of a name


def text(sheet: Sheet) -> bytes:
    """The bytes of a .script file. The poses are in one base (``one_base``)."""
    sheet.refuse_held("URScript")
    check_all_set(sheet.tools, "URScript")
    for one in (*sheet.bases, *sheet.tools):
        _check_numbers(one)
    base, first = sheet.bases[0], sheet.tools[0]
    digits = sheet.digits.unit
    pose = _format(digits)
    lines = [f"def {identifier(sheet.name, MOST)}():"]
    lines += [f"  # {comment}" for comment in sheet.comments]
    if base.left_out:
        sheet.notes.append(undeclared(base, "ref_frame"))
        lines += [
            "  # ref_frame is not assigned in this program: assign it before, in the robot's base.",
            f"  # The poses mean: {base.told}",
        ]
        lines += [f"  #   ref_frame = {_one(known(base.pose))}"] if base.pose is not None else []
    else:
        lines += [f"  # base {base.told}", f"  ref_frame = {_one(known(base.pose))}"]
    if first.left_out:
        sheet.notes += taken_for_granted([first])
        lines += [
            "  # The TCP is not set in this program: set it before.",
            f"  # The poses mean: {first.told}",
        ]
        lines += [f"  #   set_tcp({_one(known(first.pose))})"] if first.pose is not None else []
    if sheet.load is not None:
        lines.append(f"  {_payload(sheet.load)}")
    if any(step.kind == "SPL" for step in sheet.steps):
        lines.append("  # URScript has no splines: their points are joined by lines.")
    places = [
        f"pose_trans(ref_frame, {pose % tuple(row)})"
        for row in _vectors(sheet.frames, digits).tolist()
    ]
    by_controller = sheet.device is not None and sheet.device.kind == "controller"
    pressed = (
        pressing.force_mode(sheet, pose) if by_controller else pressing.before(sheet, URSCRIPT, "#")
    )
    blends = _blends(sheet)
    acceleration = ACCELERATION if sheet.pace is None else sheet.pace.acceleration_mm_s2 / 1000.0
    accelerated = decimal(acceleration, 6, 1)
    share = None if sheet.joint_percent is None else sheet.joint_percent / 100.0
    joint_speed = JOINT_SPEED if share is None else decimal(FASTEST * share, 6, 1)
    tool = None
    for step, blend, head in zip(sheet.steps, blends, pressed):
        if step.note:
            lines.append(f"  # {step.note}")
        if step.tool != tool:
            tool = step.tool
            if not sheet.tools[tool].left_out:
                lines.append(f"  # tool {sheet.tools[tool].told}")
                lines.append(f"  set_tcp({_one(known(sheet.tools[tool].pose))})")
        lines += [f"  {head}"] if head else []
        speed = decimal(sheet.speed_of(step) / 1000.0, sheet.digits.speed + 3, 1)
        place = places[step.pose]
        if step.kind == "PTP":
            tail = decimal(blend / 1000.0, 6, 1) if step.zone else "0.0"
            tail = "" if float(tail) == 0.0 else f", r={tail}"
            if step.joints is not None:
                place = "[" + ", ".join(f"{math.radians(one):.9f}" for one in step.joints) + "]"
            lines.append(f"  movej({place}, a={JOINT_ACCELERATION}, v={joint_speed}{tail})")
            continue
        tail = f"a={accelerated}, v={speed}, r={decimal(blend / 1000.0, 6, 1)}"
        if step.kind == "CIRC":
            lines.append(f"  movec({places[known(step.aux)]}, {place}, {tail}, mode=0)")
        else:
            lines.append(f"  movel({place}, {tail})")
    lines += [f"  {one}" for one in pressed[len(sheet.steps) :] if one]
    lines += ["end", ""]
    return "\n".join(lines).encode("ascii")


def _payload(load: Load) -> str:
    """kg, m and kg m2 (Ixx, Iyy, Izz, Ixy, Ixz, Iyz) in the flange."""
    at = ", ".join(decimal(one / 1000.0, 6) for one in load.centre_mm)
    about = ", ".join([*(decimal(one, 6) for one in load.inertia_kg_m2), "0", "0", "0"])
    inertia = f", [{about}]" if any(load.inertia_kg_m2) else ""
    return f"set_target_payload({decimal(load.mass_kg, 4)}, [{at}]{inertia})"


def _check_numbers(frame: Frame) -> None:
    if frame.name is not None:
        raise ProgramError(
            "programs.writers.no_names",
            "'{name}': URScript sets its {what} by numbers; give these, or none and set it before",
            name=frame.name,
            what=WHAT[frame.what],
        )


def _format(digits: int) -> str:
    return "p[" + ", ".join([f"%.{digits}f"] * 6) + "]"


def _one(frame: Floats) -> str:
    digits = DIGITS["fine"].unit
    return _format(digits) % tuple(_vectors(frame[None], digits)[0])


def _vectors(frames: Floats, digits: int) -> Floats:
    """(n, 6): metres and rotation vectors (axis times angle, at most pi)."""
    quaternions = to_quaternions(frames[:, :3, :3])
    sines = np.linalg.norm(quaternions[:, 1:], axis=1)
    small = sines < 1e-12
    factors = 2.0 * np.arctan2(sines, quaternions[:, 0]) / np.where(small, 1.0, sines)
    factors = np.where(small, 2.0, factors)
    rows = np.hstack([frames[:, :3, 3] / 1000.0, quaternions[:, 1:] * factors[:, None]])
    found = rounded(rows, digits)
    # A rounded half turn that is more than half a turn would be one about the opposite axis.
    over = np.linalg.norm(found[:, 3:], axis=1) > np.pi
    scale = 10.0**digits
    found[over, 3:] = np.trunc(rows[over, 3:] * scale) / scale + 0.0
    return found


def _blends(sheet: Sheet) -> list[float]:
    """mm for each step: never more than a share of the ways before and behind."""
    before, behind = sheet.ways()
    wanted = [sheet.blend_mm if step.zone is None else step.zone for step in sheet.steps]
    return np.minimum(wanted, BLEND_SHARE * np.minimum(before, behind)).tolist()
