"""The way through a KRL program, over the languages' core: what its blocks, FOR, EXIT and GOTO are.

What is decided at run time is left out, and what it may change is not known behind it (touched.py).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from typing import Any

from ....base.kinds import known
from ...program import Fact, Reason, Unknown
from ..core.tree import Node
from ..core.values import Evaluated
from .parts import Body, Parts
from ..core.flow import Jump, Leave
from ..core.jumps import Jumping
from .blocks import CLOSED, GOTO, LEAVING, LOOPS, OPENING, Block, Routine, word_of
from .expression import Parser
from .numbers import compared, integer, truth

FOR = re.compile(r"^FOR\s+(\w+)\s*=\s*(\S.*?)\sTO\s+(.+?)(?:\sSTEP\s+(.+))?$", re.IGNORECASE)


class Flow(Jumping, Parts):
    """Part of the interpreter (reader.py); what it needs of the others is theirs."""

    BLOCKS = {
        "for": "for_",
        "if": "if_",
        "while": "while_",
        "loop": "loop_",
        "repeat": "until_",
        "switch": "switch_",
    }
    OTHERWISE = ("else",)
    LEAVING = frozenset(LEAVING)
    SHOUTED = True
    MAX_ROUNDS = math.inf
    truth = staticmethod(truth)
    alike = staticmethod(lambda left, right: compared("==", left, right))

    @property
    def changes(self) -> int:  # type: ignore[override] # the values count them
        return self.values.changes

    def value(self, text: str) -> Any:
        return self.evaluate(text)

    def series(self, text: str) -> Iterable[Evaluated]:
        return filter(None, Parser.list(text)[0])

    def routine(self, routine: Routine) -> str:
        """Runs a routine; gives the statement that returns from it, or ""."""
        whole = (routine, 0, len(routine.statements))
        try:
            self.block(routine.blocks)
        except Leave as leave:
            if leave.word == "exit":
                raise
            if leave.word == "return":
                return leave.value
            self.problem(
                leave.line,
                "programs.krl.exit",
                "EXIT is in no loop; what follows it is left out",
            )
            self.rest(leave.line, whole)
        except Jump as jump:
            self.problem(
                jump.line,
                "programs.krl.label",
                "GOTO {label}: there is no such label that it may go to; the rest of the routine is left out",
                label=jump.label[:40].upper(),
            )
            self.rest(jump.line, whole)
        return ""

    def rest(self, line: int, body: Body) -> None:
        """Where it is not known which statements of a body run: a gap, and what they may change is not known."""
        self.gap(line)
        self.forget(line, body, inside=True, quiet=True)

    def never_left(self, jump: Jump, at: int) -> int:
        """A motion behind an endless GOTO is not reached from its first pass."""
        return at

    def skip(self, nodes: Sequence[Any], line: int, message: Fact, why: Reason) -> None:
        """As Flow's; the Blocks follow each other."""
        if not nodes:
            return
        routine, begin, end = nodes[0].routine, nodes[0].at, nodes[-1].end
        if routine.moves(begin, end):
            self.problem(line, message)
            self.gap(line)
        around = routine.around[begin]
        inside = around >= 0 and word_of(routine.statements[around][1]) in LOOPS
        self.forget(line, (routine, begin, end), inside=inside)

    def before(self, node: Block) -> None:
        """What comes before a statement or block that is reached in another way than in its turn."""
        since = self.joins.pop((id(node.routine), node.at), None) if self.joins else None
        if since is not None:
            self.gap(node.line)
            self.forget(node.line, (node.routine, since, node.at))
        if CLOSED.get(node.word) in LOOPS:  # how often what is before ran?
            self.rest(node.line, (node.routine, node.routine.around[node.at] + 1, node.at))
        if not node.closed:
            self.problem(
                node.line,
                "programs.krl.no_block_end",
                "{word} has no {end}",
                word=node.word.upper(),
                end=OPENING[node.word].upper(),
            )
            self.rest(node.line, (node.routine, node.at + 1, node.end))
            self.doubt = True  # nor is it known what belongs to the loop around

    def loop_(self, node: Node) -> None:
        """LOOP, which only what is in it ends."""
        self.repeated(node, None, None)

    def switch_(self, node: Node) -> None:
        if node.divided(self.CASES)[0][1]:
            reason = Unknown("programs.it_is_not_understood", "it is not understood")
            self.decided(node, reason, known(node.body), node.line)
            return
        super().switch_(node)

    def counted(self, node: Node) -> Sequence[Any] | None:
        match = FOR.match(node.text)
        return match.groups() if match else None

    def bounds(self, first: str, last: str, step: str | None) -> tuple[int, int, int]:
        return (
            integer(self.evaluate(first)),
            integer(self.evaluate(last)),
            integer(self.evaluate(step)) if step else 1,
        )

    def passes(self, node: Node, target: str, first: Any, last: Any, step: Any) -> None:
        name = target.lower()
        for value in range(first, last + (1 if step > 0 else -1), step):
            self.tick(node.line)
            self.store(node.line, name, (), value)
            left = self.one_pass(node)
            if left == "break":
                return
            if left == "doubt" or self.values.peek(name) != value:
                self.touch(node.line, node.text, "for", self.may_set(node.line))
                self.open_ended(node)
                return
        told = Fact(
            "programs.krl.counter",
            "behind its loop the counter {name} is not known",
            name=name.upper(),
        )
        self.lose(node.line, name, (), told)

    def jump(self, node: Node) -> None:
        match = GOTO.match(node.text)
        self.perhaps_goes_to(node, match[1].lower() if match else node.text[4:].strip(), None)

    def may_jump(self, line: int, text: str, routine: Routine, at: int) -> None:
        """A GOTO that may run or not: read as if it did not; at its label it is not known what has run."""
        self.may_leave(line, "GOTO")
        match = GOTO.match(text)
        to = routine.labels.get(match.group(1).lower()) if match else None
        if to is not None and to > at:
            key = (id(routine), to)
            self.joins[key] = min(at, self.joins.get(key, at))
        else:
            self.rest(line, (routine, to or 0, at))
