"""The tools and bases that a new program's poses are in, and what the program sets of them: nothing
that nobody has asked for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Optional, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ...base.frames import from_abc, from_quaternions, in_words, to_quaternions
from ...base.kinds import Floats
from ..program import Fact, ProgramError
from .text import printable

AS_KNOWN = "as-known"  # in place of a frame: its numbers, as the source of the poses tells them
RIGID = 1e-6  # how far a pose's matrix may be off a rotation
NUMBER = r"\s*([-+]?[\d.]+(?:e[-+]?\d+)?)"
WORDS = re.compile(r"\bX" + NUMBER + "".join(rf"\s+{k}{NUMBER}" for k in "YZABC"))
METRES = re.compile(r"p\[" + ",".join([NUMBER] * 6) + r"\]")
WHAT = {
    "tool": Fact("programs.writers.tool", "tool"),
    "base": Fact("programs.writers.base", "base"),
}
NOT_TOLD = {
    "tool": Fact("programs.writers.tool_not_told", "an unknown tool"),
    "base": Fact("programs.writers.base_not_told", "an unknown base"),
}

# A frame for all, or by its words: its name, its number, its 4 x 4 in mm, ``AS_KNOWN``, None.
One: TypeAlias = "str | int | ArrayLike | None"
Given: TypeAlias = "One | Mapping[str, One]"


@dataclass
class Frame:
    """A tool or a base. With neither ``name`` nor ``given``, the program leaves it to the controller."""

    what: str  # tool, base
    words: str  # what the source of the poses calls it; may be empty
    pose: Optional[Floats]  # 4 x 4 in mm, None: not known
    name: Optional[str] = None  # of the controller's own frame that is to be set
    given: bool = False  # the numbers of ``pose`` are to be set

    @property
    def left_out(self) -> bool:
        return self.name is None and not self.given

    @property
    def told(self) -> str:
        """What a comment says of it: ASCII in one line."""
        numbers = "" if self.pose is None else in_words(self.pose)
        return printable(self.words) or numbers or str(NOT_TOLD[self.what])


class Frames:
    """Tools or bases by their words. ``given``: as ``write_program`` takes them; ``told``: {words: 4 x 4 in mm}
    of those that the program tells."""

    def __init__(self, given: Given, what: str, told: Mapping[str, Floats]) -> None:
        self.given, self.what, self.told = given, what, told
        self.rows: list[Frame] = []
        self.numbers: dict[str, int] = {}

    def row(self, words: str) -> int:
        if words not in self.numbers:
            self.numbers[words] = len(self.rows)
            self.rows.append(self.frame(words))
        return self.numbers[words]

    def frame(self, words: str) -> Frame:
        given = self.given.get(words) if isinstance(self.given, dict) else self.given
        known = self.told.get(words)
        if known is None:
            known = frame_in_words(words)
        if given is None:
            return Frame(self.what, words, known)
        if isinstance(given, (str, int)) and given != AS_KNOWN:
            return Frame(self.what, words, known, name=str(given).strip())
        if isinstance(given, str):
            if known is None:
                raise ProgramError(
                    "programs.writers.not_known",
                    "the numbers of the {what} are not known ('{words}'); give them, or the name "
                    "or number that it has on the controller",
                    what=WHAT[self.what],
                    words=words,
                )
            return Frame(self.what, words, known, given=True)
        pose = np.asarray(given, dtype=float)
        if pose.shape != (4, 4):
            raise ProgramError(
                "programs.writers.no_matrix",
                "the {what} {words} is no 4 x 4",
                what=WHAT[self.what],
                words=words,
            )
        checked(pose[None])
        return Frame(self.what, words, pose, given=True)


def checked(frames: Floats) -> Floats:
    """Quaternions of the poses. Raises ProgramError for what is no rigid pose."""
    if not np.isfinite(frames).all():
        raise ProgramError("programs.writers.not_finite", "a pose is not finite")
    quaternions = to_quaternions(frames[:, :3, :3])
    again = from_quaternions(frames[:, :3, 3], quaternions)
    wrong = np.flatnonzero(np.abs(again - frames).max(axis=(1, 2)) > RIGID)
    if len(wrong):
        raise ProgramError(
            "programs.writers.no_rotation",
            "pose {number}: its matrix is no rotation with a position",
            number=int(wrong[0]),
        )
    return quaternions


def frame_in_words(words: str) -> Floats | None:
    """4 x 4 in mm that the words of a Motion's tool or base tell, to their digits, or None."""
    found = WORDS.search(words)
    if found:
        values = [float(v) for v in found.groups()]
        return from_abc(values[:3], values[3:])
    found = METRES.search(words)
    if found:
        from ..languages.urscript.pose import pose_of

        frame = pose_of([float(v) for v in found.groups()]).frame.copy()
        frame[:3, 3] *= 1000.0
        return frame
    return None


def words_of_cell(base_from_robot: Floats, flange_from_tcp: Floats) -> dict[str, str]:
    """dict of a ``Motion``'s tool and base: the frames of the programs in a cell (4 x 4, mm), in words."""
    base = in_words(np.linalg.inv(base_from_robot))
    return {
        "tool": f"tool in the robot's flange: {in_words(flange_from_tcp)}",
        "base": f"base in the robot's own base: {base}",
    }


def check_all_set(frames: Sequence[Frame], language: str) -> None:
    """Raises ProgramError where a program that changes between frames would leave one to the controller,
    which has one in force: the poses in the others would be ground in it.
    """
    if len(frames) > 1 and any(frame.left_out for frame in frames):
        raise ProgramError(
            "programs.writers.several_left_out",
            "the program changes between frames ({names}), which {language} cannot leave to the "
            "controller; say by name, number or numbers what each {what} is, or write one program each",
            names=", ".join(f"'{frame.told}'" for frame in frames[:5]),
            language=language,
            what=WHAT[frames[0].what],
        )


def taken_for_granted(frames: Iterable[Frame]) -> list[Fact]:
    """Facts that tell which frames the program leaves to the controller; frames: of which it sets none."""
    facts = []
    for frame in frames:
        told = frame.words or NOT_TOLD[frame.what]
        if frame.what == "tool":
            fact = Fact(
                "programs.writers.tool_left_out",
                "the program sets no tool: the controller must have the one in force that the poses "
                "mean ({tool})",
                tool=told,
            )
        else:
            fact = Fact(
                "programs.writers.base_left_out",
                "the program sets no base: the controller must have the one in force that the poses "
                "are in ({base})",
                base=told,
            )
        facts.append(fact)
    return facts


def frame_number(frame: Frame, language: str) -> int:
    """The number of a frame on controllers that know them by number alone. Raises ProgramError."""
    name = frame.name or ""
    if not re.fullmatch(r"\d{1,2}", name, re.ASCII):
        raise ProgramError(
            "programs.writers.frame_number",
            "'{name}': {language} knows its {what} by number; give the number, and set the frame on the controller",
            name=name or frame.told,
            language=language,
            what=WHAT[frame.what],
        )
    return int(name)


def undeclared(frame: Frame, name: str) -> Fact:
    """The Fact that a program uses a name which must exist on the controller."""
    return Fact(
        "programs.writers.undeclared",
        "the program uses {name}, which it does not declare: the controller must have it, as the "
        "{what} of the poses ({told})",
        name=name,
        what=WHAT[frame.what],
        told=frame.words or NOT_TOLD[frame.what],
    )
