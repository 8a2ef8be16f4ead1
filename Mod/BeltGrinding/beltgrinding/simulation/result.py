"""What a job gave, and the files that it is kept in."""

from __future__ import annotations

import copy
import io
import json
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..base import folders, schemas
from ..base.cells import numbers
from ..base.files import Data, cannot_be_read, in_file, json_bytes
from ..base.kinds import Array, Floats, Json, known
from ..cell import events, motions
from ..cell.motions import Motions
from ..engine import InputError, core
from ..inspection import finish_events
from ..job.tolerances import colour_scale
from . import convergence_record, last_door, result_folder

# What summary.json has had since belts wear and robots are followed: here nothing of either is known.
LATER = {
    "belt": {"work_J": 0.0, "removed_mm3": 0.0, "hours": 0.0, "loading": 0.0, "remaining_cut": 1.0},
    "robot": {},
    "clearances": [],
}


class Result:
    """What a job gave: ``field`` (the ground HeightField), ``summary``, ``events`` (lists and dicts
    as in summary.json and events.json), ``steps`` (dict of arrays, one value per step, or None),
    ``recording`` (core.Recording of the heights, or None), ``convergence`` (dict as in
    convergence.json, or None), ``motions`` (as ``motions.of_paths`` gives them, or None), ``verdict``
    (dict as in verdict.json, or None), ``influence``, ``force_influence``
    (core.Influence; mm, mm per relative change of the force) and ``shifts`` ((samples, shifted laws) mm), all only of a run that
    was asked for them.
    """

    VERDICT = "verdict.json"
    folder: Path | None = None  # that ``read`` read
    # The time series of a document's result, as ``reporting.charts.binned`` makes it.
    bins: dict[str, Any] | None = None
    convergence: dict[str, Any] | None = None
    motions: Motions | None = None
    verdict: dict[str, Any] | None = None
    influence: core.Influence | None = None
    force_influence: core.Influence | None = None
    shifts: Floats | None = None

    def __init__(
        self,
        job: dict[str, Any],
        field: core.HeightField,
        summary: dict[str, Any],
        events: list[dict[str, Any]],
        steps: dict[str, Array] | None,
        recording: core.Recording | None = None,
    ) -> None:
        self.job = job
        self.field = field
        self.summary = summary
        self.events = events
        self.steps = steps
        self.recording = recording

    def write(
        self, folder: Path | str, force: bool = False, used: Iterable[Path | str] = ()
    ) -> None:
        """Writes the files of a result (``result_folder.FILES``) in place of an older one's, all of them
        or none. A file that the run has read, or one of ``used``, is never written over; another's file
        only by ``force``. Raises InputError; the folder is then as it was.
        """
        begun = time.perf_counter()
        self.summary["run_id"] = result_folder.run_id(self.summary)
        result_folder.write(folder, self._contents(), self.summary, force, used, begun)

    def _contents(self) -> dict[str, Data]:
        """By file name, of all but summary.json; what is large is written as it is made."""
        run = self.summary["run_id"]
        lower, upper, limit = colour_scale(self.job)
        scale = (lower, upper, limit)
        contents: dict[str, Data] = {
            "deviation.ply": lambda file: core.deviation_ply_into(
                file, self.field, *scale, True, run
            ),
            "heightfield.h5": self._height_field,
            "events.json": json_bytes(self.events),
        }
        if self.steps is not None:
            contents["steps.csv"] = _table(self.steps)
        if self.convergence is not None:
            contents["convergence.json"] = json_bytes(self.convergence)
        if self.motions is not None:
            contents[motions.FILE] = motions.csv_text(self.motions).encode()
        if self.verdict is not None:
            contents[self.VERDICT] = self.verdict_bytes()
        return contents

    def _height_field(self, file: int) -> None:
        self.field.hdf5_into(file, json.dumps({**self.job, **self._run_id()}, allow_nan=False))

    def _run_id(self) -> dict[str, str]:
        """None of an older version's result."""
        return {key: self.summary[key] for key in ("run_id",) if key in self.summary}

    def judged_by(self) -> Json:
        """The ``inspection`` whose limits its verdict is by: its job's, or that of another by which it was judged since."""
        return self.summary.get("judged_by") or self.job["inspection"]

    def tell_finish(self, inspection: Json) -> None:
        """Makes the events of zones' finish anew, by its verdict on the zones of a job's ``inspection``, and keeps by which
        one that is.
        """
        self.summary.pop("judged_by", None)
        if inspection != self.job["inspection"]:
            self.summary["judged_by"] = inspection
        job = {**self.job, "inspection": inspection}
        self.events = finish_events.renewed(
            self.events, job, known(self.verdict)["zones"], self.motions
        )
        self.summary["events"] = events.count(self.events)

    def verdict_bytes(self) -> bytes:
        """verdict.json"""
        return json_bytes({**known(self.verdict), **self._run_id()})

    def update(
        self,
        verdict: bool = False,
        measured: bool = False,
        others: Mapping[str, bytes] | None = None,
    ) -> None:
        """Writes what was made of a result that was read into its folder: its verdict and events, the heights
        that a scan measured, ``others`` (bytes by file name). Raises InputError.
        """
        contents: dict[str, Data] = dict(others or {})
        if verdict:
            last_door.check_figures(verdict=self.verdict, events=self.events)
            contents[self.VERDICT] = self.verdict_bytes()
            contents["events.json"] = json_bytes(self.events)
        if measured:
            contents["heightfield.h5"] = self._height_field
        result_folder.update(known(self.folder), self.summary, contents)

    @classmethod
    def read(cls, folder: Path | str) -> Result:
        """The result that ``write`` left in ``folder``. An older version's gets what has come since, by
        its default; its motions and verdict are None. Raises InputError, also where a file is not as it
        was written.
        """
        folder = Path(folder)
        try:
            with folders.reading(folder):
                return cls._read(folder)
        except OSError as error:
            raise cannot_be_read(error.filename or folder, error) from None

    @classmethod
    def _read(cls, folder: Path) -> Result:
        summary = result_folder.read_summary(folder)
        result_folder.check_sums(folder, summary)
        found = events.read(folder / "events.json")
        field, attributes = core.HeightField.from_hdf5(str(folder / "heightfield.h5"))
        job = _job(folder / "heightfield.h5", attributes)
        summary = {**copy.deepcopy(LATER), **summary}
        result = cls(job, field, summary, found, _read_table(folder))
        result.folder = folder
        result.convergence = convergence_record.read(folder / "convergence.json", job)
        result.motions = motions.read(folder / motions.FILE)
        if (folder / cls.VERDICT).exists():
            rules = schemas.schema("verdict")
            result.verdict = schemas.checked_file(folder / cls.VERDICT, rules)
        return result


