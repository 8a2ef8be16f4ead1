"""Runs a job's simulation in a thread of its own, polled by the window."""

import threading
import time

from .. import Cancelled, RunContext, job as jobs
from ..objects import api, job_object
from .compat import QtCore, translate

POLL = 50  # ms


class Runner(QtCore.QObject):
    """One run. The job's data are collected here and now (raises InputError); the document is
    written only in the end, on the window's thread, in one undo transaction.

    progress(share): called while it runs; done(simulation or None, error or None): in the end.
    """

    def __init__(self, job, progress, done):
        super().__init__()
        self.document, self.name = job.Document, job.Name
        self.progress, self.done = progress, done
        self.folder = job_object.scratch_folder()
        self.data = job_object.to_data(job, self.folder.name)
        self.fingerprint = job_object.fingerprint(job)
        self.context = RunContext()
        self.result = self.error = None
        self.start = time.monotonic()
        self.thread = threading.Thread(target=self._work, daemon=True)
        self.thread.start()
        self.timer = QtCore.QTimer(self)
        self.timer.timeout.connect(self._poll)
        self.timer.start(POLL)

    def cancel(self):
        """Asks the run to end; ``done`` follows with Cancelled."""
        self.context.cancel()

    def _work(self):
        try:
            self.result = jobs.run(self.data, self.context)
        except BaseException as error:  # handed to the window's thread
            self.error = error

    def job(self):
        """The job, or None if it or its document is no longer there."""
        try:
            return self.document.getObject(self.name)
        except ReferenceError:
            return None

    def _poll(self):
        if self.job() is None:
            self.context.cancel()
        if self.thread.is_alive():
            self.progress(self.context.progress)
            return
        self.timer.stop()
        self.folder.cleanup()
        simulation = None
        if self.error is None:
            try:
                simulation = self._store()
            except Exception as error:
                self.error = error
        self.done(simulation, self.error)

    def _store(self):
        job = self.job()
        if job is None:
            raise Cancelled(translate("BeltGrinding", "the job was removed while it ran"))
        self.document.openTransaction("Simulate")
        try:
            simulation = api.store_result(job, self.result, self.fingerprint)
            self.document.commitTransaction()
            return simulation
        except BaseException:
            self.document.abortTransaction()
            raise
