"""Writes changes back into G-code and APT: the modal F and FEDRAT, coordinates of linear motions."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from typing import TYPE_CHECKING, TypeAlias

from ...base.kinds import known
from ..languages.apt.words import HARMLESS, NUMBER, TEXT
from ..languages.gcode.units import COMMENT
from .text import SMALL, decimal, decimals, moved, plan

if TYPE_CHECKING:
    from .text import Source, Work

ROUNDING_MM = 6e-5
TURN_IS_FREE = True  # x follows from the whole pass
FEED = re.compile(r"(?<![A-Z])F\s*=?\s*((?:\d+\.?\d*|\.\d+))(?![\w.])")
PLACE = r"(?<![A-Z]){axis}\s*=?\s*([-+]?(?:\d+\.?\d*|\.\d+))(?![\w.])"
FEED_DIGITS = 4
GOTO = re.compile(
    r"\s*GOTO\s*/\s*" + r"\s*,[\s$]*".join([f"({NUMBER.pattern})"] * 3), re.IGNORECASE
)

Feed: TypeAlias = "tuple[int, re.Match[str]]"  # its line, and where it stands there


def derived(source: Source, line: int) -> bool:
    return False


def rounding_mm_s(source: Source, line: int) -> float:
    return 1e-4


def edit(source: Source, work: Work) -> None:
    work.no_force()
    (_gcode if work.program.language == "G-code" else _apt)(source, work)


def _scaled(text: str, factor: float) -> str:
    """A written feed times ``factor``, with a point if it had one."""
    had = decimals(text)
    new = decimal(float(text) * factor, max(had, FEED_DIGITS), had)
    return new + "." if text.endswith(".") and "." not in new else new


# G-code


def _code(text: str) -> str:
    """A block in capitals, comments blanked place by place."""
    code, count = text.upper(), 1
    while count:
        code, count = COMMENT.subn(lambda m: " " * len(m.group()), code)
        if not count or not code.strip() or not COMMENT.search(code):
            break
    return code


def _gcode(source: Source, work: Work) -> None:
    codes = {line: _code(source.line(line)) for line in range(1, len(source) + 1)}
    troubled = {problem.line for problem in work.program.problems}
    statements: list[tuple[int, str]] = []
    feeds: dict[int, Feed | None] = {}
    last: Feed | None = None
    for line, code in codes.items():
        found = FEED.search(code)
        role = _gcode_role(work, line, code, found, troubled)
        if role in ("both", "speed") and found:
            last = (line, found)
        feeds[line] = last
        statements.append((line, role))
        if role == "end":
            break
    meant = _known(work, {line: place and place[0] for line, place in feeds.items()})
    for what, line, value in plan(statements, work.speeds, work.speed_before, work.refuse):
        begin = source.span(line)[0]
        place = feeds[line]
        if place is None:
            raise work.refuse(
                line,
                "programs.patch.no_feed",
                "no F before it tells the unit; write one in by hand",
            )
        if what == "after":
            source.insert_after(line, _word(source, place))
            continue
        if place[0] not in meant:
            raise work.refuse(
                line,
                "programs.patch.feed_meaning",
                "what F means there is not known; change it by hand",
            )
        text = _scaled(place[1].group(1), value / meant[place[0]])
        if what == "set":
            source.replace(begin + place[1].start(1), begin + place[1].end(1), text)
        else:
            at = begin + len(codes[line].rstrip())
            source.replace(at, at, f" F{text}")
    if work.shifts:
        _gcode_shifts(source, work, codes)


def _gcode_role(
    work: Work, line: int, code: str, feed: re.Match[str] | None, troubled: Collection[int]
) -> str:
    if re.search(r"(?<![A-Z])M\s*0*(2|30)(?![\d.])", code):
        return "end"
    if line in work.lines and work.program.motions[work.lines[line][0]].pose is not None:
        if work.program.motions[work.lines[line][0]].kind == "PTP":
            return "speed" if feed else "plain"
        return "both" if feed else "path"
    if line in troubled or line in work.lines or re.search(r"(?<![A-Z])G\s*9[35](?![\d.])", code):
        return "lost"
    return "speed" if feed and not re.search(r"(?<![A-Z])G\s*0*4(?![\d.])", code) else "plain"


def _known(work: Work, feeds: Mapping[int, int | None]) -> dict[int, float]:
    """{line of a feed: mm/s of the motions it governs}; feeds: that line by line."""
    meant: dict[int, float] = {}
    for line, place in feeds.items():
        speed = work.speed_before(line) if line in work.lines else None
        if speed and place:
            meant.setdefault(place, speed)
    return meant


def _word(source: Source, place: Feed) -> str:
    begin = source.span(place[0])[0]
    return source.text[begin + place[1].start() : begin + place[1].end()]


def _one_unit(work: Work, line: int) -> None:
    """Raises ProgramError where a program's motions are in several units of length."""
    if len(work.program.units_mm) > 1:
        raise work.refuse(
            line,
            "programs.patch.inches_and_mm",
            "the file changes between inches and mm; nothing is moved",
        )


