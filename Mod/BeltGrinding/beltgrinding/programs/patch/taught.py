"""Writes changes back into Fanuc TP (.ls) and Yaskawa INFORM (.jbi): speeds in the instructions,
offsets in the taught positions, if no other motion uses them. Lines keep their numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ...base.kinds import Floats, known
from ..languages.fanuc import localized
from ..languages.fanuc.motions import MM_PER_S as ENGLISH
from ..languages.taught import DIGITS
from .text import decimal, decimals, moved

if TYPE_CHECKING:
    from .text import Shift, Source, Work

MM_PER_S = {**ENGLISH, **{own: ENGLISH[unit] for own, unit in localized.MM_PER_S.items()}}
ROUNDING_MM = 5.1e-4  # positions have three decimals
INDEX = r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]"
MOTION = re.compile(rf"\b([JLCAS])\s+PR?\s*{INDEX}")
TARGET = re.compile(rf"[\s:]*PR?\s*{INDEX}")
SPEED = re.compile(
    rf"[\s:]*({DIGITS}|R{INDEX})\s*(mm/se[ck]|cm/min|inch/min|deg/se[ck]|mse[ck]|se[ck]|%)(?=\s|;|$)"
)
BLOCK = re.compile(r"P\[(\d+)(?:\s*:[^\]\r\n]*)?\]\s*\{([^{}]*)\}\s*;")
PLACE = re.compile(rf"\b([XYZ])(\s*=\s*)({DIGITS})(\s*mm)")
LEAST_DECIMALS = {"mm/sec": 0, "mm/sek": 0, "cm/min": 0, "inch/min": 1}  # what all controllers take
MOVE = re.compile(r"\s*(?:MOV[LCS]|IMOV)\s+(C|P)(\d+)(?=\s|$)")
V = re.compile(r"(\s)V=(\S*)")
ROW = re.compile(rf"\s*C(\d+)\s*=\s*({DIGITS})\s*,\s*({DIGITS})\s*,\s*({DIGITS})\s*,")

Used: TypeAlias = "Mapping[int, list[tuple[int, int]]]"  # of positions: (line, target)


def derived(source: Source, line: int) -> bool:
    """Half-way points of arcs that are taught one point a statement."""
    return bool(re.match(r"\s*(?:\d*\s*:\s*A\s|MOVC\b)", source.line(line)))


def rounding_mm_s(source: Source, line: int) -> float:
    begin, end = source.span(line)
    if re.match(r"\s*\w*MOV", source.text[begin:end]):
        return 0.05
    number, unit, _ = _feed(source, line)
    return 0.5 * 10.0 ** -_digits(number, unit) * MM_PER_S.get(unit, 1.0) * 1.0001


def edit(source: Source, work: Work) -> None:
    work.no_force()
    fanuc = work.program.language == "Fanuc TP"
    for line, value in work.speeds.items():
        (_set_feed if fanuc else _set_v)(source, work, line, value)
    if work.shifts:
        (_move_positions if fanuc else _move_rows)(source, work)


def _digits(number: str, unit: str) -> int:
    return max(LEAST_DECIMALS.get(unit, 0), 0 if number.startswith("R") else decimals(number))


def _feed(source: Source, line: int) -> tuple[str, str, re.Match[str] | None]:
    """(number, unit, match) of a statement's speed; unit "" where it has none."""
    begin = source.span(line)[0]
    stop = source.text.find(";", begin)
    motion = MOTION.search(source.text, begin, stop)
    if not motion:
        return "", "", None
    at = motion.end()
    if motion.group(1) == "C":
        second = TARGET.match(source.text, at, stop)
        at = second.end() if second else at
    found = SPEED.match(source.text, at, stop + 1)
    return (found.group(1), found.group(3), found) if found else ("", "", None)


def _set_feed(source: Source, work: Work, line: int, value: float) -> None:
    number, unit, found = _feed(source, line)
    if found is None or unit in ("%", "deg/sec", "deg/sek", ""):
        raise work.refuse(
            line,
            "programs.patch.no_speed_to_change",
            "the statement has no path speed that could be changed",
        )
    new = unit if unit in MM_PER_S else ("mm/sek" if unit.endswith("sek") else "mm/sec")
    digits = _digits(number, new) if new == unit else 0
    text = decimal(value / MM_PER_S[new], digits, digits)
    if float(text) == 0.0:
        raise work.refuse(
            line,
            "programs.patch.too_slow",
            "{value:g} mm/s is less than {unit} can say there",
            value=value,
            unit=new,
        )
    source.replace(found.start(1), found.end(1), text)
    source.replace(found.start(3), found.end(3), new)


