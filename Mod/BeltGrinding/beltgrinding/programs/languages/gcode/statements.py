"""What statements of G-code set: variables, and SINUMERIK's frames."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from ....base.kinds import known
from ...program import Unknown
from ..core.expression import Place, number
from ..set_frames import Frame, about
from .expression import BRACKETS, SIEMENS, Assigned, Brackets, Siemens, siemens_words
from .moves import Moves
from .units import Unit
from .variables import LAST, LOCAL, NOT_KNOWN, Variables

NONE = object()  # a block that is no statement
FRAME = re.compile(r"(A?)(TRANS|ROT)\b(?!\s*=)(.*)")
FOLLOWED_FRAMES = ("TRANS", "ATRANS", "ROT", "AROT")
LOST_FRAMES = ("SCALE", "ASCALE", "MIRROR", "AMIRROR", "ROTS", "AROTS", "CYCLE800")
OTHER_FRAME = re.compile(rf"(?:{'|'.join((*FOLLOWED_FRAMES, *LOST_FRAMES))})\b")


class Statements(Moves):
    """Follows blocks that set something."""

    def __init__(self, path: Path | str, main: Unit, by_m6: bool, given_units: str | None) -> None:
        super().__init__(path, by_m6, given_units)
        self.dialect = main.dialect
        siemens, linuxcnc = self.dialect == "siemens", self.dialect == "linuxcnc"
        self.parser: Any = Siemens if siemens else Brackets
        self.variables = Variables(
            SIEMENS if siemens else BRACKETS, 5000 if linuxcnc else LAST, 30 if linuxcnc else LOCAL
        )

    def frames(self, line: int, body: str) -> None:
        """TRANS and ROT, absolute or (with A) within the frame that is set; others are the control's."""
        found = FRAME.fullmatch(body)
        words = None
        try:
            if found and self.dialect == "siemens" and not (found[1] and self.shifted):
                words = self.frame_words(found[2], found[3])
        except Unknown:
            words = None
        if words is None:
            if body in ("SCALE", "MIRROR"):
                self.shift(None)
                return
            plain = re.fullmatch(r"A?TRANS\b(.*)", body)  # each axis for itself
            axes = set(plain[1] if plain else "XYZ") & set("XYZ")
            self.frame_lost(line, known(OTHER_FRAME.match(body))[0], axes)
            return
        within = known(found)[1]
        if not within and self.shifted:
            self.shift(None)
        self.set_frame(self.frame @ words if within else words)

    def frame_words(self, kind: str, text: str) -> Frame | None:
        """The Frame that TRANS or ROT writes; None where it is not known."""
        values = {}
        for address, by, value in siemens_words(text.strip()):
            if value is None or address in values or not isinstance(address, str):
                return None
            values[address] = number(self.variables.value(value))
        if kind == "TRANS":
            if not set(values) <= set("XYZ") or values and self.scale is None:
                return None
            scale = self.scale or 1.0
            return Frame(origin=[scale * values.get(letter, 0.0) for letter in "XYZ"])
        turned = [(letter, value) for letter, value in values.items() if value]
        if not turned:
            return Frame() if set(values) <= {*"XYZ", "RPL"} else None
        if len(turned) > 1:  # in which order, a parameter says
            return None
        letter, angle = turned[0]
        if letter == "RPL":
            plane = {17: 2, 18: 1, 19: 0}.get(self.plane or 0)
            return None if plane is None else Frame(about(plane, angle))
        return Frame(about("XYZ".index(letter), angle)) if letter in "XYZ" else None

    def ours(self, address: Any) -> bool:
        """Whether assigning to an address of SINUMERIK is one to a variable."""
        if isinstance(address, Place):
            return address.name == "R" or self.declared(address.name)
        return bool(re.fullmatch(r"R\d+", address)) or self.declared(address)

    def declared(self, name: str) -> bool:
        return name in self.variables.own[-1][1] or name in self.variables.own[0][1]

    def declare(self, kind: str, text: str) -> None:
        if kind not in ("REAL", "INT", "BOOL"):
            return
        parser = Siemens(text)
        while parser.at < len(parser.tokens):
            _, name = parser.next()
            steps = parser.steps()
            self.variables.declare(name, kind)
            if parser.accept("="):
                value = parser.infix()
                try:
                    value = value(self.variables)
                    if not steps:
                        self.variables.assign(name, self.typed(kind, value))
                except Unknown:  # whoever uses it reports it
                    self.variables.drop(name)
            if parser.at < len(parser.tokens):
                parser.expect(",")

    @staticmethod
    def typed(kind: str, value: Any) -> Any:
        return value if isinstance(value, bool) else float(number(value))

    def assign(self, words: Iterable[Assigned], ours: Callable[[Any], bool]) -> Any:
        """A block of assignments; NONE where it is one of words."""
        own = [by and ours(address) for address, by, _ in words]
        if not any(own):
            return NONE
        if not all(own):  # which comes first?
            raise Unknown(*NOT_KNOWN)
        found = []
        for address, _, value in words:
            name = address.name if isinstance(address, Place) else address
            try:
                name = self.variables.key(address) if isinstance(address, Place) else name
                value = value(self.variables) if callable(value) else value
                found.append((name, value if isinstance(value, bool) else float(number(value))))
            except Unknown:  # whoever uses it reports it
                self.variables.drop(name)
        if len(found) > 1:  # of several, whether one sees another depends on the control
            if any(callable(value) for _, _, value in words):
                raise Unknown(*NOT_KNOWN)
        for key, value in found:
            self.variables.assign(key, value)
        return None

    def assign_numbered(self, body: str) -> Any:
        """#1=2 #3=#4+1, whatever stands in brackets."""
        parser, words = Brackets(body), []
        while parser.at < len(parser.tokens):
            place = parser.operand(*parser.next())
            if not isinstance(place, Place):
                raise Unknown(*NOT_KNOWN)
            parser.expect("=")
            words.append((place, True, parser.infix()))
        for place, _, _ in words:
            if not self.variables.ours(self.variables.key(place)):
                raise Unknown(*NOT_KNOWN)
        return self.assign(words, lambda address: True)
