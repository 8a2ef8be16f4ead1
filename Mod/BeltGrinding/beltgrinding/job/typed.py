"""A job as plain data becomes records (settings.py), which rooms hand on down to the binding."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from ..base import records, schemas
from ..base.kinds import Json
from .settings import Job


def typed(job: Job | Json) -> Job:
    """A validated job as records, ``settings.Job``; one that is typed already as it is.

    A macro may have put objects of its own into it: what they leave out is as the schema has it.
    """
    if isinstance(job, Job):
        return job
    given = {key: value if key == "programs" else _filled(key, value) for key, value in job.items()}
    return records.made(Job, given)


def _filled(key: str, value: Any) -> Any:
    return schemas.filled(value, _rules().get(key, {}))


@lru_cache(maxsize=None)
def _rules() -> dict[str, Any]:
    rules: dict[str, Any] = schemas.schema("job")["properties"]
    return rules
