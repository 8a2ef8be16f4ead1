"""Names of types that stand in many signatures of studies."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeAlias

from ..base.kinds import Array, Json
from ..engine import RunContext

Variables: TypeAlias = Mapping[str, Array]  # of each variable or figure its value in each run
Limits: TypeAlias = Mapping[str, "tuple[float | None, float | None]"]  # of figures
Pictures: TypeAlias = Mapping[str, bytes]  # PNGs by the names of their files
Quantile: TypeAlias = Callable[[Array], "list[Any]"]  # (n,) in [0, 1]: values
OpenTurns: TypeAlias = Any  # the package, or a distribution of it: it has no types

Files: TypeAlias = Sequence["tuple[str, str, str | None]"]  # (the job's key, path, sha256)
Task: TypeAlias = Json  # as ``one.in_worker`` takes it, with a ``job_hash``
Record: TypeAlias = dict[str, Any]  # as ``one.solve`` gives it
Blobs: TypeAlias = Mapping[str, bytes]  # by their SHA-256
Blob: TypeAlias = Callable[[str], bytes]  # of a SHA-256
Taken: TypeAlias = Callable[[Record], None]
Working: TypeAlias = Callable[[int], None]  # is told how many processes work
DoneBy: TypeAlias = Callable[[Task, Blobs, "str | None"], "dict[str, Any]"]
Read: TypeAlias = Iterable["Path | str"]


class Run(Protocol):
    """``pool.run`` with its first argument."""

    def __call__(
        self,
        tasks: Sequence[Task],
        blob: Blob | None,
        taken: Taken,
        context: RunContext,
        told: Working | None = None,
        done_by: DoneBy = ...,
    ) -> None:
        ...