def _set_v(source: Source, work: Work, line: int, value: float) -> None:
    found = V.search(source.line(line))
    begin = source.span(line)[0]
    if re.search(r"\sV[RE]=", source.line(line)):
        raise work.refuse(line, "programs.patch.no_path_speed_word", "VR= or VE= is no path speed")
    text = decimal(value, 1, 1)
    if float(text) == 0.0:
        raise work.refuse(
            line, "programs.patch.too_slow_v", "{value:g} mm/s is less than V= can say", value=value
        )
    if found:
        if "." not in found.group(2):
            raise work.refuse(
                line,
                "programs.patch.speed_unit",
                "V= without a decimal point may be mm/s or cm/min",
            )
        source.replace(begin + found.start(2), begin + found.end(2), text)
        return
    position = MOVE.match(source.line(line))
    if not position:
        raise work.refuse(
            line,
            "programs.patch.instruction",
            "the instruction is not understood; change it by hand",
        )
    source.replace(begin + position.end(), begin + position.end(), f" V={text}")


def _shared(work: Work, used: Used, position: int, shift: Shift, mine: int) -> Floats:
    """Raises unless all statements that use a position move it by the same."""
    step = work.in_base(shift)
    for line, target in used[position]:
        other = work.shifts.get(line, {}).get(target)
        there = None if other is None else work.in_base(other)
        if step is None or there is None or np.abs(there - step).max() > 1e-9:
            name = f"P[{position}]" if work.program.language == "Fanuc TP" else f"C{position}"
            raise work.refuse(
                mine,
                "programs.patch.shared_target",
                "{name} is the target in line {other} as well; offset all its motions by "
                "the same",
                name=name,
                other=line,
            )
    return known(step)


def _move_positions(source: Source, work: Work) -> None:
    text = source.text
    mn = known(re.search(r"^\s*/MN\b", text, re.MULTILINE))
    pos = re.search(r"^\s*/POS\b", text, re.MULTILINE)  # None: all targets are registers'
    stop = pos.start() if pos else len(text)
    used: dict[int, list[tuple[int, int]]] = {}
    own: dict[int, list[int]] = {}
    line = 1
    for match in re.finditer(rf"(?<![A-Z])P\s*{INDEX}", text[:stop]):
        if match.start() < mn.end():
            continue
        n = re.match(r"\s*(\d+)\s*(?::|$)", match.group(1))
        while line < len(source) and source.starts[line] <= match.start():
            line += 1
        statement = line
        while re.match(r"\s*:", source.line(statement)):  # continues the one before
            statement -= 1
        if not n:
            raise work.refuse(
                line,
                "programs.patch.any_position",
                "P[{index}] may be any position; none is moved",
                index=match.group(1),
            )
        targets = own.setdefault(statement, [])
        used.setdefault(int(n.group(1)), []).append((statement, len(targets)))
        targets.append(int(n.group(1)))
    blocks = {int(m.group(1)): m for m in BLOCK.finditer(text, stop)}
    done = set()
    for line, target, shift in work.targets():
        begin = source.span(line)[0]
        if re.search(r"\bINC\b", text[begin : text.find(";", begin)]):
            raise work.refuse(line, "programs.patch.inc", "INC is relative to the motion before it")
        mine = own.get(line, [])
        number = mine[target] if target < len(mine) else -1
        if number not in blocks:
            raise work.refuse(
                line, "programs.patch.no_position", "its target is no position of this program"
            )
        if number in done:  # and compared with all that use it
            continue
        done.add(number)
        step = _shared(work, used, number, shift, line)
        body = blocks[number].span(2)
        first = text.find("GP1", *body)
        places = {
            m.group(1): m for m in reversed(list(PLACE.finditer(text, max(first, 0), body[1])))
        }
        for name, value in zip("XYZ", step):
            if value:
                place = places[name]
                new = moved(place.group(3), value, 3)
                blanks = place.group(2)
                # The number grows or shrinks at the cost of the blanks in front of it.
                room = len(blanks) + len(place.group(3)) - len(new)
                equals = blanks.rstrip()
                blanks = equals.ljust(max(room, len(equals)))
                source.replace(place.start(2), place.end(3), blanks + new)


def _move_rows(source: Source, work: Work) -> None:
    rows: dict[int, tuple[int, re.Match[str]]] = {}
    used: dict[int, list[tuple[int, int]]] = {}
    for line in range(1, len(source) + 1):
        row = ROW.match(source.line(line))
        if row:
            rows[int(row.group(1))] = (source.span(line)[0], row)
        for found in re.finditer(r"(?<![A-Z])C(\d+)(?=\s|$)", source.line(line)):
            used.setdefault(int(found.group(1)), []).append((line, 0))
    done = set()
    for line, _, shift in work.targets():
        move = re.match(r"\s*MOV[JLCS]\s+C(\d+)(?=\s|$)", source.line(line))
        if not move or int(move.group(1)) not in rows:
            raise work.refuse(
                line,
                "programs.patch.no_c_position",
                "its target is no C position: a variable is other jobs' as well",
            )
        n = int(move.group(1))
        if n in done:  # and compared with all that use it
            continue
        done.add(n)
        step = _shared(work, used, n, shift, line)
        begin, row = rows[n]
        for k, value in enumerate(step, 2):
            if value:
                source.replace(
                    begin + row.start(k), begin + row.end(k), moved(row.group(k), value, 3)
                )