def _gcode_shifts(source: Source, work: Work, codes: Mapping[int, str]) -> None:
    relative = any(re.search(r"(?<![A-Z])G91(?![\d.])", c) for c in codes.values())
    scale = max(work.program.units_mm, default=1.0)
    for line, _, shift in work.targets():
        step = work.in_base(shift)
        code = codes[line]
        if relative:
            raise work.refuse(
                line,
                "programs.patch.g91",
                "G91 makes motions relative to those before; none is moved",
            )
        _one_unit(work, line)
        if step is None or work.program.motions[shift.motions[0]].kind == "CIRC":
            raise work.refuse(
                line, "programs.patch.arc_or_subprogram", "an arc or a subprogram is not moved"
            )
        begin = source.span(line)[0]
        more = ""
        for axis, value in zip("XYZ", step):
            found = re.search(PLACE.format(axis=axis), code)
            digits = 5 if scale > 1.0 else 4
            if found and value:
                text = moved(found.group(1), value / scale, digits)
                source.replace(begin + found.start(1), begin + found.end(1), text)
            elif not found and abs(value - work.inherited(shift, line)["XYZ".index(axis)]) > SMALL:
                first = known(work.program.motions[shift.motions[0]].pose)
                place = first["XYZ".index(axis), 3] + value
                more += f" {axis}{decimal(place / scale, digits, 1)}"
        at = begin + len(code.rstrip())
        source.replace(at, at, more)


# APT


def _apt_statements(source: Source) -> Iterator[tuple[int, int, str, str]]:
    """(first line, last line, word, text) of each statement, comments left out."""
    first: int | None = None
    parts: list[str] = []
    for line in range(1, len(source) + 1):
        text, comment, _ = source.line(line).partition("$$")
        text = text.strip()
        if not text and not parts:
            continue
        first = first or line
        parts.append(text)
        if text.endswith("$") and not comment:
            continue
        whole = "".join(part.rstrip("$") if part.endswith("$") else part for part in parts)
        yield first, line, whole.partition("/")[0].strip().upper(), whole
        first, parts = None, []


def _apt(source: Source, work: Work) -> None:
    statements: list[tuple[int, str]] = []
    feeds: dict[int, tuple[int, str] | None] = {}
    ends: dict[int, int] = {}
    fronts: dict[int, int] = {}
    last: tuple[int, str] | None = None
    before: int | None = None
    for first, end, word, text in _apt_statements(source):
        role = _apt_role(work, first, word, text)
        if word == "FEDRAT" and role == "speed":
            last = (first, text)
        feeds[first], ends[first] = last, end
        # Nothing stands between a CIRCLE and the motion that ends it.
        fronts[first] = before if before and before not in work.lines and word == "GOTO" else first
        before = first if word in ("CIRCLE", "MOVARC") else None
        statements.append((first, role))
        if role == "end":
            break
    meant = _known(work, {line: feed and feed[0] for line, feed in feeds.items()})
    for what, line, value in plan(statements, work.speeds, work.speed_before, work.refuse):
        feed = feeds[line]
        if feed is None:
            raise work.refuse(
                line,
                "programs.patch.no_fedrat",
                "no FEDRAT before it tells the unit; write one in by hand",
            )
        place, text = feed
        if what == "after":
            source.insert_after(ends[line], text)
            continue
        found = NUMBER.search(text, text.index("/"))
        if found is None or place not in meant:
            raise work.refuse(
                line,
                "programs.patch.fedrat_meaning",
                "what FEDRAT means there is not known; change it by hand",
            )
        new = _scaled(found.group(), value / meant[place])
        if what == "set":
            begin = source.span(line)[0]
            at = source.text.index(found.group(), source.text.index("/", begin))
            source.replace(at, at + len(found.group()), new)
        else:
            source.insert_before(fronts[line], text[: found.start()] + new + text[found.end() :])
    scale = max(work.program.units_mm, default=1.0)
    for line, _, shift in work.targets():
        _one_unit(work, line)
        begin, end = source.span(line)[0], source.span(ends.get(line, line))[1]
        step = work.in_base(shift)
        found = GOTO.match(source.text, begin, end)
        kind = work.program.motions[shift.motions[0]].kind
        if re.match(r"\s*GODLTA", source.text[begin:end], re.IGNORECASE):
            work.relative(line, shift, "GODLTA")
            continue
        if not found or step is None or kind == "CIRC":
            raise work.refuse(
                line, "programs.patch.only_goto", "only GOTO with plain numbers is moved, no arc"
            )
        for k, value in enumerate(step, 1):
            if value:
                text = moved(found.group(k), value / scale, 5 if scale > 1.0 else 4)
                source.replace(*found.span(k), text)


def _apt_role(work: Work, line: int, word: str, text: str) -> str:
    if word == "FINI":
        return "end"
    if line in work.lines:
        motion = work.program.motions[work.lines[line][0]]
        if motion.pose is None:
            return "barrier"
        return "plain" if motion.kind == "PTP" else "path"
    if word == "FEDRAT":
        return "speed" if NUMBER.search(text, text.find("/") + 1) else "plain"
    if word in HARMLESS or text.upper().startswith(TEXT) or word in ("CIRCLE", "MOVARC", "MSYS"):
        return "plain"
    return "lost"
