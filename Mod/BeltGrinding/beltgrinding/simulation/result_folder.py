"""The files of a result in their folder: replaced as a whole, known by their SHA-256.

summary.json holds under ``files`` the size and SHA-256 of every other file, under ``run_id`` what the run was
made of (the same inputs and versions give the same) and under ``sha256`` its own, over the rest of it.
"""

from __future__ import annotations
import hashlib
import json
import os
import sys
import time
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import Path
from typing import TypeAlias, Any

from ..base import folders, schemas
from ..base.files import Data, cannot_be_read, cannot_be_written, json_bytes, sum_of, write_to
from ..base.kinds import Json
from ..base.regular_files import open_regular
from ..engine import InputError
from ..job import inputs

SUMMARY = "summary.json"
FILES = (  # of a result
    "deviation.ply",
    "heightfield.h5",
    "events.json",
    "steps.csv",
    "motions.csv",
    "verdict.json",
    "convergence.json",
    SUMMARY,
)
SCAN = "scan.json"
REPORT = "report.html"
VIEW = "view.html"
MADE_LATER = (SCAN, REPORT, VIEW)  # of a result; a new one removes them

Sums: TypeAlias = "dict[str, dict[str, int | str]]"  # by file name, as ``files.sum_of`` gives them


def run_id(summary: Json) -> str:
    """32 hex digits that tell results apart: of their inputs' hashes and of the versions."""
    made_of = [(one["what"], one["sha256"]) for one in summary.get("inputs", ())]
    return hashlib.sha256(inputs.canonical([made_of, summary["versions"]])).hexdigest()[:32]


def check(
    folder: Path | str,
    summary: Json | None = None,
    used: Iterable[Path | str] = (),
    force: bool = False,
) -> None:
    """Raises InputError where a result in ``folder`` would replace what is no run's: one of the
    files that the run reads (those of ``summary["inputs"]`` and ``used``), or, unless ``force``, a file of
    another origin under the name of one of a result's.
    """
    folder = Path(os.path.realpath(folder))
    names = {*FILES, *MADE_LATER}
    given = [one["file"] for one in (summary or {}).get("inputs", ()) if one["file"]]
    for path in (*given, *used):
        found = Path(os.path.realpath(path))
        if found.parent == folder and found.name in names:
            raise InputError(
                "simulation.own_input",
                "{file}: the result would replace it, and the run reads it; choose another folder "
                "for the result",
                file=path,
            )
    if force:
        return
    ours = _written_there(folder)
    for name in sorted(names):
        if os.path.lexists(folder / name) and name not in ours:
            raise InputError(
                "simulation.not_of_a_run",
                "{file}: no run's result has written it, and it would be replaced; choose another "
                "folder, or replace it by --force (in Python: force=True)",
                file=folder / name,
            )


def write(
    folder: Path | str,
    contents: Mapping[str, Data],
    summary: dict[str, Any],
    force: bool = False,
    used: Iterable[Path | str] = (),
    begun: float | None = None,
) -> None:
    """Writes a result's files (by name, as ``files.write_to`` takes them) and its summary in place of what an older one
    has there. ``summary`` gets ``files``, and under wall_time_s the seconds of its writing since ``begun``
    (time.perf_counter). Raises InputError; the folder is then as it was.
    """

    def of_the_old(folder: Path) -> list[str]:
        check(folder, summary, used, force)
        listed = _listed(folder).items()
        own = {name for name, kept in listed if name not in FILES and _same(folder / name, kept)}
        return sorted({*FILES, *MADE_LATER, *own} - {*contents, SUMMARY})

    def end(files: Sums) -> bytes:
        summary["files"] = files
        if begun is not None:
            summary["wall_time_s"]["write"] = time.perf_counter() - begun
        return _summary_bytes(summary)

    _replace(folder, _with_summary(contents, end), of_the_old)


