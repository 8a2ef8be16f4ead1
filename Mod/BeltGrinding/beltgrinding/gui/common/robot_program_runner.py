"""Plans a job's program for the whole robot in a thread of its own, polled by the window."""

from __future__ import annotations

from ...objects import robot_program
from ...objects.kinds import DocumentObject
from .compat import translate
from .kinds import Context, Done, Told
from .runner import Runner


class RobotProgramRunner(Runner):
    """``done(robot_program.Found or None, error or None)`` follows in the end. The RobotProgram object is written in one
    undo step, in the end. Raises InputError for what is missing."""

    def __init__(self, obj: DocumentObject, progress: Told, done: Done) -> None:
        self.made = obj.Name
        super().__init__(obj.getParentGroup(), progress, done)

    def work(self, context: Context) -> robot_program.Found:
        return robot_program.find(self.data, context)

    def _store(self, found: robot_program.Found) -> robot_program.Found:
        step = translate("BeltGrinding", "Plan robot program")
        self._store_in(self.made, step, lambda job, obj: robot_program.store(obj, job, found))
        return found
