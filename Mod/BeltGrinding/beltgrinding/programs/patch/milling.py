"""Writes changes back into G-code and APT: the modal F and FEDRAT, coordinates of linear motions."""

import re

from ..readers.apt import HARMLESS, NUMBER, TEXT
from ..readers.gcode import COMMENT, INCH
from .text import SMALL, decimal, decimals, moved, plan

ROUNDING_MM = 6e-5
TURN_IS_FREE = True  # x follows from the whole pass
FEED = re.compile(r"(?<![A-Z])F\s*=?\s*((?:\d+\.?\d*|\.\d+))(?![\w.])")
PLACE = r"(?<![A-Z]){axis}\s*=?\s*([-+]?(?:\d+\.?\d*|\.\d+))(?![\w.])"
FEED_DIGITS = 4
GOTO = re.compile(
    r"\s*GOTO\s*/\s*" + r"\s*,[\s$]*".join([f"({NUMBER.pattern})"] * 3), re.IGNORECASE
)


def derived(source, line):
    return False


def rounding_mm_s(source, line):
    return 1e-4


def edit(source, work):
    work.no_force()
    (_gcode if work.program.language == "G-code" else _apt)(source, work)


def _scaled(text, factor):
    """A written feed times ``factor``, with a point if it had one."""
    had = decimals(text)
    new = decimal(float(text) * factor, max(had, FEED_DIGITS), had)
    return new + "." if text.endswith(".") and "." not in new else new


# G-code


def _code(text):
    """A block in capitals, comments blanked place by place."""
    code, count = text.upper(), 1
    while count:
        code, count = COMMENT.subn(lambda m: " " * len(m.group()), code)
        if not count or not code.strip() or not COMMENT.search(code):
            break
    return code


def _gcode(source, work):
    codes = {line: _code(source.line(line)) for line in range(1, len(source) + 1)}
    troubled = {problem.line for problem in work.program.problems}
    statements, feeds, last = [], {}, None
    for line, code in codes.items():
        found = FEED.search(code)
        role = _gcode_role(work, line, code, found, troubled)
        if role in ("both", "speed") and found:
            last = (line, found)
        feeds[line] = last
        statements.append((line, role))
        if role == "end":
            break
    known = _known(work, {line: place and place[0] for line, place in feeds.items()})
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
        if place[0] not in known:
            raise work.refuse(
                line,
                "programs.patch.feed_meaning",
                "what F means there is not known; change it by hand",
            )
        text = _scaled(place[1].group(1), value / known[place[0]])
        if what == "set":
            source.replace(begin + place[1].start(1), begin + place[1].end(1), text)
        else:
            at = begin + len(codes[line].rstrip())
            source.replace(at, at, f" F{text}")
    if work.shifts:
        _gcode_shifts(source, work, codes)


def _gcode_role(work, line, code, feed, troubled):
    if re.search(r"(?<![A-Z])M\s*0*(2|30)(?![\d.])", code):
        return "end"
    if line in work.lines and work.program.motions[work.lines[line][0]].pose is not None:
        if work.program.motions[work.lines[line][0]].kind == "PTP":
            return "speed" if feed else "plain"
        return "both" if feed else "path"
    if line in troubled or line in work.lines or re.search(r"(?<![A-Z])G\s*9[35](?![\d.])", code):
        return "lost"
    return "speed" if feed and not re.search(r"(?<![A-Z])G\s*0*4(?![\d.])", code) else "plain"


def _known(work, feeds):
    """{line of a feed: mm/s of the motions it governs}; feeds: that line by line."""
    known = {}
    for line, place in feeds.items():
        speed = work.speed_before(line) if line in work.lines else None
        if speed and place:
            known.setdefault(place, speed)
    return known


def _word(source, place):
    begin = source.span(place[0])[0]
    return source.text[begin + place[1].start() : begin + place[1].end()]


def _gcode_shifts(source, work, codes):
    inches, metric, relative = (
        any(re.search(rf"(?<![A-Z])G({code})(?![\d.])", c) for c in codes.values())
        for code in ("20|70", "21|71", "91")
    )
    for line, _, shift in work.targets():
        step = work.in_base(shift)
        code = codes[line]
        if relative:
            raise work.refuse(
                line,
                "programs.patch.g91",
                "G91 makes motions relative to those before; none is moved",
            )
        if inches and metric:
            raise work.refuse(
                line,
                "programs.patch.inches_and_mm",
                "the file changes between inches and mm; nothing is moved",
            )
        if step is None or work.program.motions[shift.motions[0]].kind == "CIRC":
            raise work.refuse(
                line, "programs.patch.arc_or_subprogram", "an arc or a subprogram is not moved"
            )
        scale = INCH if inches else 1.0
        begin = source.span(line)[0]
        more = ""
        for axis, value in zip("XYZ", step):
            found = re.search(PLACE.format(axis=axis), code)
            digits = 5 if scale > 1.0 else 4
            if found and value:
                text = moved(found.group(1), value / scale, digits)
                source.replace(begin + found.start(1), begin + found.end(1), text)
            elif not found and abs(value - work.inherited(shift, line)["XYZ".index(axis)]) > SMALL:
                place = work.program.motions[shift.motions[0]].pose["XYZ".index(axis), 3] + value
                more += f" {axis}{decimal(place / scale, digits, 1)}"
        at = begin + len(code.rstrip())
        source.replace(at, at, more)


# APT


def _apt_statements(source):
    """(first line, last line, word, text) of each statement, comments left out."""
    first, parts = None, []
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
        yield first, line, re.match(r"[^/]*", whole).group(0).strip().upper(), whole
        first, parts = None, []


def _apt(source, work):
    statements, feeds, ends, fronts = [], {}, {}, {}
    last = before = None
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
    known = _known(work, {line: feed and feed[0] for line, feed in feeds.items()})
    for what, line, value in plan(statements, work.speeds, work.speed_before, work.refuse):
        if feeds[line] is None:
            raise work.refuse(
                line,
                "programs.patch.no_fedrat",
                "no FEDRAT before it tells the unit; write one in by hand",
            )
        place, text = feeds[line]
        if what == "after":
            source.insert_after(ends[line], text)
            continue
        found = NUMBER.search(text, text.index("/"))
        if place not in known:
            raise work.refuse(
                line,
                "programs.patch.fedrat_meaning",
                "what FEDRAT means there is not known; change it by hand",
            )
        new = _scaled(found.group(), value / known[place])
        if what == "set":
            begin = source.span(line)[0]
            at = source.text.index(found.group(), source.text.index("/", begin))
            source.replace(at, at + len(found.group()), new)
        else:
            source.insert_before(fronts[line], text[: found.start()] + new + text[found.end() :])
    inches = re.search(r"(?im)^\s*UNITS\s*/\s*IN", source.text)
    for line, _, shift in work.targets():
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
                text = moved(found.group(k), value / (INCH if inches else 1.0), 5 if inches else 4)
                source.replace(*found.span(k), text)


def _apt_role(work, line, word, text):
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
