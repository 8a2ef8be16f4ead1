"""Playback: a dock under the 3D view that shows a recorded simulation at any moment."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Mapping
from typing import Any

import FreeCAD
import FreeCADGui as Gui

from ...base.kinds import known
from ...engine import Cancelled, InputError, core
from ...objects import job_data, waiting
from ...objects.kinds import Document, DocumentObject
from ...objects.living import named
from ...objects.simulation import KEEP, Simulation, lost_recording
from ..charts.strip_chart import StripChart
from ..common.compat import QtCore, QtGui, translate
from ..common.help_pages import helped
from ..common.icons import media_icon
from ..common.kinds import Array, QtEvent, Widget
from ..common.messages import error_text
from ..common.runner import Runner
from ..common.theme import warning_style
from ..common.transaction import transaction
from ..scene.playback_scene import SAME, Scene
from ..widgets.steady import steady

SPEEDS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)  # of the real time
BUTTON = 28  # pixels of the icons of its buttons
TICK = 40  # ms between two pictures
PARTS = 100_000  # of the slider
SCALE = ("ToleranceLower", "ToleranceUpper", "ColourLimit", "Bands", "Shown")  # of a Deviation


class Playback(QtGui.QDockWidget):
    """Plays the simulation of a job. It changes no property of the document."""

    def __init__(self, job: DocumentObject) -> None:
        super().__init__(translate("BeltGrinding", "Playback"), Gui.getMainWindow())
        self.setObjectName("BeltGrinding_PlaybackDock")
        helped(self, "BeltGrinding_Playback")
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        self.document, self.name = job.Document, job.Name
        self.scene: Scene | None = None
        self.runner: Runner | None = None
        self.waiting: set[str] = set()  # what is to be done once FreeCAD has done its own
        self.clock = QtCore.QTimer(self)
        self.clock.setInterval(TICK)
        self.clock.timeout.connect(self._tick)
        self.show_result()
        FreeCAD.addDocumentObserver(self)
        self.watching = True

    def job(self) -> DocumentObject | None:
        """The job, or None if it or its document is no longer there."""
        return named(self.document, self.name)

    def show_result(self) -> None:
        """Shows the job's recording, or offers to make one."""
        self._clear()
        job = self.job()
        if job is None:
            self.close()
            return
        simulation = job_data.child(job, Simulation)
        try:
            found = None if simulation is None else _read(simulation)
        except Cancelled:
            self.setWidget(self._offer(simulation))
            self.state.setText(translate("BeltGrinding", "Cancelled."))
            return
        if found is None:
            self.setWidget(self._offer(simulation))
            return
        try:
            self.scene = Scene(job, simulation, *found)
        except InputError as error:
            self.setWidget(self._offer(simulation))
            self.state.setText(error_text(error))
            return
        self.setWidget(self._controls(simulation, found[1], self.scene))
        self.go(0.0)

    def _offer(self, simulation: DocumentObject) -> Widget:
        """What is there without a recording."""
        panel = QtGui.QWidget()
        body = QtGui.QVBoxLayout(panel)
        self.state = QtGui.QLabel(_without_recording(simulation))
        self.state.setWordWrap(True)
        self.bar = QtGui.QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.hide()
        self.record = QtGui.QPushButton(translate("BeltGrinding", "Simulate with recording"))
        self.record.setObjectName("record")
        self.record.clicked.connect(self.simulate)
        self.cancel = QtGui.QPushButton(translate("BeltGrinding", "Cancel"))
        self.cancel.setObjectName("cancelRecording")
        self.cancel.clicked.connect(lambda *_: self._stop())
        self.cancel.hide()
        row = QtGui.QHBoxLayout()
        for widget in (self.record, self.bar, self.cancel):
            row.addWidget(widget)
        row.addStretch()
        body.addWidget(self.state)
        body.addLayout(row)
        body.addStretch()
        return panel

    def simulate(self) -> None:
        """Simulates with a recording, in the background."""
        try:
            self.runner = Runner(self.job(), self._progress, self._simulated, core.Recording())
        except InputError as error:
            self.state.setText(error_text(error))
            return
        self.record.hide()
        self.bar.show()
        self.cancel.show()

    def _stop(self) -> None:
        if self.runner is not None:
            self.runner.cancel()

    def _progress(self, share: float) -> None:
        self.bar.setValue(int(1000 * share))

    def _simulated(self, simulation: DocumentObject, error: BaseException | None) -> None:
        self.runner = None
        if self.job() is None:
            self.close()
        elif error is None:
            self.show_result()
        else:
            if not isinstance(error, (InputError, Cancelled)):
                lines = traceback.format_exception(type(error), error, error.__traceback__)
                FreeCAD.Console.PrintError("".join(lines))
            self.setWidget(self._offer(job_data.child(self.job(), Simulation)))
            cancelled = isinstance(error, Cancelled)
            self.state.setText(
                translate("BeltGrinding", "Cancelled.") if cancelled else error_text(error)
            )

    def _controls(
        self, simulation: DocumentObject, steps: Mapping[str, Array], scene: Scene
    ) -> Widget:
        panel = QtGui.QWidget()
        body = QtGui.QVBoxLayout(panel)
        row = QtGui.QHBoxLayout()

        def button(name: str, picture: str, text: str, action: Callable[..., object]) -> Widget:
            made = QtGui.QToolButton()
            made.setObjectName(name)
            made.setIcon(media_icon(picture))
            made.setIconSize(QtCore.QSize(BUTTON, BUTTON))
            made.setAutoRaise(True)
            made.setToolTip(text)
            made.clicked.connect(lambda *_: action())
            row.addWidget(made)
            return made

        text = translate("BeltGrinding", "To the begin")
        button("begin", "begin", text, lambda: self.scrub(0.0))
        text = translate("BeltGrinding", "Previous event")
        button("previousEvent", "previous", text, lambda: self.step(-1))
        text = translate("BeltGrinding", "Play or pause")
        self.play_button = button("play", "play", text, self.toggle)
        text = translate("BeltGrinding", "Next event")
        button("nextEvent", "next", text, lambda: self.step(1))
        text = translate("BeltGrinding", "To the end")
        button("end", "end", text, lambda: self.scrub(scene.duration))
        self.speed = steady(QtGui.QComboBox())
        self.speed.setObjectName("speed")
        self.speed.setToolTip(translate("BeltGrinding", "Speed, as a multiple of the real time"))
        for speed in SPEEDS:
            self.speed.addItem(f"{speed:g} ×", speed)
        self.speed.setCurrentIndex(SPEEDS.index(1.0))
        row.addWidget(self.speed)
        self.slider = steady(QtGui.QSlider(QtCore.Qt.Horizontal))
        self.slider.setObjectName("timeSlider")
        self.slider.setRange(0, PARTS)
        self.slider.valueChanged.connect(self._slid)
        row.addWidget(self.slider, 1)
        self.label = QtGui.QLabel()
        self.label.setObjectName("moment")
        row.addWidget(self.label)
        body.addLayout(row)
        row = QtGui.QHBoxLayout()
        self.moving = QtGui.QCheckBox(translate("BeltGrinding", "Show the cell as it moves"))
        self.moving.setObjectName("playbackMoves")
        self.moving.setEnabled(scene.cell.cell()["holding"] == "part_in_hand")
        self.moving.toggled.connect(scene.cell.set_moving)
        row.addWidget(self.moving)
        self.kept = QtGui.QCheckBox(translate("BeltGrinding", "Save with the document"))
        self.kept.setObjectName("playbackKept")
        self.kept.setToolTip(simulation.getDocumentationOfProperty(KEEP))
        self.kept.setChecked(getattr(simulation, KEEP))
        self.kept.toggled.connect(lambda on: _keep(simulation, on))
        row.addWidget(self.kept)
        self.events = simulation.Proxy.events(simulation)
        self.chart = StripChart(steps, self.events, scene.duration)
        self.chart.chosen = self.scrub
        choice = QtGui.QToolButton()
        choice.setText(translate("BeltGrinding", "Rows"))
        choice.setMenu(self.chart.menu)
        choice.setPopupMode(QtGui.QToolButton.InstantPopup)
        row.addWidget(choice)
        text = translate("BeltGrinding", "Out of date: an input has changed since; simulate again.")
        self.stale = QtGui.QLabel(text)
        self.stale.setObjectName("playbackOutOfDate")
        self.stale.setStyleSheet(warning_style())
        self.stale.setVisible(simulation.OutOfDate)
        row.addWidget(self.stale)
        row.addStretch()
        body.addLayout(row)
        body.addWidget(self.chart, 1)
        return panel

    def toggle(self) -> None:
        """Plays or pauses; from the end, plays from the begin."""
        if self.clock.isActive():
            self.pause()
            return
        scene = known(self.scene)
        if scene.time >= scene.duration - SAME:
            self.go(0.0)
        self.last = time.monotonic()
        self.clock.start()
        self.play_button.setIcon(media_icon("pause"))

    def pause(self) -> None:
        self.clock.stop()
        self.play_button.setIcon(media_icon("play"))

    def scrub(self, moment: float) -> None:
        """Goes to a moment by hand: a playback pauses."""
        self.pause()
        self.go(moment)

    def step(self, way: int) -> None:
        """Goes to the next event (``way`` 1) or to the one before (-1)."""
        times = sorted(event["time"] for event in self.events)
        now = known(self.scene).time
        if way > 0:
            found = [t for t in times if t > now + SAME][:1]
        else:
            found = [t for t in times if t < now - SAME][-1:]
        if found:
            self.scrub(found[0])

    def go(self, moment: float) -> None:
        """Shows the moment, s since the begin of the first program."""
        scene = known(self.scene)
        scene.go(moment)
        self.slider.blockSignals(True)
        self.slider.setValue(round(PARTS * scene.time / max(scene.duration, SAME)))
        self.slider.blockSignals(False)
        self.chart.set_time(scene.time)
        text = translate("BeltGrinding", "{:.2f} of {:.2f} s · {}, pose {}")
        label, pose, line = scene.place
        text = text.format(scene.time, scene.duration, label, pose + 1)
        if line:
            text += translate("BeltGrinding", ", line {}").format(line)
        self.label.setText(text)

    def _slid(self, value: int) -> None:
        self.scrub(known(self.scene).duration * value / PARTS)

    def _tick(self) -> None:
        if self.job() is None:
            self.close()
            return
        scene, now = known(self.scene), time.monotonic()
        moment = scene.time + (now - self.last) * self.speed.currentData()
        self.last = now
        self.go(moment)
        if moment >= scene.duration:
            self.pause()

    def slotChangedObject(self, obj: DocumentObject, name: str) -> None:
        """FreeCAD changes a property: by hand, by undo, by another run."""
        if self.scene is None:
            return
        if obj == self.scene.simulation:
            if name == "OutOfDate":
                self.stale.setVisible(obj.OutOfDate)
            elif name == KEEP:
                self.kept.setChecked(getattr(obj, KEEP))
            elif name in ("Recording", "HeightField", "Fingerprint"):
                self._later(self.show_result)
        elif obj == self.scene.deviation and name in SCALE:
            self._later(self.recolour)

    def slotDeletedObject(self, obj: DocumentObject) -> None:
        """FreeCAD removes an object."""
        if self.scene is not None and any(obj == one for one in self.scene.needed):
            self.pause()
            self._later(self.show_result)

    def _later(self, work: Callable[[], object]) -> None:
        """Calls ``work`` once, when FreeCAD is through with what it does."""
        if work.__name__ not in self.waiting:
            self.waiting.add(work.__name__)
            QtCore.QTimer.singleShot(0, lambda: self._now(work))

    def _now(self, work: Callable[[], object]) -> None:
        self.waiting.discard(work.__name__)
        if self.watching:
            work()

    def preferences_changed(self) -> None:
        """The colours, or the legend's unit, are others."""
        self._later(self.recolour)

    def recolour(self) -> None:
        """Follows the bounds, steps and colours of the job's Deviation."""
        if self.scene is not None and self.job() is not None:
            self.scene.recolour(self.job())

    def slotDeletedDocument(self, document: Document) -> None:
        """FreeCAD closes a document."""
        if document is self.document or self.job() is None:
            self.close()

    def _clear(self) -> None:
        self.clock.stop()
        if self.scene is not None:
            self.scene.close()
            self.scene = None

    def closeEvent(self, event: QtEvent) -> None:
        if self.watching:
            FreeCAD.removeDocumentObserver(self)
            self.watching = False
        if self.runner is not None:
            self.runner.abandon()
            self.runner = None
        self._clear()
        super().closeEvent(event)


