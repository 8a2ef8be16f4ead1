"""The flow of G-code: assignments, jumps, branches, loops and subprograms, as far as their values are known."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ....base.kinds import known
from ...program import Unknown
from ..core.expression import number, truth
from ..core.listing import END, RETURN
from . import units
from .calls import CALL, MOST_TIMES, Calls
from .expression import Siemens, expression_of, siemens_words
from .moves import BARE, COMPUTED, NAMED
from .statements import NONE, OTHER_FRAME
from .units import JUMPS, OWORD, SIEMENS_BLOCKS, Unit
from .variables import NOT_KNOWN, place_of

STATEMENT = re.compile(
    r"#|\[|\b(?:IF|ELSE\w*|END\w+|UNTIL|WHILE|GOTO\w?|FOR|LOOP|REPEATB?|CASE|DEF|R\d+\s*=|Q\d+|P?CALL|EXTCALL|PROC|"
    r"L\d+|END\s*\d+)\b|R\d+\s*=|^O\s*[\d<]|^[A-Z_]\w+\s*(?:\[[^\]]*\]\s*)?=(?!=)|\$|M\s*98(?!\d)|G\s*65(?!\d)|"
    r"^[A-Z_]{2,}\w*\s*(?:\(|P\s*[=\d]|$)"
)
SPECIAL = re.compile(r"[LOQ$:]|98|65")
TEXTS = "MSG WORKPIECE GROUP_BEGIN GROUP_END CYCLE832 SETAL EXTERN".split()  # whatever follows them
# Blocks of their own that change neither the path nor a value.
ALONE = "DISPLOF DISPLON SAVE ORIC ORID ORICONCW ORICONCCW ORICONIO ORICONTO".split()
HARMLESS = re.compile(
    rf"(?:{'|'.join(TEXTS)})\b.*|(?:{'|'.join((*ALONE, *NAMED))}|COMP\w+|CUT2D\w*|D\d+)$|T\s*(?:=\s*)?\"[^\"]*\"$"
)
DECLARED = re.compile(r"DEF\s+(REAL|INT|BOOL|\w+)(?:\[\d+\])?\s+(.*)")
NUMBERED_FLOW = "IF THEN GOTO WHILE DO END M98 M99 G65".split()  # of the family with # and [..]
GOTOS = ("GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS")
GOTO = r"(?:(GOTOS)|(GOTO[FBC]?)\s*(\S+))$"
CONDITIONAL, JUMP = re.compile(rf"IF\b\s*(.*?)\s*\b{GOTO}"), re.compile(GOTO)
CASE = re.compile(r"CASE\b(.*?)\bOF\b((?:\s*\S+\s+GOTO[FBC]?\s+\S+)+)$")
AGAIN = re.compile(r"(REPEATB?)\s+([A-Z_]{2}\w*)(?:\s+([A-Z_]{2}\w*))?(?:\s+P\s*=?\s*(.+))?$")


class Flow(Calls):
    """Follows the lines of units."""

    def __init__(
        self,
        path: Path | str,
        main: Unit,
        others: Mapping[str, Unit],
        by_m6: bool,
        given_units: str | None,
    ) -> None:
        super().__init__(path, main, by_m6, given_units)
        self.others.update(others)
        self.counts: dict[tuple[str, int], Any] = {}

    def step(self, at: int, text: str) -> int | None:
        line = at + 1
        text = units.bare(text, self.dialect)
        if text.startswith("%") and self.program.motions:
            self.ended = True
        if not text or text.startswith(("%", "/")):
            if text.startswith("/"):
                self.lost(
                    line,
                    "programs.gcode.block_skip",
                    "a block with / is skipped or not by a switch; it is left out",
                )
                self.forget(line, text, maybe=True)
                self.jump_unknown(at, units.unnumbered(text[1:].strip()))
            return None
        body = units.unnumbered(text)
        if body in ("RET", "M17"):  # Siemens' ends of a subprogram
            return RETURN if self.depth else END
        self.ended = body == "M99"
        if self.ended and self.depth:
            return RETURN
        try:
            going = self.block(at, body)
        except Unknown as unknown:
            self.lost(
                line,
                "programs.gcode.block_left_out",
                "the block is left out: {reason}",
                reason=unknown.fact,
            )
            self.forget(line, body)
            if AGAIN.match(body):
                self.lose_modes(line, body)
            return self.jump_unknown(at, body)
        return going

    def block(self, at: int, body: str) -> int | None:
        """Follows what is behind a line's number and label; as ``step``. Raises Unknown."""
        line = at + 1
        if self.dialect == "siemens":
            words = self.quick(body)
            if words is not None:  # nearly all are
                return None if self.words(line, words) else END
        elif body and not COMPUTED.search(body) and not SPECIAL.search(body):
            return None if self.words(line, self.plain(body)) else END
        if STATEMENT.search(body) and not HARMLESS.match(body):
            found = self.statement(at, body)
            if found is not NONE:
                return found
        if body == "TRAFOOF":
            self.tcp = self.vector = None
        elif re.fullmatch(r"TRAORI\s*(?:\([\d\s,.]*\))?", body):
            self.tcp, self.vector = "angles", None
        elif OTHER_FRAME.match(body):
            self.frames(line, body)
        elif body and not HARMLESS.match(body):
            return None if self.words(line, self.split(body)) else END
        return None

    def statement(self, at: int, body: str) -> Any:
        """What a statement does; NONE where the block is one of words only."""
        if self.dialect == "siemens":
            return self.siemens(at, body)
        if self.dialect is None:
            if re.search(r"#|\[|\$|\b(?:IF|WHILE|GOTO\w?|FOR|REPEAT|DEF|CALL)\b|\bR\d+\s*=", body):
                raise Unknown(*NOT_KNOWN)
            if not re.match(r"M\s*98(?!\d)", body):
                return NONE
        return self.brackets(at, body)

    def siemens(self, at: int, body: str) -> Any:
        declared = DECLARED.match(body)
        if declared:
            self.declare(declared[1], declared[2])
            return None
        if body.startswith("PROC") or HARMLESS.match(body):
            return None
        match = CONDITIONAL.match(body)
        if match:
            return self.jump(at, match[2] or match[3], match[4]) if self.holds(match[1]) else None
        match = JUMP.match(body)
        if match and match[1]:
            return self.begins_again(at)
        if match:
            return self.jump(at, match[2], match[3])
        match = CASE.match(body)
        if match:
            return self.case(at, match[1], match[2])
        match = AGAIN.match(body)
        if match:
            return self.again(at, *match.groups())
        word = re.match(r"[A-Z]+", body)
        if word and word[0] in SIEMENS_BLOCKS and not JUMPS.search(body):
            return self.structure(at, word[0], body[word.end() :].strip())
        if JUMPS.search(body) or body.startswith(("REPEAT", "CASE")):
            raise Unknown(*NOT_KNOWN)
        if body in BARE or OTHER_FRAME.match(body) or re.match(r"TRAORI|TRAFOOF", body):
            return NONE
        call = CALL.match(body)
        if call and (call["number"] or not re.fullmatch(r"[A-Z]\d+", body.replace(" ", ""))):
            return self.call_siemens(at, call)
        if re.match(r"[A-Z_$][A-Z0-9_]*\s*(?:\[|=)", body):
            return self.assign(siemens_words(body), self.ours)
        return NONE

    def brackets(self, at: int, body: str) -> Any:
        found = OWORD.match(body)
        if found:
            return self.oword(at, found[1].replace(" ", ""), found[2], found[3])
        found = re.match(r"IF\s*(\[.*\])\s*(?:(GOTO)\s*(\d+)|THEN\s*(#.*))$", body)
        if found:
            if not self.holds(found[1]):
                return None
            return self.jump(at, found[2], found[3]) if found[2] else self.assign_numbered(found[4])
        found = re.match(r"(GOTO)\s*(\d+)$", body)
        if found:
            return self.jump(at, found[1], found[2])
        found = re.match(r"WHILE\s*(\[.*\])\s*DO\s*\d+$", body)
        if found:
            return None if self.holds(found[1]) else self.parts(at)[-1] + 1
        if re.match(r"END\s*\d+$", body):
            return self.parts(at)[0]
        if body.startswith("#"):
            return self.assign_numbered(body)
        if re.search(r"M\s*98(?!\d)|G\s*65(?!\d)", body):
            return self.call_numbered(at, body)
        if re.search(r"\b(?:IF|WHILE|GOTO\w?|FOR|REPEAT|DEF|CALL)\b", body):
            raise Unknown(*NOT_KNOWN)
        return NONE

    # Jumps, branches and loops

    def holds(self, text: str) -> bool:
        """Whether a condition is true. Raises Unknown."""
        value = expression_of(self.parser, text)(self.variables)
        if self.dialect == "linuxcnc" and not isinstance(value, bool):
            return number(value) != 0.0
        return truth(value)

    def jump(self, at: int, kind: str, label: str) -> int | None:
        """The index that a jump goes to; None: on, where GOTOC finds no label. Raises Unknown."""
        if kind == "GOTOS":
            begin: int = self.unit.begin
            return begin
        label = label_of(label)
        found: int | None = self.unit.find(label, at, kind != "GOTOB", kind != "GOTOF")
        if found is None and kind != "GOTOC":
            raise Unknown("programs.gcode.no_label", "there is no label {name}", name=label)
        return found

    def begins_again(self, at: int) -> int:
        """GOTOS without a condition."""
        self.problem(at + 1, "programs.endless", "an endless {word} is followed once", word="GOTOS")
        self.ended = True
        return END

    def case(self, at: int, text: str, branches: str) -> int | None:
        """CASE (..) OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C."""
        value = number(expression_of(Siemens, text.strip())(self.variables))
        for constant, kind, label in re.findall(r"(\S+)\s+(GOTO[FBC]?)\s+(\S+)", branches):
            if (
                constant == "DEFAULT"
                or number(expression_of(Siemens, constant)(self.variables)) == value
            ):
                return self.jump(at, kind, label)
        return None

    def again(
        self, at: int, kind: str, first: str, last: str | None, times: str | None
    ) -> int | None:
        """REPEAT and REPEATB with labels: the part comes P times again. Raises Unknown."""
        count = 1.0 if times is None else number(expression_of(Siemens, times)(self.variables))
        begins = self.unit.look().labels.get(first, [])
        if len(begins) != 1:
            raise Unknown("programs.gcode.no_label", "there is no label {name}", name=first)
        begin = begins[0]
        ends = [k for k in self.unit.labels.get(last or "ENDLABEL", []) if k >= begin]
        if kind == "REPEATB":
            end = begin + 1
        elif last is None and begin < at and not (ends and ends[0] < at):
            end = at  # the part up to here
        elif ends:
            end = ends[0] + 1
        else:
            raise Unknown(
                "programs.gcode.no_label", "there is no label {name}", name=last or "ENDLABEL"
            )
        if begin <= at < end or not 0 <= count <= MOST_TIMES or count != int(count):
            raise Unknown(*NOT_KNOWN)
        self.repeat(self.unit)
        for _ in range(int(count)):
            found = self.follow(self.unit, begin, end)
            if found < 0:
                return found
        return None

    def parts(self, at: int) -> list[int]:
        """The indices of the lines that belong to a line's IF or loop. Raises Unknown."""
        found = self.unit.look().blocks.get(at)
        if found is None or self.unit.blocks.get(found[0]) is None:
            raise Unknown("programs.gcode.no_block_end", "its IF or loop has no end or no begin")
        return found

    def structure(self, at: int, kind: str, rest: str) -> int | None:
        parts = self.parts(at)
        if kind == "IF":
            return None if self.holds(rest) else parts[1] + 1
        if kind in ("ELSE", "ENDLOOP", "ENDWHILE"):
            return parts[-1] + 1 if kind == "ELSE" else parts[0]
        if kind == "WHILE":
            return None if self.holds(rest) else parts[-1] + 1
        if kind == "UNTIL":
            return None if self.holds(rest) else parts[0]
        if kind == "FOR":
            found = re.match(r"([^=]+)=(.+)\bTO\b(.+)$", rest)
            if not found:
                raise Unknown(*NOT_KNOWN)
            key = self.variables.key(place_of(Siemens, found[1]))
            first, last = (
                number(expression_of(Siemens, t)(self.variables)) for t in found.group(2, 3)
            )
            return self.counted(parts, key, float(first), float(last))
        if kind == "ENDFOR":
            key, last = self.counts.get((self.unit.file, parts[0]), (None, None))
            if key is None:
                raise Unknown(*NOT_KNOWN)
            value = number(self.variables.scope(key).get(key)) + 1.0
            return self.counted(parts, key, value, last)
        return None

    def counted(self, parts: list[int], key: str, value: float, last: float) -> int:
        """A round of FOR, or the line after it."""
        if value > last:
            self.counts.pop((self.unit.file, parts[0]), None)
            self.variables.drop(key)
            return parts[-1] + 1
        self.counts[(self.unit.file, parts[0])] = (key, last)
        self.variables.assign(key, value)
        return parts[0] + 1

    def oword(self, at: int, label: str, kind: str, rest: str) -> int | None:
        """LinuxCNC's words of flow."""
        if kind == "CALL":
            return self.call_named(at, label, rest)
        if kind in ("RETURN", "ENDSUB"):
            if rest:
                self.variables.drop("#<_value>")
            return RETURN
        if kind in ("BREAK", "CONTINUE"):
            parts = self.unit.look().around(at, label)
            if parts is None:
                raise Unknown(
                    "programs.gcode.no_block_end", "its IF or loop has no end or no begin"
                )
            return parts[-1] + (kind == "BREAK")
        parts = self.parts(at)
        if kind == "SUB":
            return parts[-1] + 1
        if kind == "IF":
            return self.branch(parts)
        if kind in ("ELSE", "ELSEIF"):
            return parts[-1] + 1
        if kind == "WHILE":
            if parts[0] != at:  # at the end of DO
                return parts[0] if self.holds(rest) else None
            return None if self.holds(rest) else parts[-1] + 1
        if kind == "REPEAT":
            count = number(expression_of(self.parser, rest)(self.variables))
            self.counts[(self.unit.file, at)] = count
            return None if count >= 1 else parts[-1] + 1
        if kind == "ENDREPEAT":
            left = self.counts.get((self.unit.file, parts[0]), 1) - 1
            self.counts[(self.unit.file, parts[0])] = left
            return parts[0] + 1 if left >= 1 else None
        return parts[0] if kind == "ENDWHILE" else None

    def branch(self, parts: list[int]) -> int:
        """The line that the branches of an IF go on with."""
        for at in parts[:-1]:
            text = units.unnumbered(units.bare(self.unit.lines[at], self.dialect))
            found = known(OWORD.match(text))
            if found[2] == "ELSE" or self.holds(found[3]):
                return at + 1
        return parts[-1] + 1

    def jump_unknown(self, at: int, body: str) -> int | None:
        """Where to go on after a block of flow that is not followed; what may run in between is not known."""
        found = re.search(r"(?:\bIF\b|^CASE\b).*?\b(GOTO[FBCS]?)\s*(\w+)", body)
        jump = re.match(r"(GOTO[FBCS]?)\b", body)
        parts = self.unit.look().blocks.get(at) if STATEMENT.search(body) else None
        broken = re.match(
            r"O\s*(?:\d+|<[^<>]*>)\s*(?!CALL\b)[A-Z]|(?:IF(?!.*\b(?:GOTO|THEN))|WHILE|FOR|LOOP|REPEAT$|UNTIL)\b",
            body,
        )
        if jump or body.startswith("CASE") or broken and parts is None:
            self.problem(
                at + 1,
                "programs.gcode.jump_nowhere",
                "where the jump goes is not known; what follows is left out",
            )
            self.ended = True
            return END
        if found:
            target = self.unit.find(label_of(found[2]), at, found[1] != "GOTOB", False)
        elif parts is not None and parts[0] <= at < parts[-1]:
            target = parts[-1]
        elif parts is not None:
            target = None
        else:
            return None
        self.at = [None, None, None]
        self.variables.forget()
        if target is None:  # back, or nowhere
            return None
        self.lose_modes(target + 1, units.bare(self.unit.lines[target], self.dialect))
        return target + (parts is not None and not found)


def label_of(text: str) -> str:
    """A jump's target as ``Unit.labels`` has it."""
    return "N" + str(int(text)) if text.isdigit() else re.sub(r"^N0*(?=\d)", "N", text)
