"""Plans a job in a thread of its own, polled by the window."""

from __future__ import annotations

from typing import Any

from ...objects import plan as planned
from ...objects.kinds import DocumentObject
from .compat import translate
from .kinds import Context, Done, Told
from .runner import Runner


def words() -> dict[str, str]:
    """``pictures.WORDS`` in the window's language."""
    return {
        "before": translate("BeltGrinding", "before"),
        "after": translate("BeltGrinding", "as planned"),
        "why": translate("BeltGrinding", "why it stays out of tolerance"),
        "no_motion": translate("BeltGrinding", "no motion removes anything there"),
        "no_room": translate("BeltGrinding", "the wheel does not fit there"),
        "fringe": translate("BeltGrinding", "beside what no motion reaches"),
        "border": translate("BeltGrinding", "along the border of the faces"),
        "slowest_feed": translate("BeltGrinding", "too much left at the least feed"),
        "fastest_feed": translate("BeltGrinding", "cut too deep at the greatest feed"),
        "pressure": translate("BeltGrinding", "too much left at the greatest pressure"),
        "change": translate("BeltGrinding", "feed or force may not change faster"),
        "kept": translate("BeltGrinding", "its motions must not be changed"),
        "shared": translate("BeltGrinding", "its motions also grind what needs the contrary"),
    }


class PlanRunner(Runner):
    """``done(plan.Found or None, error or None)`` follows in the end; ``rounds`` grows while it runs. The Plan
    object is written in one undo step, in the end. Raises InputError for what is missing."""

    def __init__(self, obj: DocumentObject, progress: Told, done: Done) -> None:
        self.plan, self.words = obj.Name, words()
        self.rounds: list[dict[str, Any]] = []  # as ``planning`` tells them
        self.enough = False  # whether the search is to end with the best so far
        job = obj.getParentGroup()
        self.task = planned.Work(obj, job)
        super().__init__(job, progress, done)

    def work(self, context: Context) -> planned.Found:
        told = self.rounds.append
        return self.task.find(self.data, context, told, self.words, lambda: self.enough)

    @property
    def searching(self) -> bool:
        """Whether it looks for other passes still."""
        return bool(self.task.search_s) and not (self.rounds and "change" not in self.rounds[-1])

    def _store(self, found: planned.Found) -> planned.Found:
        step = translate("BeltGrinding", "Plan")
        self._store_in(self.plan, step, lambda job, obj: planned.store(obj, job, found))
        return found
