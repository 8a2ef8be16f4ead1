"""Writes changes back into KUKA KRL: the modal $VEL.CP, WITH in splines, targets.

A target in data is moved by the geometric operator; a literal one by its numbers. An inline form
whose BAS(#CP_PARAMS, v) governs its motion only gets v there and in the form's own text.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ...base.kinds import Floats, known
from ..languages.krl.blocks import ASSIGN, HARMLESS, MOTION, OPENING
from ..languages.krl.motions import SPEED
from .text import SMALL, decimal, moved, plan

if TYPE_CHECKING:
    from .text import Shift, Source, Work

ROUNDING_MM = 6e-5
SPEED_DIGITS = 9  # of m/s
CODE = re.compile(r'(?:[^";]|"[^"]*")*')
WORD = re.compile(r"\w+")
DEFINED = re.compile(r"(?:GLOBAL\s+)?DEF(?:FCT\s+\w+)?\s+(\w+)", re.IGNORECASE)
CALL = re.compile(r"([A-Za-z_]\w*)\s*\(")
BAS = re.compile(r"BAS\s*\(\s*#(?:CP_PARAMS|VEL_CP)\s*,\s*([^,)]*?)\s*\)", re.IGNORECASE)
CLOSING = {*OPENING.values(), "else", "case", "default", "goto", "return", "exit", "resume"}
REST = re.compile(r"\s+(?:C_\w+|CA\b|WITH\b|#\w+)", re.IGNORECASE)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?$")
FORM = re.compile(r"\s*;\s*FOLD\s+(?:S?LIN|S?CIRC)\b.*?\bVel\s*=\s*([\d.]+)\s*m/s", re.IGNORECASE)
FORM_PARAMETER = re.compile(r",\s*5:\s*([\d.]+)")
FORM_LINES = 8  # from a form's FOLD to its BAS at most

Codes: TypeAlias = "dict[int, tuple[int, int]]"  # of lines: (begin, end) of their statement


def derived(source: Source, line: int) -> bool:
    return False


def rounding_mm_s(source: Source, line: int) -> float:
    return 1e-6


def edit(source: Source, work: Work) -> None:
    work.no_force()
    codes = _codes(source)
    _speeds(source, work, codes)
    for line, target, shift in work.targets():
        _move(source, work, codes, line, target, shift)


def _codes(source: Source) -> Codes:
    """{line: (begin, end)} of the statements, without comments and blanks."""
    codes: Codes = {}
    for line in range(1, len(source) + 1):
        text = known(CODE.match(source.line(line))).group(0)
        begin = source.span(line)[0] + len(text) - len(text.lstrip())
        if text.strip() and not text.lstrip().startswith("&"):
            codes[line] = (begin, source.span(line)[0] + len(text.rstrip()))
    return codes


def _word(text: str) -> str:
    """The first word of a statement, in lower case."""
    word = WORD.match(text)
    return word.group(0).lower() if word else ""


def _role(source: Source, work: Work, line: int, text: str, routines: Collection[str]) -> str:
    """What a statement is to the modal speed (patch_text.plan)."""
    word = _word(text)
    motion = MOTION.match(text)
    if motion:
        if motion.group(1).upper() in ("PTP", "SPTP", "PTP_REL", "SPTP_REL"):
            return "plain"
        if line not in work.lines:
            return "barrier"
        return "plain" if SPEED.search(_tail(text)) else "path"
    assigned = ASSIGN.match(text)
    if assigned and word not in ("trigger", "wait", "interrupt", "for", "spline"):
        name = assigned["path"].lower()
        return "speed" if name == "$vel.cp" else "barrier" if name == "$vel" else "plain"
    if word in ("spline", "endspline"):
        return "plain"
    if word in OPENING or word in CLOSING or re.match(r"\w+\s*:", text):
        return "barrier"
    if word in ("end", "endfct"):
        return "end" if len(routines) == 1 else "barrier"
    if word in ("def", "deffct") or text.lower().startswith("global def"):
        return "barrier"
    if BAS.match(text):
        return "speed"
    call = CALL.match(text)
    if call and word not in ("trigger", "wait", "interrupt", "decl", "bas", *HARMLESS):
        return "barrier" if word in routines else "lost"
    return "plain"


def _speeds(source: Source, work: Work, codes: Codes) -> None:
    """Speeds in splines by WITH, all others by the modal $VEL.CP."""
    if not work.speeds:
        return
    wanted = dict(work.speeds)
    statements: list[tuple[int, str]] = []
    spline: tuple[int, list[int]] | None = None
    texts = {line: source.text[slice(*span)] for line, span in codes.items()}
    heads = (DEFINED.match(text) for text in texts.values())
    routines = {head.group(1).lower() for head in heads if head}
    for line, text in texts.items():
        word = _word(text)
        role = _role(source, work, line, text, routines)
        if word == "spline":
            spline = (line, [])
        elif word == "endspline" and spline:
            _spline(source, work, codes, wanted, *spline)
            spline = None
        elif spline and MOTION.match(text):
            spline[1].append(line)
            header = bool(SPEED.search(texts[spline[0]]))
            role = "plain" if header or line in wanted else role
        elif line in wanted and role == "plain":
            _with(source, codes, line, wanted.pop(line))
        statements.append((line, role))
    found = plan(statements, wanted, work.speed_before, work.refuse)
    for what, line, value in found:
        text = f"$VEL.CP={decimal(value / 1000.0, SPEED_DIGITS)}"
        if what == "before":
            source.insert_before(line, text)
        elif what == "after":
            source.insert_after(line, text)
        else:
            _set(source, codes, line, value)


def _spline(
    source: Source,
    work: Work,
    codes: Codes,
    wanted: dict[int, float],
    header: int,
    lines: Sequence[int],
) -> None:
    """The speeds of a spline block's motions: in its head where all get the same."""
    values = {wanted.pop(line, None) for line in lines}
    mine = {line: work.speeds[line] for line in lines if line in work.speeds}
    own = any(SPEED.search(_tail(source.text[slice(*codes[line])])) for line in lines)
    begin, end = codes[header]
    head = SPEED.search(source.text, begin, end)
    if len(values) == 1 and mine and head and not own:
        source.replace(*head.span(1), decimal(known(values.pop()) / 1000.0, SPEED_DIGITS))
        return
    for line, value in mine.items():
        _with(source, codes, line, value)