def update(folder: Path | str, summary: dict[str, Any], contents: Mapping[str, Data]) -> None:
    """Writes files (as ``write`` takes them) that were made of a result beside it, such as its verdict or a report, and their
    sums into its summary. Of an older version's result, which has none, the files alone. Raises InputError,
    also where another result has taken its place meanwhile.
    """

    before = summary.get("files")
    if before is None:
        _replace(folder, contents)
        return

    def unchanged(folder: Path) -> None:
        try:
            now = read_summary(folder).get("files")
        except InputError:
            now = None
        if now != before:
            raise InputError(
                "simulation.replaced",
                "{file}: another result has taken the place of the one that was read; do it again",
                file=folder,
            )

    changed = dict(summary)

    def end(files: Sums) -> bytes:
        changed["files"] = {**(before or {}), **files}
        return _summary_bytes(changed)

    _replace(folder, _with_summary(contents, end), unchanged)
    summary["files"] = changed["files"]


def read_summary(folder: Path) -> dict[str, Any]:
    """summary.json of a folder, checked by its own sum if it has one. Raises InputError."""
    path = Path(folder, SUMMARY)
    if Path(folder).is_dir() and not path.exists():
        raise InputError(
            "simulation.no_result",
            "{file}: holds no result: no run has ended there, or one was broken off while it "
            "wrote; run the job again",
            file=folder,
        )
    summary: dict[str, Any] = schemas.checked_file(path, schemas.schema("summary"))
    if "sha256" in summary and summary.pop("sha256") != _own_sum(summary):
        raise _damaged(path)
    return summary


def check_sums(folder: Path, summary: Json) -> None:
    """Raises InputError naming the first file that is missing or not as it was written."""
    for name, kept in _sums_of(summary).items():
        path = Path(folder, name)
        try:
            same = _same(path, kept)
        except OSError as error:
            raise cannot_be_read(path, error) from None
        if not same:
            raise _damaged(path)


def _damaged(path: Path) -> InputError:
    return InputError(
        "simulation.not_as_written",
        "{file}: is not as the run wrote it: it is damaged, was changed, or is another run's; run the "
        "job again",
        file=path,
    )


def _replace(
    folder: Path | str,
    contents: Mapping[str, Data],
    look: Callable[[Path], Collection[str] | None] | None = None,
) -> None:
    try:
        folders.replace(Path(folder), contents, look)
    except OSError as error:
        raise cannot_be_written(folder, error) from None


def _written_there(folder: Path) -> Collection[str]:
    """Names of the files in ``folder`` that a run of this program has written."""
    try:
        summary = schemas.read_json(folder / SUMMARY)
    except InputError:
        return ()
    if not isinstance(summary, dict) or not {"samples", "versions"} <= set(summary):
        return ()
    if "files" not in summary:  # an older version's
        return {*FILES, *MADE_LATER}
    return {SUMMARY, *_sums_of(summary)}


def _listed(folder: Path) -> Sums:
    try:
        summary = schemas.read_json(folder / SUMMARY)
    except InputError:
        return {}
    return _sums_of(summary) if isinstance(summary, dict) else {}


def _sums_of(summary: Json) -> Sums:
    """``files`` of a summary that may hold anything; names that lead elsewhere are left out."""
    files = summary.get("files", {})
    files = files if isinstance(files, dict) else {}
    return {name: kept for name, kept in files.items() if name == Path(name).name}


def _with_summary(contents: Mapping[str, Data], end: Callable[[Sums], bytes]) -> dict[str, Data]:
    """``contents`` and, behind them, the summary: the bytes that ``end`` makes of their sizes and SHA-256."""
    files: Sums = {}

    def noting(name: str, data: Data) -> Callable[[int], None]:
        def write(number: int) -> None:
            write_to(number, data)
            files[name] = sum_of(number)

        return write

    made = {name: noting(name, data) for name, data in contents.items()}
    return {**made, SUMMARY: lambda number: write_to(number, end(files))}


def _same(path: Path, kept: Any) -> bool:
    """Whether a file is what ``sum_of`` told. Raises OSError where it cannot be read."""
    if not isinstance(kept, dict) or path.stat().st_size != kept.get("bytes"):
        return False
    with open_regular(path, sys.maxsize) as file:
        return sum_of(file.fileno())["sha256"] == kept.get("sha256")


def _own_sum(summary: Json) -> str:
    # As it comes back from its JSON: a tuple is a list then.
    return hashlib.sha256(inputs.canonical(json.loads(json_bytes(summary)))).hexdigest()


def _summary_bytes(summary: Json) -> bytes:
    return json_bytes({**summary, "sha256": _own_sum(summary)})
