"""Numbers and names in the text of robot programs."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import ArrayLike

from ...base.kinds import Floats

MM_DIGITS = 6
DEGREE_DIGITS = 7
UNIT_DIGITS = 9  # of quaternions, metres and radians
SPEED_DIGITS = 6  # of mm/s
ROUNDS = 20  # until rounded quaternions stay; a few do
FLAWS = re.compile(r"[^\x20-\x7e]")


def printable(text: object) -> str:
    """ASCII in one line."""
    return FLAWS.sub("?", " ".join(str(text).split()))[:200]


def identifier(name: str, most: int) -> str:
    """A name as the controllers take them: letters, digits and _, a letter first."""
    name = re.sub(r"\W+", "_", name, flags=re.ASCII)[:most]
    return name if re.match(r"[A-Za-z]", name) else f"p_{name}"[:most]


def rounded(values: ArrayLike, digits: int) -> Floats:
    """Rounded, without negative zeros."""
    return np.round(np.asarray(values, dtype=float), digits) + 0.0


def rounded_quaternions(quaternions: Floats) -> Floats:
    """(n, 4) rounded so that, read and set to length 1, they round to the same digits again."""
    found = rounded(quaternions, UNIT_DIGITS)
    for _ in range(ROUNDS):
        again = rounded(found / np.linalg.norm(found, axis=1)[:, None], UNIT_DIGITS)
        if np.array_equal(again, found):
            break
        found = again
    return found
