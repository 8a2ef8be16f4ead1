"""Subprograms of G-code: in the same file, or in one beside it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

from ...program import Unknown
from ..core.expression import Place, number
from ..core.listing import END, no_subprogram
from . import units
from .expression import Siemens, expression_of
from .statements import Statements
from .units import Unit
from .variables import LETTERS, NOT_KNOWN

MOST_TIMES = 9999  # that a subprogram is called in a block, or a part is repeated
CALLS = ("CALL", "PCALL", "EXTCALL")  # beside a name alone, and L with a number
CALL = re.compile(
    r"(?:P?CALL\s*\"(?P<quoted>[\w/.]+)\"|PCALL\s+(?P<path>[\w/]+)|EXTCALL\s*\(?\s*\"(?P<outer>[\w/.]+)\"\s*\)?|"
    r"L(?P<number>\d+)|(?P<name>[A-Z_]{2}\w*?))\s*(?:\((?P<given>.*)\))?\s*(?:(?<!\w)P\s*=?\s*(?P<times>[\w$(].*))?$"
)
HEAD = re.compile(r"\s*(?:N\d+\s*)?PROC\s+\w+\s*(?:\((.*)\))?(.*)")
PARAMETER = re.compile(r"\s*(VAR\s+)?(REAL|INT|BOOL)\s+(\w+)\s*(?:=\s*(.*))?$")
FILE = re.compile(r"(?:.*/)?(?:_N_)?(\w+?)(?:[._][SM]PF)?$")


class Parameter(NamedTuple):
    """Of a PROC: whether it gives its variable the value back, its name, what it is without one."""

    back: bool
    name: str
    default: Any


class Calls(Statements):
    """Follows calls."""

    def call(
        self,
        at: int,
        unit: Unit,
        begin: int,
        values: dict[str, Any],
        count: float = 1.0,
        back: dict[str, str] | None = None,
    ) -> int | None:
        """Follows a subprogram ``count`` times. ``back``: {name in it: variable that gets its value}."""
        if not 0 <= count <= MOST_TIMES or count != int(count):
            raise Unknown(*NOT_KNOWN)
        for _ in range(int(count)):
            self.variables.enter(values)
            try:
                if self.routine(at + 1, unit, begin) == END:
                    return END
            finally:
                inner = self.variables.leave()
            for name, key in (back or {}).items():
                if name in inner:
                    self.variables.assign(key, inner[name])
                else:
                    self.variables.drop(key)
        return None

    def other(self, name: str, suffixes: tuple[str, ...]) -> Unit:
        """The Unit of a file beside the program, or in it. Raises Unknown."""

        def load(path: Path) -> Unit:
            unit, more, _ = units.load(path)
            return more.get(name, unit)

        unit = self.beside(name, suffixes, load)
        if unit.dialect not in (self.dialect, None):
            raise no_subprogram(name)
        unit.dialect = self.dialect
        return unit

    def call_siemens(self, at: int, match: re.Match[str]) -> int | None:
        file = FILE.match(match["quoted"] or match["path"] or match["outer"] or match["name"] or "")
        name = "L" + match["number"] if match["number"] else file[1] if file else ""
        unit = self.other(name, (".spf", ".mpf"))
        given = [] if not (match["given"] or "").strip() else Siemens.list(match["given"])[0]
        first = unit.lines[unit.begin : unit.begin + 50]
        head = next(filter(None, (HEAD.match(t.upper().replace("()", "( )")) for t in first)), None)
        parameters = self.parameters(head[1] or "") if head else []
        if len(given) > len(parameters):
            raise Unknown(*NOT_KNOWN)
        values = {one.name: one.default for one in parameters}
        back = {}
        for one, expression in zip(parameters, given):
            value = expression(self.variables)
            values[one.name] = value if isinstance(value, (bool, str)) else float(number(value))
            if one.back:
                if not isinstance(expression, Place):
                    raise Unknown(*NOT_KNOWN)
                back[one.name] = self.variables.key(expression)
        times = match["times"]
        count = number(expression_of(Siemens, times)(self.variables)) if times else 1.0
        found = self.call(at, unit, unit.begin, values, count, back)
        if head and "SAVE" in head[2]:
            self.lose_modes(at + 1, match[0])
        return found

    def parameters(self, text: str) -> list[Parameter]:
        """Those of a PROC; one that a call leaves out has its default, or 0. Raises Unknown."""
        found = []
        for one in Siemens.split(text):
            match = PARAMETER.match(one)
            if not match:
                raise Unknown(*NOT_KNOWN)
            default: Any = match[2] != "BOOL" and 0.0
            if match[4]:
                default = expression_of(Siemens, match[4])(self.variables)
            found.append(Parameter(bool(match[1]), match[3], default))
        return found

    def call_named(self, at: int, label: str, rest: str) -> int | None:
        """o100 call [1] [2]."""
        parser: Any = self.parser(rest)
        values: dict[str, Any] = {}
        while parser.at < len(parser.tokens):
            parser.expect("[")
            values[f"#{len(values) + 1}"] = float(number(parser.infix()(self.variables)))
            parser.expect("]")
        unit = self.unit
        begin = unit.look().subs.get(label)
        if begin is None:
            unit = self.other(label.strip("<>"), (".ngc", ".nc"))
            begin = unit.look().subs.get(label)
        if begin is None:
            raise no_subprogram(label)
        return self.call(at, unit, begin + 1, values)

    def call_numbered(self, at: int, body: str) -> int | None:
        """M98 P100 L2, G65 P100 A1 B2: a program of the same file."""
        words = self.split(body)
        given = dict(words)
        number_of = given.pop("P", 0.0)
        begin = self.unit.look().subs.get(f"{number_of:g}") if 0 < number_of < 10_000 else None
        if len(given) + 1 < len(words) or begin is None:
            raise no_subprogram(f"{number_of:g}")
        count = given.pop("L", 1.0)
        if given.pop("G", None) == 65:
            if not set(given) <= set(LETTERS):
                raise Unknown(*NOT_KNOWN)
            values = {f"#{LETTERS[letter]}": value for letter, value in given.items()}
            return self.call(at, self.unit, begin, values, count)
        if set(given) != {"M"}:
            raise Unknown(*NOT_KNOWN)
        self.variables.own[-1][0].clear()  # whose #1 to #33 they are, controls differ
        found = self.call(at, self.unit, begin, {}, count)
        self.variables.own[-1][0].clear()
        return found
