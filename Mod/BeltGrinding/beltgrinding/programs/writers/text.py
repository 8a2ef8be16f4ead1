"""Numbers and names in the text of robot programs."""

import re

import numpy as np

MM_DIGITS = 6
DEGREE_DIGITS = 7
UNIT_DIGITS = 9  # of quaternions, metres and radians
SPEED_DIGITS = 6  # of mm/s
FLAWS = re.compile(r"[^\x20-\x7e]")


def printable(text):
    """ASCII in one line."""
    return FLAWS.sub("?", " ".join(str(text).split()))[:200]


def identifier(name, most):
    """A name as the controllers take them: letters, digits and _, a letter first."""
    name = re.sub(r"\W+", "_", name, flags=re.ASCII)[:most]
    return name if re.match(r"[A-Za-z]", name) else f"p_{name}"[:most]


def rounded(values, digits):
    """Rounded, without negative zeros."""
    return np.round(values, digits) + 0.0