def _job(path: Path, attributes: str) -> dict[str, Any]:
    """The job that a height field's file holds. Raises InputError."""
    try:
        job = json.loads(attributes)
        job.pop("run_id", None)
    except (ValueError, AttributeError, TypeError, RecursionError):
        raise InputError(
            "simulation.no_job", "{file}: holds no job; it is not a run's result", file=path
        ) from None
    try:
        return schemas.checked(job, schemas.schema("job"), "job")
    except InputError as error:
        raise in_file(error, path) from None


STEP_COLUMNS = {
    "program": "program",
    "pose": "pose",
    "time": "time_s",
    "duration": "duration_s",
    "feed": "feed_mm_s",
    "force": "force_N",
    "approach": "approach_mm",
    "contact_area": "contact_area_mm2",
    "peak_pressure": "peak_pressure_MPa",
    "removal_rate": "removal_rate_mm3_s",
    "segments": "segments",
    "deepest_approach": "deepest_approach_mm",
}
ADDED = {"deepest_approach_mm"}  # since 0.1.0, whose results are read with NaN there


def _table(steps: Mapping[str, Array]) -> bytes:
    """One row a step, as CSV; programs and poses count from 0."""
    rows = np.column_stack([steps[name] for name in STEP_COLUMNS])
    text = io.StringIO()
    np.savetxt(text, rows, "%.9g", ",", header=",".join(STEP_COLUMNS.values()), comments="")
    return text.getvalue().encode()


def _read_table(folder: Path) -> dict[str, Array] | None:
    """The steps that ``_table`` wrote; None where there are none."""
    path = folder / "steps.csv"
    if not path.is_file():
        return None
    try:
        with open(path, encoding="utf-8") as file:
            names = file.readline().strip().split(",")
            rows = numbers(file)
    except (OSError, ValueError) as error:
        raise InputError(
            "simulation.no_steps", "{file}: no table of steps: {reason}", file=path, reason=error
        ) from None
    found = dict(zip(names, rows.T))
    found.update({name: np.full(len(rows), np.nan) for name in ADDED - set(found)})
    missing = [name for name in STEP_COLUMNS.values() if name not in found]
    if missing:
        raise InputError(
            "simulation.no_column",
            "{file}: the column {column} is missing",
            file=path,
            column=missing[0],
        )
    return {name: found[column] for name, column in STEP_COLUMNS.items()}
