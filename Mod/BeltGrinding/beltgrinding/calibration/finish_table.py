"""The table of measured roughnesses that a calibration of the finish reads."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..engine import InputError, core
from ..job import law as laws
from .table import number, small_name, split

# Canonical column: other names that it goes by, in small letters.
COLUMNS = {
    "grit": ("fepa_p", "p_number", "belt_grit", "grain"),
    "pressure_MPa": ("mean_pressure_mpa", "pressure"),
    "force_N": ("normal_force_n", "mean_force_n", "force"),
    "area_mm2": ("contact_area_mm2", "area"),
    "belt_speed_m_s": ("speed_m_s", "belt_speed", "vb_m_s"),
    "feed_mm_s": ("feed_rate_mm_s", "feed_speed_mm_s", "feed"),
    "remaining_cut": ("cut_share", "k_t"),
    "work_J": ("belt_work_j",),
    "removed_so_far_mm3": ("belt_removed_mm3",),
    "passes": ("number_of_passes", "n_passes"),
    "initial_Ra_um": ("ra_before_um", "before_um"),
    "Ra_um": ("ra", "ra_after_um", "roughness_um"),
}
MAY_BE_UNKNOWN = ("passes", "initial_Ra_um")
NEEDED = {  # by the fact that names it
    "grit": ("calibration.the_grit", "the belt's grit"),
    "belt_speed_m_s": ("calibration.the_speed", "the belt's speed"),
    "feed_mm_s": ("calibration.the_feed", "the feed"),
    "Ra_um": ("calibration.the_roughness", "the measured roughness Ra"),
}


class FinishTable(NamedTuple):
    """Measured roughnesses, (n,) float unless said; nan: not known."""

    path: str
    lines: Array  # of the file, from 1
    grit: Floats  # in one unit
    pressure: Floats  # MPa, mean over the contact
    speed: Floats  # m/s, of the belt
    feed: Floats  # mm/s
    cut: Floats  # share of a fresh belt's cut that remains
    passes: Floats  # over the place; nan: so many that more change nothing
    initial: Floats  # um, Ra before them
    measured: Floats  # um, Ra
    notes: list[Any]  # facts for the user

    def take(self, index: Array) -> FinishTable:
        """The rows of ``index``, a mask or an array of places."""
        arrays = {
            key: value[index] for key, value in self._asdict().items() if hasattr(value, "dtype")
        }
        return self._replace(**arrays)


def read(
    path: Path | str, remaining_cut: Callable[[float, float], float] | None = None
) -> FinishTable:
    """FinishTable of a CSV file; ``remaining_cut``: as of ``from_columns``. Raises InputError."""
    header, rows, lines = split(Path(path), _canonical)
    columns = {name: [row[i] for row in rows] for i, name in enumerate(header)}
    return from_columns(columns, str(path), lines, remaining_cut)


def wear_by(job: Json) -> Callable[[float, float], float]:
    """``remaining_cut`` of ``from_columns`` by a job's ``law`` and ``belt_machine``, validated. It raises InputError for a
    belt that loads: no column says how loaded it was."""

    def remaining(work: float, removed: float) -> float:
        if laws.engine_wear(job["law"]).loading_share > 0.0:
            raise InputError(
                "calibration.loading_unknown",
                "{key}: the job's belt loads, and the table does not say how loaded it was; give the column remaining_cut",
                key="law.wear.loading_share",
            )
        belt = {"work": float(work), "volume": float(removed), "time": 0.0}
        return laws.remaining_cut(job, belt)

    return remaining


def _canonical(name: str) -> str | None:
    small = small_name(name)
    for canonical, aliases in COLUMNS.items():
        if small == canonical.lower() or small in aliases:
            return canonical
    return None


def from_columns(
    columns: Mapping[str, Sequence[Any]],
    path: str = "measurements",
    lines: Sequence[int] | None = None,
    remaining_cut: Callable[[float, float], float] | None = None,
) -> FinishTable:
    """FinishTable of columns by name (lists of numbers or texts). ``remaining_cut(work J, removed mm3)``: share of a
    fresh belt's cut, for tables that tell what the belt has done in its place. Raises InputError.
    """
    notes, c, given = [], {}, {}
    count = max((len(values) for values in columns.values()), default=0)
    lines = np.arange(1, count + 1) if lines is None else np.asarray(lines)
    for name, values in columns.items():
        canonical = _canonical(name)
        if canonical is None:
            notes.append(
                core.Fact(
                    "calibration.unknown_column",
                    "the column '{column}' is not known and left out{hint}",
                    column=name[:40],
                    hint="",
                )
            )
            continue
        if canonical in c:
            raise InputError(
                "calibration.same_column",
                "{file}: '{first}' and '{second}' are the same column",
                file=path,
                first=given[canonical],
                second=name,
            )
        if len(values) != count:
            raise InputError(
                "calibration.column_length",
                "{file}: '{column}' has {count} values, others {expected}",
                file=path,
                column=name,
                count=len(values),
                expected=count,
            )
        given[canonical] = name
        c[canonical] = np.array(
            [
                number(cell, {"file": path, "line": line}, name, canonical, MAY_BE_UNKNOWN)
                for cell, line in zip(values, lines)
            ]
        )
    for name, what in NEEDED.items():
        _require(name in c, path, core.Fact(*what), name)
    loaded = "force_N" in c and "area_mm2" in c
    pressure = core.Fact("calibration.the_pressure", "the mean pressure")
    _require(
        "pressure_MPa" in c or loaded,
        path,
        pressure,
        "pressure_MPa or force_N, area_mm2",
    )
    unknown = np.full(count, math.nan)
    return FinishTable(
        path=path,
        lines=lines,
        grit=c["grit"],
        pressure=c["pressure_MPa"] if "pressure_MPa" in c else c["force_N"] / c["area_mm2"],
        speed=c["belt_speed_m_s"],
        feed=_moving(c["feed_mm_s"], path, lines),
        cut=_cut(c, path, lines, count, remaining_cut, notes),
        passes=c.get("passes", unknown),
        initial=c.get("initial_Ra_um", unknown),
        measured=c["Ra_um"],
        notes=notes,
    )


def _require(there: Any, path: Any, what: str, columns: Any) -> None:
    if not there:
        raise InputError(
            "calibration.no_column",
            "{file}: {what} is missing; add a column {columns}",
            file=path,
            what=what,
            columns=columns,
        )


def _moving(feed: Floats, path: Any, lines: Any) -> Floats:
    still = np.flatnonzero(~(feed > 0.0))
    if len(still):
        raise InputError(
            "calibration.finish_stands",
            "{file}: line {line}: a place that the belt does not move over has no finish of a pass; the feed must be "
            "positive",
            file=path,
            line=int(lines[still[0]]),
        )
    return feed


def _cut(
    c: Mapping[str, Any],
    path: Any,
    lines: Any,
    count: int,
    remaining_cut: Callable[[float, float], float] | None,
    notes: list[Any],
) -> Floats:
    """Share of a fresh belt's cut."""
    if "remaining_cut" in c:
        above = np.flatnonzero(c["remaining_cut"] > 1.0)
        if len(above):
            raise InputError(
                "calibration.cut_above_one",
                "{file}: line {line}: the remaining cut is a share of a fresh belt's, at most 1",
                file=path,
                line=int(lines[above[0]]),
            )
        return c["remaining_cut"]
    used = [name for name in ("work_J", "removed_so_far_mm3") if name in c]
    if used and remaining_cut is not None:
        zero = np.zeros(count)
        work, removed = (c.get(name, zero) for name in ("work_J", "removed_so_far_mm3"))
        found = np.array([remaining_cut(one, other) for one, other in zip(work, removed)])
        notes.append(_of_job(", ".join(used), np.ptp(found) > 0.0))
        return found
    if used:
        notes.append(
            core.Fact(
                "calibration.wear_without_job",
                "what a belt has done says nothing of its cut without a law of wear: give the job (--job), or the "
                "column remaining_cut; all belts are taken as fresh",
            )
        )
    return np.ones(count)


def _of_job(columns: Any, worn: bool) -> core.Fact:
    """The note that a job has told how far belts were worn; ``worn``: whether it makes a difference."""
    if not worn:
        return core.Fact(
            "calibration.no_wear_by_job",
            "the job's law of wear tells no difference from {columns}: all belts are taken as equally sharp",
            columns=columns,
        )
    return core.Fact(
        "calibration.wear_by_job",
        "the belts' wear follows from {columns} by the job's law of wear",
        columns=columns,
    )
