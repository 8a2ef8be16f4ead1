"""Programs with one statement that no reader understands, and what may become of their motions.

What a statement touches is unknown where it is not understood: motions are lost with a word, or their speed or
frame is told as not known. None lies elsewhere, goes at another speed or in another frame.
"""

import re
from typing import NamedTuple

import numpy as np

SAME = 1e-6  # mm, and of a rotation's elements
UNCLOSED = {"programs.urscript.no_end"}  # where blocks end is not known then
STRING = r'"[^"\n]*"'
NAME = r"[A-Za-z_$][\w$]*"
NUMBER = r"(?<![\w.$#])(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])"


class Language(NamedTuple):
    """How the text of a language is made one that is not understood."""

    number: str  # in place of a number {}
    comment: str  # what is no statement
    lines: str = ""  # of which lines; all without it
    name: str = "zz{}"  # in place of a name {}
    numbers: str = NUMBER
    # Any word may be a procedure, of which nothing is known: what is said at its line may change the rest.
    procedures: bool = False


LANGUAGES = {
    ".src": Language("ZZF({})", r";.*", procedures=True),
    ".mod": Language("zzf({})", r"!.*", procedures=True),
    ".script": Language("zzf({})", r"#.*", procedures=True),
    ".ls": Language("R[977]", r"!.*", r"\s*\d*:", "ZZ{}", procedures=True),
    ".jbi": Language("D977", r"'.*", name="ZZ{}", procedures=True),
    ".nc": Language("#977", r"\([^)]*\)|;.*|(?<![A-Z])N\d+", numbers=r"(?<=[A-Z=])[-+]?(?:\d+\.?\d*|\.\d+)", procedures=True),
    ".mpf": Language("R977", r";.*|(?<![A-Z])N\d+", numbers=r"(?<=[A-Z=])[-+]?(?:\d+\.?\d*|\.\d+)", procedures=True),
    ".h": Language("Q1977", r";.*|\*.*|^\d+(?=\s)", name="ZZ{}", numbers=r"(?<=[A-Z+\- ])(?:\d+\.?\d*|\.\d+)", procedures=True),
    ".ngc": Language("#977", r"\([^)]*\)|;.*", numbers=r"(?<=[A-Z=\[*+ ])[-+]?(?:\d+\.?\d*|\.\d+)", procedures=True),
    ".as": Language("SIG({})", r";.*", procedures=True),
    ".apt": Language("ZZV", r"\$\$.*|(?<=LOADTL/)\d+", name="ZZ{}", procedures=True),
    ".csv": Language("?", r"#.*"),
    ".pgx": Language("zzf({})", r"//.*|<[^>]*>|\]\]>|<!\[CDATA\[", procedures=True),
    ".urp": Language("?", r"<\?[^>]*>", name=""),
}  # fmt: skip


# Where another name would be no statement that is not understood, but a sound one about something else.
ROUTINE = r"(?im)^\s*(?:LOCAL\s+)?(?:PROC|FUNC\s+\w+|DEF|DEFFCT\s+\w+)\s+(\w+)"
HEAD = rf"{ROUTINE}|(?i:^\s*\w+\s*:\s*$)"
LOOP = r"(?i)^\s*FOR\s+$"
DECLARED = r"(?i)^\s*(?:(?:LOCAL|TASK|GLOBAL|DECL|CONST|PERS|VAR)\b\s*)+(?:\w+\s+)*$"


def _renames(row, match, own):
    """Whether a name is one that a statement declares, assigns, or hands to a routine of the file."""
    before, first = row[: match.start()], re.match(r"\s*(\w*)", row)[1].lower()
    if re.match(LOOP, before) or match[0].lower() in own:
        return True
    if re.match(DECLARED, before) and re.match(
        r"\s*(?:\{[^}]*\}\s*)?(:?=|;|$)", row[match.end() :]
    ):
        return True
    if before[-1:] != "\\" and re.match(r"\s*(?:\{[^}]*\}|\.\w+)*\s*:=", row[match.end() :]):
        return True
    return first in own and bool(before.strip())


class Mutant(NamedTuple):
    text: str
    line: int
    at: int  # column of what was changed
    first: bool  # it is the statement's own word

    def __str__(self):
        return f"line {self.line}: {self.text.splitlines()[self.line - 1].strip()[:120]}"


