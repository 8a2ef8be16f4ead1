"""What a job gave, and the files that it is kept in."""

import copy
import io
import json
import os
import shutil
import tempfile
import time
from pathlib import Path

import numpy as np

from ..base import schemas
from ..base.files import cannot_be_read, cannot_be_written, json_bytes, write_whole
from ..cell import events, motions
from ..engine import InputError, core
from ..job.tolerances import colour_scale

# What summary.json has had since belts wear and robots are followed: here nothing of either is known.
LATER = {
    "belt": {"work_J": 0.0, "removed_mm3": 0.0, "hours": 0.0, "remaining_cut": 1.0},
    "robot": {},
    "clearances": [],
}

FILES = (  # of a result
    "deviation.ply",
    "heightfield.h5",
    "events.json",
    "steps.csv",
    "motions.csv",
    "verdict.json",
    "convergence.json",
    "summary.json",
)

OF_THE_LAST = ("scan.json",)  # what was made of a result before, and does not belong to a new one
PART = ".part-"  # a folder with what is not yet whole
LEFT_OVER = 3600.0  # s; a folder of that age is a killed run's


class Result:
    """What a job gave: ``field`` (the ground HeightField), ``summary``, ``events`` (lists and dicts
    as in summary.json and events.json), ``steps`` (dict of arrays, one value per step, or None),
    ``recording`` (core.Recording of the heights, or None), ``convergence`` (dict as in
    convergence.json, or None), ``motions`` (as ``motions.of_paths`` gives them, or None), ``verdict``
    (dict as in verdict.json, or None).
    """

    VERDICT = "verdict.json"
    bins = None  # the time series of a document's result, as ``reporting.charts.binned`` makes it
    convergence = None
    motions = None
    verdict = None

    def __init__(self, job, field, summary, events, steps, recording=None):
        self.job = job
        self.field = field
        self.summary = summary
        self.events = events
        self.steps = steps
        self.recording = recording

    def write(self, folder):
        """Writes the files of ``FILES``, all of them whole or none: until all are written they lie in
        a folder beside. The last to change its place is summary.json; without it a folder is no
        result.
        """
        start = time.perf_counter()
        folder = Path(folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            _remove_left_over(folder)
            with tempfile.TemporaryDirectory(prefix=PART, dir=folder) as part:
                self._write_files(Path(part))
                self.summary["wall_time_s"]["write"] = time.perf_counter() - start
                write_whole(Path(part, FILES[-1]), json_bytes(self.summary))
                for path in Path(part).iterdir():
                    _put_on_disk(path)  # the file system would do it between two changes of place
                (folder / FILES[-1]).unlink(missing_ok=True)
                for name in FILES:
                    if Path(part, name).exists():
                        os.replace(Path(part, name), folder / name)
                    else:
                        (folder / name).unlink(missing_ok=True)  # of another run
                for name in OF_THE_LAST:
                    (folder / name).unlink(missing_ok=True)
        except OSError as error:
            raise cannot_be_written(folder, error) from None

    def _write_files(self, folder):
        """All but summary.json."""
        lower, upper, limit = colour_scale(self.job)
        ply = core.deviation_ply(self.field, lower, upper, limit, True)
        write_whole(folder / "deviation.ply", ply)
        self.field.write_hdf5(str(folder / "heightfield.h5"), json.dumps(self.job))
        write_whole(folder / "events.json", json_bytes(self.events))
        if self.steps is not None:
            write_whole(folder / "steps.csv", _table(self.steps))
        if self.convergence is not None:
            write_whole(folder / "convergence.json", json_bytes(self.convergence))
        if self.motions is not None:
            write_whole(folder / motions.FILE, motions.csv_text(self.motions).encode())
        if self.verdict is not None:
            self.write_verdict(folder / self.VERDICT)

    def write_verdict(self, path):
        """Writes the verdict alone. Raises OSError."""
        write_whole(Path(path), json_bytes(self.verdict))

    @classmethod
    def read(cls, folder):
        """The result that ``write`` left in ``folder``. An older version's gets what has come since, by
        its default; its motions and verdict are None. Raises InputError.
        """
        from . import convergence_record

        folder = Path(folder)
        if folder.is_dir() and not (folder / FILES[-1]).exists():
            raise InputError(
                "simulation.no_result",
                "{file}: holds no result: no run has ended there, or one was broken off while it "
                "wrote; run the job again",
                file=folder,
            )
        data = {}
        for name in ("summary.json", "events.json"):
            try:
                data[name] = json.loads((folder / name).read_text(encoding="utf-8"))
            except OSError as error:
                raise cannot_be_read(folder / name, error) from None
            except ValueError as error:
                raise InputError(
                    "simulation.no_json",
                    "{file}: no JSON: {reason}",
                    file=folder / name,
                    reason=error,
                ) from None
        field, attributes = core.HeightField.from_hdf5(str(folder / "heightfield.h5"))
        try:
            job = schemas.filled(json.loads(attributes), schemas.schema("job"))
        except ValueError:
            raise InputError(
                "simulation.no_job",
                "{file}: holds no job; it is not a run's result",
                file=folder / "heightfield.h5",
            ) from None
        data["summary.json"] = {**copy.deepcopy(LATER), **data["summary.json"]}
        found = events.complete(data["events.json"])
        result = cls(job, field, data["summary.json"], found, _read_table(folder))
        result.convergence = convergence_record.read(folder / "convergence.json", job)
        result.motions = motions.read(folder / motions.FILE)
        if (folder / cls.VERDICT).exists():
            result.verdict = schemas.read_json(folder / cls.VERDICT)
        return result


def _put_on_disk(path):
    with open(path, "rb") as file:
        os.fsync(file.fileno())


def _remove_left_over(folder):
    """What killed runs could not tidy up themselves."""
    for part in folder.glob(PART + "*"):
        if time.time() - part.stat().st_mtime > LEFT_OVER:
            shutil.rmtree(part, ignore_errors=True)


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
}


def _table(steps):
    """One row a step, as CSV; programs and poses count from 0."""
    rows = np.column_stack([steps[name] for name in STEP_COLUMNS])
    text = io.StringIO()
    np.savetxt(text, rows, "%.9g", ",", header=",".join(STEP_COLUMNS.values()), comments="")
    return text.getvalue().encode()


def _read_table(folder):
    """The steps that ``_table`` wrote; None where there are none."""
    path = folder / "steps.csv"
    if not path.is_file():
        return None
    try:
        with open(path, encoding="utf-8") as file:
            names = file.readline().strip().split(",")
            rows = np.loadtxt(file, delimiter=",", ndmin=2)
    except (OSError, ValueError) as error:
        raise InputError(
            "simulation.no_steps", "{file}: no table of steps: {reason}", file=path, reason=error
        ) from None
    found = dict(zip(names, rows.T))
    missing = [name for name in STEP_COLUMNS.values() if name not in found]
    if missing:
        raise InputError(
            "simulation.no_column",
            "{file}: the column {column} is missing",
            file=path,
            column=missing[0],
        )
    return {name: found[column] for name, column in STEP_COLUMNS.items()}
