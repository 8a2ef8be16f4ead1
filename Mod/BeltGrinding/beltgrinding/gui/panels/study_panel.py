"""Task panel of a study: what varies, which runs are made, progress while they run, and the way to the table."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ...base.kinds import known
from ...engine import InputError
from ...objects import job_data, study as studies, study_keys
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of
from ...studies import names
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Json, Widget
from ..common.messages import error_text
from ..common.report_language import words
from ..common.study_runner import StudyRunner
from ..common.transaction import commit
from ..widgets.best_form import BestForm
from ..widgets.correlation_rows import CorrelationRows
from ..widgets.fold import Fold, slim
from ..widgets.form import Form
from ..widgets.steady import steady
from ..widgets.varied_rows import VariedRows
from .run_panel import RunPanel

if TYPE_CHECKING:
    from ..common.runner import Runner

MOST_RUNS, MOST_SEED, MOST_WORKERS = 1_000_000, 2**31 - 1, 4096


class StudyPanel(RunPanel):
    """Settings go into the Study object as they are typed; the table and the answers are stored in it in the end."""

    runner: StudyRunner | None

    def __init__(self, obj: DocumentObject, open_table: Callable[[DocumentObject], object]) -> None:
        """``open_table(obj)`` shows the table and the charts."""
        super().__init__(
            obj.getParentGroup(), translate("BeltGrinding", "Study"), "BeltGrinding_Study"
        )
        self.obj, self.document, self.open_table = obj, obj.Document, open_table
        body = QtGui.QVBoxLayout(self.form)
        body.addWidget(self._varied())
        body.addWidget(self._correlated())
        body.addWidget(self._design())
        body.addWidget(self._best())
        row = QtGui.QHBoxLayout()
        self.begin = self._button("runStudy", translate("BeltGrinding", "Run"), self.start)
        self.table = self._button(
            "studyTable", translate("BeltGrinding", "Table and charts"), self.show_table
        )
        for button in (self.begin, self.cancel, self.table):
            row.addWidget(button)
        body.addLayout(row)
        body.addWidget(self.bar)
        body.addWidget(self.state)
        body.addStretch()
        slim(self.form)
        self.begin_made(obj)
        self._open()
        self._arrange(False)
        self.show(None)

    def _varied(self) -> Widget:
        box = QtGui.QGroupBox(translate("BeltGrinding", "What varies"))
        layout = QtGui.QVBoxLayout(box)
        self.choices = {one.key: one for one in study_keys.choices(self.job)}
        texts = {key: one.text for key, one in self.choices.items()}
        self.varied = VariedRows(self.obj.Proxy.settings(self.obj)["vary"], texts)
        self.varied.setToolTip(
            translate(
                "BeltGrinding",
                "= sets the value, + adds to the job's, × is a factor on it; numbers in the unit that the key ends "
                "with, blanks between them",
            )
        )
        self.varied.changed = self._changed
        layout.addWidget(self.varied)
        self.keys = steady(QtGui.QComboBox())
        self.keys.setObjectName("studyKeys")
        self.keys.setEditable(True)
        self.keys.setInsertPolicy(QtGui.QComboBox.NoInsert)
        self.keys.completer().setFilterMode(QtCore.Qt.MatchContains)
        self.keys.completer().setCompletionMode(QtGui.QCompleter.PopupCompletion)
        self.keys.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        self.keys.setMinimumContentsLength(12)
        for key, one in self.choices.items():
            self.keys.addItem(key, key)
            self.keys.setItemData(self.keys.count() - 1, one.text, QtCore.Qt.ToolTipRole)
        self.keys.setCurrentIndex(max(self.keys.findData("belt_machine.force_N"), 0))
        layout.addWidget(self.keys)
        layout.addWidget(self._button("addVaried", translate("BeltGrinding", "Add"), self.add))
        self.varied_box = box
        return box

    def _correlated(self) -> Fold:
        settings = self.obj.Proxy.settings(self.obj)
        self.entries = settings["vary"]  # of the last that could be
        names = [entry.get("name", entry["key"]) for entry in settings["vary"]]
        self.correlated = CorrelationRows(settings.get("correlations") or [], names)
        self.correlated.changed = self._changed
        self.correlated.check = self._check_correlated
        self.correlated_fold = Fold(
            "foldCorrelated",
            translate("BeltGrinding", "Correlations"),
            self.correlated,
            self.correlated.summary,
            folded=not self.correlated.rows,
        )
        return self.correlated_fold

    def _check_correlated(self, pairs: Sequence[Json]) -> None:
        studies.check_correlated(pairs, self.entries, self.obj.Method)

    def _design(self) -> Form:
        box = Form(self.obj, translate("BeltGrinding", "Runs"))
        box.add(
            "Method",
            translate("BeltGrinding", "Design"),
            {
                "latin_hypercube": translate("BeltGrinding", "Latin hypercube"),
                "sobol": translate("BeltGrinding", "Sobol sequence"),
                "monte_carlo": translate("BeltGrinding", "Monte Carlo"),
                "grid": translate("BeltGrinding", "grid"),
                "sobol_indices": translate("BeltGrinding", "blocks for Sobol indices"),
            },
        )
        box.add("Runs", translate("BeltGrinding", "Number")).setRange(1, MOST_RUNS)
        box.add("Seed", translate("BeltGrinding", "Seed")).setRange(0, MOST_SEED)
        workers = box.add("Workers", translate("BeltGrinding", "Side by side"))
        workers.setRange(0, MOST_WORKERS)
        workers.setSpecialValueText(translate("BeltGrinding", "one a core"))
        box.changed = self._changed
        self.design = box
        return box

    def _best(self) -> Fold:
        told = words()
        numbers = [name for name in names.NAMES if name != "overall"]
        for zone in job_data.zones(self.job):
            numbers += [
                f"zones.{zone['name']}.{last}" for last in names.OF_ZONE if last != "verdict"
            ]
        figures = {name: names.figure(name, told) for name in numbers}
        asked = self.obj.Proxy.settings(self.obj)["answers"]
        self.best = BestForm(asked.get("best"), figures)
        self.best.changed = self._changed
        folded = not asked.get("best")
        title = translate("BeltGrinding", "Best setting")
        self.best_fold = Fold("foldBest", title, self.best, self.best.summary, folded)
        return self.best_fold

    def add(self) -> None:
        """Adds the chosen key, with a first range around its value."""
        key = self.keys.currentText().strip()
        one = self.choices.get(key) or study_keys.Choice(key, key, None, None)
        entry = {"key": key}
        if one.choices:
            entry["values"] = one.choices
        else:
            entry["range"] = study_keys.spread(one)
        try:
            given = [*self.varied.entries(), entry]
            studies.check_varied(given)
        except InputError as error:
            self._tell(error)
            return
        self.varied.add(entry)
        self._changed()

    def doing(self) -> str:
        return translate("BeltGrinding", "Running, {}")

    def start(self) -> None:
        try:
            self._take()
        except InputError as error:
            self._arrange(False)
            self._tell(error)
            return
        self.document.recompute()
        super().start()
        if self.runner is not None:  # else something is missing, and the step goes on
            self._commit()

    def make_runner(self) -> Runner:
        self.design.check()
        return StudyRunner(self.obj, self.progress, self.done)

    def progress(self, share: float) -> None:
        super().progress(share)
        told = known(self.runner).told
        if told is None or not told.runs:
            return
        text = translate("BeltGrinding", "{} of {} runs").format(told.done, told.runs)
        if told.failed:
            text += translate("BeltGrinding", ", {} failed").format(told.failed)
        self._say(f"{text}\n{self.state.text()}")

    def done(self, found: Any, error: BaseException | None) -> None:
        super().done(found, error)
        if type_of(self.obj) == studies.Study.TYPE:
            self._open()

    def show(self, found: Any) -> None:
        """Says what the document has. ``found``: the ``study.Found``, if it was made just now."""
        self._arrange(False)
        obj = self.obj
        if not obj.Fingerprint:
            self._say(
                translate(
                    "BeltGrinding",
                    "The job is simulated many times, with other values of what varies. The job itself stays as it is.",
                )
            )
            return
        if found is not None and found.cancelled:
            text = translate(
                "BeltGrinding", "Cancelled: {} of {} runs are kept, Run goes on from there."
            )
            self._say(text.format(obj.RunsDone + obj.RunsFailed, obj.RunsInAll))
        else:
            self._tell_state()
        if found is not None:
            self.show_table()

    def _tell_state(self) -> None:
        obj = self.obj
        if obj.OutOfDate:
            self._say(
                translate("BeltGrinding", "Out of date: an input has changed since; run again."),
                True,
            )
            return
        lines = [
            translate("BeltGrinding", "{} of {} runs have figures.").format(
                obj.RunsDone, obj.RunsInAll
            )
        ]
        if obj.RunsFailed:
            text = translate("BeltGrinding", "{} could not be run; the table says why.")
            lines.append(text.format(obj.RunsFailed))
        if obj.Yield >= 0.0:
            text = translate("BeltGrinding", "{:.1f} % of the runs pass.")
            lines.append(text.format(obj.Yield))
        self._say("\n".join(lines))

    def show_table(self) -> None:
        self.open_table(self.obj)

    def _changed(self) -> None:
        try:
            self._take()
        except InputError as error:
            self._say(error_text(error), True)
            return
        self.obj.Proxy.update(self.obj)
        if self.obj.Fingerprint:
            self._tell_state()
        else:
            self.show(None)

    def _take(self) -> None:
        """What the panel holds into the object, all of it that is right. Raises InputError for the first that is not."""
        wrong = []
        for take in (self._take_varied, self._take_correlated, self._take_best):
            try:
                take()
            except InputError as error:
                wrong.append(error)
        if wrong:
            raise wrong[0]

    def _take_varied(self) -> None:
        entries = self.varied.entries()
        varied = studies.check_varied(entries)
        self._put("Vary", entries)
        self.entries = entries
        self.correlated.set_names([one.name for one in varied])

    def _take_correlated(self) -> None:
        self._put("Correlations", self.correlated.values())

    def _take_best(self) -> None:
        asked = {
            k: v for k, v in self.obj.Proxy.settings(self.obj)["answers"].items() if k != "best"
        }
        best = self.best.wanted()
        if best is not None:
            asked["best"] = best
        self._put("Asked", asked)

    def _put(self, name: str, value: Any) -> None:
        """Sets a property of JSON, if that is another value."""
        held, text = getattr(self.obj, name), json.dumps(value, allow_nan=False) if value else ""
        if (json.dumps(json.loads(held), allow_nan=False) if held else "") != text:
            setattr(self.obj, name, text)

    def _open(self) -> None:
        if not self.document.HasPendingTransaction:
            self.document.openTransaction(translate("BeltGrinding", "Settings of the study"))

    def _commit(self) -> None:
        commit(self.document)

    def _arrange(self, running: bool) -> None:
        super()._arrange(running)
        self.begin.setVisible(not running)
        self.table.setVisible(not running and bool(self.obj.Fingerprint))
        for widget in (self.varied_box, self.correlated_fold, self.design, self.best_fold):
            widget.setEnabled(not running)

    def reject(self) -> bool:
        if self.end_made():
            return super().reject()
        self._commit()
        self.document.recompute()
        return super().reject()