def _with(source: Source, codes: Codes, line: int, value: float) -> None:
    """A speed of a motion's own."""
    begin, end = codes[line]
    text = decimal(value / 1000.0, SPEED_DIGITS)
    code = source.text[begin:end]
    tail = len(code) - len(_tail(code))
    found = SPEED.search(code, tail)
    if found:
        source.replace(begin + found.start(1), begin + found.end(1), text)
        return
    given = re.search(r"\bWITH\b", code, re.IGNORECASE)
    if given:
        source.replace(begin + given.end(), begin + given.end(), f" $VEL.CP={text},")
        return
    at = begin + _targets(code)[-1][1]
    source.replace(at, at, f" WITH $VEL.CP={text}")


def _set(source: Source, codes: Codes, line: int, value: float) -> None:
    """The speed in an assignment or a BAS, and in the inline form around it."""
    begin, end = codes[line]
    text = decimal(value / 1000.0, SPEED_DIGITS)
    code = source.text[begin:end]
    bas = BAS.match(code)
    span = bas.span(1) if bas else known(ASSIGN.match(code)).span("value")
    first, last = begin + span[0], begin + span[1]
    while first < last and source.text[first].isspace():
        first += 1
    source.replace(first, last, text)
    for k in range(line - 1, max(0, line - 1 - FORM_LINES), -1) if bas else ():
        row, start = source.line(k), source.span(k)[0]
        if re.match(r"\s*;\s*(END)?FOLD", row, re.IGNORECASE):
            form = FORM.match(row)
            parameter = form and FORM_PARAMETER.search(row)
            for match in (form, parameter):
                if match and match.group(1) == source.text[first:last]:
                    source.replace(start + match.start(1), start + match.end(1), text)
            break


