"""The position registers PR[n] of a Fanuc TP program, element by element, as far as it sets them."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable
from typing import Any

from ...program import Reason, Unknown
from ..taught_program import Taught
from .registers import INDEX, Registers

SETS = re.compile(rf"PR\s*{INDEX}\s*=\s*(.*)$")
WHOLE = re.compile(rf"\s*([-+]?)\s*(PR|P)\s*{INDEX}")
OTHER_GROUP = re.compile(r"\s*GP(\d+)\s*:")
PARTS = re.compile(r"((?:[^,\[]|\[[^\]]*\])*)(,?)(.*)$", re.DOTALL)
ELEMENTS = 6  # X, Y, Z, W, P, R
ANY = -1  # a register of which the number is not known


class PositionRegisters(Registers, Taught):
    """Values of position registers; what the program does not set is asked for."""

    where: Callable[[], Any]
    taught: Callable[[int], list[float]]

    def begin_registers(self) -> None:
        # of PR[n]: X, Y, Z, W, P, R each a number, a Reason, or None: not set here
        self.elements: dict[int, list[Any]] = {}
        # lines that set PR[n] to what is not known, by n; ANY: one of them
        self.set_here: dict[int, int] = {}

    def position_register(self, n: int) -> list[float]:
        """X, Y, Z, W, P, R of PR[n]. Raises Unknown."""
        found = self.elements.get(n, [None] * ELEMENTS)
        if None in found:
            found = [
                mine if mine is not None else own for mine, own in zip(found, self.of_person(n))
            ]
        for element in found:
            if isinstance(element, Reason):
                raise Unknown(element)
        return list(found)

    def of_person(self, n: int) -> list[float]:
        """The elements of PR[n] as a person gives them. Raises Unknown."""
        if n in self.set_here or ANY in self.set_here:
            raise Unknown(
                "programs.fanuc.register_set",
                "PR[{n}] is set by the program, in line {line}, which is not followed",
                n=n,
                line=self.set_here.get(n, self.set_here.get(ANY)),
            )
        reason = Reason(
            "programs.fanuc.position_register",
            "PR[{index}] is a position register of the controller",
            index=n,
        ).wanting(f"PR[{n}]", "frame")
        six = self.from_person(f"PR[{n}]", reason)
        if not isinstance(six, tuple):
            raise Unknown(reason)
        x, y, z, a, b, c = six
        return [x, y, z, c, b, a]

    def element(self, n: int, k: int) -> float:
        """The number in PR[n,k]. Raises Unknown."""
        if not 1 <= k <= ELEMENTS:
            raise Unknown("programs.fanuc.no_index", "[{text}] is no number", text=k)
        found = self.elements.get(n, [None] * ELEMENTS)[k - 1]
        if isinstance(found, Reason):
            raise Unknown(found)
        return float(self.of_person(n)[k - 1] if found is None else found)

    def place_of(self, text: str) -> tuple[int, int | None]:
        """(n, index of the element or None) of what stands in PR[...]. Raises Unknown."""
        text = OTHER_GROUP.sub("", text)
        match = PARTS.match(text)
        first, comma, second = match.groups() if match else ("", "", "")
        n = self.index(first)
        if not comma:
            return n, None
        k = self.index(second)
        if not 1 <= k <= ELEMENTS:
            raise Unknown("programs.fanuc.no_index", "[{text}] is no number", text=text)
        return n, k - 1

    def sets_position(self, line: int, text: str) -> None:
        """Follows PR[n]=... and PR[n,i]=...; what is not known afterwards says so where it is used."""
        match = SETS.match(text)
        group = OTHER_GROUP.match(match.group(1)) if match else None
        if group and group.group(1) != "1":
            return
        try:
            n, k = self.place_of(match.group(1) if match else "")
        except Unknown:
            self.lose_positions(line, text)
            return
        assert match is not None  # else its place is none
        self.changes += 1
        try:
            if k is None:
                self.elements[n] = self.sum_of(match.group(2))
                self.set_here.pop(n, None)
            else:
                value = self.number(match.group(2))
                self.elements.setdefault(n, [None] * ELEMENTS)
                self.elements[n] = [value if i == k else v for i, v in enumerate(self.elements[n])]
        except Unknown as unknown:
            if k is None or n not in self.elements:
                self.elements.pop(n, None)
                self.set_here[n] = line
            else:
                why = Reason(unknown)
                self.elements[n] = [why if i == k else v for i, v in enumerate(self.elements[n])]

    def sum_of(self, text: str) -> list[float]:
        """The elements of LPOS, or of P[n] and PR[n] with + and - between them. Raises Unknown."""
        text = text.strip()
        if text == "LPOS":
            return list(self.where())
        total, at = None, 0
        while at < len(text.rstrip()):
            match = WHOLE.match(text, at)
            if not match or (total is None) != (not match.group(1)):
                raise Unknown(
                    "programs.fanuc.not_known_before",
                    "'{text}' is not known before it runs",
                    text=text[:40],
                )
            sign, kind, index = match.groups()
            n = self.index(index)
            other = self.position_register(n) if kind == "PR" else self.taught(n)
            sense = -1.0 if sign == "-" else 1.0
            total = [a + sense * b for a, b in zip(total or [0.0] * ELEMENTS, other)]
            at = match.end()
        if total is None:
            raise Unknown("programs.it_is_not_understood", "it is not understood")
        return total

    def lose_positions(self, line: int, text: str) -> None:
        """A statement may set the position registers that it names as set, whichever they are."""
        self.changes += 1
        for found in re.findall(rf"\bPR\s*{INDEX}\s*=", text) or [""]:
            try:
                n = self.place_of(found)[0]
            except Unknown:
                n = ANY
                self.elements.clear()
            self.elements.pop(n, None)
            self.set_here[n] = line

    def lose_all_positions(self, line: int) -> None:
        """Another program may have set all that this one has set."""
        self.changes += 1
        self.set_here.update(dict.fromkeys(self.elements, line))
        self.elements.clear()

    def state(self) -> Hashable:
        """All that decides how the program goes on, as far as registers do."""
        places = frozenset((n, *map(str, found)) for n, found in self.elements.items())
        return self.numbers(), places
