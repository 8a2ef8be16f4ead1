"""Writes changes back into ABB RAPID: \\V or the speed of an instruction, Offs() and RelTool()."""

from __future__ import annotations

import functools
import re
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ...base.kinds import Floats, known
from ..languages.rapid.data import SPEEDS
from ..languages.rapid.motion import spec_of
from .text import decimal, decimals, moved

if TYPE_CHECKING:
    from .text import Shift, Source, Work

ROUNDING_MM = 6e-5
SPEED_DIGITS = 6  # of mm/s
HIDDEN = re.compile(r'"(?:[^"\r\n]|"")*"|![^\r\n]*')
NAME = re.compile(r"[A-Za-z]\w*")
ALTERNATIVE = re.compile(r"(?:move|search)(?:j|l|c|absj)$")  # instructions that have \V
POSITION = re.compile(
    r"\[\s*\[" + ",".join([r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*"] * 3) + r"\]"
)
DATA = r"\bspeeddata\s+{name}\s*:=\s*\[([^\[\]]*)\]"

Arguments: TypeAlias = "list[tuple[str | None, int, int]]"  # option, begin, end


def derived(source: Source, line: int) -> bool:
    return False


def rounding_mm_s(source: Source, line: int) -> float:
    return 1e-6


def edit(source: Source, work: Work) -> None:
    work.no_force()
    # Comments and strings blanked, place by place.
    text = HIDDEN.sub(_blank, source.text)
    for line, value in work.speeds.items():
        _speed(source, text, work, line, value)
    for line, target, shift in work.targets():
        _move(source, text, work, line, target, shift)


def _blank(match: re.Match[str]) -> str:
    size = len(match.group())
    return '"' + " " * (size - 2) + '"' if match.group()[0] == '"' else " " * size


def _instruction(text: str, source: Source, work: Work, line: int) -> tuple[str, Any, Arguments]:
    """(word, spec, arguments) of a line's motion; arguments as (option or None, begin, end), begin
    and end of a switch None."""
    begin, end = source.span(line)
    stop = text.find(";", end)
    found = [
        match
        for match in NAME.finditer(text, begin, len(text) if stop < 0 else stop)
        if spec_of(match.group().lower())
    ]
    if not found or any(match.start() < end for match in found[1:]):
        raise work.refuse(
            line,
            "programs.patch.not_one_motion",
            "the line does not hold one motion by name; change it by hand",
        )
    word = found[0].group().lower()
    return word, spec_of(word), _arguments(text, found[0].end())


def _arguments(text: str, at: int) -> Arguments:
    rows: list[tuple[bool, int, int]] = []
    depth, first, option = 0, at, False
    while True:
        letter = text[at]
        if depth == 0 and letter in ",\\;":
            rows.append((option, first, at))
            if letter == ";":
                break
            option, first = letter == "\\", at + 1
        depth += (letter in "([{") - (letter in ")]}")
        at += 1
    result: Arguments = []
    for option, begin, end in rows:
        name = None
        if option:
            match = known(re.compile(r"\s*(\w+)\s*(?::=)?").match(text, begin, end))
            name, begin = match.group(1).lower(), match.end()
        piece = text[begin:end]
        if piece.strip() or option:
            lead = len(piece) - len(piece.lstrip())
            result.append((name, begin + lead, begin + max(lead, len(piece.rstrip()))))
    return result


def _speed(source: Source, text: str, work: Work, line: int, value: float) -> None:
    word, spec, arguments = _instruction(text, source, work, line)
    number = decimal(value, SPEED_DIGITS)
    options = {name: (begin, end) for name, begin, end in arguments if name}
    if "v" in options:
        source.replace(*options["v"], number)
        return
    if "t" in options:
        begin, end = options["t"]
        source.replace(begin, end, number)
        at = source.text.upper().rindex("T", 0, source.text.rindex(":=", 0, begin))
        source.replace(at, at + 1, "V" if source.text[at] == "T" else "v")
        return
    rows = [(begin, end) for name, begin, end in arguments if name is None]
    begin, end = rows[spec[3] + (2 if spec[0] == "CIRC" else 1)]
    now = text[begin:end].lower()
    if value in SPEEDS and now in [f"v{v}" for v in SPEEDS]:
        source.replace(begin, end, f"v{number}")
    elif ALTERNATIVE.match(word):
        source.replace(end, end, f"\\V:={number}")
    else:
        values = ["", "500", "5000", "1000"]  # those of the predefined speeds
        literal = re.fullmatch(r"\[([^\[\]]*)\]", now)
        literal = literal or _data(text, now)
        if literal:
            values = [part.strip() for part in literal.group(1).split(",")]
        elif not re.fullmatch(r"v\d+", now):
            raise work.refuse(
                line,
                "programs.patch.speed_data",
                "what {name} holds is not written in this file",
                name=now,
            )
        source.replace(begin, end, f"[{','.join([number, *values[1:]])}]")


@functools.lru_cache(maxsize=16)
def _data(text: str, name: str) -> re.Match[str] | None:
    return re.search(DATA.format(name=re.escape(name)), text, re.IGNORECASE)


def _move(source: Source, text: str, work: Work, line: int, target: int, shift: Shift) -> None:
    _, spec, arguments = _instruction(text, source, work, line)
    rows = [(begin, end) for name, begin, end in arguments if name is None]
    begin, end = rows[spec[3] + target]
    now = source.text[begin:end]
    if "crobt" in now.lower():
        work.relative(line, shift, "CRobT")
        return
    step = work.in_base(shift)
    literal = POSITION.match(text, begin, end)
    if literal and step is not None:
        for k, value in enumerate(step, 1):
            if value:
                had = literal.group(k)
                if decimals(had) == 0 and "e" in had.lower():
                    raise work.refuse(
                        line,
                        "programs.patch.no_plain_numbers",
                        "its coordinates are no plain numbers",
                    )
                source.replace(*literal.span(k), moved(had, value))
        return
    if shift.base.any() and shift.tool_z:
        if step is None:
            raise work.refuse(
                line,
                "programs.patch.rounds_one_kind",
                "its rounds are turned differently; give one kind of offset",
            )
        source.replace(begin, end, f"Offs({now},{_numbers(step)})")
    elif shift.base.any():
        source.replace(begin, end, f"Offs({now},{_numbers(shift.base)})")
    else:
        source.replace(begin, end, f"RelTool({now},{_numbers([0.0, 0.0, shift.tool_z])})")


def _numbers(values: Floats | list[float]) -> str:
    return ",".join(decimal(value, 6) for value in np.round(np.asarray(values), 6))
