"""ABB RAPID as text: a module with tools, work objects and a PROC main. After ABB's Technical
reference manual, RAPID instructions, functions and data types; names of at most 32 characters."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...base.frames import to_quaternions
from ...base.kinds import Floats, known
from ..patch.text import decimal
from ..force_device import RAPID
from ..program import Joints, Posture, ProgramError
from ..languages.rapid.data import SPEEDS, ZONES, zone
from .frames import undeclared
from . import pressing
from .text import DIGITS, ZONE_DIGITS, Digits, identifier, rounded, rounded_quaternions

if TYPE_CHECKING:
    from .frames import Frame
    from ..force_device import ForceDevice
    from .sheet import Load, Sheet, Step

MOST = 32  # characters of an identifier
FORCE_DIGITS = 4  # of N along an axis
EXTERNAL, NO_AXIS = 6, "9E+09"  # external axes of a target; the value of one that is not there
JOINT_DIGITS, LOAD_DIGITS = 6, 4  # of degrees; of kg, mm, kg m2
NAME = re.compile(r"[A-Za-z]\w{0,31}", re.ASCII)
TYPES = {"tool": "tooldata", "base": "wobjdata"}
DECLARED = {"tool": "tool_", "base": "wobj_"}
# Of frames that nobody has named: the controller has none of these names, and refuses the program.
LEFT_OUT = {"tool": "tBelt", "base": "wPart"}
MOVES = {"PTP": "MoveJ", "LIN": "MoveL", "SPL": "MoveL", "CIRC": "MoveC"}
TURNING = 500.0  # degrees/s, of the speeds that RAPID has names for
THRESHOLD = 50  # percent of the force, at which FCPress1LStart takes the contact for found


def text(sheet: Sheet) -> bytes:
    """The bytes of a .mod file."""
    held = sheet.part_in_hand
    lines = [f"MODULE {identifier(sheet.name, MOST)}"]
    lines += [f"  ! {comment}" for comment in sheet.comments]
    names: dict[str, list[str]] = {"tool": [], "base": []}
    for frames in (sheet.tools, sheet.bases):
        for number, frame in enumerate(frames, 1):
            name = _name(frame, number)
            there = name in names[frame.what]  # one of the controller's may be given for several
            names[frame.what].append(name)
            if frame.given:
                lines += _declaration(frame, name, held, sheet.load)
            elif not there:
                lines += _asked_for(frame, name, held)
                sheet.notes.append(undeclared(frame, name))
    lines += ["  PROC main()", "    ConfL\\Off;", "    ConfJ\\Off;"]
    if sheet.pace is not None:
        most = decimal(sheet.pace.acceleration_mm_s2 / 1000.0, 6)
        lines.append(f"    PathAccLim TRUE\\AccMax:={most},TRUE\\DecelMax:={most};")
    turning = TURNING if sheet.pace is None else sheet.pace.rotation_speed_deg_s
    if any(step.kind == "SPL" for step in sheet.steps):
        lines.append("    ! RAPID has no splines: their points are joined by lines.")
    places = [
        f"{_target(p, q, sheet.digits)[:-1]},{configuration},{external}]"
        for p, q, configuration, external in zip(
            rounded(sheet.positions, sheet.digits.mm).tolist(),
            rounded_quaternions(sheet.quaternions, sheet.digits.unit).tolist(),
            _configurations(sheet),
            _externals(sheet),
        )
    ]
    blend = _blend(sheet.blend_mm)
    device = sheet.device
    by_controller = device is not None and device.kind == "controller"
    pressed = pressing.runs(sheet) if by_controller else [""] * len(sheet.steps)
    heads = [""] * len(sheet.steps) if by_controller else pressing.before(sheet, RAPID, "!")
    for k, step in enumerate(sheet.steps):
        if step.note:
            lines.append(f"    ! {step.note}")
        if heads[k]:
            lines.append(
                f"    {heads[k]}" + ("" if heads[k][0] == "!" or heads[k][-1] == ";" else ";")
            )
        speed = sheet.speed_of(step)
        if step.kind == "PTP":
            speed = step.speed or sheet.ptp_speed_mm_s
        target = places[step.pose]
        if step.kind == "CIRC":
            target = f"{places[known(step.aux)]},{target}"
        rounds = blend if step.zone is None else _zone(step.zone)
        if k + 1 == len(sheet.steps):
            rounds = "fine"
        move, force = MOVES[step.kind], ""
        if step.kind == "PTP" and step.joints is not None:
            move, target = "MoveAbsJ", _joint_target(step.joints, step.external)
        if pressed[k] == "start":
            move, force = "FCPress1LStart", _first_press(
                known(device), step, sheet.frames[step.pose]
            )
        elif pressed[k] == "press":
            move = "FCPressC" if step.kind == "CIRC" else "FCPressL"
            force = f",{decimal(known(step.force), 3)}"
        elif pressed[k] == "end":
            move = "FCPressEnd"
        where = "" if pressed[k] == "end" else f",{rounds}"
        lines.append(
            f"    {move} {target},{_speed(speed, sheet.digits.speed, turning)}{force}{where},"
            f"{names['tool'][step.tool]}\\WObj:={names['base'][step.base]};"
        )
    lines += ["  ENDPROC", "ENDMODULE", ""]
    return "\r\n".join(lines).encode("ascii")


def _joint_target(joints: Joints, external: Sequence[float]) -> str:
    angles = ",".join(decimal(one, JOINT_DIGITS) for one in joints)
    return f"[[{angles}],{_external(external)}]"


def _external(values: Sequence[float]) -> str:
    """extjoint: where the external axes are, mm or degrees."""
    known = [decimal(one, JOINT_DIGITS) for one in values]
    return "[" + ",".join([*known, *[NO_AXIS] * (EXTERNAL - len(known))]) + "]"


def _externals(sheet: Sheet) -> list[str]:
    """extjoint of each pose."""
    found = [_external(())] * len(sheet.frames)
    for step in sheet.steps:
        for pose in (step.pose, step.aux):
            if pose is not None:
                found[pose] = _external(step.external)
    return found


def _configurations(sheet: Sheet) -> list[str]:
    """confdata of each pose: [0,0,0,0] where the posture is not known."""
    found = ["[0,0,0,0]"] * len(sheet.frames)
    for step in sheet.steps:
        if step.posture is not None and step.joints is not None:
            found[step.pose] = "[" + ",".join(map(str, confdata(step.posture, step.joints))) + "]"
    return found


def confdata(posture: Posture, joints: Joints) -> tuple[int, int, int, int]:
    """cf1, cf4, cf6: the quarter turns that axes 1, 4 and 6 are in, 0 from 0 to 90 degrees, -1 below. cfx: 4 the wrist is
    behind axis 1, 2 it is behind the lower arm, 1 axis 5 is at a negative angle."""
    quarters = [math.floor(joints[k] / 90.0) for k in (0, 3, 5)]
    behind = 4 * posture.behind + 2 * posture.back + (joints[4] < 0.0)
    return quarters[0], quarters[1], quarters[2], behind


def _first_press(device: ForceDevice, step: Step, frame: Floats) -> str:
    """Of FCPress1LStart: the force along the tool's axes, the share of it that tells of contact, the frame."""
    along = rounded(known(step.force) * pressing.along(device, frame), FORCE_DIGITS).tolist()
    axes = zip("xyz", along)
    forces = "".join(f"\\F{axis}:={decimal(one, FORCE_DIGITS)}" for axis, one in axes if one)
    return f"{forces},{THRESHOLD}\\ForceFrameRef:=FC_REFFRAME_TOOL"