def _read(simulation: DocumentObject) -> Any:
    """Its recording, as ``Simulation.recording``; reading a large one takes seconds. Raises Cancelled."""
    text = translate("BeltGrinding", "Reading the recording")
    return waiting.wait(lambda _: simulation.Proxy.recording(simulation), text)


def _without_recording(simulation: DocumentObject | None) -> str:
    """Why there is nothing to play."""
    if simulation is None:
        return translate("BeltGrinding", "There is no result yet.")
    if lost_recording(simulation):
        return translate("BeltGrinding", "The recording was not saved with the document.")
    return translate("BeltGrinding", "This result was not recorded.")


def _keep(simulation: DocumentObject, on: bool) -> None:
    """Has the recording saved with the document, or not; an undo step."""
    if getattr(simulation, KEEP) != on:
        with transaction(simulation.Document, translate("BeltGrinding", "Save the recording")):
            setattr(simulation, KEEP, on)


def show(job: DocumentObject) -> Playback:
    """Opens the playback of a job under the 3D view, in place of another one's."""
    window = Gui.getMainWindow()
    for dock in window.findChildren(QtGui.QDockWidget, "BeltGrinding_PlaybackDock"):
        dock.close()
    dock = Playback(job)
    window.addDockWidget(QtCore.Qt.BottomDockWidgetArea, dock)
    dock.show()
    return dock
