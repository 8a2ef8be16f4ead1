"""Numbers and names in the text of robot programs."""

from __future__ import annotations

import re
import textwrap
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...base.kinds import Floats


@dataclass(frozen=True)
class Digits:
    """Decimals of mm, degrees, of quaternions, metres and radians, and of mm/s."""

    mm: int
    degree: int
    unit: int
    speed: int


# fine: poses read back within 1e-6 mm and 1e-6 degrees; robot: what a controller makes use of, 0.001 mm, 0.001
# degrees and 0.1 mm/s.
DIGITS = {"fine": Digits(6, 7, 9, 6), "robot": Digits(3, 3, 6, 1)}
ZONE_DIGITS = 3  # of mm
ROUNDS = 20  # until rounded quaternions stay; a few do
FLAWS = re.compile(r"[^\x20-\x7e]")


def printable(text: object) -> str:
    """ASCII in one line."""
    return FLAWS.sub("?", " ".join(str(text).split()))[:200]


def remarks(text: str, most: int) -> list[str]:
    """A comment in lines of at most ``most`` characters."""
    return textwrap.wrap(text, most)


def identifier(name: str, most: int) -> str:
    """A name as the controllers take them: letters, digits and _, a letter first."""
    name = re.sub(r"\W+", "_", name, flags=re.ASCII)[:most]
    return name if re.match(r"[A-Za-z]", name) else f"p_{name}"[:most]


def rounded(values: ArrayLike, digits: int) -> Floats:
    """Rounded, without negative zeros."""
    return np.round(np.asarray(values, dtype=float), digits) + 0.0


def rounded_quaternions(quaternions: Floats, digits: int) -> Floats:
    """(n, 4) rounded so that, read and set to length 1, they round to the same digits again."""
    found = rounded(quaternions, digits)
    for _ in range(ROUNDS):
        again = rounded(found / np.linalg.norm(found, axis=1)[:, None], digits)
        if np.array_equal(again, found):
            break
        found = again
    return found
