"""Task panel of a belt plan: parts and costs, progress, then when to change the belt, as figures and a chart."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

from ...base.kinds import known
from ...engine import Cancelled, InputError
from ...objects import preferences
from ...objects.kinds import DocumentObject
from ...planning import belt_chart, belt_loading, belt_plan
from ..common.compat import QtCore, QtGui, translate
from ..common.kinds import Context, Done, Json, Told, Widget
from ..common.messages import error_text
from ..common.runner import Runner
from ..widgets.picture_label import PictureLabel
from ..widgets.steady import steady
from .run_panel import RunPanel

PREFERENCE = "BeltPlan"  # begins the names of what is kept from one time to the next
FIELD_WIDTH = 64  # pixels, least: label and field go side by side
SMALL = (440, 0.8)  # width and share of the chart in the panel, which shows it at half its size
LARGE = 0.9  # of the screen
FIRST_BELTS = 8  # that are told one by one


def words() -> dict[str, str]:
    """``belt_chart.WORDS`` in the window's language."""
    return {
        "title": translate("BeltGrinding", "{} parts, {} new belts, cost {:.2f}"),
        "cut": translate("BeltGrinding", "cut of the belt, %"),
        "pace": translate("BeltGrinding", "of the program's, %"),
        "feed": translate("BeltGrinding", "feed"),
        "force": translate("BeltGrinding", "force"),
        "cost": translate("BeltGrinding", "cost of the part"),
        "part": translate("BeltGrinding", "part; a new belt where the background changes"),
    }


class _Runner(Runner):
    """``done((BeltPlan, Costs) or None, error or None)`` follows; the document is not written."""

    def __init__(self, job: DocumentObject, wanted: Json, progress: Told, done: Done) -> None:
        self.wanted = wanted
        super().__init__(job, progress, done)

    def work(self, context: Context) -> tuple[Any, Any]:
        wanted = self.wanted
        part, _ = belt_plan.part_of(
            self.data, wanted["feed_min"], wanted["force_max"], wanted["follow"], context
        )
        costs = belt_plan.Costs(wanted["belt"], 60.0 * wanted["change"], wanted["minute"])
        between = belt_loading.Between(wanted["pause"], wanted["dress_every"], wanted["dress"])
        found = belt_plan.plan(self.data, part, costs, wanted["parts"], context, between)
        return found, costs

    def _store(self, found: Any) -> Any:
        if self.job() is None:
            raise Cancelled(translate("BeltGrinding", "the job was removed while it ran"))
        return found


