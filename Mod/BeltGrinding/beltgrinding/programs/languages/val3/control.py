"""How a VAL3 program runs through blocks: decisions and loops, each as far as it is static."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from ...program import Fact, ProgramError, Unknown
from ..core.tree import Node
from ..core.values import Evaluated
from ..core.flow import Flow, Leave
from .data import Missing
from .expression import expression, place, split
from .functions import FUNCTIONS
from .state import ASSIGNED, READING, State

MOTION = re.compile(r"(?:([^=\"(]*)=(?!=)\s*)?((?:move|alterMove|alter)\w*)\s*\((.*)\)$")
MOVES = re.compile(r"(?<![\w.])(?:move|alter)\w*\s*\(")
ASSIGN = re.compile(r"([^\W\d]\w*(?:\[[^=]*\])?(?:\.\w+(?:\[[^=\[\]]*\])?)*)\s*=(?!=)\s*(.+)$")
CALL = re.compile(r"call\s+(\w+(?::\w+)?)\s*(?:\((.*)\))?$", re.IGNORECASE)
INSTRUCTION = re.compile(r"(\w+(?::\w+)?)\s*\((.*)\)$")
FOR = re.compile(
    r"for\s+([^\W\d]\w*(?:\[[^=]*\])?)\s*=\s*(\S.*?)\sto\s+(.+?)(?:\sstep\s+(.+?))?(?:\sdo)?$",
    re.IGNORECASE,
)
NAME = re.compile(r"[^\W\d]\w*")
CALLED = re.compile(r"([^\W\d]\w*)\s*\(")
# Instructions that neither move the arm nor change data.
HARMLESS = frozenset(
    """
    waitEndMove open close delay watch wait resetMotion stopMove restartMove autoConnectMove
    resetTurn put putln cls gotoxy userPage title popUpMsg logMsg help setLanguage
    enablePower disablePower setMonitorSpeed setVelCmd getVersion
    taskKill taskSuspend taskResume taskStatus taskLock taskUnlock
    sioCtrl dioSet aioSet clearBuffer sioSet libLoad libSave libDelete setMutex
    """.split()
)


class Control(Flow, State):
    """Runs blocks of statements; ``statement(node)`` is what the reader adds."""

    BLOCKS = {"if": "if_", "for": "for_", "while": "while_", "do": "until_", "switch": "switch_"}
    LEAVING = RETURNING = frozenset(("return",))  # break leaves a switch

    def unknown(self, target: str, why: Fact) -> None:
        try:
            self.assign(target, Missing(why))
        except Unknown:
            match = NAME.match(target)
            if match:
                self.forget(match.group(), why)

    def handed(self, text: str) -> None:
        """What is handed to something that is not followed is not known afterwards."""
        try:
            for part in split(text):
                if ASSIGN.match(part + "=0") and "[" in part:
                    self.unknown(part, ASSIGNED)
                else:
                    self.lose(part)
        except Unknown:
            self.lose(text)

    def handed_in(self, text: str) -> None:
        """What functions of the controller in a text that is not followed may have changed."""
        if any(n not in FUNCTIONS and not READING.fullmatch(n) for n in CALLED.findall(text)):
            self.lose(text)

    def lose(self, text: str) -> None:
        """Whatever is named in a text may have changed."""
        for name in set(NAME.findall(text)):
            self.forget(name)

    def may_change(self, node: Node) -> tuple[bool, Mapping[str, Sequence[Node]]]:
        match = ASSIGN.match(node.text) if node.body is None else None
        moves = bool(MOVES.search(node.text)) or node.word.startswith("taskcreate")
        if match or node.body is not None:
            self.handed_in(match[2] if match else node.text)
        if match:
            try:
                self.forget(place(match[1]).name)
            except Unknown:
                self.lose(match[1])
        elif node.word == "for":
            self.lose(node.text.split("=")[0])
        elif node.body is None and not MOTION.match(node.text):
            called = INSTRUCTION.match(node.text)
            if not called or called[1] not in HARMLESS:
                self.lose(node.text)
        if node.word != "call":
            return moves, {}
        call = CALL.match(node.text)
        try:
            inner = self.project.routine(call[1]) if call else None
        except ProgramError:
            inner = None
        return moves or inner is None, {call[1]: inner.body} if call and inner else {}

    def counted(self, node: Node) -> Sequence[Any] | None:
        match = FOR.match(node.text)
        return match.groups() if match else None

    def series(self, text: str) -> list[Evaluated]:
        return [expression(part) for part in split(text)]

    def switch_(self, node: Node) -> None:
        try:
            super().switch_(node)
        except Leave as leave:
            if leave.word != "break":
                raise
