"""The cells of a CSV."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

FORMULA = ("=", "+", "-", "@", "\t", "\r")  # as spreadsheets take them


def cell(text: str) -> str:
    """A name as a cell: not one that a spreadsheet would compute, such as a link. Numbers are written without
    this."""
    return "'" + text if text.startswith(FORMULA) else text


def comment_cells(text: str) -> str:
    """Likewise a comment, which has cells of its own wherever it has a separator."""
    return re.sub(r"[,;\t](?=\s*[\"']?[=+@-])", " ", text)


def numbers(file: Path | str | TextIO) -> NDArray[np.float64]:
    """(n, columns) of the rows that are left in an open CSV of numbers. Raises ValueError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that there are none is no news
        return np.loadtxt(file, delimiter=",", ndmin=2)
