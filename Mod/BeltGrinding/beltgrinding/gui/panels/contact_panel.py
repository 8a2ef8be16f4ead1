"""Task panel: the pressure on the wheel's footprint at any pose of a job's programs."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui
import numpy as np

from ...contact import single_contact as contact
from ...engine import Cancelled, InputError
from ...objects import ground_by, job_inputs
from ...objects.belt_machine import WHEELS
from ...objects.kinds import DocumentObject
from ..common.compat import QtCore, QtGui, buttons, translate
from ..common.help_pages import helped
from ..common.icons import qicon
from ..common.kinds import Buttons, Image, Json
from ..common.messages import error_text
from ..common.runner import Background
from ..common.task_progress import TaskRow
from ..widgets.steady import steady

WAIT = 300  # ms after the last move of the slider
PICTURE = 200  # pixels, of the longer side; more is too wide beside a scroll bar
# From nothing to the highest pressure; lightness falls all the way, so that grey shows it too.
COLOURS = np.array(
    [(255, 255, 255), (254, 217, 118), (253, 141, 60), (227, 26, 28), (128, 0, 38)], dtype=float
)


def picture(result: Json) -> Image:
    """QImage of the pressure: x along the belt's travel to the right, y upwards."""
    pressure = result["pressure"][::-1]
    at = pressure / max(float(pressure.max()), 1e-12) * (len(COLOURS) - 1)
    places = np.arange(len(COLOURS))
    rgb = np.stack([np.interp(at, places, COLOURS[:, k]) for k in range(3)], axis=-1)
    rgb[result["coverage"][::-1] <= 0] = 230
    height, width = pressure.shape
    data = np.ascontiguousarray(rgb.astype(np.uint8)).tobytes()
    image = QtGui.QImage(data, width, height, 3 * width, QtGui.QImage.Format_RGB888).copy()
    # Cells need not be square.
    size = np.array([np.ptp(result["x"]) + 1e-9, np.ptp(result["y"]) + 1e-9])
    wide, high = (PICTURE * size / size.max()).astype(int)
    return image.scaled(max(int(wide), 8), max(int(high), 8))


class ContactPanel:
    """Shows the contact at a pose; nothing in the document changes."""

    def __init__(self, job: DocumentObject) -> None:
        self.paths = ground_by.required(job)
        self.folder = job_inputs.scratch_folder()
        self.data = job_inputs.to_data(job, self.folder.name)
        wheel = self.data["belt_machine"].get("kind", WHEELS[0]) in WHEELS
        self.pressing = (
            translate("BeltGrinding", "Wheel") if wheel else translate("BeltGrinding", "Belt")
        )
        self.task: Background | None = None
        self.form = QtGui.QWidget()
        self.form.destroyed.connect(lambda *_: self._gone())  # whatever closes it
        self.form.setWindowTitle(translate("BeltGrinding", "Contact at a pose"))
        self.form.setWindowIcon(qicon("BeltGrinding_Contact"))
        helped(self.form, "BeltGrinding_Contact")
        body = QtGui.QVBoxLayout(self.form)
        self.program = steady(QtGui.QComboBox())
        self.program.setObjectName("program")
        for path in self.paths:
            self.program.addItem(path.Label)
        self.program.setVisible(len(self.paths) > 1)
        body.addWidget(self.program)
        row = QtGui.QHBoxLayout()
        self.slider = steady(QtGui.QSlider(QtCore.Qt.Horizontal))
        self.number = steady(QtGui.QSpinBox())
        self.number.setObjectName("pose")
        self.number.setPrefix(translate("BeltGrinding", "pose "))
        row.addWidget(self.slider, 1)
        row.addWidget(self.number)
        body.addLayout(row)
        self.state = QtGui.QLabel()
        self.state.setObjectName("contactState")
        self.state.setWordWrap(True)
        self.image = QtGui.QLabel()
        self.image.setObjectName("footprint")
        self.image.setAlignment(QtCore.Qt.AlignCenter)
        body.addWidget(self.image)
        body.addWidget(self.state)
        self.progress = TaskRow()
        body.addWidget(self.progress)
        body.addStretch()
        self.timer = QtCore.QTimer(self.form)
        self.timer.setSingleShot(True)
        self.timer.timeout.connect(self.compute)
        self.slider.valueChanged.connect(self.number.setValue)
        self.number.valueChanged.connect(self.slider.setValue)
        self.number.valueChanged.connect(lambda _: self.timer.start(WAIT))
        self.program.currentIndexChanged.connect(self.choose)
        self.choose(0)

    def choose(self, index: int) -> None:
        """Another program: its poses, from the first that is not reached by a rapid motion."""
        path = self.paths[index]
        count = len(path.Poses)
        first = next((i + 1 for i, rapid in enumerate(path.Rapid) if not rapid), 1)
        for widget in (self.slider, self.number):
            widget.setRange(1, count)
        self.number.setValue(min(first + 1, count))
        self.timer.start(0)

    def compute(self) -> None:
        """Presses the wheel at the chosen pose; a computation under way is given up."""
        if self.task is not None:
            self.task.cancel()
            self.timer.start(WAIT)
            return
        pose, program = self.number.value(), self.program.currentIndex() + 1
        self.task = Background(
            lambda context: contact.at_pose(self.data, pose, program, context),
            self.show,
            self.form,
        )
        self.state.clear()
        text = translate("BeltGrinding", "Grinding up to pose {}").format(pose)
        self.progress.follow(self.task, text)

    def show(self, result: Any, error: BaseException | None) -> None:
        self.task = None
        self.progress.end()
        if isinstance(error, Cancelled):
            return
        self.image.setVisible(error is None)
        if error is not None:
            if not isinstance(error, InputError):
                raise error
            self.state.setText(error_text(error))
            return
        self.image.setPixmap(QtGui.QPixmap.fromImage(picture(result)))
        self.state.setText(
            translate(
                "BeltGrinding",
                "Force: {:.1f} N (commanded: {:.1f} N)\nHighest pressure: {:.3f} MPa (darkest)\n"
                "Contact: {:.0f} mm² of {:.1f} x {:.1f} mm\n{}: {:+.3f} mm beyond its pose\n"
                "x to the right along the belt, y upwards along the axis",
            ).format(
                result["force"],
                result["commanded_force"],
                result["peak_pressure"],
                result["contact_area"],
                np.ptp(result["x"]),
                np.ptp(result["y"]),
                self.pressing,
                result["approach"],
            )
        )

    def getStandardButtons(self) -> Buttons:
        return buttons("Close")

    def _gone(self) -> None:
        if self.task is not None:
            self.task.abandon(self.folder.cleanup)
        else:
            self.folder.cleanup()

    def reject(self) -> bool:
        self.timer.stop()
        Gui.Control.closeDialog()
        return True
