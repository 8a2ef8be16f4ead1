"""The table of a study: a row a run, in CSV and, where pyarrow is there, in Parquet."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..base.files import cannot_be_read
from ..base.kinds import Array
from ..base.regular_files import read_regular
from ..engine import InputError

FILE, PARQUET = "table.csv", "table.parquet"
RUN, STATUS, ERROR, HASH = "run", "status", "error", "job_hash"
DONE, FAILED, OPEN = "done", "error", "open"  # of a run
TEXTS = ("overall", STATUS, ERROR, HASH)  # columns that are never numbers
LARGEST = 1 << 32  # bytes of a table
INTEGER = re.compile(r"[+-]?\d{1,18}")


class Table:
    """``names`` in order and ``columns``, arrays by name, all of the same length: int64, float64 (NaN: nothing there) or
    object (str, bool, list; None: nothing there). ``varied`` and ``figures``: which of the names are what varies and
    what came out; of a CSV alone that is not known (None)."""

    def __init__(
        self,
        columns: Mapping[str, Sequence[Any]],
        varied: Sequence[str] | None = None,
        figures: Sequence[str] | None = None,
    ) -> None:
        """``columns``: sequences by name, in order."""
        self.names = list(columns)
        self.columns = {name: _array(values, name in TEXTS) for name, values in columns.items()}
        self.varied, self.figures = varied, figures

    def __len__(self) -> int:
        return len(self.columns[self.names[0]]) if self.names else 0

    def __getitem__(self, name: str) -> Array:
        """The array of a column. Raises InputError."""
        if name not in self.columns:
            raise InputError(
                "studies.no_column",
                "the study's table has no column '{name}'; it has {names}",
                name=name,
                names=", ".join(self.names),
            )
        return self.columns[name]

    @property
    def done(self) -> Array:
        """(n,) bool: the runs that have figures."""
        return self[STATUS] == DONE

    def csv_bytes(self) -> bytes:
        """The table as CSV; numbers with all their digits."""
        file = io.StringIO()
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(self.names)
        rows.writerows(zip(*([_cell(v) for v in self.columns[n].tolist()] for n in self.names)))
        return file.getvalue().encode("utf-8", "backslashreplace")

    def parquet_bytes(self) -> bytes | None:
        """The table as Parquet; None where pyarrow is not there."""
        try:
            import pyarrow
            from pyarrow import parquet
        except ImportError:
            return None
        columns = {
            name: (
                pyarrow.array([None if v is None else _cell(v) for v in values], pyarrow.string())
                if values.dtype == object
                else pyarrow.array(values)
            )
            for name, values in self.columns.items()
        }
        buffer = pyarrow.BufferOutputStream()
        parquet.write_table(pyarrow.table(columns), buffer)
        return buffer.getvalue().to_pybytes()

    @classmethod
    def read(
        cls,
        path: Path | str,
        varied: Sequence[str] | None = None,
        figures: Sequence[str] | None = None,
    ) -> Table:
        """The table of a CSV that ``csv_bytes`` made. Raises InputError."""
        path = Path(path)
        try:
            text = read_regular(path, LARGEST).decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise cannot_be_read(path, error) from None
        try:
            rows = list(csv.reader(io.StringIO(text)))
        except csv.Error as error:
            raise cannot_be_read(path, ValueError(str(error))) from None
        names = rows[0] if rows else []
        if not {RUN, STATUS, HASH} <= set(names) or len(set(names)) < len(names):
            raise InputError("studies.no_table", "{file}: is no table of a study's runs", file=path)
        for number, row in enumerate(rows, 1):
            if len(row) != len(names):
                raise InputError(
                    "studies.row_length",
                    "{file}: row {row} has {count} cells, not {wanted}: the table is damaged; run the study again",
                    file=path,
                    row=number,
                    count=len(row),
                    wanted=len(names),
                )
        _check_runs(path, names, rows[1:])
        cells = zip(*rows[1:]) if len(rows) > 1 else ([] for _ in names)
        return cls(
            {
                name: list(column) if name in TEXTS else _read(column)
                for name, column in zip(names, cells)
            },
            varied,
            figures,
        )


def _check_runs(path: Path, names: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    number, status = names.index(RUN), names.index(STATUS)
    for row, cells in enumerate(rows, 2):
        if not INTEGER.fullmatch(cells[number]) or cells[status] not in (DONE, FAILED, OPEN):
            raise InputError(
                "studies.no_run",
                "{file}: row {row} is no run of a study: the table is damaged; run the study again",
                file=path,
                row=row,
            )


def _array(values: Iterable[Any], text: bool = False) -> Array:
    """int64 or float64 where all are numbers, else object."""
    values = list(values)
    if text:
        return _objects(["" if v is None else v for v in values])
    kinds = {type(v) for v in values if v is not None}
    if kinds <= {int} and None not in values:
        return np.array(values, dtype=np.int64)
    if kinds <= {int, float}:
        return np.array([np.nan if v is None else v for v in values], dtype=float)
    return _objects(values)


def _objects(values: Sequence[Any]) -> Array:
    found = np.empty(len(values), dtype=object)
    found[:] = values
    return found


def _cell(value: Any) -> str:
    if value is None or value != value:
        return ""
    if isinstance(value, (bool, list, dict)):
        return json.dumps(value, sort_keys=True, allow_nan=False)
    return repr(value) if isinstance(value, float) else str(value)


def _read(cells: Sequence[str]) -> list[Any]:
    """Values of a column's cells: numbers where all are."""
    if all(INTEGER.fullmatch(cell) for cell in cells):
        return [int(cell) for cell in cells]
    try:
        return [float(cell) if cell else None for cell in cells]
    except ValueError:
        return [_value(cell) for cell in cells]


def _value(cell: str) -> Any:
    if cell in ("", "true", "false") or cell[:1] in "[{":
        try:
            return json.loads(cell) if cell else None
        except ValueError:
            pass
    return cell
