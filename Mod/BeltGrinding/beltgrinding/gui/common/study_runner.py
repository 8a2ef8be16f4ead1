"""Runs a study in a thread of its own, polled by the window; its runs are processes of their own where Dask is."""

from __future__ import annotations

from ...objects import study as studies
from ...objects.kinds import DocumentObject
from .compat import translate
from .kinds import Context, Done, Told
from .runner import Runner


class StudyRunner(Runner):
    """``done(study.Found or None, error or None)`` follows in the end; ``told`` is the last ``Progress``. The Study object is
    written in one undo step, in the end, also with what a cancelled study had. Raises InputError for what is missing.
    """

    def __init__(self, obj: DocumentObject, progress: Told, done: Done) -> None:
        self.study = obj.Name
        self.told: studies.making.Progress | None = None
        job = obj.getParentGroup()
        self.task = studies.Work(obj, job)
        super().__init__(job, progress, done)

    def work(self, context: Context) -> studies.Found:
        return self.task.find(self.data, context, self._tell)

    def _tell(self, progress: studies.making.Progress) -> None:
        self.told = progress

    def _store(self, found: studies.Found) -> studies.Found:
        step = translate("BeltGrinding", "Study")
        self._store_in(self.study, step, lambda _, obj: studies.store(obj, found))
        return found
