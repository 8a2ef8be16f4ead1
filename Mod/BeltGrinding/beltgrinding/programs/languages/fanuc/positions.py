"""The /POS section of a Fanuc TP program: P[n]{ GP1: UF, UT, CONFIG, X .. R or J1 .. };"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, TypeAlias, Union

from ...program import Fact, ProgramError
from ..taught import sound_number

COMPONENTS = ("X", "Y", "Z", "W", "P", "R")
UNITS = dict(zip(COMPONENTS, ("mm", "mm", "mm", "deg", "deg", "deg")))
BLOCK = re.compile(r"P\[(\d{1,6})(?:\s*:[^\]\n]*)?\]\s*\{([^{}]*)\}\s*;")
CONFIG = re.compile(r"\w+\s*:\s*'[^'\n]*'")  # CONFIG, or what it is called in another language
ITEM = re.compile(r"\s*([A-Z]{1,2}\d*)\s*[=:]\s*([^\s,=:]+)\s*(mm|deg)?\s*$")
BLANK = re.compile(r"\s*")
Place: TypeAlias = "Union[Fact, tuple[list[float] | None, int | None, int | None]]"
Positions: TypeAlias = "dict[int, Place]"


def positions_of(lines: list[str], line: int, file: str, problem: Callable[..., Any]) -> Positions:
    """{n: (components or None, UF, UT)} or {n: a Fact, why it is unknown}: components X, Y, Z in mm and
    W, P, R in degrees, None for a joint position; UF, UT None for those selected. ``line`` is the
    number of the first line. Raises ProgramError; ``problem(line, code, form, ...)`` takes notes.
    """
    text, at, noted = "\n".join(lines), 0, False
    positions: Positions = {}
    while True:
        begin = BLANK.match(text, at).end()  # type: ignore[union-attr] # matches always
        line += text.count("\n", at, begin)
        if begin == len(text):
            return positions
        match = BLOCK.match(text, begin)
        if not match:
            raise ProgramError.at(
                file,
                line,
                "programs.fanuc.position_expected",
                "a position P[n]{{ ... }}; is expected here",
            )
        n = int(match.group(1))
        if n in positions:
            raise ProgramError.at(
                file, line, "programs.fanuc.position_twice", "P[{n}] occurs twice", n=n
            )
        groups = re.split(r"\bGP(\d+)\s*:", CONFIG.sub("", match.group(2)))
        if not groups[0].strip() and len(groups) > 1 and "1" not in groups[1::2]:
            positions[n] = Fact("programs.fanuc.only_others", "P[{n}] is of other groups", n=n)
            line += text.count("\n", begin, match.end())
            at = match.end()
            continue
        if groups[0].strip() or len(groups) == 1:
            raise ProgramError.at(
                file, line, "programs.fanuc.no_group", "P[{n}] has no group GP1", n=n
            )
        if len(groups) > 3 and not noted:
            noted = True
            problem(line, "programs.fanuc.other_groups", "other motion groups than GP1 are ignored")
        positions[n] = _position(groups[2 * groups[1::2].index("1") + 2], n, file, line)
        line += text.count("\n", begin, match.end())
        at = match.end()


def _position(body: str, n: int, file: str, line: int) -> Place:
    values = {}
    for item in re.split(r"[,\n]", body):
        if not item.strip():
            continue
        match = ITEM.match(item)
        if not match or match.group(1) in values:
            raise ProgramError.at(
                file,
                line,
                "programs.fanuc.item",
                "'{item}' in P[{n}] is not understood",
                item=item.strip(),
                n=n,
            )
        name, value, unit = match.groups()
        if UNITS.get(name, unit) != unit:
            raise ProgramError.at(
                file,
                line,
                "programs.fanuc.unit",
                "{name} of P[{n}] is not in {unit}",
                name=name,
                n=n,
                unit=UNITS[name],
            )
        values[name] = value
    joints = "J1" in values
    if "RX" in values:
        return Fact("programs.fanuc.remote", "P[{n}] is of a remote TCP", n=n)
    components = []
    for name in [k for k in values if re.fullmatch(r"J\d", k)] if joints else COMPONENTS:
        if name not in values:
            raise ProgramError.at(
                file, line, "programs.fanuc.no_component", "P[{n}] has no {name}", n=n, name=name
            )
        if set(values[name]) == {"*"}:
            return Fact("programs.fanuc.not_taught", "P[{n}] is not taught", n=n)
        value = sound_number(values[name])
        if value is None:
            raise ProgramError.at(
                file,
                line,
                "programs.fanuc.no_sound_number",
                "{name} of P[{n}] is '{text}', no sound number",
                name=name,
                n=n,
                text=values[name],
            )
        components.append(value)
    selected = []
    for name in ("UF", "UT"):
        frame = values.get(name, "F")
        if not re.fullmatch(r"F|\d{1,3}", frame, re.ASCII):
            raise ProgramError.at(
                file,
                line,
                "programs.fanuc.no_frame_number",
                "{name} of P[{n}] is '{text}', no frame number",
                name=name,
                n=n,
                text=frame,
            )
        selected.append(None if frame == "F" else int(frame))
    return (None if joints else components, selected[0], selected[1])
