"""Task panel of the job: the faces, sampling, tolerance, timing, law."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import FreeCADGui as Gui

from ...engine import Cancelled, InputError
from ...objects import first_settings, job_data, sides
from ...objects.belt_machine import WHEELS, BeltMachine
from ...objects.kinds import Document, DocumentObject
from ...objects.raster_path import RasterPath, proposed, replace_proposed
from ...objects.robot_path import RobotPath
from ...objects.stock import Stock
from ..common import gates
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.kinds import Widget
from ..common.messages import error_text
from ..scene.face_tint import FaceTint
from ..scene.stock_lines import StockLines
from ..widgets.fold import Fold
from ..widgets.form import NUMBERS, QUANTITIES, Form
from ..widgets.active_programs import ActivePrograms
from .finish_form import FinishForm
from .heat_form import HeatForm
from .law_forms import LawForms
from .machine_form import MachineForm
from .panel import Panel

MANY = 2_000_000  # samples; more are warned of
SAMPLE_BYTES = 400  # of memory in a run, about
PLAN_BELOW = 0.8  # of the area in tolerance: planned feeds are offered


def check_tolerance(job: DocumentObject) -> None:
    """Raises InputError if a job's tolerance is upside down."""
    if job.ToleranceLower > job.ToleranceUpper:
        raise InputError("gui.limits_swapped", "The lower limit lies above the upper limit.")


def mark_tolerance(form: Form, job: DocumentObject) -> None:
    """Marks the fields of a job's tolerance in a form if it is upside down."""
    try:
        check_tolerance(job)
        mistake = ""
    except InputError as error:
        mistake = error_text(error)
    for name in ("ToleranceLower", "ToleranceUpper"):
        form.mark(name, mistake)


class FaceGate:
    """Lets faces and whole parts be selected."""

    def allow(self, document: Document, obj: DocumentObject, sub: str | None) -> bool:
        return hasattr(obj, "Shape") and (not sub or sub.rpartition(".")[2].startswith("Face"))


