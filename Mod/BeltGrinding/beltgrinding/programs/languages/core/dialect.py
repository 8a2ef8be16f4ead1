"""The interpreter of a language: variables, blocks, jumps and motions, told of what only the controller knows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

from ....base.kinds import Json
from ...program import LOOPED, Program, Told, Unknown, name_of, work_of
from .expression import alike
from .flow import Jump, Leave
from .jumps import Jumping
from .memory import Data, Memory
from .moving import Moving
from .tree import Node, grown


MAX_CALLS = 20


class Dialect(Jumping, Memory, Moving):
    """What a language adds: ``LANGUAGE``, its name; ``CLOSED_BY``, as ``tree.grown`` takes it; ``run()``; ``does(node)``, which
    runs a statement; and what ``Flow`` and ``Memory`` ask for."""

    LANGUAGE = ""
    CLOSED_BY: Mapping[str, Sequence[str]] = {}
    run: Callable[[], None]
    does: Callable[[Node], None]
    FOR: Any = None  # of the text of a "for": target, first, last, step
    SHOUTED = True
    alike: Callable[..., bool] = staticmethod(alike)

    def __init__(
        self, path: Path | str, values: Json | None = None, data: Data | None = None
    ) -> None:
        self.program = Program(self.LANGUAGE, name_of(path))
        self.file, self.line = self.program.file, 0
        Jumping.__init__(self)
        Memory.__init__(self, {} if data is None else data, values)
        Moving.__init__(self)

    def followed(self) -> Program:
        """The Program, once it is run."""
        self.run()
        return self.program

    def counted(self, node: Node) -> Sequence[Any] | None:
        match = self.FOR and self.FOR.match(node.text)
        return match and match.groups()

    def cost(self, node: Node) -> int:
        return work_of(node.text) + 2 * node.text.count("(") + 2 * (node.word not in self.BLOCKS)

    def problem(
        self, line: int, told: Told, text: str | None = None, /, **arguments: object
    ) -> None:
        self.program.problem(self.file, line, told, text, **arguments)

    def gap(self, line: int) -> None:
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.here = self.through = None
        self.program.gap(line, self.file)

    def grown(self, rows: Iterable[tuple[int, str, str]]) -> list[Node]:
        """The Nodes of (line, word, text); a block without its end, or the other way round, is a Problem."""
        rows = list(rows)
        self.rounds -= LOOPED * sum(work_of(text) for _, _, text in rows)

        def stray(line: int, word: str, text: str, node: Node | None) -> None:
            self.problem(
                line,
                "programs.no_beginning",
                "{word} ends no block that is open",
                word=word.upper(),
            )
            self.gap(line)

        def unclosed(node: Node, line: int) -> None:
            self.problem(
                node.line,
                "programs.no_end",
                "{word} has no end; the file may be cut off",
                word=self.shown(node),
            )

        return grown(rows, self.CLOSED_BY, self.file, stray, unclosed)

    def statement(self, node: Node) -> None:
        try:
            self.does(node)
        except Unknown as unknown:
            self.program.need(unknown)
            self.problem(
                node.line,
                "programs.left_out",
                "{what} is left out: {reason}",
                what=self.shown(node),
                reason=unknown.fact,
            )
            self.gap(node.line)

    def invoke(
        self,
        name: str,
        parameters: Iterable[str],
        texts: Iterable[str],
        nodes: Sequence[Node],
        file: str,
    ) -> None:
        """Runs a routine of a file with the texts of its arguments; its variables in them get back what it makes
        of them."""
        if len(self.scopes) > MAX_CALLS:
            raise Unknown(
                "programs.routine_calls_itself", "{name} calls itself too deeply", name=name
            )
        self.tick(self.line, 1)
        scope, back = self.bound(parameters, texts)
        outer, self.file = (self.file, self.line), file
        self.scopes.append(scope)
        try:
            self.block(nodes)
        except Leave as leave:
            if leave.word == "exit":
                raise
        except Jump as jump:
            self.no_label(jump)
        finally:
            self.scopes.pop()
            self.file, self.line = outer
        self.returned(scope, back)

    def not_here(self, name: str, text: str) -> NoReturn:
        """Raises Unknown for a routine that may be anywhere: what the program has stored may be other then."""
        self.lose(self.names(text) | {one for one in self.spent if not self.local(one)})
        for which in ("base", "tool"):
            self.frame_unknown(which, self.line)
        raise Unknown("programs.no_routine_here", "the routine {name} is not here", name=name)

    def not_run(self, line: int, name: str, begin: str) -> None:
        """Tells of a routine with motions that the one with which reading begins does not run."""
        self.problem(
            line,
            "programs.not_run",
            "the program {name} is not run by {begin}, with which reading begins; its motions are left "
            "out; name the file after the program to begin with",
            name=name,
            begin=begin,
        )
        self.gap(line)
