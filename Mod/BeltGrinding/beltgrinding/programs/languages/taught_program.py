"""The interpreter of taught programs (Fanuc TP, Yaskawa INFORM): files that call each other, over the languages' core."""

from __future__ import annotations

import heapq
import math
import re
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ..program import LOOPED, SKIPPED, Fact, ProgramError, Reason, Unknown, name_of, work_of
from .core.beside import near
from .core.dialect import MAX_CALLS, Dialect
from .core.flow import Jump, Leave
from .core.tree import Node, every, grown
from .taught import TaughtPath
from .taught_numbers import Numbers

Row = tuple[int, str, str]  # line, word in lower case, text


class Taught(Numbers, TaughtPath, Dialect):
    """Follows a program of taught positions, and those beside it that it calls.

    A language adds to what a Dialect has: ``SUFFIXES`` of
    its files; ``load(path, problem)``, the Unit in a file;
    ``take(unit)``, which goes on with one, and ``KEPT``, the names of what that sets; ``called(text)``, the name of
    the program that a statement calls ("": it is not known; None: it calls none); ``forget_all(line)``, what another
    program may change.
    """

    load: Callable[..., Any]
    take: Callable[..., None]
    forget_all: Callable[[int], None]
    SUFFIXES: tuple[str, ...] = ()
    NO_ARC: re.Pattern[str]  # of motions that are no point of an arc
    RELATIVE: re.Pattern[str]  # of one that goes on from where the robot is
    KEPT: tuple[str, ...] = ()
    LEFT_OUT: tuple[str, str]  # code and form of {what} {last}
    UNREADABLE: tuple[str, str]  # of a program that is called, {reason}
    ELSEWHERE: tuple[str, str]  # of one that is not here, {name}
    MAY_RETURN = (
        "programs.inform.return_at_run_time",
        "{word} is decided at run time; the job is read as if it went on",
    )
    MAX_ROUNDS = math.inf
    SHOUTED = True

    def __init__(self, path: Path | str, values: dict[str, Any] | None = None) -> None:
        super().__init__(path, values)
        self.causes, self.used, self.arguments = {}, set(), []
        self.path = path
        self.begin_path()
        self.beside: dict[str, Path] | None = None  # the programs in the folder, once one is called
        self.loaded: dict[str, Any] = {}  # Units by name
        self.callers: list[str] = []  # names of the programs under way
        self.noted: set[object] = set()  # Facts of which one Problem is enough
        self.loops = 0  # around the statement in its program
        self.open: dict[int, str] = {}  # words of Nodes that nothing closes, by their id

    def run(self) -> None:
        """Follows the program from its beginning."""
        try:
            self.follow(self.load(self.path, self.problem))
        except Leave:
            pass
        except ProgramError:
            if self.overlong() is None:
                raise
            self.arc = []
            told = "programs.endless", "an endless {word} is followed once"
            self.problem(self.line, *told, word="loop")
        self.close_arc()

    def follow(self, unit: Any) -> None:
        """Runs a Unit. Raises Leave where what comes after it is not known."""
        self.take(unit)
        self.file, loops, self.loops = unit.file, self.loops, 0
        try:
            self.block(self.nodes_of(unit))
        except Leave as leave:
            if leave.word == "exit":
                raise
        except Jump as jump:
            self.no_label(jump)
        finally:
            self.loops = loops

    def nodes_of(self, unit: Any) -> list[Node]:
        if unit.nodes is None:
            unit.nodes = self.grown(unit.rows())
        return unit.nodes

    def grown(self, rows: Iterable[Row]) -> list[Node]:
        """As a Dialect's; a block without its end is a Problem where it runs."""
        rows = list(rows)
        strays: list[Node] = []

        def stray(line: int, word: str, text: str, node: Node | None) -> None:
            (strays if node is None else node.body or []).append(Node(line, "stray", text))

        def unclosed(node: Node, line: int) -> None:
            self.open[id(node)], node.word = node.word, "unclosed"

        self.rounds -= LOOPED * sum(work_of(text) for _, _, text in rows)
        nodes = grown(rows, self.CLOSED_BY, self.file, stray, unclosed)
        return list(heapq.merge(nodes, strays, key=lambda node: node.line))

    def cost(self, node: Node) -> int:
        return work_of(node.text)

    def note_once(self, line: int, code: str, text: str, /, **arguments: object) -> None:
        fact = Fact(code, text, **arguments)
        if fact not in self.noted:
            self.noted.add(fact)
            self.problem(line, fact)

    def statement(self, node: Node) -> None:
        if node.word in ("label", "unclosed", "stray", *self.OTHERWISE, *self.CASES):
            if node.word != "label":
                self.unclosed(node)
            return
        try:
            self.does(node)
        except Unknown as unknown:
            self.program.need(unknown)
            if not self.NO_ARC.match(node.text):
                self.break_arc()
            self.problem(
                node.line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=node.text[:30],
                reason=unknown.fact,
            )
            self.gap(node.line)

    def unclosed(self, node: Node) -> None:
        """A loop without an end is read once; of a branch it is not known what belongs to it."""
        word = self.open.get(id(node), "")
        self.break_arc()
        if not word:
            self.problem(
                node.line,
                "programs.no_beginning",
                "{word} ends no block that is open",
                word=node.text.split()[0][:20],
            )
        elif self.BLOCKS[word] == "for_":
            told = "programs.krl.no_block_end", "{word} has no {end}"
        else:
            told = "programs.inform.no_block_end", "{word} has no {end}; what follows is left out"
        if word:
            end = self.CLOSED_BY[word][0].upper()
            self.problem(node.line, *told, word=word.upper(), end=end)
        self.gap(node.line)
        if word and self.BLOCKS[word] == "for_":
            self.may_change(node)
            self.one_pass(node)
        elif node.word != "stray":
            self.skip_quietly(node.body or [], node.line)
            raise Leave("exit", node.line)

    def skip_quietly(self, nodes: Sequence[Node], line: int) -> bool:
        """What statements change that may run is not known; gives whether they change anything."""
        self.may_return(nodes)
        before, moved = self.changes, False
        for node in every(nodes):
            self.tick(line, 1 + work_of(node.text) // SKIPPED)
            self.may_set_force(node.line, node.text)
            _, called = self.may_change(node)
            moved |= bool(called) or bool(self.RELATIVE.search(node.text))
        return moved or self.changes != before

    def one_pass(self, node: Node) -> str:
        self.loops += 1
        try:
            return super().one_pass(node)
        finally:
            self.loops -= 1

    def leaves_loop(self, node: Node) -> None:
        """BREAK and CONTINUE."""
        if not self.loops:
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        raise Leave(node.word, node.line)

    def decided(self, node: Node, reason: Reason, nodes: Sequence[Node], line: int) -> None:
        what = Fact(
            "programs.at_run_time",
            "{word} is decided at run time ({reason})",
            reason=reason.fact,
            word=self.shown(node),
        )
        last = max([one.line for one in every(nodes)], default=line)
        self.skip(nodes, line, Fact(*self.LEFT_OUT, what=what, last=last), reason)

    def endless(self, node: Node) -> None:
        super().endless(node)
        raise Leave("exit", node.line)

    def again(self, jump: Any, nodes: Sequence[Node]) -> None:
        self.problem(
            jump.line,
            "programs.jump_back",
            "a jump back is decided at run time; it is followed once",
        )
        self.program.need(jump.reason)
        if self.skip_quietly(nodes, jump.line):  # it may end elsewhere than the first time
            self.gap(jump.line)

    def no_label(self, jump: Jump) -> None:
        self.problem(
            jump.line,
            "programs.leads_nowhere",
            "'{text}' leads nowhere known; what follows is left out",
            text=jump.node.text[:40],
        )
        raise Leave("exit", jump.line)

    def unit_of(self, name: str, line: int) -> Any:
        """The Unit of a program beside the file, None where there is none that can be followed."""
        if self.beside is None:
            self.beside = near(self.path, self.SUFFIXES)
        path = self.beside.get(name)
        if path is None or name in self.callers or len(self.callers) >= MAX_CALLS:
            return None
        if name not in self.loaded:
            try:
                self.loaded[name] = self.load(path, partial(self.program.problem, name_of(path)))
            except ProgramError as error:
                self.loaded[name] = None
                self.problem(line, *self.UNREADABLE, reason=str(error))
        return self.loaded[name]

    def call(self, line: int, name: str, passed: list[float | Reason]) -> bool:
        """Follows the program NAME beside the file; False where nobody knows here what it does."""
        unit = self.unit_of(name, line)
        if unit is None:
            return False
        kept = {one: getattr(self, one) for one in (*self.KEPT, "file", "call_line", "arguments")}
        self.call_line, self.arguments = self.place(line), passed
        self.callers.append(name)
        self.scopes.append({})
        try:
            self.follow(unit)
        finally:
            self.callers.pop()
            self.scopes.pop()
            for one, value in kept.items():
                setattr(self, one, value)
        return True

    def call_unknown(self, line: int, name: str) -> None:
        """A program that is not followed may move the robot, and change what is not its own."""
        self.note_once(line, *self.ELSEWHERE, name=name[:60])
        self.forget_all(line)
        self.gap(line)

    def may_call(self, line: int, name: str) -> tuple[bool, dict[str, list[Node]]]:
        """As ``may_change`` of a call."""
        unit = self.unit_of(name, line)
        self.forget_all(line)
        if unit is None:
            return True, {}
        outer, self.file = self.file, unit.file
        nodes = self.nodes_of(unit)
        self.file = outer
        return False, {name: nodes}
