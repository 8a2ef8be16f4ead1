"""What a KRL program has beside its statements: values of data lists, routines of its file and of other modules."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ...program import LOOPED, ProgramError, name_of, work_of
from .data_lists import Rows
from .parts import Parts
from . import data_lists, modules
from .blocks import ASSIGN, Routine, word_of
from .types import declaration, structure
from .values import Members, Scope

HEADS = re.compile(r"^(?:GLOBAL\s+)?DEF(?:FCT)?\b", re.IGNORECASE)
NAME = re.compile(r"(\w+)\s*\(")


class Sources(Parts):
    """Part of the interpreter (reader.py); what it needs of the others is theirs."""

    def read_lists(self, path: Path) -> None:
        """Takes the values of the data lists that a module sees, its own last."""
        shared, more = data_lists.others(path)
        if more:
            self.problem(
                1,
                "programs.krl.many_lists",
                "the folder has too many .dat files; some are not read",
            )
        origin: dict[Any, str] = {}
        module = self.values.module
        for one, rows in shared:
            told = len(self.program.problems)
            self.values.module = found = Scope()
            self.read_data(rows, name_of(one))
            del self.program.problems[told:]  # those of other modules
            self.values.module = module
            module.kinds.update(found.kinds)
            for name, value in found.values.items():
                self.take_shared(name, value, name_of(one), origin)
        self.program.asked.clear()
        self.values.private = frozenset(self.read_own(path))

    def read_own(self, path: Path) -> set[str]:
        """Takes the values of a module's own list. Gives the names that no other module sees."""
        data = data_lists.own(path)
        rows = [] if data is None else data_lists.statements(data)
        self.read_data(rows, "" if data is None else name_of(data))
        found = [declaration(text) for _, text in rows if "global" not in text.lower().split()]
        return {name for one in found if one for name in one[1] if not name.startswith("$")}

    def read_modules(self, near: Iterable[tuple[Path, Rows]]) -> None:
        """Takes the routines of other modules, (path, statements) each, with their own data."""
        module = self.values.module
        for path, statements in near:
            self.values.module = found = Scope()
            own: set[str] = set()
            with contextlib.suppress(ProgramError):  # its values are asked for where they are used
                own = self.read_own(path)
            self.values.module = module
            scope = Scope(frozenset(own), found.kinds)
            scope.values = {name: value for name, value in found.values.items() if name in own}
            home = self.homes[path.stem.lower()] = modules.Home(name_of(path), scope)
            self.divide(statements, home)
        for name, home in self.homes.items():
            seen = {
                one: other.routines[one]
                for one, other in self.homes.items()
                if one != name and one in other.routines
            }
            home.routines = {**seen, **home.routines}

    @contextlib.contextmanager
    def at_home(self, home: modules.Home) -> Iterator[None]:
        """Runs statements of a module."""
        kept = self.file, self.home, self.values.home
        self.file, self.home, self.values.home = home.file, home, home.scope
        try:
            yield
        finally:
            self.file, self.home, self.values.home = kept

    def take_shared(self, name: str, value: Any, file: str, origin: dict[Any, str]) -> None:
        """A value of another list; where two lists do not agree on it, neither is taken."""
        module = self.values.module
        elements: dict[Any, Any] = {(): value}
        if isinstance(value, Members) and any(isinstance(step, tuple) for step in value):
            elements = dict(value)
            module.values.setdefault(name, Members())
        for indices, one in elements.items():
            key = (name, indices)
            holder: Any = module.values if not indices else module.values[name]
            at = indices or name
            if not isinstance(holder, dict):
                continue
            if key in origin and holder.get(at) != one:
                self.problem(
                    1,
                    "programs.krl.defined_twice",
                    "{name} is not the same in {one} and {other}; neither is taken",
                    name=name.upper(),
                    one=origin[key],
                    other=file,
                )
                holder.pop(at, None)
            elif key not in origin:
                holder[at] = one
            origin.setdefault(key, file)

    def read_data(self, statements: Rows, name: str) -> None:
        own, self.file = self.file, name
        for line, text in statements:
            self.rounds -= LOOPED * work_of(text)
            self.line = line
            self.declare(text)
            match = ASSIGN.match(text)
            if match:
                self.assign(match, line)
        self.file = own

    def declare(self, text: str) -> None:
        """Takes the types that a statement of the module declares."""
        found, made = declaration(text), structure(text)
        if found:
            self.values.module.kinds.update(dict.fromkeys(found[1], found[0]))
        if made:
            self.values.structures[made[0]] = made[1]

    def divide(self, statements: Rows, home: modules.Home) -> tuple[Routine | None, str | None]:
        """Takes the routines of a module's statements. Gives the first, or None, and the name of one that has no
        end."""
        bodies: dict[str, Rows] = {}
        heads: dict[str, str] = {}
        order: list[Rows] = []
        body: Rows = []
        name: str | None = None
        for line, text in statements:
            self.rounds -= LOOPED * work_of(text)
            word = word_of(text)
            if HEADS.match(text):
                match = NAME.search(text)
                name, body = (match.group(1).lower() if match else f"?{line}"), []
                bodies[name], heads[name] = body, text
                order.append(body)
            elif word in ("end", "endfct"):
                name = None
            elif name is not None:
                body.append((line, text))
            elif not order:  # an excerpt without its DEF
                name, body = "", [(line, text)]
                order.append(body)
            made = structure(text) if word in ("struc", "global") else None
            if made:
                self.values.structures[made[0]] = made[1]
        home.routines = {
            key: Routine(body, heads.get(key, ""), home) for key, body in bodies.items()
        }
        if not order:
            return None, name
        first = next((r for r in home.routines.values() if r.statements is order[0]), None)
        return first or Routine(order[0], "", home), name
