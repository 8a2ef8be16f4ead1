"""The //POS section of a Yaskawa INFORM job: C, P and other positions under their ///headers.

Headers and columns as in Yaskawa's operator's manuals, "Job Data Format" (NX100 HW0481924, 4.1.3;
DX100 HW0482494, 4.1): ///NPOS C,BC,EC,P,BP,EX; USER; TOOL; POSTYPE PULSE, BASE, ROBOT, TOOL, USER,
MTOOL; RECTAN x,y,z,Rx,Ry,Rz[,Re] in mm and degrees; RCONF.
"""

import re

from ...program import ProgramError
from ..taught import LARGEST, value_of

ROW = re.compile(r"(C|P|BC|EC|BP|EX)(\d{1,6})\s*=\s*(.*)$", re.ASCII)
HEADER = re.compile(r"///([A-Z]+)\s*(.*)$")
PULSES = ("PULSE", "ANGLE")
POSTYPES = ("BASE", "ROBOT", "TOOL", "USER", "MTOOL", *PULSES, "RECTAN")


def positions_of(rows, file, problem):
    """{(letter, n): (components or why they are unknown, base, tool)} of (line, text) ``rows``.

    Components are x, y, z in mm and Rx, Ry, Rz in degrees. Raises ProgramError;
    ``problem(line, message)`` takes notes.
    """
    positions, counted, npos = {}, {}, None
    user, tool, postype = "", "", None
    for line, text in rows:
        header = HEADER.match(text)
        if header:
            name, value = header.groups()
            if name in ("USER", "TOOL"):
                number = re.match(r"(\d{1,3})(?:\s*,\s*\d{1,3})*$", value, re.ASCII)
                if not number:
                    raise ProgramError(f"{file}:{line}: ///{name} is '{value}', no number")
                user, tool = (
                    (f"USER {int(number.group(1))}", tool)
                    if name == "USER"
                    else (user, f"TOOL {int(number.group(1))}")
                )
            elif name == "POSTYPE":
                if value not in POSTYPES:
                    raise ProgramError(f"{file}:{line}: ///POSTYPE {value} is not known")
                postype = value
            elif name == "NPOS":
                if not re.fullmatch(r"\d{1,6}(,\d{1,6}){5}", value, re.ASCII):
                    raise ProgramError(f"{file}:{line}: ///NPOS {value} is not six counts")
                npos = line, dict(zip(("C", "BC", "EC", "P", "BP", "EX"), value.split(",")))
            elif name not in ("RECTAN", "RCONF", "PULSE", "ANGLE"):
                problem(line, f"///{name} is not known; it is ignored")
            continue
        row = ROW.match(text)
        if not row:
            raise ProgramError(f"{file}:{line}: '{text[:40]}' is no position")
        letter, n, values = row.group(1), int(row.group(2)), row.group(3)
        if (letter, n) in positions:
            raise ProgramError(f"{file}:{line}: {letter}{row.group(2)} occurs twice")
        what = f"{letter}{row.group(2)}"
        limit = 1e10 if postype in PULSES or len(letter) > 1 else LARGEST
        numbers = [value_of(v, what, file, line, limit) for v in values.split(",")]
        counted[letter] = counted.get(letter, 0) + 1
        base = {"USER": user, "BASE": "BASE", "ROBOT": "ROBOT"}.get(postype)
        if letter not in ("C", "P"):
            base = "is no pose"
        elif postype in PULSES:
            numbers = "is a joint position; where it lies only the robot's kinematics tell"
        elif not base:
            numbers = f"is in the frame {postype or 'not named'}, which only the controller knows"
        elif len(numbers) not in (6, 7):
            raise ProgramError(f"{file}:{line}: {what} has {len(numbers)} values, a pose has 6")
        else:
            numbers = numbers[:6]  # Re turns the elbow of a seven-axis arm, not the tool
        positions[letter, n] = (numbers, base or "", tool)
    for letter, count in npos[1].items() if npos else ():
        if int(count) != counted.get(letter, 0):
            problem(
                npos[0], f"///NPOS announces {count} {letter}, {counted.get(letter, 0)} are there"
            )
    return positions
