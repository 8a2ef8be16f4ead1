"""Reads Kawasaki AS: the programs, locations and numbers of a .as or .pg file.

Millimetres and degrees. Meaning of the instructions as in Kawasaki's "AS Language Reference Manual". Poses are
those of the tool (TOOL) in the base (BASE); where a program sets none, the controller's. A speed in percent is
not known. What only the controller knows is a Problem.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ....base.kinds import Json, known
from ...program import Program, Unknown
from ..core.tree import Node
from ..core.dialect import Dialect
from ..core.expression import number, true
from ..core.flow import Leave
from ..core.poses import as_zyz, moved, pose, shifted
from ..core.statements import Statements
from .expression import FUNCTIONS, Parser
from .source import LOST, MOVE, MOVES, Source

# The words of statements that neither move the robot nor change data.
QUIET = frozenset(
    """
    signal sig swait twait wait print type ty open close openi closei clamp relax relaxi accel decel pulse
    timer utimer bits runmask reset pcexecute pcabort pcend ifpwprint weight payload mc abs.speed send
    """.split()
)
STATES, FRAMES = ("speed", "accuracy"), ("tool", "base")
PARTS = ("label", "value", "default", "else", "elseif")  # of blocks
ENDS = {"return": "return", "stop": "exit", "halt": "exit"}
# Of those that change what they name, and move nothing.
ASKING = ("prompt", "receive")
CHANGING = re.compile(rf"(?:(?:tcp|udp)_\w+|{'|'.join(ASKING)}|for|point|decompose|here)\b")
SWITCH = re.compile(r"(\S+)\s+(on|off)$", re.IGNORECASE)
GOTO = re.compile(r"(?:if\s(.*?)\s+)?go\s?to\s+([\w.]+)(?:\s+if\s(.*))?$", re.IGNORECASE)
ASSIGN = re.compile(
    r"(point|decompose)?(?:/(\w+))?\s*([.$#&\w]+\s*(?:\[.*?\])?)\s*=(?!=)\s*(.+)$", re.IGNORECASE
)
STILL = {*QUIET, *PARTS, *ENDS, "goto", "break"}
FOR = re.compile(r"for\s+(\S+)\s*=\s*(\S.*?)\sto\s+(.+?)(?:\sstep\s+(.+?))?$", re.IGNORECASE)
RATE = re.compile(r"(.*?)(?:(?<=[\s\d.)\]])(mm/s|mm/min|cm/min|s))?\s*$", re.IGNORECASE)
LASTING = re.compile(r"\s+always\b", re.IGNORECASE)
CALL = re.compile(r"call\s+([\w.]+)\s*(?:\((.*)\))?\s*$", re.IGNORECASE)
NOT_UNDERSTOOD = ("programs.it_is_not_understood", "it is not understood")


def read(path: Path | str, values: Json | None = None) -> Program:
    """The Program of a file; ``values``: as ``Memory`` takes them. Raises ProgramError."""
    return Reader(path, values).followed()


class Reader(Dialect):
    """Follows a program with the values it can know."""

    LANGUAGE = "Kawasaki AS"
    CLOSED_BY = dict.fromkeys(("if", "while", "for", "case"), ("end",)) | {"do": ("until",)}
    BLOCKS = {"if": "if_", "for": "for_", "while": "while_", "do": "until_", "case": "switch_"}
    CASES = ("value", "default")
    LEAVING = frozenset(("return", "stop", "halt", "goto"))
    RETURNING = LEAVING - {"goto"}
    PARSER, FUNCTIONS, FOR = Parser, FUNCTIONS, FOR
    truth = staticmethod(true)

    def __init__(self, path: Path | str, values: Json | None = None) -> None:
        self.source = Source(path)
        super().__init__(path, values, self.source.data)
        self.trees: dict[str, list[Node]] = {}  # Nodes of the programs that are followed
        # SPEED and ACCURACY, ALWAYS and for the next motion
        self.lasting: dict[str, Any] = {}
        self.briefly: dict[str, Any] = {}
        self.stopping: bool | None = False  # CP OFF; None: not known

    def local(self, name: str) -> bool:
        return name.startswith(".")

    def given(self, name: str) -> bool:
        return name[0] not in "#$"

    def run(self) -> None:
        begin = self.source.start()
        try:
            self.call(begin, "")
        except Leave:
            pass
        self.ends_arc()
        for name, (line, rows) in self.source.programs.items():
            if name not in self.trees and any(MOVE.match(text) for _, text in rows):
                self.not_run(line, name, begin)

    def tree(self, name: str) -> list[Node]:
        if name not in self.trees:
            self.trees[name] = self.grown(self.source.rows(name))
        return self.trees[name]

    def call(self, name: str, text: str) -> None:
        own = self.source.find(name)
        if own is None:
            self.lasting, self.briefly = {}, {}
            self.not_here(name, text)
        texts = self.PARSER.split(text)
        self.invoke(name, own.parameters[name], texts, self.tree(name), own.file)

    def leads_to(self, node: Node) -> str | None:
        match = GOTO.match(node.text) if node.word == "goto" else None
        return match[2].lower() if match else None

    def may_change(self, node: Node) -> tuple[bool, Mapping[str, Sequence[Node]]]:
        word, call = node.word, CALL.match(node.text)
        match = ASSIGN.match(node.text)
        if match and word != "for":
            self.lose(self.names(match[3]))
            return False, {}
        if word in FRAMES:
            self.frame_unknown(word, node.line)
        elif word in STATES:
            self.lasting, self.briefly = {}, {}
        elif word == "cp":
            self.stopping = None
        elif word == "call" and call:
            self.lose(self.names(call[2] or ""))
            name = call[1].lower()
            known = self.source.find(name) is not None
            return not known, {name: self.tree(name)} if known else {}
        elif word == "for":
            self.lose(self.names(node.text.partition("=")[0]))
        elif node.body is None and word not in STILL and not MOVE.match(node.text):
            self.lose(self.names(node.text))
        moves = bool(MOVE.match(node.text))
        self.here = None if moves else self.here
        return moves, {}

    def does(self, node: Node) -> None:
        line, text, word = node.line, node.text, node.word
        rest = text[len(word) :].strip()
        match = ASSIGN.match(text)
        if word == "goto":
            match = GOTO.match(text)
            if not match:
                raise Unknown(*NOT_UNDERSTOOD)
            self.goes_to(node, match[2].lower(), match[1] or match[3])
        elif word in ENDS:
            raise Leave(ENDS[word], line)
        elif word == "call":
            match = CALL.match(text)
            if not match:
                raise Unknown(*NOT_UNDERSTOOD)
            self.call(match[1].lower(), match[2] or "")
        elif word == "break":
            self.stops()
        elif match:
            self.assigns(*match.groups())
        elif SWITCH.match(text):
            self.stopping = text[-1] in "fF" if word == "cp" else self.stopping
        elif word in FRAMES:
            plain = rest.isidentifier() and rest.lower() not in self.spent
            self.frame(word, line, rest, plain)
        elif word in STATES:
            self.sets(word, rest)
        elif word == "here":
            self.put(rest, lambda: self.current(True))
        elif MOVE.match(text):
            self.motion(line, word, rest)
        elif word not in QUIET and word not in PARTS:
            self.lose(self.names(rest))
            if not CHANGING.match(word):
                raise Unknown(*NOT_UNDERSTOOD)

    def assigns(self, kind: str | None, part: str | None, target: str, text: str) -> None:
        """POINT, DECOMPOSE and what has no word."""
        if kind and kind.lower() == "decompose":
            self.spread(target, lambda: as_zyz(self.value(text)))
            return

        def value() -> Any:
            found = self.value(text)
            if part:  # of POINT/X: the rest stays
                raise Unknown(*NOT_UNDERSTOOD)
            return pose(found) if kind and "#" not in target else found

        self.put(target, value)

    def sets(self, word: str, rest: str) -> None:
        """SPEED and ACCURACY."""
        kept = self.lasting if LASTING.search(rest) else self.briefly
        self.briefly.pop(word, None)
        text = re.sub(r"\s+fine$", "", LASTING.sub("", rest), flags=re.IGNORECASE)
        kept[word] = None
        try:
            if word == "accuracy":
                kept[word] = max(0.0, number(self.value(text)))
                return
            text, unit = known(RATE.match(self.PARSER.split(text)[0])).groups()
            kept[word] = number(self.value(text)), (unit or "%").lower()
        except (Unknown, IndexError):  # each motion tells it
            pass

    def motion(self, line: int, word: str, rest: str) -> None:
        kind = "PTP" if word[0] == "j" else "CIRC" if word[0] == "c" else "LIN"
        if word in LOST:
            raise Unknown("programs.kawasaki.of_robot", "where it goes only the controller knows")
        if word in ("joint", "linear"):  # a taught step
            rest = rest[rest.find("#[") :].rstrip(" ;")
        given = [one(self) for one in self.listed(rest)]
        if not given:
            raise Unknown(*NOT_UNDERSTOOD)
        target = given[0]
        if word in ("draw", "tdraw"):
            if any(given[3:]):
                raise Unknown(
                    "programs.kawasaki.turning", "a turn or a speed in it is not followed"
                )
            here = self.current()
            target = shifted(here, *given[:3]) if word == "draw" else here @ moved(*given[:3])
        elif word[1:] == "depart":
            target = self.current() @ moved(z=-number(target))
        elif word[1:] == "appro":
            target = pose(target) @ moved(z=-number(given[1] if len(given) > 1 else None))
        if word == "c1move":
            self.middle(line, target)
            return
        states = {**self.lasting, **self.briefly}
        zone = {True: 0.0, None: None}.get(self.stopping, states.get("accuracy"))
        self.goes(kind, line, target, states.get("speed"), zone)
        self.briefly = {}


STATEMENTS = Statements(
    followed=sorted(
        {one.upper() for one in (*MOVES, *Reader.BLOCKS, *STATES, *FRAMES, *ENDS)}
        | {"GOTO", "CALL", "BREAK", "CP", "HERE", "POINT", "DECOMPOSE"}
    ),
    ignored=sorted(one.upper() for one in QUIET),
    asked=[one.upper() for one in ASKING],
    left_out=[one.upper() for one in LOST],
)
