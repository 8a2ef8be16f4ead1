"""Writes changes back into URScript: v= of a motion, pose_trans() around a target."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ...base.kinds import Floats
from ..languages.urscript.motion import PARAMETERS
from ..languages.urscript.reader import COMMENT
from .text import decimal, moved

if TYPE_CHECKING:
    from .text import Shift, Source, Work

ROUNDING_MM = 6e-5
CALL = re.compile(r"\b(move[jlpc])\s*\(")
LITERAL = re.compile(r"p\s*\[([^\[\]]*)\]$")
IN_FRAME = re.compile(r"pose_trans\s*\(\s*ref_frame\s*,\s*(p\s*\[[^\[\]]*\])\s*\)$")
NUMBER = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*$")
SPEED_DIGITS = 9  # of m/s
PLACE_DIGITS = 7  # of m

Arguments: TypeAlias = "list[tuple[str | None, int, int]]"  # keyword, begin, end


def derived(source: Source, line: int) -> bool:
    return False


def rounding_mm_s(source: Source, line: int) -> float:
    return 1e-6


def edit(source: Source, work: Work) -> None:
    work.no_force()
    for line, value in work.speeds.items():
        name, arguments, end = _call(source, work, line)
        names = PARAMETERS[name]
        given = _given(names, arguments)
        text = decimal(value / 1000.0, SPEED_DIGITS, 1)
        if "t" in given and _number(source.text[slice(*given["t"])]) != 0.0:
            source.replace(*given["t"], "0")  # t goes before v
        if "v" in given:
            source.replace(*given["v"], text)
        else:
            source.replace(end, end, f", v={text}")
    for line, target, shift in work.targets():
        name, arguments, _ = _call(source, work, line)
        given = _given(PARAMETERS[name], arguments)
        _move(source, work, line, shift, *given[PARAMETERS[name][target]])


def _number(text: str) -> float | None:
    match = NUMBER.match(text)
    return float(match.group(1)) if match else None


def _call(source: Source, work: Work, line: int) -> tuple[str, Arguments, int]:
    """(name, [(keyword or None, begin, end)], end of the last) of a line's motion."""
    begin, _ = source.span(line)
    code = COMMENT.sub(lambda m: m.group(1) or "", source.line(line))
    found = list(CALL.finditer(code))
    if len(found) != 1:
        raise work.refuse(
            line,
            "programs.patch.not_one_motion",
            "the line does not hold one motion by name; change it by hand",
        )
    arguments: Arguments = []
    depth, first = 0, found[0].end()
    for at in range(first, len(code)):
        letter = code[at]
        if depth == 0 and letter in ",)":
            text = code[first:at]
            keyword = re.match(r"\s*([A-Za-z_]\w*)\s*=(?!=)", text)
            inner = first + (keyword.end() if keyword else 0)
            inner += len(code[inner:at]) - len(code[inner:at].lstrip())
            stop = inner + len(code[inner:at].rstrip())
            arguments.append((keyword.group(1) if keyword else None, begin + inner, begin + stop))
            if letter == ")":
                return found[0].group(1), arguments, begin + stop
            first = at + 1
        depth += (letter in "([") - (letter in ")]")
    raise work.refuse(
        line, "programs.patch.motion_does_not_end", "the motion does not end in its line"
    )


def _given(names: Sequence[str], arguments: Arguments) -> dict[str, tuple[int, int]]:
    result = {}
    for k, (keyword, begin, end) in enumerate(arguments):
        name = names[k] if keyword is None else keyword
        result[name if name in names else names[0]] = (begin, end)
    return result


def _move(source: Source, work: Work, line: int, shift: Shift, begin: int, end: int) -> None:
    text = source.text[begin:end]
    step = work.in_base(shift)
    literal = IN_FRAME.match(text) if _in_frame(work, shift) else LITERAL.match(text)
    if literal and step is not None:
        first = begin + literal.start(1) + (literal.group(1).find("[") + 1)
        edits = _literal(literal.group(1).split("[")[-1].rstrip("]"), first, step)
        if edits is not None:
            for edit_ in edits:
                source.replace(*edit_)
            return
    step = work.in_tool(shift)
    if step is None:
        raise work.refuse(
            line,
            "programs.patch.passes_turned",
            "its passes are turned differently; give the offset as tool_dz_mm",
        )
    place = ", ".join(decimal(v / 1000.0, PLACE_DIGITS + 2, 1) for v in np.round(step, 9))
    source.replace(begin, end, f"pose_trans({text}, p[{place}, 0.0, 0.0, 0.0])")


def _literal(text: str, first: int, step: Floats) -> list[tuple[int, int, str]] | None:
    """(begin, end, number) of each coordinate to be changed; None: they are no plain numbers."""
    edits = []
    for value, part in zip(step, text.split(",")):
        number = NUMBER.match(part)
        if not number:
            return None
        if value:
            place = moved(number.group(1), value / 1000.0, PLACE_DIGITS)
            edits.append((first + number.start(1), first + number.end(1), place))
        first += len(part) + 1
    return edits


def _in_frame(work: Work, shift: Shift) -> bool:
    return work.program.motions[shift.motions[0]].base.startswith("ref_frame")
