"""What a run is known by: a hash of its job, of the content of the files that the job reads, and of the engine's version.

Paths are no part of it, only the names of the files, so that a study may move. What is large and does not vary (shapes,
poses, files) is hashed once.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.kinds import Json
from ..engine import core
from ..job import inputs

if TYPE_CHECKING:
    from .kinds import Files

FORMAT = 1  # of what is stored of a run; another one is another hash


class Hashes:
    """Hashes of the jobs of one study; files are taken to stay as they are meanwhile."""

    def __init__(self, bases: Iterable[Json]) -> None:
        """``bases``: the validated jobs that the others are made of."""
        self._files: dict[
            bytes, Files
        ] = {}  # by the paths that a job names: [(what, path, sha256)]
        self._held: dict[
            int, tuple[Any, str]
        ] = {}  # by id: (the object, so that its id stays its own; its sha256)
        for job in bases:
            for held, name in _large(job):
                self._held[id(held[name])] = (held[name], _sha256(held[name]))

    def job(self, job: Json) -> str:
        """64 hex digits of a validated job."""
        slim = self._slim(job)
        read = [(what, Path(path).name, sha) for what, path, sha in self.files(job)]
        made_of = [FORMAT, core.versions(), _even(_by_name(slim)), read]
        return hashlib.sha256(inputs.canonical(made_of)).hexdigest()

    def files(self, job: Json) -> Files:
        """[(the job's key, path, sha256 or None)] of the files that a validated job reads."""
        slim = self._slim(job)
        named = inputs.canonical(
            [
                slim["design"],
                slim["stock"],
                slim["programs"],
                slim["cell"]["bodies"],
                slim["belt_machine"]["compliance"]["surrogate_file"],
            ]
        )
        if named not in self._files:
            self._files[named] = [
                (one["what"], one["file"], one["sha256"])
                for one in inputs.digests(slim)
                if one["file"] is not None
            ]
        return self._files[named]

    def _slim(self, job: Json) -> dict[str, Any]:
        """The job with hashes in place of shapes and poses."""
        slim = dict(job)
        for key in ("design", "stock"):
            slim[key] = self._without(job[key], "brep")
        slim["programs"] = [self._without(one, "poses") for one in job["programs"]]
        bodies = [self._without(one, "brep") for one in job["cell"]["bodies"]]
        slim["cell"] = {**job["cell"], "bodies": bodies}
        return slim

    def _without(self, held: Json, name: str) -> Json:
        return {**held, name: self._sha(held[name])} if name in held else held

    def _sha(self, data: Any) -> str:
        known = self._held.get(id(data))
        return known[1] if known is not None else _sha256(data)


def _sha256(data: Any) -> str:
    return hashlib.sha256(inputs.canonical(data)).hexdigest()


def _large(job: Json) -> Iterator[tuple[Json, str]]:
    """(what holds it, its name) of shapes and poses."""
    for held in (job["design"], job["stock"], *job["cell"]["bodies"]):
        if "brep" in held:
            yield held, "brep"
    for program in job["programs"]:
        if "poses" in program:
            yield program, "poses"


def _even(value: Any) -> Any:
    """Plain data with whole numbers as they are otherwise: 20 and 20.0 are the same job."""
    if isinstance(value, dict):
        return {name: _even(one) for name, one in value.items()}
    if isinstance(value, list):
        return [_even(one) for one in value]
    return float(value) if type(value) is int else value


def _by_name(slim: Json) -> dict[str, Any]:
    """The job with names of files in place of their paths."""

    def named(held: Json, key: str = "file") -> Json:
        return {**held, key: Path(held[key]).name} if isinstance(held.get(key), str) else held

    compliance = slim["belt_machine"]["compliance"]
    if compliance["surrogate_file"]:
        compliance = named(compliance, "surrogate_file")
    return {
        **slim,
        "design": named(slim["design"]),
        "stock": named(named(slim["stock"]), "left_by"),
        "programs": [named(named(one), "values") for one in slim["programs"]],
        "cell": {**slim["cell"], "bodies": [named(one) for one in slim["cell"]["bodies"]]},
        "belt_machine": {**slim["belt_machine"], "compliance": compliance},
    }