def _name(frame: Frame, number: int) -> str:
    """What the instructions call a frame, which is the number ``number`` of its kind."""
    if frame.given:
        return f"{DECLARED[frame.what]}{number}"
    if frame.left_out:
        return LEFT_OUT[frame.what] + ("" if number == 1 else f"_{number}")
    name = known(frame.name)
    if not NAME.fullmatch(name):
        raise ProgramError(
            "programs.writers.rapid_name",
            "'{name}' is no name of RAPID: a letter, then at most 31 letters, digits or _",
            name=name,
        )
    return name


def _declaration(frame: Frame, name: str, held: bool, load: Load | None) -> list[str]:
    words = f"  ! {'tool' if frame.what == 'tool' else 'work object'} {frame.told}"
    if frame.what == "tool":
        asked = [] if load else ["  ! Enter its load before the program runs."]
        place = f"{_flag(not held)},{_pose(known(frame.pose))}"
        return [words, *asked, f"  PERS tooldata {name}:=[{place},{_load(load)}];"]
    return [
        words,
        f'  PERS wobjdata {name}:=[{_flag(held)},TRUE,"",{_pose(known(frame.pose))},'
        "[[0,0,0],[1,0,0,0]]];",
    ]


def _load(load: Load | None) -> str:
    """loaddata, in the wrist's frame; of a load that is not known the least that the controller takes."""
    if load is None:
        return "[1,[0,0,1],[1,0,0,0],0,0,0]"
    at = ",".join(decimal(one, LOAD_DIGITS) for one in load.centre_mm)
    about = ",".join(decimal(one, LOAD_DIGITS) for one in load.inertia_kg_m2)
    return f"[{decimal(load.mass_kg, LOAD_DIGITS)},[{at}],[1,0,0,0],{about}]"


def _asked_for(frame: Frame, name: str, held: bool) -> list[str]:
    """Comments: a frame that the program does not declare."""
    kind = TYPES[frame.what]
    flag = _flag(held == (frame.what == "base"))
    lines = [
        f"  ! {name} is not declared in this module: the controller must have this {kind}, robhold {flag}.",
        f"  ! The poses mean: {frame.told}",
    ]
    if frame.pose is not None:
        lines.append(f"  !   {_pose(known(frame.pose))}")
    return lines


def _flag(value: bool) -> str:
    return "TRUE" if value else "FALSE"


def _pose(frame: Floats) -> str:
    digits = DIGITS["fine"]
    place = rounded(frame[:3, 3], digits.mm).tolist()
    turn = rounded_quaternions(to_quaternions(frame[None, :3, :3]), digits.unit)[0].tolist()
    return _target(place, turn, digits)


def _target(place: list[float], turn: list[float], digits: Digits) -> str:
    at = ",".join(f"{one:.{digits.mm}f}" for one in place)
    quaternion = ",".join(f"{one:.{digits.unit}f}" for one in turn)
    return f"[[{at}],[{quaternion}]]"


def _speed(speed: float, digits: int, turning: float) -> str:
    """speeddata of mm/s, and degrees/s of turning."""
    number = decimal(speed, digits)
    if float(number) in SPEEDS and turning == TURNING:
        return f"v{float(number):.0f}"
    return f"[{number},{decimal(turning, 3)},5000,1000]"


def _blend(most: float) -> str:
    fitting = [size for size in ZONES if size <= most]
    return _zone(fitting[-1] if fitting else 0.0)


def _zone(size: float) -> str:
    """zonedata of a size in mm, 0: fine."""
    size = float(decimal(size, ZONE_DIGITS))
    if size in ZONES:
        return f"z{int(size)}"
    numbers = ",".join(decimal(one, ZONE_DIGITS) for one in zone(size)[1:])
    return f"[FALSE,{numbers}]" if size > 0.0 else "fine"
