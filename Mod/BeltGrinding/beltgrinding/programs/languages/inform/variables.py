"""The numbers of an INFORM job: variables B, I, D, R as far as the job itself, or a person, says what they are."""

from __future__ import annotations

import math
import re
from typing import Any

from ...program import Reason, Unknown
from .. import taught_numbers
from ..core.expression import Call, Place, divided, number

NAME = re.compile(r"(?<![\w$#])(L?)([BIDR])(?:(\d{1,5})(?!\d)|\[([^\[\]]*)\])", re.ASCII)
RANGE = {"B": (0, 255), "I": (-32768, 32767), "D": (-(2**31), 2**31 - 1)}  # of whole numbers
# What an instruction makes of the variable that it names and of a value; None: it needs none.
CALCULATED = {
    "set": lambda old, new: new(),
    "add": lambda old, new: old() + new(),
    "sub": lambda old, new: old() - new(),
    "mul": lambda old, new: old() * new(),
    "div": lambda old, new: divided(old(), new()),
    "inc": lambda old, new: old() + 1.0,
    "dec": lambda old, new: old() - 1.0,
    "getarg": lambda old, new: new(),
}
ARGUMENT = re.compile(r"\b(?:ARGF\s*(-?[\d.]+)|ARG\s*(L?[BIDR]\d{1,5}))(?=\s|$)", re.ASCII)
PASSED = re.compile(r"IARG#\((\d{1,2})\)", re.ASCII)


class Parser(taught_numbers.Parser):
    TOKEN = re.compile(
        r"\s*(?:(?P<number>(?:\d+(?:\.\d*)?|\.\d+)(?![\w.]))|(?P<name>[A-Za-z_$][\w$]*#?)"
        r"|(?P<op><>|<=|>=|[-+*/()\[\]=<>,]))",
        re.ASCII,
    )

    fold = staticmethod(lambda name: {"ANDEXP": "AND", "OREXP": "OR"}.get(name, name))


class Variables(taught_numbers.Numbers):
    """Values of variables; what the job does not set is asked for."""

    PARSER = Parser
    SHAPE = "number"

    def local(self, name: str) -> bool:
        return name.startswith("L")

    def named(self, place: Place) -> str:
        """B005 of B005, B5 and B[5]."""
        index = place.steps[0] if place.steps else ()
        written = NAME.fullmatch(place.name)
        if written and not place.steps:
            local, kind, digits, _ = written.groups()
        elif re.fullmatch("L?[BIDR]", place.name) and len(index) == 1 == len(place.steps):
            local, kind, digits = place.name[:-1], place.name[-1], self.whole(index[0](self))
        else:
            raise Unknown("programs.inform.at_run_time", "it is known at run time only")
        return f"{local}{kind}{int(digits):03}"

    def whole(self, value: Any) -> int:
        """An index: a whole number. Raises Unknown."""
        value = number(value)
        if value != int(value) or not 0 <= value < 1e5:
            raise Unknown(
                "programs.inform.no_variable", "'{text}' is no number", text=f"{value:g}"[:20]
            )
        return int(value)

    def absent(self, name: str) -> Reason:
        return Reason(
            "programs.inform.no_number_value", "{name} has no value that the job gives", name=name
        )

    def function(self, call: Call) -> None:
        raise Unknown("programs.inform.at_run_time", "it is known at run time only")

    def keep(self, name: str, value: float) -> None:
        """Raises Unknown where the value does not fit."""
        least, most = RANGE.get(name.lstrip("L")[0], (-1e12, 1e12))
        if not least <= value <= most or (
            name.lstrip("L")[0] in RANGE and value != math.floor(value)
        ):
            raise Unknown(
                "programs.inform.does_not_fit",
                "{value:g} does not fit into {name}",
                value=value,
                name=name,
            )
        super().keep(name, value)

    def forgets_named(self, text: str) -> None:
        """All variables that a statement names; of an index that is not known all of its kind."""
        for match in NAME.finditer(text):
            begin = match.group(1) + match.group(2)
            try:
                self.forgets(self.named(self.PARSER.place(match.group())))
            except Unknown:
                for name in [*self.data, *self.scopes[-1]]:
                    if name.startswith(begin):
                        self.forgets(name)

    def calculates(self, word: str, text: str) -> bool:
        """Follows SET, INC, DEC, ADD, SUB, MUL, DIV and GETARG of a number; False: it is another statement."""
        match = re.match(r"\w+\s+(\S+)\s*(.*)$", text)
        if word not in CALCULATED or not match or not NAME.fullmatch(match.group(1)):
            return False
        target, rest = match.groups()
        rest = rest.partition("'")[0].rstrip()
        try:
            name = self.named(self.PARSER.place(target))
        except Unknown:
            self.forgets_named(target)
            return True

        def new() -> float:
            passed = PASSED.fullmatch(rest)
            if word == "getarg":
                return self.argument(int(passed.group(1)) if passed else 0)
            return self.number(re.sub(r"^EXPRESS\b", "", rest))

        try:
            self.keep(name, CALCULATED[word](lambda: self.known(name), new))
        except Unknown as unknown:
            self.forgets(name, Reason(unknown))
        return True

    def argument(self, n: int) -> float:
        if not 1 <= n <= len(self.arguments):
            raise Unknown("programs.inform.no_argument", "the call of the job does not give it")
        return super().argument(n)

    def arguments_of(self, text: str) -> list[float | Reason]:
        """What a CALL passes."""
        return [self.passed(constant or variable) for constant, variable in ARGUMENT.findall(text)]
