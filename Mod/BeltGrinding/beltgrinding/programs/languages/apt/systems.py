"""The coordinate systems of an APT file: CSYS, MSYS, ORIGIN and what else shifts coordinates."""

from __future__ import annotations

import contextlib

import numpy as np

from ...program import Unknown
from ..tool_axis import unit
from .feeds import Feeds

IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)  # rows of CSYS
SQUARE = 1e-3  # cosine between the axes of a coordinate system
MAX_WORDS = 200  # characters of a base's


class Systems(Feeds):
    """The base that motions are in."""

    def __init__(self, language: str, name: str, units: str | None) -> None:
        super().__init__(language, name, units)
        self.axis: tuple[float, ...] | None = (0.0, 0.0, 1.0)
        self.system = ""  # what the base is made of
        self.shifts: dict[str, str] = {}
        self.of_world = False  # whatever CSYS says

    def coordinates_of(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """TRNTYP/WORLD (CAMWorks): coordinates and axes are those of the part; a CSYS behind it says only how the
        part is clamped, and its z is the tool's axis until a GOTO names another."""
        self.of_world = values[:1] == ["WORLD"] or values[:1] == ["world"]

    def shift(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """ORIGIN, TRANS, TRACUT, ...: coordinates after it are others, which the post-processor knows."""
        off = not values or values[0].upper() in ("OFF", "NOMORE")
        with contextlib.suppress(Unknown):
            off = off or word in ("ORIGIN", "TRANS") and not any(self.numbers(values, 3))
            if word == "CSYS":
                numbers = self.numbers(values, 12)
                off = off or tuple(numbers) == IDENTITY or self.of_world
                if self.of_world:
                    self.axis = unit(numbers[2::4])
        self.shifts.pop(word, None)
        if not off:
            self.shifts[word] = rest
        self.set_base()

    def set_base(self) -> None:
        """The base in words: the coordinate system, and what shifts it."""
        words = [f"MSYS {self.system}"] if self.system else []
        words += [f"{word} {rest}" for word, rest in self.shifts.items()]
        self.base = " ".join(words)[:MAX_WORDS]

    def machine_system(self, line: int, word: str, rest: str, values: list[str]) -> None:
        """MSYS/x,y,z,i,j,k,i,j,k: origin, x and y of the coordinates to come in those of the part (NX)."""
        self.system = rest
        self.set_base()
        if self.shifts or not (self.scale or self.given):
            return
        try:
            numbers = self.numbers(values, 9)
            x, y = (unit(numbers[at : at + 3]) for at in (3, 6))
            if x is None or y is None or abs(sum(a * b for a, b in zip(x, y))) > SQUARE:
                return
            frame = np.eye(4)
            frame[:3, 0], frame[:3, 1], frame[:3, 2] = x, y, np.cross(x, y)
            frame[:3, 3] = self.point(numbers[:3])
        except Unknown:
            return  # of this base nothing is known
        self.program.base_frames[self.base] = frame