def _tail(text: str) -> str:
    """What follows a motion's targets."""
    return text[_targets(text)[-1][1] :]


def _targets(text: str) -> list[tuple[int, int]]:
    """Spans of the targets of a motion statement."""
    spans: list[tuple[int, int]] = []
    depth, first = 0, known(MOTION.match(text)).start(2)
    for at in range(first, len(text) + 1):
        letter = text[at] if at < len(text) else ""
        rest = depth == 0 and letter.isspace() and REST.match(text, at)
        if rest or not letter or (letter == "," and depth == 0):
            stop = first + len(text[first:at].rstrip())
            spans.append((first + len(text[first:stop]) - len(text[first:stop].lstrip()), stop))
            if letter != ",":
                return spans
            first = at + 1
        depth += (letter in ("{", "(", "[")) - (letter in ("}", ")", "]"))
    return spans


def _move(source: Source, work: Work, codes: Codes, line: int, target: int, shift: Shift) -> None:
    begin, end = codes[line]
    code = source.text[begin:end]
    motion = MOTION.match(code)
    if not motion:
        raise work.refuse(
            line,
            "programs.patch.motion_not_found",
            "the motion is not found in its line; change it by hand",
        )
    if "_REL" in motion.group(1).upper():
        work.relative(line, shift, motion.group(1).upper())
        return
    spans = _targets(code)
    first, last = (begin + at for at in spans[target])
    text = source.text[first:last]
    if text.startswith("{") and ":" not in text.partition(":")[2]:
        _move_literal(source, work, line, shift, first, text)
        return
    step = work.in_base(shift)
    if step is not None and (shift.base.any() or work.in_tool(shift) is None):
        left, right = _frame(step) + " : ", ""
    else:
        step = work.in_tool(shift)
        if step is None:
            raise work.refuse(
                line,
                "programs.patch.rounds_tool",
                "its rounds are turned differently; give tool_dz_mm only",
            )
        left, right = "", " : " + _frame(step)
    source.replace(first, last, left + text + right)


def _frame(step: Floats) -> str:
    x, y, z = (decimal(v, 6) for v in np.round(step, 6))
    return f"{{FRAME: X {x},Y {y},Z {z},A 0,B 0,C 0}}"


def _move_literal(
    source: Source, work: Work, line: int, shift: Shift, first: int, text: str
) -> None:
    """The numbers of an aggregate; a component it does not name is the motion's before."""
    step = work.in_base(shift)
    if step is None:
        raise work.refuse(
            line,
            "programs.patch.rounds_literal",
            "its rounds are turned differently; a literal cannot tell them",
        )
    places: dict[str, tuple[int, int]] = {}
    for match in re.finditer(r"(?:[{,:])\s*([A-Za-z_]\w*)\s+([^,{}]+?)\s*(?=[,}])", text):
        places[match.group(1).upper()] = match.span(2)
    last = max((span[1] for span in places.values()), default=None)
    for name, value in zip("XYZ", step):
        if name in places:
            at, stop = places[name]
            number = text[at:stop].replace(" ", "")
            if not value:
                continue
            if not NUMBER.match(number):
                raise work.refuse(
                    line,
                    "programs.patch.no_plain_number",
                    "its {name} is no plain number; change it by hand",
                    name=name,
                )
            source.replace(first + at, first + stop, moved(number, value))
            continue
        due = value - work.inherited(shift, line)["XYZ".index(name)]
        if abs(due) >= SMALL:
            if last is None or len(shift.motions) > 1:
                raise work.refuse(
                    line,
                    "programs.patch.not_given",
                    "its {name} is not given; change it by hand",
                    name=name,
                )
            place = known(work.program.motions[shift.motions[0]].pose)["XYZ".index(name), 3] + value
            source.replace(first + last, first + last, f",{name} {decimal(place, 6)}")
