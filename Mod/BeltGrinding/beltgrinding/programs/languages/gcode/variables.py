"""The variables of a G-code program: what it assigns itself is known, all else is the control's."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from ...program import Unknown
from ..core.expression import NOT_COMPUTABLE, Call, Place, number

LOCAL = 33  # Fanuc's #1 to #33 and LinuxCNC's #1 to #30 are those of a subprogram
LAST = 999  # beyond, numbers are the control's own; 5000 in LinuxCNC
NOT_KNOWN = ("programs.gcode.macro", "variables and macros are known to the control only")
# Fanuc's G65 by letters.
LETTERS = dict(zip("ABCDEFHIJKMQRSTUVWXYZ", (1, 2, 3, 7, 8, 9, 11, 4, 5, 6, 13, *range(17, 27))))


class Variables:
    """Values by name as "R1", "#101", "#<name>", "NAME" or "NAME[2]", those of a subprogram for itself."""

    def __init__(
        self, functions: Mapping[str, Callable[..., Any]], last: int = LAST, local: int = LOCAL
    ) -> None:
        self.functions, self.last, self.local = functions, last, local
        self.all: dict[str, Any] = {}
        # ({name: value}, {name declared: its type}) of each subprogram
        self.own: list[tuple[dict[str, Any], dict[str, str | None]]] = [({}, {})]

    def enter(self, values: dict[str, Any]) -> None:
        """Begins a subprogram with values of its own, by name."""
        self.own.append((dict(values), dict.fromkeys(values)))

    def leave(self) -> dict[str, Any]:
        """Ends it; its own values."""
        return self.own.pop()[0]

    def declare(self, name: str, kind: str) -> None:
        self.own[-1][1][name] = kind
        self.own[-1][0].pop(name, None)

    def forget(self) -> None:
        """Nothing that was assigned is known."""
        self.all.clear()
        for values, _ in self.own:
            values.clear()

    def drop(self, name: str) -> None:
        """What is assigned to ``name`` is not known; of a field none of its elements."""
        for values in (self.all, self.own[-1][0]):
            if name in ("R", "#"):
                values.clear()
                return
            for one in [one for one in values if one == name or one.startswith(name + "[")]:
                del values[one]

    def key(self, place: Place) -> str:
        """The name that a Place has at this moment. Raises Unknown."""
        if not place.steps:
            return place.name
        values = []
        for step in place.steps:
            if isinstance(step, str):
                raise Unknown(*NOT_KNOWN)
            for one in step:
                value = number(one(self))
                if value != int(value) or value < 0:
                    raise Unknown("programs.gcode.whole", "a whole number expected")
                values.append(str(int(value)))
        if place.name in ("R", "#") and len(values) == 1:
            return place.name + values[0]
        return f"{place.name}[{','.join(values)}]"

    def scope(self, key: str) -> dict[str, Any]:
        """The dict that a name's value is in."""
        if key.startswith("#<"):
            return self.all if key.startswith("#<_") else self.own[-1][0]
        if key[0] == "#":
            return self.own[-1][0] if int(key[1:]) <= self.local else self.all
        if key.split("[")[0] in self.own[-1][1]:
            return self.own[-1][0]
        return self.all

    def read(self, place: Place) -> Any:
        key = self.key(place)
        if key not in self.scope(key):
            raise Unknown(*NOT_KNOWN)
        return self.scope(key)[key]

    def ours(self, key: str) -> bool:
        """Whether assigning to a name changes nothing but its value."""
        if key.startswith("#<"):
            return not key.startswith("#<_HAL") and not key.startswith("#<_INI")
        if key[0] == "#":
            return 0 < int(key[1:]) <= self.last
        return key[0] != "$"

    def assign(self, key: str, value: Any) -> None:
        kind = self.own[-1][1].get(key.split("[")[0])
        if (
            kind == "BOOL"
            and not isinstance(value, bool)
            or kind in ("REAL", "INT")
            and (isinstance(value, bool) or kind == "INT" and value != int(value))
        ):
            self.drop(key)
            raise Unknown("programs.gcode.kind", "{name} is {kind}", name=key, kind=kind)
        self.scope(key)[key] = value

    def function(self, call: Call) -> Any:
        values, _ = call.values(self)
        if call.name == "ATAN" and len(values) == 2:
            y, x = map(number, values)
            if y < 0.0:  # LinuxCNC: -180 to 0, Fanuc: as a parameter says
                raise Unknown("programs.gcode.negative", "controls differ in what they make of it")
            return math.degrees(math.atan2(y, x))
        if call.name not in self.functions:
            raise Unknown(*NOT_KNOWN)
        try:
            return number(self.functions[call.name](*values))
        except NOT_COMPUTABLE:
            raise Unknown(
                "programs.not_computable",
                "{text} cannot be evaluated for these arguments",
                text=call.name,
            ) from None

    def value(self, one: Any) -> float:
        """The number that a word has: itself, or that of an expression."""
        if type(one) is float:
            return one
        found = one(self) if callable(one) else one
        return number(found)


def place_of(parser_class: Any, text: str) -> Place:
    """The Place that a text is. Raises Unknown."""
    parser = parser_class(text)
    found = parser.operand(*parser.next())
    parser.end()
    if not isinstance(found, Place):
        raise Unknown("programs.not_assignable", "'{text}' cannot be assigned to", text=text[:30])
    return found
