"""The cells of a CSV."""

import re
import warnings

import numpy as np

FORMULA = ("=", "+", "-", "@", "\t", "\r")  # as spreadsheets take them


def cell(text):
    """A name as a cell: not one that a spreadsheet would compute, such as a link. Numbers are written without
    this."""
    return "'" + text if text.startswith(FORMULA) else text


def comment_cells(text):
    """Likewise a comment, which has cells of its own wherever it has a separator."""
    return re.sub(r"[,;\t](?=\s*[\"']?[=+@-])", " ", text)


def numbers(file):
    """(n, columns) of the rows that are left in an open CSV of numbers. Raises ValueError."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that there are none is no news
        return np.loadtxt(file, delimiter=",", ndmin=2)
