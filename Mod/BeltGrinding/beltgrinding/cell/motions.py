"""The motions of a job's programs, numbered from 0 through all programs as the removal trace of a
height field counts them: motion m leads to pose ``pose[m]`` of program ``program[m]``.

Arrays of m values: ``program``, ``pose`` (both from 0), ``line`` (of the source file, 0: unknown),
``point`` (m, 3), the contact point in the work frame at its end, mm, and ``time``, of its end, s since the first
program began; what earlier versions kept lacks ``time``.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TypeAlias, TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..base import cells
from ..base.files import cannot_be_read
from ..base.kinds import Array
from ..engine import InputError

if TYPE_CHECKING:
    from ..engine import core

Motions: TypeAlias = "Mapping[str, Array]"  # as ``of_paths`` gives them
FILE = "motions.csv"
COLUMNS = ("program", "pose", "line", "x_mm", "y_mm", "z_mm", "time_s")
EARLIER = COLUMNS[:6]  # of what older versions wrote


def of_paths(paths: Sequence[core.ToolPath]) -> dict[str, Array]:
    """The motions of some core.ToolPath, one after the other."""
    counts = [len(path) for path in paths]
    empty, none = np.zeros((0, 3)), np.zeros(0, dtype=int)
    begins = np.cumsum([0.0, *(path.duration() for path in paths)])
    return {
        "program": np.repeat(np.arange(len(paths)), counts),
        "pose": np.concatenate([np.arange(count) for count in counts] or [none]).astype(int),
        "line": np.concatenate([path.lines() for path in paths] or [none]).astype(int),
        "point": np.concatenate([empty, *(path.work_from_contact()[:, :3, 3] for path in paths)]),
        "time": np.concatenate(
            [[], *(path.times() + begin for path, begin in zip(paths, begins))]
        ).astype(float),
    }


def time_at(motions: Motions, motion: int, point: ArrayLike) -> float:
    """When the tool passes nearest to ``point`` (3,), mm, on the motion of this number, s: as if it went straight and
    evenly from contact point to contact point."""
    ends, end = motions["time"], motions["point"][motion]
    if motion == 0:
        return float(ends[0])
    same = motions["program"][motion - 1] == motions["program"][motion]
    begin = motions["point"][motion - 1]
    way = end - begin
    length = float(way @ way)
    if not same or not length > 0.0:
        return float(ends[motion])
    share = min(max(float((np.asarray(point) - begin) @ way) / length, 0.0), 1.0)
    return float(ends[motion - 1] + share * (ends[motion] - ends[motion - 1]))


def csv_text(motions: Motions) -> str:
    """One row a motion."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    timed = "time" in motions
    rows.writerow(COLUMNS if timed else EARLIER)
    numbers = np.column_stack([motions[name] for name in COLUMNS[:3]]).tolist()
    values = np.column_stack([motions["point"], *([motions["time"]] if timed else [])]).tolist()
    for row, rest in zip(numbers, values):
        rows.writerow([*row, *(f"{value:.9g}" for value in rest)])
    return text.getvalue()


def read(path: Path) -> dict[str, Array] | None:
    """What ``csv_text`` wrote to ``path`` (a pathlib.Path); None if there is no file. Raises
    InputError.
    """
    try:
        with open(path, encoding="utf-8") as file:
            columns = tuple(file.readline().strip().split(","))
            if columns not in (COLUMNS, EARLIER):
                raise ValueError("its columns are others")
            rows = cells.numbers(file).reshape(-1, len(columns))
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
    timed = {"time": rows[:, 6]} if columns == COLUMNS else {}
    return {**numbers, "point": rows[:, 3:6], **timed}
