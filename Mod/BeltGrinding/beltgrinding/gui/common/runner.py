"""Runs a job's simulation in a thread of its own, polled by the window."""

from __future__ import annotations

import gc
import threading
import time
import weakref
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

from ...engine import Cancelled, RunContext
from ...objects import api, deviation, job_data, job_inputs, simulation as results
from ...objects.kinds import DocumentObject
from ...objects.living import named
from ...simulation import run as runs
from .compat import QtCore, translate
from .kinds import Context, Done, Told, Widget
from .transaction import abort, commit

if TYPE_CHECKING:
    from ...engine import core
    from ...simulation.result import Result

POLL = 50  # ms
END_POLL = 8  # ms, between looks at whether a run has ended
TOLD = 0.25  # s from the start to the first progress that is told, and on to the next: what changes in FreeCAD's
# window has all of it put together anew, which takes a processor as long as 50 steps of the grinding
MOST_RECORDED = 200e6  # bytes; what takes more is not kept for playback
# All works until the window has seen their end. Else the thread may be the last that holds one and free it with
# its timer, which only the window's thread may do; and who is told of the end may let go of the object whose
# method PySide is just calling. Of both FreeCAD dies, at times.
_going: set[Background] = set()
COLLECT = 2.0  # s between collections of garbage while works go on
_collected = [0.0]  # when the last one was
_before = [True]  # whether Python collected before the works began


def _begin(work: Background) -> None:
    """Holds a work. Python looks for garbage in whatever thread happens to make objects, and frees widgets there,
    of which Qt then keeps a dead address: while works go on only the window's thread does it."""
    if not _going:
        _before[0] = gc.isenabled()
        gc.disable()
    _going.add(work)


def _end(work: Background) -> None:
    """Lets go of a work whose end the window has seen."""
    _going.discard(work)
    if not _going and _before[0]:
        gc.enable()


def _collect() -> None:
    if time.monotonic() - _collected[0] > COLLECT:
        gc.collect(1)
        _collected[0] = time.monotonic()


class Background(QtCore.QObject):
    """Runs ``work(context)`` in a thread; ``done(result or None, error or None)`` follows on the
    window's thread, but not once ``owner``, a widget, is gone: then the work is cancelled.
    """

    def __init__(self, work: Callable[[RunContext], Any], done: Done, owner: Widget = None) -> None:
        super().__init__()
        self.context = RunContext()
        self.outcome: tuple[Any, BaseException | None] = (None, None)
        self.done = done
        self.thread = threading.Thread(target=self._work, args=(work,), daemon=True)
        _begin(self)
        self.thread.start()
        self.timer = QtCore.QTimer(self)
        self.timer.timeout.connect(self._poll)
        self.timer.start(POLL)
        if owner is not None:
            myself = weakref.ref(self)  # the owner may outlast it

            def gone(*_: object) -> None:
                background = myself()
                if background is not None:
                    background.abandon()

            owner.destroyed.connect(gone)

    def cancel(self) -> None:
        """Asks the work to end; ``done`` follows with Cancelled."""
        self.context.cancel()

    def abandon(self, then: Callable[[], object] = lambda: None) -> None:
        """Cancels for one who goes away: in the end only ``then`` is called."""
        self.done = lambda *_: then()
        self.cancel()

    def forget(self) -> None:
        """Its end was waited for: nothing follows any more."""
        self.timer.stop()
        _end(self)

    def _work(self, work: Callable[[RunContext], Any]) -> None:
        try:
            self.outcome = (work(self.context), None)
        except BaseException as error:  # handed to the window's thread
            self.outcome = (None, error)

    def _poll(self) -> None:
        _collect()
        if not self.thread.is_alive():
            self.timer.stop()
            QtCore.QTimer.singleShot(0, lambda: _end(self))
            self.done(*self.outcome)


