"""The motions of a job's programs, numbered from 0 through all programs as the removal trace of a
height field counts them: motion m leads to pose ``pose[m]`` of program ``program[m]``.

Arrays of m values: ``program``, ``pose`` (both from 0), ``line`` (of the source file, 0: unknown) and
``point`` (m, 3), the contact point in the work frame at its end, mm.
"""

import csv
import io

import numpy as np

from ..base import cells
from ..base.files import cannot_be_read
from ..engine import InputError

FILE = "motions.csv"
COLUMNS = ("program", "pose", "line", "x_mm", "y_mm", "z_mm")


def of_paths(paths):
    """The motions of some core.ToolPath, one after the other."""
    counts = [len(path) for path in paths]
    empty = np.zeros((0, 3))
    return {
        "program": np.repeat(np.arange(len(paths)), counts),
        "pose": np.concatenate([np.arange(count) for count in counts] or [[]]).astype(int),
        "line": np.concatenate([path.lines() for path in paths] or [[]]).astype(int),
        "point": np.concatenate([empty, *(path.work_from_contact()[:, :3, 3] for path in paths)]),
    }


def csv_text(motions):
    """One row a motion."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    numbers = np.column_stack([motions[name] for name in COLUMNS[:3]]).tolist()
    for row, point in zip(numbers, motions["point"].tolist()):
        rows.writerow([*row, *(f"{value:.9g}" for value in point)])
    return text.getvalue()


def read(path):
    """What ``csv_text`` wrote to ``path`` (a pathlib.Path); None if there is no file. Raises
    InputError.
    """
    try:
        with open(path, encoding="utf-8") as file:
            if file.readline().strip() != ",".join(COLUMNS):
                raise ValueError("its columns are others")
            rows = cells.numbers(file).reshape(-1, len(COLUMNS))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise cannot_be_read(path, error) from None
    except ValueError as error:
        raise InputError(
            "cell.no_motions", "{file}: no table of motions: {reason}", file=path, reason=error
        ) from None
    if not np.isfinite(rows).all():
        raise InputError(
            "cell.motions_not_finite",
            "{file}: no table of motions: a number is not finite",
            file=path,
        )
    numbers = {name: rows[:, i].astype(int) for i, name in enumerate(COLUMNS[:3])}
    return {**numbers, "point": rows[:, 3:]}