class JobPanel(Panel):
    """Edits a BeltGrindingJob."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(obj, translate("BeltGrinding", "Belt-grinding job"), "BeltGrinding_Job")
        self.first: dict[str, Any] | None = getattr(obj.Proxy, "proposed", None)  # of a new job
        self.add_fold("foldFaces", "GrindFaces", self._faces())
        for fold in self._whole():
            self.body.addWidget(fold)
        sampling = Form(obj, translate("BeltGrinding", "Sampling and tolerance"))
        sampling.add("Spacing", translate("BeltGrinding", "Sample spacing"))
        self.count = QtGui.QLabel()
        self.count.setObjectName("sampleCount")
        self.count.setWordWrap(True)
        sampling.layout_.addRow(self.count)
        sampling.add("ToleranceLower", translate("BeltGrinding", "Lower limit"))
        sampling.add("ToleranceUpper", translate("BeltGrinding", "Upper limit"))
        sampling.add("ColourLimit", translate("BeltGrinding", "Colours end at"))
        sampling.add("FlipNormals", translate("BeltGrinding", "Flip loose normals"))
        self.add_fold("foldSampling", "Zones", sampling, False, self._sampling_text)
        self.timing = Form(obj, translate("BeltGrinding", "Robot's speed"))
        timings = {
            "constant_feed": translate("BeltGrinding", "Constant feed"),
            "trapezoidal": translate("BeltGrinding", "With acceleration and zones"),
        }
        self.timing.add("Timing", translate("BeltGrinding", "Timing"), timings)
        self.timing.add("PathAcceleration", translate("BeltGrinding", "Path acceleration"))
        self.timing.add("DefaultZone", translate("BeltGrinding", "Default zone"))
        self.timing.add("RotationSpeed", translate("BeltGrinding", "Rotation speed"), unit="°/s")
        self.timing.add(
            "AngularAcceleration", translate("BeltGrinding", "Angular acceleration"), unit="°/s²"
        )
        self.arrange_timing()
        self.law = LawForms(obj)
        title = translate("BeltGrinding", "Removal and belt wear")
        new = self.first is not None
        self.add_fold("foldLaw", "Calibrate", self.law, new, self._law_text, title)
        self.heat = HeatForm(obj)
        self.add_fold("foldHeat", "Heat", self.heat, True, self.heat.summary)
        # Not self.finish, which a panel ends with.
        self.texture = FinishForm(obj)
        self.add_fold("foldFinish", "Finish", self.texture, True, self.texture.summary)
        text = self.timing.rows["Timing"][1].currentText
        self.add_fold("foldTiming", "Speed", self.timing, new, text)
        self.sampling = sampling
        sampling.changed = self.estimate
        self.timing.changed = self.arrange_timing
        self.finish()
        self.gate = FaceGate()
        gates.hold(self.gate)
        self.tint = FaceTint(self.document)
        self.stock_lines = StockLines(self.document)
        self.stock_lines.show(obj)
        self.chosen = self._numbers()
        self.kind = self._kind()
        for form in self.form.findChildren(Form):
            if form.obj is not obj:
                form.changed = self.estimate
        self.law.changed = self.estimate
        self.estimate()

    def _sampling_text(self) -> str:
        lower, upper = (
            figure(v.Value, "+g") for v in (self.obj.ToleranceLower, self.obj.ToleranceUpper)
        )
        spacing = self.obj.Spacing
        chosen = translate("BeltGrinding", "spacing chosen")
        return f"{lower} … {upper} mm; {spacing.UserString if spacing.Value > 0 else chosen}"

    def _law_text(self) -> str:
        return (
            f"K = {figure(self.obj.LawCoefficient, '.3g')} mm²/N"
            if self.obj.Law != "geometric"
            else ""
        )

    def _whole(self) -> Iterator[Fold]:
        """Stock, machine and passes, in short; each has a panel of its own with all there is to it."""
        new = self.first is not None
        stock: DocumentObject = job_data.child(self.obj, Stock)
        if stock is not None and stock.Kind == "allowance":
            form = Form(stock, "")
            form.add("Allowance", translate("BeltGrinding", "Allowance"))
            yield Fold(
                "foldStock",
                translate("BeltGrinding", "Stock"),
                form,
                lambda: stock.Allowance.UserString,
                not new,
                "Stock",
            )
        machine, self.machine = job_data.child(self.obj, BeltMachine), None
        if machine is not None:
            self.machine = MachineForm(machine)
            yield Fold(
                "foldMachine",
                translate("BeltGrinding", "Belt machine"),
                self.machine,
                self.machine.summary,
                not new,
                "BeltMachine",
            )
        programs = job_data.children(self.obj, RobotPath)
        if len(programs) > 1 or not all(path.Active for path in programs):
            box = ActivePrograms(programs)
            title = translate("BeltGrinding", "Programs of a run")
            yield Fold("foldPrograms", title, box, box.summary, False, "ImportProgram")
        self.passes = self.plan_then = None
        paths = [path for path in job_data.children(self.obj, RasterPath) if proposed(path)]
        if paths and new:
            box = QtGui.QWidget()
            layout = QtGui.QVBoxLayout(box)
            layout.setContentsMargins(0, 0, 0, 0)
            self.passes = QtGui.QCheckBox(translate("BeltGrinding", "Lay passes on the faces"))
            self.passes.setObjectName("layPasses")
            self.passes.setToolTip(
                translate("BeltGrinding", "Off: the job gets a robot program of yours")
            )
            self.passes.setChecked(True)
            form = Form(paths[0], "")
            form.add("Feed", translate("BeltGrinding", "Feed"))
            form.add("StepOverShare", translate("BeltGrinding", "Share of contact width"))
            self.passes.toggled.connect(form.setVisible)
            layout.addWidget(self.passes)
            layout.addWidget(form)
            share = (self.first or {}).get("in_tolerance")
            if share is not None and share < PLAN_BELOW:
                self.plan_then = QtGui.QCheckBox(translate("BeltGrinding", "Plan feeds after OK"))
                self.plan_then.setObjectName("planThen")
                self.passes.toggled.connect(self.plan_then.setEnabled)
                layout.addWidget(self.plan_then)
            title = translate("BeltGrinding", "Passes")
            text = lambda: paths[0].Feed.UserString
            yield Fold("foldPasses", title, box, text, False, "RasterPath")

    def arrange_timing(self) -> None:
        """Shows the accelerations only where they matter."""
        trapezoidal = self.obj.Timing == "trapezoidal"
        self.timing.show_rows(self.timing.rows if trapezoidal else {"Timing"})

    def _faces(self) -> Widget:
        box = QtGui.QGroupBox(translate("BeltGrinding", "Faces to be ground"))
        layout = QtGui.QVBoxLayout(box)
        self.list = QtGui.QListWidget()
        self.list.setObjectName("faces")
        self.list.setMaximumHeight(80)
        self.list.setSelectionMode(QtGui.QAbstractItemView.ExtendedSelection)
        layout.addWidget(self.list)
        row = QtGui.QHBoxLayout()
        for name, text, action in (
            ("addFaces", translate("BeltGrinding", "Add selected"), self.add_selected),
            ("removeFaces", translate("BeltGrinding", "Remove"), self.remove),
        ):
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.clicked.connect(action)
            row.addWidget(button)
        layout.addLayout(row)
        self.flipping = QtGui.QPushButton(translate("BeltGrinding", "Flip side"))
        self.flipping.setObjectName("flipFaces")
        self.flipping.setToolTip(
            translate("BeltGrinding", "Turns loose faces to be ground from their other side")
        )
        self.flipping.clicked.connect(self.flip)
        layout.addWidget(self.flipping)
        self.fill()
        return box

    def pairs(self) -> list[tuple[DocumentObject, str]]:
        """[(object, face name or '' for all)] of the job."""
        return [(obj, sub) for obj, subs in self.obj.DesignFaces for sub in (subs or ("",))]

    def fill(self) -> None:
        self.list.clear()
        parts = {obj for obj, _ in self.pairs()}
        self.flipping.setVisible(any(sides.loose_faces(obj.Shape) for obj in parts))
        for obj, sub in self.pairs():
            everything = translate("BeltGrinding", "all faces")
            flipped = translate("BeltGrinding", "flipped") if (obj, sub) in self.flips() else ""
            self.list.addItem(f"{obj.Label}: {sub or everything}" + (flipped and f" ({flipped})"))

    def add_selected(self) -> None:
        """Adds the faces that are selected in the 3D view."""
        found = []
        for one in Gui.Selection.getSelectionEx(self.document.Name):
            if hasattr(one.Object, "Shape"):
                faces = [s for s in one.SubElementNames if s.startswith("Face")]
                found += [(one.Object, face) for face in faces or [""]]
        if not found:
            self.tell(translate("BeltGrinding", "Select faces in the 3D view first."), True)
            return
        self.set_pairs(self.pairs() + [pair for pair in found if pair not in self.pairs()])

    def remove(self) -> None:
        rows = {index.row() for index in self.list.selectedIndexes()}
        self.set_pairs([pair for i, pair in enumerate(self.pairs()) if i not in rows])

    def flips(self) -> list[tuple[DocumentObject, str]]:
        """[(object, face name or '' for all)] of the faces that are flipped."""
        return [(obj, sub) for obj, subs in self.obj.FlipFaces for sub in (subs or ("",))]

    def flip(self) -> None:
        """Flips the loose ones of the faces that are chosen in the list, or else in the 3D view."""
        pairs, rows = self.pairs(), sorted(index.row() for index in self.list.selectedIndexes())
        chosen = [pairs[row] for row in rows] or [
            (one.Object, sub)
            for one in Gui.Selection.getSelectionEx(self.document.Name)
            for sub in one.SubElementNames
            if (one.Object, sub) in pairs or (one.Object, "") in pairs
        ]
        found = []
        for obj, sub in chosen:
            loose = [f"Face{i}" for i in sides.loose_faces(obj.Shape)]
            found += [(obj, face) for face in loose if sub in (face, "")]
        if not found:
            self.tell(
                translate(
                    "BeltGrinding",
                    "Choose loose faces in the list; faces of a solid look out of it already.",
                ),
                True,
            )
            return
        flips = [pair for pair in self.flips() if pair not in found]
        flips += [pair for pair in found if pair not in self.flips()]
        self.obj.FlipFaces = [(obj, (sub,)) for obj, sub in flips]
        for path in job_data.children(self.obj, RasterPath):
            if "Touched" in path.State:
                path.recompute()
        self.fill()
        self.estimate()

    def set_pairs(self, pairs: Sequence[tuple[DocumentObject, str]]) -> None:
        self.obj.DesignFaces = [(obj, (sub,)) for obj, sub in pairs]
        self.fill()
        if self.first is not None and "feed_mm_s" in self.first and pairs:
            self.propose(self.first)
        self.estimate()

    def propose(self, first: dict[str, Any]) -> None:
        """Looks at other faces; what the user has changed of the ``first`` values stays."""
        text = translate("BeltGrinding", "Looking at the part for first values")
        try:
            found = first_settings.propose(self.obj, text)
        except (InputError, Cancelled) as error:
            first["notes"], self.kind = [error], self._kind()
            return
        first_settings.apply(self.obj, found, first)
        for path in job_data.children(self.obj, RasterPath):
            if proposed(path):
                path.recompute()  # they are drawn as they will be
        # What they bring is not known before the passes are laid.
        self.first = self.obj.Proxy.proposed = {**first, **found, "in_tolerance": None}
        self.chosen, self.kind = self._numbers(), self._kind()
        for form in self.form.findChildren(Form):
            for name in form.rows:
                if form.obj.getTypeIdOfProperty(name) in QUANTITIES | NUMBERS:
                    form.refresh(name)

    def _kind(self) -> str | None:
        """Of the belt machine; None where there is none."""
        machine = job_data.child(self.obj, BeltMachine)
        return machine and machine.Kind

    def _numbers(self) -> list[Any]:
        """What the feed of a new job was chosen by, and the feed."""
        job, paths = self.obj, job_data.children(self.obj, RasterPath)
        stock, machine = job_data.child(job, Stock), job_data.child(job, BeltMachine)
        return [
            (job.ToleranceLower.Value, job.ToleranceUpper.Value, job.LawCoefficient, job.Law),
            stock and (stock.Kind, stock.Allowance.Value),
            machine
            and (
                *(machine.WheelRadius.Value, machine.WheelWidth.Value, machine.RunWidth.Value),
                *(machine.Force.Value, machine.BeltSpeed.Value),
            ),
            [(path.Feed.Value, path.StepOverShare) for path in paths if proposed(path)],
        ]

    def estimate(self) -> None:
        """Says what the settings will cost; a new job gets other ones where its machine becomes another kind."""
        if self.machine is not None:
            self.machine.arrange()
        if self.first is not None and "feed_mm_s" in self.first and self._kind() != self.kind:
            self.propose(self.first)
        mark_tolerance(self.sampling, self.obj)
        try:
            self.check()
            shape, numbers = job_data.design(self.obj)
        except InputError as error:
            self.tint.show([])
            self.tell(error_text(error), True)
            return
        # A hidden part lies under the deviation, whose colours a tint would change.
        seen = any(obj.ViewObject.Visibility for obj, _ in self.obj.DesignFaces)
        self.tint.show([shape.Faces[number - 1] for number in numbers] if seen else [])
        area = sum(shape.Faces[number - 1].Area for number in numbers)
        if self.obj.Spacing.Value > 0:
            count = area / self.obj.Spacing.Value**2
            text = translate("BeltGrinding", "about {:,.0f} samples").format(count)
        else:
            count = 0
            text = translate("BeltGrinding", "chosen by faces, wheel and tolerance")
        self.count.setText(text)
        lines = [
            translate("BeltGrinding", "Faces: {}. Area: {:,.0f} mm².").format(len(numbers), area)
        ]
        if count > MANY:
            lines.append(
                translate(
                    "BeltGrinding",
                    "So many samples take some {:.1f} GB, and minutes; {:.2g} mm would be {:,.0f}.",
                ).format(count * SAMPLE_BYTES / 1e9, (area / MANY * 2) ** 0.5, MANY / 2)
            )
        lines += [f"⚠ {error_text(note)}" for note in sides.notes(self.obj)]
        if self.first is not None:
            lines += [f"⚠ {error_text(note)}" for note in self.first["notes"]]
            share = self.first.get("in_tolerance")
            if share is not None and self._numbers() == self.chosen:
                lines.append(
                    translate(
                        "BeltGrinding",
                        "By a coarse run they bring {:.0f} % of the area into tolerance.",
                    ).format(100.0 * share)
                )
                if share < PLAN_BELOW:
                    lines.append(
                        translate(
                            "BeltGrinding", "⚠ Planned feeds bring more: tick Plan feeds after OK."
                        )
                    )
            if "feed_mm_s" in self.first and self._numbers() != self.chosen:
                lines.append(
                    translate(
                        "BeltGrinding",
                        "⚠ Changed since the values were chosen from the part: the feed need not take the "
                        "allowance off on the mean any more.",
                    )
                )
            elif "feed_mm_s" in self.first and self._kind() not in WHEELS:
                lines.append(
                    translate(
                        "BeltGrinding",
                        "Chosen from the part: force, passes, samples, and the feed at which the allowance comes off "
                        "on the mean, if K is right: K is not known before the belt is calibrated. The belt is taken "
                        "as it is.",
                    )
                )
            elif "feed_mm_s" in self.first:
                lines.append(
                    translate(
                        "BeltGrinding",
                        "Chosen from the part: wheel, force, passes, samples, and the feed at which the "
                        "allowance comes off on the mean, if K is right: K is not known before the belt "
                        "is calibrated.",
                    )
                )
        self.tell("\n".join(lines), count > MANY)

    def check(self) -> None:
        if self.obj.Spacing.Value < 0:
            raise InputError("gui.spacing", "The sample spacing must not be negative.")
        check_tolerance(self.obj)
        self.heat.check()
        self.texture.check()
        job_data.design(self.obj)

    def apply(self) -> None:
        if self.passes is not None and not self.passes.isChecked():
            replace_proposed(self.obj)

    def accept(self) -> bool:
        planned = self.plan_then is not None and self.plan_then.isChecked()
        planned = planned and self.passes is not None and self.passes.isChecked()
        accepted = super().accept()
        if accepted and planned:
            QtCore.QTimer.singleShot(0, lambda: Gui.runCommand("BeltGrinding_Plan"))
        return accepted

    def close(self) -> None:
        gates.release(self.gate)
        self.tint.close()
        self.stock_lines.close()
        self.obj.Proxy.proposed = None
