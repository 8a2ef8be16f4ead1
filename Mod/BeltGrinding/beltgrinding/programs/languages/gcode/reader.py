"""Reads 5-axis G-code with tool-centre-point control (ISO 6983; SINUMERIK's, Fanuc's and LinuxCNC's words).

Under G43.4 or TRAORI X, Y, Z are the tool's tip in the part and the rotary words give the axis from
the part to the spindle: Rz(C) Rx(A) [0,0,1], or Rz(C) Ry(B) [0,0,1]; under G43.5 I, J, K are the
axis itself, and so are A3, B3, C3 under TRAORI. The pose's z points into the work (-axis); the
rotation about it is free (``roll``). Without rotary words the axis is Z, and no TCP control is needed. What needs the machine's kinematics or the control's memory
is a Problem, and the motions that depend on it are left out.
A file that does not say G20 or G21 (G70, G71, G700, G710) is in the control's unit, which is asked for; one without
G90 or G91 is absolute. After a G word that is not known here, or cannot be read, no mode is known until the file says
it again; after another word that is not known, coordinates are in a frame of its own. Variables that the file assigns
are known, and with them its jumps, loops and subprograms; which dialect's, its own words tell (``units.dialect_of``).
"""

from __future__ import annotations

import re
from pathlib import Path

from ...program import Program
from ..core.listing import END
from ..core.statements import Statements
from . import flow, units
from .calls import CALLS
from .expression import BRACKETS, SHIFTING, SIEMENS
from .flow import ALONE, GOTOS, NUMBERED_FLOW, TEXTS
from .modes import (
    COORDINATE_WORDS,
    CYCLES,
    FEEDS,
    FRAMES,
    FRAMES_END,
    HARMLESS,
    MACHINE,
    MOTIONS,
    OFFSETS,
    OFFSETS_OF_TOOL,
    PLANES,
    TCP,
    UNITS,
    ZONES,
)
from .moves import BARE, MEANT, NAMED
from .statements import FOLLOWED_FRAMES, LOST_FRAMES


def _codes(*codes: float) -> list[str]:
    return [f"G{code:g}" for code in sorted(set(codes))]


SHIFTED_PATH = {41, 42}  # by the control: taken unshifted, with a word
OPEN_FEEDS = FEEDS - {94, 96}  # whose speed is not known
FOLLOWED = _codes(
    *MOTIONS, *UNITS, 90, 91, *PLANES, *TCP, 49, *OFFSETS - {58, 59}, *FRAMES_END, *ZONES, 94
)
IGNORED = _codes(*(HARMLESS | OFFSETS_OF_TOOL | {96}) - FRAMES_END - ZONES - SHIFTED_PATH - {94})
LEFT_OUT = _codes(*MACHINE, *FRAMES, *CYCLES, *SHIFTED_PATH, *OPEN_FEEDS)
OF_SHIFT = _codes(58, 59)  # SINUMERIK's frames, bases elsewhere
STATEMENTS = {
    "siemens": Statements(
        followed=[
            *FOLLOWED,
            *sorted({*MEANT, *units.SIEMENS_BLOCKS, *SHIFTING, *SIEMENS}),
            *GOTOS,
            *CALLS,
            *FOLLOWED_FRAMES,
            *BARE,
            *"CASE REPEATB DEF PROC TRAORI TRAFOOF RET M17 M2 M30".split(),
        ],
        ignored=[*IGNORED, *TEXTS, *ALONE, *NAMED],
        left_out=[*LEFT_OUT, *OF_SHIFT, *LOST_FRAMES, *COORDINATE_WORDS],
    ),
    "fanuc": Statements(
        followed=[*FOLLOWED, *OF_SHIFT, *NUMBERED_FLOW, *sorted(BRACKETS), "M2", "M30"],
        ignored=IGNORED,
        left_out=LEFT_OUT,
    ),
    "linuxcnc": Statements(
        followed=[
            *FOLLOWED,
            *OF_SHIFT,
            *(f"O {w}" for w in units.OWORDS),
            *sorted(BRACKETS),
            "M2",
            "M30",
        ],
        ignored=IGNORED,
        left_out=LEFT_OUT,
    ),
}
CHANGE = re.compile(r"(?<![A-Za-z0-9.])[Mm]0?6(?![\d.])")


def read(path: Path | str, units_of: str | None = None) -> Program:
    """The Program of a G-code file. ``units_of``: "mm" or "inch", where it does not say them itself. Raises
    ProgramError when it cannot be read at all."""
    main, others, text = units.load(path)
    reader = flow.Flow(path, main, others, CHANGE.search(text) is not None, units_of)
    if reader.follow(main, main.begin) != END and not reader.ended:
        reader.problem(
            main.end,
            "programs.gcode.no_end",
            "the file ends without M30, M2 or %; it may be cut off",
        )
    return reader.program
