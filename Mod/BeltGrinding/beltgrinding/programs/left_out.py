"""How many motions are in the blocks of a program that are left out whole: counted by their words, as nothing in
them is followed.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .program import Program

# By suffix: words of a motion, of the beginning of a block and of its end, where a line begins with them.
_KRL = (
    r"S?(PTP|LIN|CIRC)(_REL)?\b|SPL\b",
    r"(IF|WHILE|FOR|LOOP|REPEAT|SWITCH|SPLINE)\b",
    r"(END(IF|WHILE|FOR|LOOP|SWITCH|SPLINE)|UNTIL)\b",
)
_RAPID = (
    r"(IF\b.*\s)?(Move|Trigg|Search|Arc|Paint|FCPress)\w*",  # IF with one statement has no THEN
    r"(IF\b.*\bTHEN\s*(!.*)?$|(WHILE|FOR|TEST)\b)",
    r"END(IF|WHILE|FOR|TEST)\b",
)
_URSCRIPT = (
    r"(move[jlpc]|optimove[jl])\s*\(",
    r"(if|while|for|def|thread)\b.*:",
    r"end\b",
)
_VAL3 = (
    r"move[jlc]\s*\(",
    r"(if|while|for|do|switch)\b",
    r"(end(If|While|For|Switch)|until)\b",
)
_FANUC = (
    r"(\d+\s*:)?\s*[JLCAS]\s+P",  # where a jump is decided the problems name the last line
    r"(\d+\s*:)?\s*(FOR\b|IF\b.*\bTHEN\b)",
    r"(\d+\s*:)?\s*END(FOR|IF)\b",
)
_INFORM = (
    r"\+?(S?MOV[JLCS]|IMOV)\b",
    r"(IFTHEN|WHILE|FOR|SWITCH)",
    r"(END(IF|WHILE|SWITCH)|NEXT)\b",
)
_KAWASAKI = (
    r"(\d+\s+)?([JLHX]MOVE|C2MOVE|[LJ](APPRO|DEPART)|T?DRAW|ALIGN|DRIVE|HOME|JOINT|LINEAR)\b(?!\s*=)",
    r"(\.PROGRAM|(\d+\s+)?(IF\b(?!.*\bGO\s?TO\b)|(WHILE|FOR|DO|CASE)\b))",
    r"(\.END|END|UNTIL)\b",
)
WORDS: dict[str, tuple[str, ...]] = {
    ".src": _KRL,
    **dict.fromkeys((".mod", ".modx", ".prg", ".sys"), _RAPID),
    ".script": _URSCRIPT,
    ".pgx": _VAL3,
    ".ls": _FANUC,
    ".jbi": _INFORM,
    **dict.fromkeys((".as", ".pg"), _KAWASAKI),
}


def more(program: Program, suffix: str, lines: Sequence[str]) -> int:
    """How many motions, beyond one each, are in the blocks at the places of a Program's gaps; ``lines``: the
    text of its file."""
    if suffix not in WORDS:
        return 0
    motion, *ends = (re.compile(word, re.IGNORECASE) for word in WORDS[suffix])
    lines = [line.lstrip() for line in lines]
    last = {p.line: int(p.arguments["last"]) for p in program.problems if "last" in p.arguments}
    counts: dict[int, int] = {}
    for file, line in program.left_out:
        if file != program.file or not 0 < line <= len(lines):
            continue
        if line not in counts:
            inside = _block(lines, line, last.get(line), ends)
            counts[line] = max(1, sum(motion.match(one) is not None for one in inside)) - 1
    return sum(
        counts[line] for file, line in program.left_out if file == program.file and line in counts
    )


def _block(
    lines: Sequence[str],
    line: int,
    last: int | None,
    ends: Sequence[re.Pattern[str]],
) -> Sequence[str]:
    """The lines of the block that begins in ``line`` (from 1); that line alone where none does. ``ends``: the words of its
    beginning and of its end, or none."""
    if last is not None:
        return lines[line - 1 : max(line, last)]
    if not ends or not ends[0].match(lines[line - 1]):
        return lines[line - 1 : line]
    begin, end = ends
    depth = 0
    for k in range(line - 1, len(lines)):
        depth += (begin.match(lines[k]) is not None) - (end.match(lines[k]) is not None)
        if depth <= 0:
            return lines[line - 1 : k + 1]
    return lines[line - 1 :]
