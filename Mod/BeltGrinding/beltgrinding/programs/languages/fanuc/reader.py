"""Reads Fanuc TP programs as text (.ls): /MN statements and /POS positions.

Poses are those of the tool frame UT in the user frame UF; W, P, R turn about the fixed X, Y, Z
(Rz(R) Ry(P) Rx(W)). What only the controller can know is a Problem.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ...program import Program, Reason, Unknown
from ..core.flow import Leave
from ..core.statements import Statements
from ..core.tree import Node
from .listing import IF_JUMP, JUMP, SUFFIXES, Listing
from .motions import AT_RUN_TIME, KINDS, MOTION, Motions
from .registers import INDEX

BLOCKS = {"if": "if_", "for": "for_", "select": "switch_"}
CLOSED_BY = {"if": ("endif",), "for": ("endfor",), "select": ("endselect",)}
# What neither moves the robot nor changes a register or a frame, by its first word.
QUIET = frozenset(
    """
    do di ro ri go gi ao ai so uo ui wo wi f m sr ar timer payload override wait pause message ualm lock unlock col rsr
    monitor joint_max_speed linear_max_speed tc_online stop_tracking pulse error_prog resume_prog maint_prog
    clear_resume_prog strlen weld arc preg
    """.split()
)
CONDITIONS = frozenset(("offset", "tool_offset"))
FRAMES = ("uframe", "utool")  # set at run time
LEAVING = frozenset(("end", "abort"))
# Motions that say so are left out.
SAID_BY_MOTIONS = re.compile(r"(?:SKIP|V?OFFSET|TOOL_OFFSET)\s+CONDITION\b", re.IGNORECASE)
SYSTEM = re.compile(
    r"\$(?!\w*(?:FRAME|TOOL))\w+", re.IGNORECASE
)  # variables without effect on frames
LIKE_MOTION = re.compile(r"\bPR?\s*\[|^[A-Z]\s|\b(?:mm/sec|cm/min|inch/min|deg/sec|FINE|CNT\d)\b")
ASSIGN = re.compile(rf"(UFRAME_NUM|UTOOL_NUM|R{INDEX})(?:\[[^\]]*\])?\s*=\s*(.*)$")
FOR = re.compile(r"FOR\s+(R\[[^\[\]]*\])\s*=\s*(\S.*?)\s(TO|DOWNTO)\s+(.+)$")
CALL = re.compile(r"CALL\s+([^\s(]+)\s*(?:\((.*)\))?\s*$")
ARGUMENT = re.compile(r"((?:[^,\[\]()]|\[(?:[^\[\]]|\[[^\]]*\])*\]|\([^()]*\))+)")


def read(path: Path | str, values: dict[str, Any] | None = None) -> Program:
    """The Program of a .ls file; ``values``: what a person gives, {NAME: number, or six of a frame}. Raises
    ProgramError when it cannot be read."""
    return _Reader(path, values).followed()


def quiet(word: str, text: str) -> bool:
    """Whether a statement changes nothing that the path depends on."""
    return word in QUIET or bool(SAID_BY_MOTIONS.match(text) or SYSTEM.match(text))


class _Reader(Motions):
    """Follows a TP program, and those that it calls, with the registers it can know."""

    LANGUAGE = "Fanuc TP"
    SUFFIXES = SUFFIXES
    RELATIVE = re.compile(r"\bINC\b|CALL|RUN")
    KEPT = ("positions",)
    RETURNING = frozenset(("end",))
    LEAVING = LEAVING
    BLOCKS, CLOSED_BY = BLOCKS, CLOSED_BY
    LEFT_OUT = ("programs.fanuc.motions_left_out", "{what}; motions up to line {last} left out")
    UNREADABLE = (
        "programs.fanuc.call_unreadable",
        "the program that is called cannot be read ({reason})",
    )
    ELSEWHERE = (
        "programs.not_in_file",
        "{name} is not in this file; motions in it are left out",
    )

    def load(self, path: Path | str, problem: Callable[..., Any]) -> Listing:
        return Listing(path, problem)

    def take(self, unit: Listing) -> None:
        """Goes on with a Listing from its beginning."""
        self.positions = unit.positions

    def nodes_of(self, unit: Listing) -> list[Node]:
        if unit.nodes is None:
            self.rounds -= 20 * len(unit.positions)
        return super().nodes_of(unit)

    def counted(self, node: Node) -> Any:
        match = FOR.match(node.text)
        return match and (match[1], match[2], match[4], "-1" if match[3] == "DOWNTO" else "")

    def forget_all(self, line: int) -> None:
        """Another program may change registers and select frames."""
        self.uframe = self.utool = None
        self.forgets_all()
        self.lose_all_positions(line)
        self.conditions = {}

    def leads_to(self, node: Node) -> str | None:
        match = (JUMP.match(node.text) or IF_JUMP.match(node.text)) if node.word == "jmp" else None
        return self.label(match.groups()[-1]) if match else None

    def label(self, text: str) -> str:
        try:
            return str(self.index(text))
        except Unknown:
            return ""

    def may_change(self, node: Node) -> tuple[bool, dict[str, list[Node]]]:
        """What a statement that may run changes is unknown afterwards."""
        line, word, text = node.line, node.word, node.text
        if MOTION.match(text):
            self.here = None
            return True, {}
        if word in ("call", "run"):
            match = CALL.match(text)
            return self.may_call(line, match[1].upper() if match else "")
        if word == "for":
            match = FOR.match(text)
            self.forgets_register(match[1][2:-1] if match else "?")
        if node.body is not None or word in ("label", "jmp", "else", "case", "default", "end"):
            return False, {}
        for found in re.findall(rf"\bR{INDEX}\s*=", text):
            self.forgets_register(found)
        if re.search(rf"\bPR\s*{INDEX}\s*=", text):
            self.lose_positions(line, text)
        if re.search(r"OFFSET\s+CONDITION", text, re.IGNORECASE):
            why = Reason("programs.fanuc.at_run_time", "it is decided at run time")
            self.conditions = dict.fromkeys(CONDITIONS, (why, None))
        if "_NUM" in text:
            self.uframe = self.utool = None
        elif set_ := re.search(r"\b(UFRAME|UTOOL)\s*\[", text):
            self.sets_frame(line, set_[1], text[set_.start() :])
        elif not quiet(word, text):
            self.may_shift(line, text, maybe=True)
            if "=" not in text or text.startswith("$"):
                self.may_frame(line, text)
            if LIKE_MOTION.match(text) and "=" not in text:
                return True, {}
        return False, {}

    def may_frame(self, line: int, text: str) -> None:
        """Frames that an instruction which is not followed names may be others from here on."""
        for what in re.findall(r"FRAME|TOOL", text.upper()):
            self.others["U" + what] = line, "NUM" in text.upper()
            self.uframe = self.utool = self.here = None

    def does(self, node: Node) -> None:
        line, text, word = node.line, node.text, node.word
        match, assigned = MOTION.match(text), ASSIGN.match(text)
        if match:
            self.motion(line, *match.groups())
        elif word == "jmp":
            self.jump(node)
        elif word in LEAVING:
            raise Leave("return" if word == "end" else "exit", line)
        elif assigned:
            self.assigns(line, assigned[1], assigned[3])
        elif word in ("call", "run"):
            self.calls(node)
        elif self.sets_condition(text):
            pass
        elif word in FRAMES:
            self.sets_frame(line, word.upper(), text)
            self.problem(
                line,
                "programs.fanuc.frame_at_run_time",
                "a frame is set at run time; poses stay those in it",
            )
        elif word in ("select", "?", "for") and text != "?":
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        elif re.match(r"P\s*\[|[A-Z]\s+PR?\s*\[", text) or text == "?":
            if text != "?":
                self.problem(
                    line,
                    "programs.fanuc.left_out",
                    "'{text}' is not understood; it is left out",
                    text=text[:40],
                )
            self.break_arc()
            self.gap(line)
        elif re.match(r"PR\s*\[", text):
            self.sets_position(line, text)
        elif not quiet(word, text):
            self.not_followed(node)

    def jump(self, node: Node) -> None:
        match, condition = JUMP.match(node.text), IF_JUMP.match(node.text)
        label = self.label(match[1] if match else condition[2] if condition else "")
        self.goes_to(node, label, condition[1] if condition else None)

    def not_followed(self, node: Node) -> None:
        """What a statement that is not understood names is not known afterwards; it may jump to labels."""
        line, text = node.line, node.text
        self.problem(
            line, "programs.ignored", "'{text}' is not understood; it is ignored", text=text[:40]
        )
        for found in re.findall(rf"(?<!P)R{INDEX}", text):
            self.forgets_register(found)
        if re.search(r"PR\s*\[", text):
            self.lose_positions(
                line, "".join(f"PR[{n}]=" for n in re.findall(rf"PR\s*{INDEX}", text))
            )
        self.may_shift(line, text)
        self.may_frame(line, text)
        if LIKE_MOTION.search(text):
            self.break_arc()
            self.gap(line)
        for label in re.findall(r"LBL\s*\[\s*(\d{1,6})", text):
            self.perhaps_goes_to(
                node, label, Reason("programs.fanuc.at_run_time", "it is decided at run time")
            )

    def sets_frame(self, line: int, word: str, text: str) -> None:
        """A frame is another from here on: motions so far were in the one before."""
        match = re.match(rf"{word}\s*{INDEX}", text)
        try:
            names = {f"{word} {self.index(match[1] if match else '')}"}
        except Unknown:  # any of them
            names = {one for m in self.program.motions for one in (m.base, m.tool)}
            names = {one.split(" after")[0] for one in names if one.startswith(word)}
        for name in names:
            if any(name in (m.base, m.tool) for m in self.program.motions):
                self.frames[name] = f"{name} after line {line}"
                self.here = None

    def assigns(self, line: int, name: str, text: str) -> None:
        """R[n]=, UFRAME_NUM= and UTOOL_NUM=."""
        if name.startswith("R"):
            try:
                self.sets(f"R[{self.index(name[2:-1])}]", text)
            except Unknown as unknown:
                self.forgets_register(name[2:-1], Reason(unknown))
            return
        value = None
        try:
            value = int(self.number(text))
        except Unknown as unknown:
            self.problem(
                line,
                "programs.fanuc.frame_unknown",
                "{name} is not known: {reason}; each position tells its own",
                name=name,
                reason=unknown.fact,
            )
        if self.others.get(name[:-4], (0, False))[1] and value is not None:
            del self.others[name[:-4]]  # selected anew
        self.changes += 1
        setattr(self, name[:-4].lower(), value)

    def calls(self, node: Node) -> None:
        """Follows the program that is called, NAME.LS beside the file; of others nobody knows here what they do."""
        match = CALL.match(node.text)
        passed = [self.passed(one) for one in ARGUMENT.findall(match[2] or "")] if match else []
        if match is None or not self.call(node.line, match[1].upper(), passed):
            name = re.sub(r"^(CALL|RUN)\s*", "", node.text).split("(")[0].strip()
            self.call_unknown(node.line, name)


STATEMENTS = Statements(
    followed=[
        *KINDS,
        *(one.upper() for one in (*BLOCKS, "else", *LEAVING, "lbl", "jmp", "call")),
        *"ENDIF ENDFOR R PR UFRAME_NUM UTOOL_NUM".split(),
        *(f"{one.upper()} CONDITION" for one in sorted(CONDITIONS)),
    ],
    ignored=sorted(one.upper() for one in QUIET),
    left_out=["RUN", *(one.upper() for one in FRAMES), *AT_RUN_TIME],
)