def mutants(text, suffix):
    """All Mutants of a program: each number and each name, one at a time, is one that says nothing."""
    language = LANGUAGES[suffix]
    token = re.compile(
        rf"(?P<skipped>{STRING}|{language.comment})|(?P<number>{language.numbers})|(?P<name>{NAME})"
    )
    found, rows = [], text.split("\n")
    own = {one.lower() for one in re.findall(ROUTINE, text)}
    for k, row in enumerate(rows):
        if language.lines and not re.match(language.lines, row) or re.search(HEAD, row):
            continue
        begin = re.match(language.lines, row).end() if language.lines else 0
        assigned = re.search(r"(?<![:<>=!])(?::=|=)(?!=)", row)
        first = True
        for match in token.finditer(row, begin):
            kind = match.lastgroup
            if kind == "skipped":
                continue
            if kind == "name" and first and assigned and match.start() < assigned.start():
                first = False  # it would be another that is assigned
                if not re.match(r"(?i)(FOR|IF|DECL|CONST|PERS|VAR|LOCAL|GLOBAL|while)\b", match[0]):
                    continue
            if kind == "name" and (not language.name or _renames(row, match, own)):
                continue
            other = (language.number if kind == "number" else language.name).format(match[0])
            text = "\n".join(
                [*rows[:k], row[: match.start()] + other + row[match.end() :], *rows[k + 1 :]]
            )
            found.append(Mutant(text, k + 1, match.start(), first and kind == "name"))
            first = False
    return found


class Told(NamedTuple):
    """What a reader tells of a motion."""

    line: int
    kind: str
    aux: bool
    pose: object
    joints: object
    base: str
    tool: str
    speed: object
    zone: object
    roll: bool  # the pose's turn about its z means something


def told(program):
    """[Told, or None for a gap or a motion without a place] of a program."""
    return [
        (
            None
            if m.pose is None and m.joints_deg is None
            else Told(
                m.line,
                m.kind,
                m.aux,
                m.pose,
                m.joints_deg,
                m.base,
                m.tool,
                None if m.kind == "PTP" else m.speed_mm_s,
                m.zone_mm,
                not m.free_roll,
            )
        )
        for m in program.motions
    ]


def _same_place(a, b, arriving):
    """Whether two of Told are one motion; ``arriving``: over a gap, rapidly whatever their kind."""
    if (
        not arriving
        and a.kind != b.kind
        or (a.line, a.aux) != (b.line, b.aux)
        or (a.pose is None) != (b.pose is None)
    ):
        return False
    if a.pose is None:
        return a.joints == b.joints
    columns = slice(3, 4) if a.aux else slice(0, 4) if a.roll else slice(2, 4)
    return float(np.abs(a.pose - b.pose)[:, columns].max()) < SAME


def _same_frame(a, b, one, other):
    """Whether the words ``a``, ``b`` of a frame mean the same in what two programs tell of them."""
    return a == b or a in one and b in other and np.abs(one[a] - other[b]).max() < SAME


def finding(whole, mutant, changed, procedures):
    """What is wrong with what a reader makes of a Mutant, or None; ``whole``, ``changed``: the Programs read of the
    program as it was and of the Mutant."""
    before = {(p.line, str(p)) for p in whole.problems}
    new = {line for line, text in {(p.line, str(p)) for p in changed.problems} - before}
    unclosed = {p.code for p in changed.problems} & UNCLOSED
    if procedures and mutant.first and (mutant.line in new or unclosed):
        return None
    old, at, arriving = told(whole), 0, True
    words = {word for one in old if one is not None for word in (one.base, one.tool)}
    for one in told(changed):
        if one is None:
            arriving = True
            continue
        start = at
        while at < len(old) and (old[at] is None or not _same_place(old[at], one, arriving)):
            at += 1
        if at == len(old):
            return f"another motion in line {one.line}: {_words(one)}"
        if not arriving and any(m is not None and not m.aux for m in old[start:at]):
            return f"joined to line {one.line} over {old[at - 1] and old[at - 1].line}"
        was, at, arriving = old[at], at + 1, False
        if one.speed != was.speed and (one.speed is not None or not new):
            return f"another speed in line {one.line}: {one.speed}, not {was.speed}"
        for a, b, frames, others in (
            (one.base, was.base, changed.base_frames, whole.base_frames),
            (one.tool, was.tool, changed.tool_frames, whole.tool_frames),
        ):
            elsewhere = a in frames or a in words and not new
            if elsewhere and not _same_frame(a, b, frames, others):
                return f"another frame in line {one.line}: {a!r}, not {b!r}"
        if one.zone not in (was.zone, None):
            return f"another zone in line {one.line}: {one.zone}, not {was.zone}"
    missing = len([m for m in old if m]) - len([m for m in told(changed) if m])
    if missing and not new:
        return f"{missing} motions are lost without a word"
    return None


def _words(one):
    where = one.joints if one.pose is None else np.round(one.pose[:3, 3], 3).tolist()
    return f"{one.kind} {where}"
