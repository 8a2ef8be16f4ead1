"""How a RAPID program runs through blocks, and what statements change that may run or not."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ....base.kinds import Json
from ...program import Fact, Unknown, work_of
from ..core.expression import number, truth
from ..core.jumps import Jumping
from ..core.tree import Node
from . import data
from .calls import HARMLESS
from .expression import Parser, first
from .motion import MotionRunner, spec_of

FOR = re.compile(
    r"FOR\s+(\w+)\s+FROM\s+(\S.*?)\sTO\s+(.+?)(?:\sSTEP\s+(.+))?$", re.IGNORECASE | re.DOTALL
)
GOTO = re.compile(r"\bGOTO\s+(\w+)\s*$", re.IGNORECASE)
TARGET = re.compile(r"\s*(\w+)\s*(?:\{[^}]*\}\s*|\.\s*\w+\s*)*:=")


class Control(Jumping, MotionRunner):
    """Runs blocks of statements; ``statement(node)`` is what a language's reader adds."""

    BLOCKS = {"if": "if_", "for": "for_", "while": "while_", "test": "switch_"}
    LEAVING = frozenset(("return", "raise", "exit", "exitcycle", "goto"))
    RETURNING = LEAVING - {"goto"}
    PARSER = Parser
    SHOUTED = True

    def __init__(self, path: Path | str, given: Json | None = None) -> None:
        Jumping.__init__(self)
        MotionRunner.__init__(self, path, given)
        self.routines: dict[str, Any] = {}  # (node, parameters, body) by name

    def cost(self, node: Node) -> int:
        return work_of(node.text) + 2 * node.text.count("(")

    def leads_to(self, node: Node) -> str | None:
        match = GOTO.search(node.text) if node.word in ("goto", "if;") else None
        return match[1].lower() if match else None

    def shown(self, node: Node) -> str:
        return super().shown(node).rstrip(";")

    def copy(self, value: Any, line: int) -> Any:
        """A copy of data; large data counts as many statements. Raises Unknown beyond reason."""
        size = data.bounded_size(value, data.MAX_ARRAY)
        if size > data.MAX_ARRAY:
            raise Unknown("programs.rapid.array_size", "the array's size is not sensible")
        if size > data.MAX_RECORD:
            self.tick(line, size // 8)
        return data.copied(value)

    def returns(self, node: Node) -> str:
        if node.word != "if;":
            return super().returns(node)
        words = node.text.lower().split()
        return next((word for word in words[1:] if word in self.RETURNING), "")

    def leaves(self, node: Node) -> bool:
        return node.word in self.LEAVING or (
            node.word == "if;" and bool(self.LEAVING & set(node.text.lower().split()))
        )

    def may_change(self, node: Node) -> tuple[bool, Mapping[str, Sequence[Node]]]:
        words = [w.lower() for w in re.findall(r"\w+", node.text)]
        self.lose_functions(set(words))
        target = TARGET.match(node.text)
        if target:
            self.forget(target.group(1).lower())
        elif node.word not in HARMLESS:
            specs = [spec for spec in map(spec_of, words) if spec]
            for word in words[1:] if not specs or specs[0].search else []:  # a search writes
                self.forget(word)
            if words[:1] == ["velset"]:
                self.override = None
        found = words if node.word == "if;" else words[:1]
        if {"pdispset", "pdispon", "pdispoff"} & set(found):
            self.displacement = False
        called = {name: self.routines[name][2] for name in set(found) & self.routines.keys()}
        return bool(called) or any(spec_of(word) is not None for word in found), called

    def short_if(self, node: Node) -> None:
        """IF with one statement and no ENDIF."""
        rest = ""
        try:
            condition, rest = first(node.text)
            known = truth(condition(self))
        except Unknown as unknown:
            self.may_set_force(node.line, rest)
            message = Fact(
                "programs.rapid.motion_at_run_time",
                "{word} is decided at run time ({reason}); its motion is left out",
                reason=unknown.fact,
                word="IF",
            )
            self.skip([node], node.line, message, unknown)
            return
        word = re.match(r"\w+", rest)
        self.tick(node.line, work_of(rest))
        if known and word:
            if not self.sets_force(node.line, rest):
                self.statement(Node(node.line, word.group().lower(), rest))
        elif not word:
            self.problem(
                node.line,
                "programs.rapid.if_without_statement",
                "IF has neither THEN nor a statement",
            )

    def counted(self, node: Node) -> Sequence[Any] | None:
        match = FOR.match(" ".join(node.text.split()))
        return (match[1].lower(), *match.groups()[1:]) if match else None

    def bounds(self, first: str, last: str, step: str | None) -> tuple[float, float, float]:
        with self.asking("num"):
            begin, end = number(self.value(first)), number(self.value(last))
            return begin, end, number(self.value(step)) if step else 1.0 if end >= begin else -1.0

    @contextlib.contextmanager
    def counter(self, name: str) -> Iterator[None]:
        scope = self.globals if self.locals is None else self.locals
        before = scope.get(name)
        scope[name] = ["num", None]
        try:
            yield
        finally:
            scope.pop(name, None)  # the loop's variable ends with it
            if before is not None:
                scope[name] = before

    def assign(self, target: str, value: Any) -> None:
        self.store(target, value)
