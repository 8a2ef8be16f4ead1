"""Task panel of a plan: its limits, its rounds while it runs, before and after, and Apply."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import FreeCADGui as Gui

from ...base.kinds import known
from ...engine import InputError
from ...objects import api, plan as planned
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of
from ...objects.deviation import Deviation
from ...objects.job_data import child
from ..charts.feed_chart import FeedChart
from ..common.compat import QtGui, translate
from ..common.figures import figure
from ..common.kinds import Widget
from ..common.messages import error_text
from ..common.plan_runner import PlanRunner, words
from ..common.transaction import commit, transaction
from ..common.task_panel import show_panel
from ..widgets import kept_motions
from ..widgets.fold import Fold, slim
from ..widgets.form import Form
from .plan_figures import PlanFigures
from .run_panel import RunPanel
from .simulation_panel import lay_deviation

if TYPE_CHECKING:
    from ..common.runner import Runner


MOST_SECONDS = 86_400  # of a search


class PlanPanel(RunPanel):
    """Settings go into the Plan object as they are typed; what was found is shown, and goes into the paths by
    Apply."""

    runner: PlanRunner | None

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(
            obj.getParentGroup(), translate("BeltGrinding", "Plan"), "BeltGrinding_Plan"
        )
        self.obj, self.document, self.found = obj, obj.Document, None
        body = QtGui.QVBoxLayout(self.form)
        body.addWidget(self._limits())
        body.addWidget(self._changes())
        body.addWidget(self._rounds())
        row = QtGui.QHBoxLayout()
        self.begin = self._button("plan", translate("BeltGrinding", "Plan"), self.start)
        row.addWidget(self.begin)
        self.enough = self._button(
            "enough", translate("BeltGrinding", "Take the best so far"), self._take_best
        )
        row.addWidget(self.enough)
        row.addWidget(self.cancel)
        body.addLayout(row)
        body.addWidget(self.bar)
        body.addWidget(self.state)
        self.apply = self._button("apply", translate("BeltGrinding", "Apply"), self.put_in)
        self.write = self._button(
            "writePrograms", translate("BeltGrinding", "Write programs..."), self.write_programs
        )
        row = QtGui.QHBoxLayout()
        for button in (self.apply, self.write):
            row.addWidget(button)
        body.addLayout(row)
        self.figures = PlanFigures(words())
        body.addWidget(self.figures)
        self.chart = FeedChart()
        self.chart.changed = self._choose
        body.addWidget(self.chart)
        self.keep = self._button(
            "keepChosen", translate("BeltGrinding", "Leave these as they are"), self._keep_chosen
        )
        body.addWidget(self.keep)
        body.addStretch()
        slim(self.form)
        self.begin_made(obj)
        obj.ViewObject.Visibility = True
        self._open()
        self._enable()
        self.show(None)

    def _limits(self) -> Widget:
        box = Form(self.obj, translate("BeltGrinding", "Limits"))
        goals = {
            "tolerance": translate("BeltGrinding", "most in tolerance"),
            "time": translate("BeltGrinding", "shortest time"),
        }
        box.add("Goal", translate("BeltGrinding", "Goal"), goals)
        box.add("WantedShare", translate("BeltGrinding", "In tolerance, share"))
        box.add("Probability", translate("BeltGrinding", "Probability"))
        box.add("PlacementDeviation", translate("BeltGrinding", "Placement, std. dev."))
        box.add("FeedMin", translate("BeltGrinding", "Least feed"))
        box.add("FeedMax", translate("BeltGrinding", "Greatest feed"))
        if self.obj.getParentGroup() is not None and self._by_force():
            box.add("ForceMin", translate("BeltGrinding", "Least force"))
            box.add("ForceMax", translate("BeltGrinding", "Greatest force"))
        if self._has_passes():
            box.add("LayPasses", translate("BeltGrinding", "Lay the passes anew"))
            seconds = box.add("SearchSeconds", translate("BeltGrinding", "Search, at most"))
            seconds.setMaximum(MOST_SECONDS)
            seconds.setSuffix(" s")
            seconds.setSpecialValueText(translate("BeltGrinding", "by rules alone"))
        levels = box.add("Levels", translate("BeltGrinding", "Different feeds"))
        levels.setMaximum(10_000)
        levels.setSpecialValueText(translate("BeltGrinding", "any number"))
        self.kept = QtGui.QLineEdit(kept_motions.text(self.obj.Proxy.settings(self.obj)["keep"]))
        self.kept.setObjectName("keep")
        self.kept.setPlaceholderText(translate("BeltGrinding", "none, or as 12-40, 2:7"))
        self.kept.setToolTip(
            translate(
                "BeltGrinding",
                "motions that keep their feed: lines of the program or, of paths made here, poses; of the "
                "second program as 2:7-9",
            )
        )
        self.kept.textChanged.connect(lambda _: self._keep())
        box.layout_.addRow(translate("BeltGrinding", "Motions that stay"), self.kept)
        box.changed = self._changed
        self.limits = box
        self._show_goal()
        return box

    def _show_goal(self) -> None:
        rows = set(self.limits.rows)
        if self.obj.Goal != "time" and not self.obj.Probability:
            rows.discard("WantedShare")
        if not self.obj.Probability:
            rows.discard("PlacementDeviation")
        if not self.obj.LayPasses:
            rows.discard("SearchSeconds")
        self.limits.show_rows(rows)

    def _changes(self) -> Fold:
        box = Form(self.obj, "")
        timings = {
            "robot": translate("BeltGrinding", "the robot's"),
            "job": translate("BeltGrinding", "as the job says"),
        }
        box.add("Timing", translate("BeltGrinding", "Time law"), timings)
        box.add("FeedChange", translate("BeltGrinding", "Change of feed, mm/s per mm"))
        box.add("Acceleration", translate("BeltGrinding", "Acceleration"))
        if self.obj.getParentGroup() is not None and self._by_force():
            box.add("ForceChange", translate("BeltGrinding", "Change of force, N/s"))
            box.add("PressureMax", translate("BeltGrinding", "Greatest pressure"))
            box.add("HeatMax", translate("BeltGrinding", "Pressure × belt speed, MPa·m/s"))
        box.changed = self._changed
        self.changes = box
        return Fold(
            "foldChanges", translate("BeltGrinding", "Change, pressure, heat"), box, folded=True
        )

    def _has_passes(self) -> bool:
        try:
            return planned.passes_of(self.job) is not None
        except InputError:
            return False

    def _other_force(self) -> str:
        """A line that tells the one force of passes that were planned for another than the belt machine's."""
        from ...objects.belt_machine import BeltMachine

        machine = child(self.job, BeltMachine)
        force = json.loads(self.obj.Raster)["force_N"] if self.obj.Raster else 0.0
        if machine is None or not force or abs(machine.Force.getValueAs("N").Value - force) < 1e-6:
            return ""
        told = translate(
            "BeltGrinding", "The passes are planned for {} N: set them by hand on the belt machine."
        )
        return "\n" + told.format(figure(force, ".4g"))

    def _by_force(self) -> bool:
        from ...objects.belt_machine import BeltMachine

        machine = child(self.job, BeltMachine)
        return machine is None or machine.Control == "force"

    def _rounds(self) -> Fold:
        box = Form(self.obj, "")
        box.add("Rounds", translate("BeltGrinding", "Rounds, at most"))
        resolutions = {
            "full": translate("BeltGrinding", "full"),
            "coarse": translate("BeltGrinding", "coarse"),
        }
        box.add(
            "SearchResolution", translate("BeltGrinding", "Resolution of the search"), resolutions
        )
        box.add("MostChange", translate("BeltGrinding", "Most change a round"))
        box.add("LeastGain", translate("BeltGrinding", "Least gain of a round"))
        box.add("Smoothing", translate("BeltGrinding", "Smoothing"))
        box.add("Check", translate("BeltGrinding", "Check at half the spacing"))
        box.changed = self._changed
        self.rounds = box
        self.fold = Fold("foldRounds", translate("BeltGrinding", "Rounds"), box, folded=True)
        return self.fold

    def doing(self) -> str:
        return translate("BeltGrinding", "Planning, {}")

    def start(self) -> None:
        self.fold.fold(True)
        self.found = None
        self.document.recompute()
        super().start()
        if self.runner is not None:  # else something is missing, and the step goes on
            self._commit()

    def make_runner(self) -> Runner:
        for form in (self.limits, self.changes, self.rounds):
            form.check()
        self._check_kept()
        return PlanRunner(self.obj, self.progress, self.done)

    def progress(self, share: float) -> None:
        super().progress(share)
        runner = known(self.runner)
        self.figures.show_rounds(runner.rounds)
        self.enough.setVisible(runner.searching)

    def _take_best(self) -> None:
        known(self.runner).enough = True
        self.enough.setEnabled(False)

    def done(self, found: Any, error: BaseException | None) -> None:
        super().done(found, error)
        if type_of(self.obj) == planned.Plan.TYPE:
            self._open()

    def show(self, found: Any) -> None:
        """Shows the plan that the document has. ``found``: the ``plan.Found``, if it was made just now."""
        self.found = found
        self._arrange(False)
        obj = self.obj
        if not obj.Fingerprint:
            self._say(
                translate(
                    "BeltGrinding",
                    "The job is simulated, its feeds are changed, and it is simulated again, a few rounds of that. "
                    "The programs stay as they are until you apply the plan.",
                )
            )
            return
        self.figures.show_plan(obj)
        self.chart.show_plan(obj)
        self._tell_state()

    def _tell_state(self) -> None:
        obj = self.obj
        if obj.OutOfDate:
            text = translate("BeltGrinding", "Out of date: an input has changed since; plan again.")
        elif obj.Applied:
            text = translate("BeltGrinding", "The programs have these feeds.")
        elif not obj.Better:
            text = translate(
                "BeltGrinding", "Nothing better was found: the feeds stay as they are."
            )
        else:
            text = translate("BeltGrinding", "{:.1f} % in tolerance as planned; {:.1f} % before.")
            text = text.format(obj.InTolerance, obj.InToleranceBefore)
        beyond = (obj.Proxy.data(obj) or {}).get("beyond_limits", {}).get("after", 0)
        if beyond:
            more = translate(
                "BeltGrinding",
                "At {} places feed or force change faster than they may: the program's own steps, or motions that stay.",
            )
            text += "\n" + more.format(beyond)
        text += self._other_force()
        self._say(text, obj.OutOfDate)
        self._enable()

    def put_in(self) -> None:
        """Apply: feeds and forces into the paths, and the planned result into the job, as one undo step."""
        self._commit()
        made = child(self.job, Deviation) is None
        with transaction(self.document, translate("BeltGrinding", "Apply plan")) as step:
            found = self.found
            if found is None:
                api.apply_plan(self.obj)
            else:
                api.apply_plan(self.obj, found.result, found.ground)
            if found is not None and made:
                lay_deviation(self.job)
        self._open()
        if not step.failed:
            self._tell_state()

    def write_programs(self) -> None:
        """The programs' files with the planned feeds, into a folder."""
        title = translate("BeltGrinding", "Folder for the planned programs")
        folder = QtGui.QFileDialog.getExistingDirectory(Gui.getMainWindow(), title)
        if not folder:
            return
        try:
            files, without = api.write_plan(self.obj, folder)
        except InputError as error:
            self._say(error_text(error), True)
            return
        told = [translate("BeltGrinding", "Written: {}").format(Path(file)) for file in files]
        if without:
            text = translate(
                "BeltGrinding", "Made here, so apply the plan and export the program: {}"
            )
            told.append(text.format(", ".join(without)))
        self._say("\n".join(told))

    def _changed(self) -> None:
        self._show_goal()
        self.obj.Proxy.update(self.obj)
        if self.obj.Fingerprint:
            self._tell_state()

    def _keep(self) -> None:
        try:
            wanted = kept_motions.parsed(self.kept.text(), planned.sources(self.job))
        except InputError:
            self.kept.setStyleSheet("border: 2px solid #b3261e;")
            return
        self.kept.setStyleSheet("")
        self.obj.Keep = kept_motions.stored(wanted)
        self._changed()

    def _check_kept(self) -> None:
        kept_motions.parsed(self.kept.text(), planned.sources(self.job))

    def _choose(self) -> None:
        self._enable()

    def _keep_chosen(self) -> None:
        """Adds the motions that are chosen in the chart to those that stay."""
        added = kept_motions.of_chart(self.chart, planned.sources(self.job))
        self.kept.setText(", ".join(filter(None, [self.kept.text().strip(), added])))

    def _open(self) -> None:
        if not self.document.HasPendingTransaction:
            self.document.openTransaction(translate("BeltGrinding", "Settings of the plan"))

    def _commit(self) -> None:
        commit(self.document)

    def _arrange(self, running: bool) -> None:
        super()._arrange(running)
        self.begin.setVisible(not running)
        self.enough.setVisible(running and self.runner is not None and self.runner.searching)
        self.enough.setEnabled(True)
        for widget in (self.limits, self.changes, self.rounds):
            widget.setEnabled(not running)
        there = bool(self.obj.Fingerprint)
        self.figures.setVisible(running or there)
        if running:
            self.figures.clear()
        for widget in (self.chart, self.apply, self.write):
            widget.setVisible(there and not running)
        self._enable()

    def _enable(self) -> None:
        obj, there = self.obj, bool(self.obj.Fingerprint)
        useful = there and obj.Better and not obj.OutOfDate
        self.apply.setEnabled(useful and not obj.Applied)
        why = self._why_not_written()
        self.write.setEnabled(not why)
        self.write.setToolTip(why)
        self.keep.setVisible(
            there and self.chart.isVisibleTo(self.form) and self.chart.chosen is not None
        )

    def _why_not_written(self) -> str:
        """Why no programs can be written; "" where they can."""
        obj = self.obj
        if not obj.Fingerprint or obj.OutOfDate:
            return translate("BeltGrinding", "Plan first: there is no plan that is up to date.")
        if not obj.Better:
            return translate("BeltGrinding", "Nothing better was found: there is nothing to write.")
        if not any(planned.sources(self.job)):
            return translate(
                "BeltGrinding",
                "The job has no imported program. Apply the plan, and export the paths that were made here.",
            )
        return ""

    def reject(self) -> bool:
        if self.end_made():
            return super().reject()
        self._commit()
        self.obj.ViewObject.Visibility = False  # the colours of its reasons go with their words
        self.document.recompute()
        return super().reject()


def show(obj: DocumentObject) -> None:
    """Opens the panel of a Plan object."""
    if obj.getParentGroup() is not None and not Gui.Control.activeDialog():
        show_panel(PlanPanel(obj), obj)