class BeltPlanPanel(RunPanel):
    """Nothing of the job is changed; what was found is shown, and written into a folder if wanted."""

    def __init__(self, job: DocumentObject) -> None:
        super().__init__(job, translate("BeltGrinding", "Belt plan"), "BeltGrinding_BeltPlan")
        self.found: tuple[belt_plan.BeltPlan, belt_plan.Costs] | None = None
        body = QtGui.QVBoxLayout(self.form)
        about = QtGui.QLabel(
            translate(
                "BeltGrinding",
                "A worn belt cuts less: each part is ground slower, or pressed harder, so that it loses as much as with a "
                "fresh belt. When is a new belt cheaper?",
            )
        )
        about.setWordWrap(True)
        body.addWidget(about)
        self.fields = QtGui.QFormLayout()
        self.fields.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        body.addLayout(self.fields)
        self._rows()
        row = QtGui.QHBoxLayout()
        self.begin = self._button("planBelts", translate("BeltGrinding", "Plan"), self.start)
        self.save = self._button("saveBelts", translate("BeltGrinding", "Save..."), self.write)
        for button in (self.begin, self.cancel, self.save):
            row.addWidget(button)
        body.addLayout(row)
        body.addWidget(self.bar)
        body.addWidget(self.state)
        self.chart = PictureLabel("beltChart", self.enlarge)
        self.chart.hide()
        body.addWidget(self.chart)
        body.addStretch()
        self._arrange(False)
        self._show_follow()

    def _rows(self) -> None:
        self.parts = self._number("parts", translate("BeltGrinding", "Parts"), 500, 1, 100_000, 0)
        self.belt = self._number("beltCost", translate("BeltGrinding", "Cost of a belt"), 10.0)
        self.change = self._number(
            "changeTime", translate("BeltGrinding", "Changing it, min"), 3.0, decimals=2
        )
        self.minute = self._number(
            "minuteCost", translate("BeltGrinding", "Cost of a minute"), 1.5, decimals=3
        )
        self.follow = steady(QtGui.QComboBox())
        self.follow.setObjectName("follow")
        for key, text in (
            ("feed", translate("BeltGrinding", "feed")),
            ("force", translate("BeltGrinding", "force")),
            ("both", translate("BeltGrinding", "force, then feed")),
        ):
            self.follow.addItem(text, key)
        kept = preferences.parameters().GetString(PREFERENCE + "follow", "feed")
        _narrow(self.follow)
        self.follow.setCurrentIndex(max(self.follow.findData(kept), 0))
        self.follow.currentIndexChanged.connect(lambda _: self._show_follow())
        self.fields.addRow(translate("BeltGrinding", "Follows the wear"), self.follow)
        self.feed_min = self._number(
            "feedMin", translate("BeltGrinding", "Least feed, mm/s"), 3.0, least=1e-3, decimals=3
        )
        self.force_max = self._number(
            "forceMax", translate("BeltGrinding", "Greatest force, N"), 100.0, least=1e-3
        )
        self.pause = self._number("pause", translate("BeltGrinding", "Pause between parts, s"), 0.0)
        self.dress_every = self._number(
            "dressEvery",
            translate("BeltGrinding", "Dressed every (parts; 0: never)"),
            0,
            decimals=0,
        )
        self.dress = self._number("dressTime", translate("BeltGrinding", "Dressing it, s"), 0.0)

    def _number(
        self,
        name: str,
        text: str,
        value: float,
        least: float = 0.0,
        most: float = 1e9,
        decimals: int = 2,
    ) -> Widget:
        spin = steady(QtGui.QDoubleSpinBox() if decimals else QtGui.QSpinBox())
        spin.setObjectName(name)
        if decimals:
            spin.setDecimals(decimals)
            value = preferences.parameters().GetFloat(PREFERENCE + name, value)
        else:
            value = preferences.parameters().GetInt(PREFERENCE + name, value)
        spin.setRange(least, most)
        spin.setValue(value)
        spin.setKeyboardTracking(False)
        _narrow(spin)
        self.fields.addRow(text, spin)
        return spin

    def _show_follow(self) -> None:
        key = self.follow.currentData()
        shows = [(self.feed_min, key != "force"), (self.force_max, key != "feed")]
        shows += [(spin, self._loads()) for spin in (self.pause, self.dress_every, self.dress)]
        for spin, shown in shows:
            spin.setVisible(shown)
            self.fields.labelForField(spin).setVisible(shown)

    def _loads(self) -> bool:
        return bool(self.job.LoadingShare > 0.0)

    def doing(self) -> str:
        return translate("BeltGrinding", "Planning, {}")

    def make_runner(self) -> Runner:
        kept = preferences.parameters()
        for spin in self.form.findChildren(QtGui.QDoubleSpinBox):
            spin.interpretText()
            kept.SetFloat(PREFERENCE + spin.objectName(), spin.value())
        for spin in (self.parts, self.dress_every):
            spin.interpretText()
            kept.SetInt(PREFERENCE + spin.objectName(), spin.value())
        kept.SetString(PREFERENCE + "follow", self.follow.currentData())
        follow = self.follow.currentData()
        wanted = {
            "parts": self.parts.value(),
            "belt": self.belt.value(),
            "change": self.change.value(),
            "minute": self.minute.value(),
            "follow": follow,
            "feed_min": self.feed_min.value(),
            "force_max": self.force_max.value() if follow != "feed" else 0.0,
            "pause": self.pause.value() if self._loads() else 0.0,
            "dress_every": self.dress_every.value() if self._loads() else 0,
            "dress": self.dress.value() if self._loads() else 0.0,
        }
        self.found = None
        return _Runner(self.job, wanted, self.progress, self.done)

    def show(self, found: Any) -> None:
        """Shows what was found: (BeltPlan, Costs)."""
        self.found = found
        plan, costs = found
        data = belt_plan.summary(plan, costs)
        belts = [str(count) for count in data["parts_per_belt"][:FIRST_BELTS]]
        if len(data["parts_per_belt"]) > FIRST_BELTS:
            belts.append("...")
        lines = [
            translate("BeltGrinding", "New belts: {}; parts on each belt: {}").format(
                data["new_belts"], ", ".join(belts)
            ),
            translate("BeltGrinding", "A part costs {:.3f}, the batch {:.2f}; {:.1f} h").format(
                data["cost_per_part"], data["cost"], data["seconds"] / 3600.0
            ),
            translate("BeltGrinding", "With every belt as long as it can: {:.2f}").format(
                data["cost_until_worn_out"]
            ),
        ]
        if data["parts_beyond_measured_wear"]:
            text = translate(
                "BeltGrinding",
                "{} parts are ground by belts that have done more than their wear was measured for",
            )
            lines.append(text.format(data["parts_beyond_measured_wear"]))
        self._say("\n".join(lines))
        small = {**words(), "title": ""}
        self.chart.show_bytes(belt_chart.draw(plan, small, *SMALL))
        self._arrange(False)

    def enlarge(self) -> None:
        """The chart in a window of its own."""
        if self.found is None:
            return
        window = QtGui.QDialog(Gui.getMainWindow())
        window.setObjectName("beltPlanWindow")
        window.setWindowTitle(self.form.windowTitle())
        window.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        label, pixmap = QtGui.QLabel(), QtGui.QPixmap()
        pixmap.loadFromData(belt_chart.draw(self.found[0], words()))
        room = LARGE * Gui.getMainWindow().screen().availableGeometry().size()
        if pixmap.width() > room.width() or pixmap.height() > room.height():
            pixmap = pixmap.scaled(room, QtCore.Qt.KeepAspectRatio, QtCore.Qt.SmoothTransformation)
        label.setPixmap(pixmap)
        QtGui.QVBoxLayout(window).addWidget(label)
        window.show()

    def write(self) -> None:
        """Figures, a line a part and the chart, into a folder."""
        title = translate("BeltGrinding", "Folder for the belt plan")
        folder = QtGui.QFileDialog.getExistingDirectory(Gui.getMainWindow(), title)
        if not folder:
            return
        try:
            plan, costs = known(self.found)
            belt_plan.write(plan, costs, folder, words(), replace=False)
        except InputError as error:
            self._say(error_text(error), True)
            return
        files = ", ".join(belt_plan.FILES)
        self._say(translate("BeltGrinding", "Written into {}: {}").format(folder, files))

    def _arrange(self, running: bool) -> None:
        super()._arrange(running)
        self.begin.setVisible(not running)
        self.save.setVisible(not running)
        self.save.setEnabled(self.found is not None)
        self.chart.setVisible(not running and self.found is not None)
        for k in range(self.fields.count()):
            self.fields.itemAt(k).widget().setEnabled(not running)


def _narrow(field: Widget) -> None:
    field.setMinimumWidth(FIELD_WIDTH)
    field.setSizePolicy(QtGui.QSizePolicy.Ignored, QtGui.QSizePolicy.Fixed)
