"""Reads ABB RAPID modules: .mod, .prg, .modx, .sys.

Poses are those of the tool in the work object (object frame), as programmed. PERS data has the
value the module gives. What only the controller can know is a Problem.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ....base.kinds import Json, known
from ...program import LOOPED, Fact, Program, Unknown, work_of
from . import data, modules
from ..core.flow import Leave
from ..core.statements import Statements
from ..core.tree import Node, every
from .calls import CHANGING, HARMLESS
from .control import TARGET
from .data import PREDEFINED, number
from .expression import arguments, expression, place
from .loading import DECLARATION, Routine
from .motion import MOVES, spec_of
from .routines import Routines, Undecided
from .state import FRAMES
from .text import tree


SETTINGS = ("velset", "pdispset", "pdispon", "pdispoff")
ENDS = {"return": "return", "raise": "return", "exit": "exit", "exitcycle": "exit"}
COUNTING = ("incr", "decr", "add", "clear")


def read(path: Path | str, values: Json | None = None) -> Program:
    """The Program of a RAPID module; ``values``: what a person gives, by name. Raises ProgramError when it cannot be read at all."""
    interpreter = _Interpreter(path, values)
    interpreter.run(tree(path), modules.others(Path(path)))
    return interpreter.finish()


class _Interpreter(Routines):
    """Follows a program from PROC main on with the values it can know."""

    def __init__(self, path: Path | str, given: Json | None = None) -> None:
        super().__init__(path, given)
        self.missing: set[str] = set()

    def run(self, nodes: Sequence[Node], near: Sequence[tuple[str, list[Node]]] = ()) -> None:
        """``near``: the other modules of the folder, (file, nodes) each."""
        for node in every([*nodes, *(one for _, others in near for one in others)]):
            self.rounds -= LOOPED * (work_of(node.text) + 2 * node.text.count("("))
        loose = self.module(nodes)
        own = dict(self.routines)
        self.neighbours(near)
        self.follow(loose, own)

    def follow(self, loose: list[Node], own: dict[str, Routine]) -> None:
        """Runs the program: ``loose`` statements, or the routines ``own`` of its module."""
        for name in list(self.globals):
            self.settle(name)
        starts = [own["main"]] if "main" in own else self.uncalled(own)
        if loose and not own:  # an excerpt without its PROC
            starts = [(loose[0], [], loose)]
        elif "main" not in own and starts:
            self.problem(
                starts[0][0].line,
                "programs.rapid.no_main",
                "there is no PROC main; the procedures nothing here calls are followed in turn",
            )
        try:
            for head, parameters, body in starts:
                self.forget_position()
                self.locals = {one.name: [one.kind, None] for one in parameters}
                self.routine(head, body)
        except Leave:
            pass

    def statement(self, node: Node) -> None:
        spec = spec_of(node.word)
        if spec is not None and self.evaluating:
            raise Undecided(Fact("programs.rapid.function_moves", "it moves the robot"))
        if spec is not None:
            self.motion(node.line, node.text, spec)
        elif node.word == "if;":
            self.short_if(node)
        elif node.word == "label":
            return
        elif node.word == "placeholder":
            self.problem(
                node.line,
                "programs.rapid.placeholder",
                "{text} stands for a statement that is still to be written; the controller stops there",
                text=node.text,
            )
            self.gap(node.line)
        elif match := DECLARATION.match(node.text):
            scope = self.globals if self.locals is None else self.locals
            self.declare(node, scope)
            self.settle(match.group(3).lower())
        elif TARGET.match(node.text):
            self.assignment(node)
        else:
            self.instruction(node)

    def assignment(self, node: Node) -> None:
        name = known(TARGET.match(node.text)).group(1).lower()
        try:
            written, _, text = node.text.partition(":=")
            target, found = place(written), expression(text)
            entry: Any = self.entry(name) or PREDEFINED.get(name)
            kind = "num" if target.steps else entry[0] if entry else None
            with self.asking(self.kind_of(found, kind)):
                value = self.copy(found(self), node.line)
            if not target.steps:
                self.store(name, value)
                return
            holder, kind = self.variable(name)
            if self.entry(name) is None:  # predefined: this program's own from here on
                self.store(name, data.copied(holder))
                holder = self.variable(name)[0]
            *path, last = [index for index, _ in self.steps_of(target, kind)]
            for index in path:
                holder = holder[self.element(holder, index, name)]
            holder[self.element(holder, last, name)] = value
            self.texts.clear()
            self.changes += 1
            if kind in FRAMES:
                self.another(name)
        except Unknown as unknown:
            # Not known from here on: whoever uses it reports it.
            self.lose_functions({word.lower() for word in re.findall(r"\w+", node.text)})
            self.forget(name, unknown)
        except ValueError:
            self.problem(
                node.line,
                "programs.rapid.assignment",
                "the assignment to {name} is not understood",
                name=name,
            )
            self.forget(name)

    def instruction(self, node: Node) -> None:
        word, line = node.word, node.line
        if word == "goto":
            self.goes_to(node, self.leads_to(node) or "")
        if word == "return" and self.evaluating:
            try:
                raise Leave("return", line, self.copy(self.value(node.text[6:]), line))
            except Unknown as unknown:
                raise Undecided(unknown) from None
        if word in ENDS:
            raise Leave(ENDS[word], line)
        if word in SETTINGS and self.evaluating:
            raise Undecided(Fact("programs.rapid.function_sets", "it changes what motions follow"))
        if word in SETTINGS:
            self.setting(line, word, node.text)
            return
        if word in self.routines:
            self.call(node)
            return
        if word in COUNTING:
            self.count(node)
            return
        if word in CHANGING or word not in HARMLESS:
            for name in re.findall(r"\w+", node.text)[1:]:
                self.forget(name.lower())
        if word not in HARMLESS and word not in CHANGING and word not in self.missing:
            self.missing.add(word)
            what = (
                node.text.split("\n")[0][:30] if not word else known(re.match(r"\w+", node.text))[0]
            )
            self.problem(
                line,
                "programs.not_in_file",
                "{name} is not in this file; motions in it are left out",
                name=what,
            )
            self.gap(line)

    def count(self, node: Node) -> None:
        name = ""
        try:
            row = arguments(node.text)[0]
            name = row[0].name.lower()
            if row[0].steps:
                raise Unknown("programs.it_is_not_understood", "it is not understood")
            before = number(self.variable(name)[0])
            step = number(row[1](self)) if node.word == "add" else 1.0
            change = {"incr": 1.0, "decr": -1.0, "add": step, "clear": -before}[node.word]
            self.store(name, before + change)
        except (Unknown, IndexError, AttributeError):
            self.forget(name)


STATEMENTS = Statements(
    followed=[
        *MOVES,
        *(word.upper() for word in (*_Interpreter.BLOCKS, *ENDS, "goto")),
        *("VelSet", "PDispSet", "PDispOff", "Incr", "Decr", "Add", "Clear"),
    ],
    ignored=sorted(HARMLESS),
    asked=sorted(CHANGING),
    left_out=["<SMT>"],
)
