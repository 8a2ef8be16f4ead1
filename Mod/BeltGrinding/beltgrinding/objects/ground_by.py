"""Which of a job's programs a run takes, and which ones a result was made with."""

from __future__ import annotations

from collections.abc import Sequence

from ..engine import InputError
from .job_data import children
from .kinds import DocumentObject
from .robot_path import RobotPath


def active(job: DocumentObject) -> list[DocumentObject]:
    """The job's programs that a run takes, in the order in which they are ground."""
    return [path for path in children(job, RobotPath) if getattr(path, "Active", True)]


def required(job: DocumentObject) -> list[DocumentObject]:
    """The same. Raises InputError where there is none."""
    found = active(job)
    if not found and children(job, RobotPath):
        raise InputError(
            "objects.no_active_program",
            "{object}: all its robot programs are left out; make one active",
            object=job.Label,
        )
    if not found:
        raise InputError(
            "objects.no_program", "{object} has no robot program; import one", object=job.Label
        )
    return found


def of_result(job: DocumentObject, names: Sequence[str]) -> list[DocumentObject]:
    """The programs with the names that a result of the job has, in its order: others may have become active since, or
    one may have another name. Raises InputError where one is gone."""
    now = active(job)
    if not names or [path.Label for path in now] == list(names):
        return now  # older results name none
    left, found = children(job, RobotPath), []
    renamed = now if len(now) == len(names) else []
    for at, name in enumerate(names):
        one = next((path for path in left if path.Label == name), None)
        if one is None and at < len(renamed) and renamed[at].Label not in names:
            one = renamed[at]
        if one is None or one not in left:
            raise InputError(
                "objects.other_programs",
                "{object}: the result was made with {program}, which is not there now; simulate again",
                object=job.Label,
                program=name,
            )
        left.remove(one)
        found.append(one)
    return found
