"""What a study has on the disk: a file for each finished run, named by the hash of its job, and the table made of them.

Each file is written whole or not at all, so that whatever ends the study in between leaves every finished run.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base import schemas
from ..base.files import cannot_be_written, json_bytes, write_whole
from ..base.kinds import Json
from ..base.regular_files import read_regular
from ..engine import InputError
from . import table

if TYPE_CHECKING:
    from .kinds import Record

RUNS, FIELDS = "runs", "fields"
STUDY, DESIGN = "study.json", "design.json"
KEYS = {"job_hash", "status", "figures", "error", "seconds"}
LARGEST = 1 << 26  # bytes of a run's file


class Store:
    """The folder of a study."""

    def __init__(self, folder: Path | str, fields: bool = False) -> None:
        """``fields``: a run is there only if its height field is."""
        self.folder, self.fields = Path(folder), fields

    def _path(self, job_hash: str) -> Path:
        return self.folder / RUNS / job_hash[:2] / f"{job_hash}.json"

    def field_path(self, job_hash: str) -> Path:
        """Where the height field of a run lies, if it was kept."""
        return self.folder / FIELDS / f"{job_hash}.h5"

    def read(self, job_hash: str) -> Record | None:
        """The record of a finished run: dict(job_hash, status, figures, error, seconds); None where there is none, or only
        what is no whole one. Raises InputError for a file that is there and cannot be read."""
        path = self._path(job_hash)
        if not path.exists():
            return None
        try:
            record = json.loads(read_regular(path, LARGEST))
        except (ValueError, RecursionError):
            return None
        if not _whole(record) or record["job_hash"] != job_hash:
            return None
        wanted = self.fields and record["status"] == table.DONE
        return None if wanted and not self.field_path(job_hash).exists() else record

    def write(self, record: Record) -> None:
        """Keeps the record of ``one.solve``. Raises InputError where it cannot be written."""
        job_hash = record["job_hash"]
        if record.get("field") is not None:
            self._write(self.field_path(job_hash), record["field"])
        kept = {name: record[name] for name in sorted(KEYS)}
        self._write(self._path(job_hash), json_bytes(kept))

    def write_study(self, study: Json, design: Json) -> None:
        """Keeps the study, so that it can be run again from here, and what its design is."""
        self._write(self.folder / STUDY, json_bytes(study))
        self._write(self.folder / DESIGN, json_bytes(design))

    def write_table(self, made: table.Table) -> None:
        """Writes the table as CSV and, where pyarrow is there, as Parquet. Raises InputError."""
        self._write(self.folder / table.FILE, made.csv_bytes())
        data = made.parquet_bytes()
        if data is not None:
            self._write(self.folder / table.PARQUET, data)
        else:  # an older one would be another table
            (self.folder / table.PARQUET).unlink(missing_ok=True)

    def _write(self, path: Path, data: bytes) -> None:
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(path, data)
        except OSError as error:
            raise cannot_be_written(path, error) from None


def _whole(record: Any) -> bool:
    """Whether what was read is a record of ``one.solve``."""
    if not isinstance(record, dict) or not KEYS <= set(record):
        return False
    done = record["status"] == table.DONE
    return (
        (done or record["status"] == table.FAILED and isinstance(record["error"], str))
        and isinstance(record["figures"], dict)
        and isinstance(record["seconds"], (int, float))
        and schemas.finite(record["seconds"])
    )


def read_json(path: Path, form: str) -> dict[str, Any]:
    """A file that ``Store`` wrote, checked by the schema ``form``. Raises InputError."""
    return schemas.checked_file(path, schemas.schema(form))


def check_folder(folder: Path | str, files: Iterable[Path | str]) -> None:
    """Raises InputError where a study's folder would take the place of one of ``files`` that the study reads."""
    import os

    real = Path(os.path.realpath(folder))
    for path in files:
        found = Path(os.path.realpath(path))
        if found.parent == real and found.name in (
            STUDY,
            DESIGN,
            table.FILE,
            table.PARQUET,
        ):
            raise InputError(
                "studies.own_input",
                "{file}: the study reads it, and its results would replace it; choose another folder",
                file=path,
            )
