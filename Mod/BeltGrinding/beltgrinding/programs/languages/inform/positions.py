"""The //POS section of a Yaskawa INFORM job: C, P and other positions under their ///headers.

Headers and columns as in Yaskawa's operator's manuals, "Job Data Format" (NX100 HW0481924, 4.1.3;
DX100 HW0482494, 4.1): ///NPOS C,BC,EC,P,BP,EX; USER; TOOL; POSTYPE PULSE, BASE, ROBOT, TOOL, USER,
MTOOL; RECTAN x,y,z,Rx,Ry,Rz[,Re] in mm and degrees; RCONF.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias, Union

from ...program import Fact, ProgramError, Reason
from ..taught import LARGEST, sound_number

ROW = re.compile(r"(C|P|BC|EC|BP|EX)(\d{1,6})\s*=\s*(.*)$", re.ASCII)
HEADER = re.compile(r"///([A-Z]+)\s*(.*)$")
PULSES = ("PULSE", "ANGLE")
POSTYPES = ("BASE", "ROBOT", "TOOL", "USER", "MTOOL", *PULSES, "RECTAN")


@dataclass(frozen=True)
class Joints:
    """A position as the robot's joints have it: six pulses, or angles in degrees (``kind``: PULSE, ANGLE)."""

    kind: str
    values: tuple[float, ...]


# (components or Joints, or the Reason why they are unknown; base; tool) by letter and number
Positions: TypeAlias = "dict[tuple[str, int], tuple[Union[list[float], Joints, Reason], str, str]]"
JOINTS = Reason(
    "programs.inform.joint_position",
    "is a joint position; where it lies only the robot's kinematics tell",
)


def positions_of(
    rows: Iterable[tuple[int, str]], file: str, problem: Callable[..., Any]
) -> Positions:
    """{(letter, n): (components or the Reason why they are unknown, base, tool)} of (line, text) ``rows``.

    Components are x, y, z in mm and Rx, Ry, Rz in degrees, or Joints. Raises ProgramError;
    ``problem(line, code, form, ...)`` takes notes.
    """
    positions: Positions = {}
    counted: dict[str, int] = {}
    npos: tuple[int, dict[str, str]] | None = None
    user, tool, postype = "", "", ""
    for line, text in rows:
        header = HEADER.match(text)
        if header:
            name, value = header.groups()
            if name in ("USER", "TOOL"):
                number = re.match(r"(\d{1,3})(?:\s*,\s*\d{1,3})*$", value, re.ASCII)
                if not number:
                    raise ProgramError.at(
                        file,
                        line,
                        "programs.inform.no_number",
                        "///{name} is '{value}', no number",
                        name=name,
                        value=value,
                    )
                user, tool = (
                    (f"USER {int(number.group(1))}", tool)
                    if name == "USER"
                    else (user, f"TOOL {int(number.group(1))}")
                )
            elif name == "POSTYPE":
                if value not in POSTYPES:
                    raise ProgramError.at(
                        file,
                        line,
                        "programs.inform.postype",
                        "///POSTYPE {value} is not known",
                        value=value,
                    )
                postype = value
            elif name == "NPOS":
                if not re.fullmatch(r"\d{1,6}(,\d{1,6}){5}", value, re.ASCII):
                    raise ProgramError.at(
                        file,
                        line,
                        "programs.inform.npos",
                        "///NPOS {value} is not six counts",
                        value=value,
                    )
                npos = line, dict(zip(("C", "BC", "EC", "P", "BP", "EX"), value.split(",")))
            elif name not in ("RECTAN", "RCONF", "PULSE", "ANGLE"):
                problem(
                    line,
                    "programs.inform.unknown_header",
                    "///{name} is not known; it is ignored",
                    name=name,
                )
                user, tool, postype = "", "", ""  # it may be any of them
            continue
        row = ROW.match(text)
        if not row:
            raise ProgramError.at(
                file, line, "programs.inform.no_position", "'{text}' is no position", text=text[:40]
            )
        letter, n, values = row.group(1), int(row.group(2)), row.group(3)
        if (letter, n) in positions:
            raise ProgramError.at(
                file,
                line,
                "programs.inform.position_twice",
                "{letter}{number} occurs twice",
                letter=letter,
                number=row.group(2),
            )
        what = f"{letter}{row.group(2)}"
        limit = 1e10 if postype in PULSES or len(letter) > 1 else LARGEST
        numbers = [sound_number(v.strip(), limit) for v in values.split(",")]
        if None in numbers:
            raise ProgramError.at(
                file,
                line,
                "programs.inform.no_sound_number",
                "{what} is '{text}', no sound number",
                what=what,
                text=values.split(",")[numbers.index(None)].strip(),
            )
        counted[letter] = counted.get(letter, 0) + 1
        base = {"USER": user, "BASE": "BASE", "ROBOT": "ROBOT"}.get(postype)
        found: Any = numbers
        if letter not in ("C", "P"):
            pass  # an external axis or a base axis is no pose
        elif postype in PULSES:
            found = Joints(postype, tuple(found)) if len(found) == 6 else JOINTS
        elif not base:
            found = Reason(
                "programs.inform.foreign_frame",
                "is in the frame {frame}, which only the controller knows",
                frame=postype or Fact("programs.inform.not_named", "not named"),
            )
        elif len(numbers) not in (6, 7):
            raise ProgramError.at(
                file,
                line,
                "programs.inform.pose_values",
                "{what} has {count} values, a pose has 6",
                what=what,
                count=len(numbers),
            )
        else:
            found = found[:6]  # Re turns the elbow of a seven-axis arm, not the tool
        positions[letter, n] = (found, base or "", tool)
    announced = npos or (0, {})
    for letter, count in announced[1].items():
        if int(count) != counted.get(letter, 0):
            problem(
                announced[0],
                "programs.inform.npos_differs",
                "///NPOS announces {announced} {letter}, {found} are there",
                announced=count,
                letter=letter,
                found=counted.get(letter, 0),
            )
    return positions
