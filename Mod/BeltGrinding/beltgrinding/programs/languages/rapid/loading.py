"""What RAPID modules declare: data, records and routines, of the program's own module and of those beside it."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

from ....base.kinds import Json, known
from ...program import ProgramError, Unknown
from .state import Entry
from ..core.tree import Node, every
from . import data, modules
from .control import Control
from .data import number
from .expression import arguments

MADE = 64  # values of an array, which are made in a unit of work
DECLARATION = re.compile(
    r"(?:(?:LOCAL|TASK)\s+)*(CONST|PERS|VAR)\s+(\w+)\s+(\w+)\s*(?:(\{[^}]*\})\s*)?(?::=(.*))?$",
    re.IGNORECASE | re.DOTALL,
)
ROUTINE = re.compile(r"\s*(?:LOCAL\s+)?(?:PROC|FUNC\s+\w+)\s+(\w+)\s*\(([^)]*)\)", re.IGNORECASE)
PARAMETER = re.compile(
    r"(?P<mark>[,\\|]?)\s*(?:(?P<by>INOUT|VAR|PERS)\s+)?(?P<kind>\w+)\s+(?P<name>\w+)\s*(?:\{[^}]*\})?\s*",
    re.IGNORECASE,
)


class Parameter(NamedTuple):
    """A parameter of a routine."""

    by_reference: bool
    kind: str
    name: str
    optional: bool


Routine: TypeAlias = tuple[Node, list[Parameter], list[Node]]  # its head, parameters and statements


class Loading(Control):
    """Declares what stands in modules."""

    def __init__(self, path: Path | str, given: Json | None = None) -> None:
        super().__init__(path, given)
        self.functions: dict[str, Routine] = {}  # as routines
        self.evaluating = 0  # functions in each other
        # Of routines of other modules, by the id of their node
        self.homes: dict[int, modules.Home] = {}
        self.own: dict[
            str, Entry
        ] | None = None  # the data of another module while its routine runs
        self.private: set[str] = set()  # LOCAL data of this module

    def neighbours(self, near: Iterable[tuple[str, list[Node]]]) -> None:
        """Declares what other modules tell all, where this one does not and no two of them do."""
        mine = set(self.globals) | set(self.routines) | set(self.functions)
        told: dict[str, list[modules.Home]] = {}
        homes: list[modules.Home] = []
        for file, nodes in near:
            home = modules.Home(file)
            kept = self.globals, self.routines, self.functions, self.constants
            self.globals, self.routines, self.functions, self.constants = {}, {}, {}, set()
            with contextlib.suppress(ProgramError):
                self.module(nodes)
            found = self.globals, self.routines, self.functions
            self.globals, self.routines, self.functions, self.constants = kept
            home.data, home.routines, home.functions = found
            homes.append(home)
            for name in {*found[0], *found[1], *found[2]} - self.local_names(nodes) - mine:
                told.setdefault(name, []).append(home)
        shared = {name: found[0] for name, found in told.items() if len(found) == 1}
        for name, home in shared.items():
            for here, there in (
                (self.globals, home.data),
                (self.routines, home.routines),
                (self.functions, home.functions),
            ):
                if name in there and name != "main":
                    here[name] = there[name]
        for home in homes:
            for node, _, _ in (*home.routines.values(), *home.functions.values()):
                self.homes[id(node)] = home
        for home in homes:  # before the names of this module's own are the only ones that are seen
            home.routines = {**self.routines, **home.routines}
            home.functions = {**self.functions, **home.functions}
            with self.within(home):
                for name in home.data:
                    self.settle(name)

    @staticmethod
    def local_names(nodes: Iterable[Node]) -> set[str]:
        """Names that a module declares LOCAL, in lower case."""
        names: set[str] = set()
        stack = list(nodes)
        while stack:
            node = stack.pop()
            if node.word == "module":
                stack += known(node.body)
            elif modules.LOCAL.match(node.text):
                for pattern, group in ((DECLARATION, 3), (ROUTINE, 1)):
                    match = pattern.match(node.text)
                    if match:
                        names.add(match.group(group).lower())
        return names

    @contextlib.contextmanager
    def within(self, home: modules.Home | None) -> Iterator[None]:
        """Runs statements of another module (None: of the one that runs)."""
        if home is None:
            yield
            return
        kept = self.file, self.own, self.routines, self.functions, self.locals
        self.file, self.own = home.file, home.data
        self.routines, self.functions = home.routines, home.functions
        self.other_names()
        try:
            yield
        finally:
            self.file, self.own, self.routines, self.functions, self.locals = kept
            self.other_names()

    def other_names(self) -> None:
        """The names of frames may mean others from here on; in functions nothing moves."""
        if not self.evaluating:
            self.texts.clear()

    def entry(self, name: str) -> Entry | None:
        if self.own is None or self.locals is not None and name in self.locals:
            return super().entry(name)
        if name in self.own:
            return self.own[name]
        return None if name in self.private else self.globals.get(name)

    def uncalled(self, own: dict[str, Routine]) -> list[Routine]:
        nodes = every([node for _, _, body in own.values() for node in body])
        called = {word.lower() for node in nodes for word in re.findall(r"\w+", node.text)}
        return [r for name, r in own.items() if name not in called] or list(own.values())[:1]

    def module(self, nodes: Iterable[Node]) -> list[Node]:
        """Declares a module's data and routines; returns statements outside of any routine."""
        loose: list[Node] = []
        for node in nodes:
            if node.word == "module":
                loose += self.module(known(node.body))
            elif node.word == "record":
                self.record(node)
            elif node.word in ("proc", "func") and (match := ROUTINE.match(node.text)):
                name, parameters = match.groups()
                body = known(node.body)
                handler = next(
                    (k for k, n in enumerate(body) if n.word in ("error", "undo", "backward")),
                    len(body),
                )
                kept = self.routines if node.word == "proc" else self.functions
                kept[name.lower()] = (
                    node,
                    self.parameters(parameters),
                    body[:handler],
                )
            elif node.word in ("func", "trap"):
                continue  # evaluated, and interrupted by, on the controller only
            elif match := DECLARATION.match(node.text):
                self.declare(node, self.globals)
                if modules.LOCAL.match(node.text):
                    self.private.add(match.group(3).lower())
            else:
                loose.append(node)
        return loose

    def record(self, node: Node) -> None:
        parts: dict[str, str] = {}
        for part in known(node.body):
            words = part.text.lower().split()
            if len(words) == 2:
                parts[words[1]] = words[0]
        self.records[node.text.split()[-1].lower()] = parts

    @staticmethod
    def parameters(text: str) -> list[Parameter]:
        """The Parameters of a routine's head."""
        found: list[Parameter] = []
        optional = False
        for match in PARAMETER.finditer(text):
            optional = match["mark"] == "\\" or match["mark"] == "|" and optional
            names = match["kind"].lower(), match["name"].lower()
            found.append(Parameter(bool(match["by"]), *names, optional))
        return found

    def declare(self, node: Node, scope: dict[str, Entry]) -> None:
        storage, kind, name, dimensions, text = known(DECLARATION.match(node.text)).groups()
        kind, name = kind.lower(), name.lower()
        self.other_names()
        scope[name] = [kind, None]
        if storage.lower() == "const" and scope is self.globals:
            self.constants.add(name)
        if text is not None:
            if not text.strip():
                raise ProgramError.at(
                    self.file,
                    node.line,
                    "programs.rapid.given_no_value",
                    "{name} is given no value",
                    name=name,
                )
            scope[name].append((node.line, text))
            return
        try:
            value = data.initial(kind, self.records)
            if dimensions:
                sizes = [int(number(one(self))) for one in arguments("DIM " + dimensions[1:-1])[0]]
                count = data.array_size(sizes, value)
                self.tick(node.line, count // MADE)
                value = data.array(sizes, value)
            # Persistent data without a value keeps what the controller last had.
            scope[name][1] = None if storage.lower() == "pers" else value
        except Unknown:
            pass
