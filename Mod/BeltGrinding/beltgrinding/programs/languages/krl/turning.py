"""How KRL turns the tool on the way: $ORI_TYPE and $CIRC_TYPE."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .values import Lost, Members, Values

KINDS = {
    "ori": {"var": "", "variable": "", "constant": "hold", "const": "hold"},
    "circ": {"base": "", "path": "path"},
}
NAMES = tuple(f"${kind}_type" for kind in KINDS)


class Turning:
    """What holds where the program stands: assigned, by an inline form's LDAT, or behind WITH."""

    def __init__(self, values: Values) -> None:
        self.values = values
        self.said: set[tuple[str, str]] = set()

    def take(self, ldat: Any) -> None:
        """As BAS(#CP_PARAMS) does; ``ldat``: LDAT_ACT, or Lost."""
        for kind in KINDS:
            word = ldat.get(f"{kind}_typ", ldat.rest) if isinstance(ldat, Members) else ldat
            if isinstance(word, (str, Lost)):
                self.values.assign(f"${kind}_type", (), word)

    def reset(self) -> None:
        """As BAS(#INITMOV) does."""
        for name in NAMES:
            self.values.drop(name)

    def of(self, line: int, problem: Callable[..., None]) -> str:
        """The ``turn`` of a Motion; what is not followed is a problem, once."""
        found = []
        for kind, known in KINDS.items():
            value = self.values.peek(f"${kind}_type")
            word = "?" if isinstance(value, Lost) else str(value or "").lower().lstrip("#")
            if word and word not in known and (kind, word) not in self.said:
                self.said.add((kind, word))
                if isinstance(value, Lost):
                    problem(
                        line,
                        "programs.krl.turning_unknown",
                        "{name} is not known; here the tool turns evenly from the start's orientation to "
                        "the target's, from this line on",
                        name=f"${kind.upper()}_TYPE",
                    )
                else:
                    problem(
                        line,
                        "programs.krl.turning",
                        "{name} is {word}, which depends on the robot's joints; here the tool turns "
                        "evenly from the start's orientation to the target's, from this line on",
                        name=f"${kind.upper()}_TYPE",
                        word=f"#{word.upper()}"[:20],
                    )
            found.append(known.get(word, ""))
        return " ".join(filter(None, found))
