"""Task panel of the job: the faces, sampling, tolerance, timing, law."""

import FreeCADGui as Gui

from ...engine import InputError
from ...objects import job_data
from ..common.compat import QtGui, translate
from ..common.messages import error_text
from ..scene.face_tint import FaceTint
from ..widgets.form import Form
from .law_forms import LawForms
from .panel import Panel


def check_tolerance(job):
    """Raises InputError if a job's tolerance is upside down."""
    if job.ToleranceLower > job.ToleranceUpper:
        raise InputError("gui.limits_swapped", "The lower limit lies above the upper limit.")


def mark_tolerance(form, job):
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

    def allow(self, document, obj, sub):
        return hasattr(obj, "Shape") and (not sub or sub.rpartition(".")[2].startswith("Face"))


class JobPanel(Panel):
    """Edits a BeltGrindingJob."""

    def __init__(self, obj):
        super().__init__(obj, translate("BeltGrinding", "Belt-grinding job"), "BeltGrinding_Job")
        self.body.addWidget(self._faces())
        sampling = Form(obj, translate("BeltGrinding", "Sampling and tolerance"))
        sampling.add("Spacing", translate("BeltGrinding", "Sample spacing"))
        sampling.add("ToleranceLower", translate("BeltGrinding", "Lower limit"))
        sampling.add("ToleranceUpper", translate("BeltGrinding", "Upper limit"))
        sampling.add("ColourLimit", translate("BeltGrinding", "Colours end at"))
        sampling.add("FlipNormals", translate("BeltGrinding", "Flip loose normals"))
        self.body.addWidget(sampling)
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
        self.body.addWidget(self.law)
        self.body.addWidget(self.timing)
        self.forms = (sampling, self.timing, self.law)
        self.sampling = sampling
        sampling.changed = self.estimate
        self.timing.changed = self.arrange_timing
        self.finish()
        Gui.Selection.addSelectionGate(FaceGate())
        self.tint = FaceTint(self.document)
        self.estimate()

    def arrange_timing(self):
        """Shows the accelerations only where they matter."""
        trapezoidal = self.obj.Timing == "trapezoidal"
        self.timing.show_rows(self.timing.rows if trapezoidal else {"Timing"})

    def _faces(self):
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
        self.fill()
        return box

    def pairs(self):
        """[(object, face name or '' for all)] of the job."""
        return [(obj, sub) for obj, subs in self.obj.DesignFaces for sub in (subs or ("",))]

    def fill(self):
        self.list.clear()
        for obj, sub in self.pairs():
            everything = translate("BeltGrinding", "all faces")
            self.list.addItem(f"{obj.Label}: {sub or everything}")

    def add_selected(self):
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

    def remove(self):
        rows = {index.row() for index in self.list.selectedIndexes()}
        self.set_pairs([pair for i, pair in enumerate(self.pairs()) if i not in rows])

    def set_pairs(self, pairs):
        self.obj.DesignFaces = [(obj, (sub,)) for obj, sub in pairs]
        self.fill()
        self.estimate()

    def estimate(self):
        """Says what the settings will cost."""
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
        count = area / self.obj.Spacing.Value**2
        self.tell(
            translate(
                "BeltGrinding", "Faces: {}. Area: {:,.0f} mm². Samples: about {:,.0f}."
            ).format(len(numbers), area, count)
        )

    def check(self):
        if self.obj.Spacing.Value <= 0:
            raise InputError("gui.spacing", "The sample spacing must be positive.")
        check_tolerance(self.obj)
        job_data.design(self.obj)

    def close(self):
        Gui.Selection.removeSelectionGate()
        self.tint.close()
