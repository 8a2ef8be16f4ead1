"""The numeric registers R[n] and the arguments AR[n] of a Fanuc TP program, as far as the program itself sets them."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from ...program import Reason, Unknown
from .. import taught_numbers
from ..core.expression import Call, Constant, Place, number

INDEX = r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]"
COMMENT = re.compile(r"(?<=[\d\]])\s*:[^\[\]]*(?=\])")  # of R[5:speed], PR[5,2:dy]
GROUP = re.compile(r"\bGP1\s*:")
BEHIND = re.compile(r":[^\[\]]*$")  # the comment of an index


def plain(text: str) -> str:
    """An expression without the comments in its brackets."""
    return COMMENT.sub("", GROUP.sub("", text)) if ":" in text else text


class Parser(taught_numbers.Parser):
    TOKEN = re.compile(
        r"\s*(?:(?P<number>\d+(?:\.\d*)?|\.\d+)|(?P<name>\$?[A-Za-z_][\w$.]*)"
        r"|(?P<op><>|<=|>=|[-+*/()\[\]=<>,!:]))",
        re.ASCII,
    )

    @classmethod
    def scanned(cls, text: str) -> Any:
        return super().scanned(plain(text))


class Registers(taught_numbers.Numbers):
    """Values of registers; what the program does not set raises Unknown. ``element(n, k)``: that of PR[n,k]."""

    PARSER = Parser
    element: Callable[[int, int], float]

    def index(self, text: str) -> int:
        """The number in P[3], P[3:name], P[R[2]]. Raises Unknown."""
        expression = self.expression(BEHIND.sub("", text))
        if not isinstance(expression, (Constant, Place)):
            raise Unknown("programs.fanuc.no_index", "[{text}] is no number", text=text)
        return self.whole(expression(self), text)

    @staticmethod
    def whole(value: Any, text: str) -> int:
        value = number(value)
        if not 0 <= value < 1e6:
            raise Unknown("programs.fanuc.no_index", "[{text}] is no number", text=text)
        return int(value)

    def named(self, place: Place) -> str:
        """R[5] of R[5], R[5:name] and R[R[2]]. Raises Unknown."""
        one = place.steps[0] if len(place.steps) == 1 else ()
        if place.name != "R" or len(one) != 1 or not isinstance(one[0], (Constant, Place)):
            raise self.at_run_time(place)
        return f"R[{self.whole(one[0](self), place.name)}]"

    def read(self, place: Place) -> Any:
        if place.name in ("PR", "AR") and len(place.steps) == 1:
            index = [self.whole(one(self), place.name) for one in place.steps[0]]
            if place.name == "PR" and len(index) == 2:
                return self.element(*index)
            if place.name == "AR" and len(index) == 1:
                return self.argument(index[0])
        return super().read(place)

    @staticmethod
    def at_run_time(place: Place) -> Unknown:
        index = "[..]" if place.steps else ""
        return Unknown(
            "programs.fanuc.not_known_before",
            "'{text}' is not known before it runs",
            text=f"{place.name}{index}"[:40],
        )

    def function(self, call: Call) -> None:
        raise self.at_run_time(Place(call.name))

    def absent(self, name: str) -> Reason:
        return Reason(
            "programs.fanuc.no_register_value",
            "R[{text}] has no value that this file gives",
            text=name[2:-1],
        )

    def forgets_register(self, text: str, reason: Reason | None = None) -> None:
        """The register R[``text``] is not known from here on; any, where which one it is is not known."""
        try:
            name = f"R[{self.index(text)}]"
        except Unknown:
            self.forgets_all()
            self.spent.update(one for one in self.used if one.startswith("R"))
            return
        self.forgets(name, reason)
