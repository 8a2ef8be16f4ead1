"""ABB RAPID as text: a module with tools, work objects and a PROC main. After ABB's Technical
reference manual, RAPID instructions, functions and data types; names of at most 32 characters."""

from ...base.frames import to_quaternions
from ..patch.text import decimal
from ..readers.rapid.data import SPEEDS
from .text import MM_DIGITS, SPEED_DIGITS, UNIT_DIGITS, identifier, rounded

MOST = 32  # characters of an identifier
ZONES = (0.3, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200)  # mm: z0, z1, ...
PLACE = f"[%.{MM_DIGITS}f,%.{MM_DIGITS}f,%.{MM_DIGITS}f]"
TURN = "[" + ",".join([f"%.{UNIT_DIGITS}f"] * 4) + "]"
AXES = "[0,0,0,0],[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]"
MOVES = {"PTP": "MoveJ", "LIN": "MoveL", "SPL": "MoveL", "CIRC": "MoveC"}


def text(sheet):
    """The bytes of a .mod file."""
    held = sheet.part_in_hand
    lines = [f"MODULE {identifier(sheet.name, MOST)}"]
    lines += [f"  ! {comment}" for comment in sheet.comments]
    lines.append("  ! Enter the loads (tload) before the program runs.")
    for k, (frame, words) in enumerate(sheet.tools, 1):
        lines.append(f"  ! tool {words}")
        lines.append(
            f"  PERS tooldata tool_{k}:=[{_flag(not held)},{_pose(frame)},"
            "[1,[0,0,1],[1,0,0,0],0,0,0]];"
        )
    for k, (frame, words) in enumerate(sheet.bases, 1):
        lines.append(f"  ! work object {words}")
        lines.append(
            f'  PERS wobjdata wobj_{k}:=[{_flag(held)},TRUE,"",{_pose(frame)},'
            "[[0,0,0],[1,0,0,0]]];"
        )
    lines += ["  PROC main()", "    ConfL\\Off;", "    ConfJ\\Off;"]
    if any(step.kind == "SPL" for step in sheet.steps):
        lines.append("    ! RAPID has no splines: their points are joined by lines.")
    places = [
        f"[{PLACE % tuple(p)},{TURN % tuple(q)},{AXES}]"
        for p, q in zip(
            rounded(sheet.positions, MM_DIGITS).tolist(),
            rounded(sheet.quaternions, UNIT_DIGITS).tolist(),
        )
    ]
    zone, force = _zone(sheet.blend_mm), None
    for k, step in enumerate(sheet.steps):
        if step.note:
            lines.append(f"    ! {step.note}")
        if step.force != force:
            force = step.force
            lines.append("    ! force as set" if force is None else f"    ! force {force:g} N")
        speed = step.speed or (sheet.ptp_speed_mm_s if step.kind == "PTP" else sheet.speed_mm_s)
        target = places[step.pose]
        if step.kind == "CIRC":
            target = f"{places[step.aux]},{target}"
        rounds = "fine" if k + 1 == len(sheet.steps) else zone
        lines.append(
            f"    {MOVES[step.kind]} {target},{_speed(speed)},{rounds},"
            f"tool_{step.tool + 1}\\WObj:=wobj_{step.base + 1};"
        )
    lines += ["  ENDPROC", "ENDMODULE", ""]
    return "\r\n".join(lines).encode("ascii")


def _flag(value):
    return "TRUE" if value else "FALSE"


def _pose(frame):
    place = rounded(frame[:3, 3], MM_DIGITS).tolist()
    turn = rounded(to_quaternions(frame[None, :3, :3])[0], UNIT_DIGITS).tolist()
    return f"[{PLACE % tuple(place)},{TURN % tuple(turn)}]"


def _speed(speed):
    if speed in SPEEDS:
        return f"v{speed:.0f}"
    return f"[{decimal(speed, SPEED_DIGITS)},500,5000,1000]"


def _zone(blend):
    fitting = [zone for zone in ZONES if zone <= blend]
    return f"z{int(fitting[-1])}" if fitting else "fine"