class Runner(Background):
    """One run. The job's data are collected here and now (raises InputError); the document is
    written only in the end, on the window's thread, in one undo transaction.

    recording: an empty core.Recording, or None. progress(share): called while it runs; done(simulation or
    None, error or None): in the end. then(job): what belongs to the undo step of the result.
    """

    def __init__(
        self,
        job: DocumentObject,
        progress: Told,
        done: Done,
        recording: core.Recording | None = None,
        then: Callable[[DocumentObject], object] | None = None,
    ) -> None:
        self.document, self.name = job.Document, job.Name
        self.transient = job.Document.TransientDir
        self.progress, self.ended = progress, done
        self.folder = job_inputs.scratch_folder()
        self.data = job_inputs.to_data(job, self.folder.name)
        self.fingerprint = job_inputs.fingerprint(job)
        self.start = time.monotonic()
        self.recorded, self.then = recording, then
        found = job_data.child(job, deviation.Deviation)
        self.shown = then is not None or found is not None
        self.surface = "" if found is None else found.MeshOf
        self.progress_at = self.start  # s, when it was told last
        super().__init__(self.work, self._finish)
        self.timer.setInterval(END_POLL)

    def work(self, context: Context) -> Any:
        """(the run's ``Result``, its files as the document keeps them); in the thread."""
        result = self.grind(context)
        if result.recording is not None and result.recording.bytes > MOST_RECORDED:
            result.recording = None
        with ThreadPoolExecutor(1) as beside:
            files = beside.submit(results.files_of, result, self.transient)
            if self.shown:
                limits = result.job["inspection"]["tolerance_mm"]
                deviation.prepare(result.field, limits, self.surface)
            return result, files.result()

    def grind(self, context: Context) -> Result:
        """The ``simulation.result.Result``; in the thread."""
        return runs.run(self.data, context, self.recorded)

    def job(self) -> DocumentObject | None:
        """The job, or None if it or its document is no longer there."""
        return named(self.document, self.name)

    def abandon(self, then: Callable[[], object] = lambda: None) -> None:
        """Cancels, and stores nothing even if the run has just ended."""
        self.progress = lambda _: None

        def end() -> None:
            self.folder.cleanup()
            then()

        super().abandon(end)

    def _poll(self) -> None:
        if self.job() is None:
            self.context.cancel()
        now = time.monotonic()
        if self.thread.is_alive() and now - self.progress_at > TOLD:
            self.progress_at = now
            self.progress(self.context.progress)
        super()._poll()

    def _finish(self, result: Any, error: BaseException | None) -> None:
        self.folder.cleanup()
        simulation = None
        if error is None:
            try:
                simulation = self._store(result)
            except Exception as problem:
                error = problem
        self.ended(simulation, error)

    def _store(self, outcome: Any) -> Any:
        result, files = outcome
        job = self.job()
        if job is None:
            raise Cancelled(translate("BeltGrinding", "the job was removed while it ran"))

        def write() -> DocumentObject:
            simulation = api.store_result(job, result, self.fingerprint, files)
            if self.then is not None:
                self.then(job)
            return simulation

        try:
            return self._in_one_step("Simulate", write)
        finally:
            deviation.forget_prepared()

    def _store_in(
        self, name: str, step: str, store: Callable[[DocumentObject, DocumentObject], object]
    ) -> None:
        """``store(job, obj)`` for the object called ``name`` that is made out of a run, in one undo step."""
        job = self.job()
        obj: DocumentObject = None if job is None else self.document.getObject(name)
        if obj is None:
            raise Cancelled(translate("BeltGrinding", "the job was removed while it ran"))

        def write() -> None:
            store(job, obj)
            obj.Proxy.update(obj)  # an input may have changed while it ran

        self._in_one_step(step, write)

    def _in_one_step(self, name: str, write: Callable[[], Any]) -> Any:
        self.document.openTransaction(name)
        try:
            made = write()
            commit(self.document)
            return made
        except BaseException:
            abort(self.document)
            raise
