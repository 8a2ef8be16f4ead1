"""Task panels of the stock and of the belt machine."""

from ...engine import InputError
from ...objects import preferences, stock_scan
from ...objects.belt import Belt
from ...objects.geometry import placement_from_job
from ...objects.proxy import type_of
from ...scan import start as scan_start
from ..common.compat import QtGui, translate
from ..common.messages import error_text
from ..common.runner import Background
from ..widgets.form import Form
from ..widgets.steady import steady
from .panel import Panel
from .preset_form import HardnessField, PresetForm

MESH_FILES = "*.stl *.ply *.obj *.off *.3mf"


class StockPanel(Panel):
    """Edits a Stock."""

    def __init__(self, obj):
        super().__init__(obj, translate("BeltGrinding", "Stock"), "BeltGrinding_Stock")
        form = self.fields = Form(obj, translate("BeltGrinding", "Stock on the design faces"))
        kinds = {
            "allowance": translate("BeltGrinding", "Uniform allowance"),
            "solid": translate("BeltGrinding", "Solid"),
            "mesh": translate("BeltGrinding", "Mesh (a scan)"),
        }
        bodies = [
            one
            for one in obj.Document.Objects
            if hasattr(one, "Shape") or (hasattr(one, "Mesh") and not hasattr(one, "Simulation"))
        ]
        form.add("Kind", translate("BeltGrinding", "Kind"), kinds)
        form.add("Allowance", translate("BeltGrinding", "Allowance"))
        form.add("Source", translate("BeltGrinding", "Object"), bodies)
        form.add(
            "File",
            translate("BeltGrinding", "or file"),
            translate("BeltGrinding", "Mesh") + f" ({MESH_FILES})",
        )
        form.add("FileUnit", translate("BeltGrinding", "Unit of the file"), unit="mm")
        form.add("FilePlacement", translate("BeltGrinding", "Place of the file"))
        form.add("Deflection", translate("BeltGrinding", "Chord error"))
        form.add("SearchAbove", translate("BeltGrinding", "Search outward"))
        form.add("SearchBelow", translate("BeltGrinding", "Search inward"))
        form.changed = self.arrange
        self.body.addWidget(form)
        self.work = None
        self.scan = QtGui.QWidget()
        rows = QtGui.QFormLayout(self.scan)
        rows.setContentsMargins(0, 0, 0, 0)
        self.start = steady(QtGui.QComboBox())
        self.start.setObjectName("scanStart")
        self.start.addItem(translate("BeltGrinding", "as it lies"), None)
        self.start.addItem(translate("BeltGrinding", "principal axes"), "principal")
        rows.addRow(translate("BeltGrinding", "Start"), self.start)
        self.datum = QtGui.QLineEdit()
        self.datum.setObjectName("scanDatum")
        self.datum.setPlaceholderText(translate("BeltGrinding", "all that are not ground"))
        rows.addRow(translate("BeltGrinding", "Datum faces"), self.datum)
        self.lay = QtGui.QPushButton(translate("BeltGrinding", "Lay the scan on the design"))
        self.lay.setObjectName("layScan")
        self.lay.clicked.connect(self.align)
        rows.addRow(self.lay)
        self.body.addWidget(self.scan)
        self.finish()
        self.arrange()

    def align(self):
        """Lays the file's mesh on the faces that are not ground; ``_laid`` follows."""
        try:
            job = self.obj.getParentGroup()
            stock, data, placed = stock_scan.prepare(job)
            options = {"start": self.start.currentData() or placed}
            if self.datum.text().strip():
                options["datum_faces"] = scan_start.face_numbers(self.datum.text())
        except InputError as error:
            self.tell(error_text(error), True)
            return
        self.lay.setEnabled(False)
        self.tell(translate("BeltGrinding", "Laying the scan on the design..."))
        file, unit = stock.File, stock.FileUnit
        self.work = Background(
            lambda context: stock_scan.align(data, file, unit, context, **options), self._laid
        )

    def _laid(self, found, error):
        self.work = None
        self.lay.setEnabled(True)
        if error is not None:
            self.tell(error_text(error), True)
            return
        placement, figures = found
        self.obj.FilePlacement = placement_from_job(placement)
        self.fields.refresh("FilePlacement")
        text = translate("BeltGrinding", "Laid on the design with {} rms.").format(
            preferences.length_text(figures["rms_mm"], 1, "")
        )
        warnings = [error_text(warning) for warning in figures["warnings"]]
        self.tell("\n".join([text, *warnings]), bool(warnings))

    def close(self):
        if self.work is not None:
            self.work.abandon()
            self.work = None

    def arrange(self):
        """Shows the fields that the kind uses."""
        self.scan.setVisible(
            self.obj.Kind == "mesh" and self.obj.Source is None and bool(self.obj.File)
        )
        rays = {"Kind", "Source", "SearchAbove", "SearchBelow"}
        files = {"File", "FileUnit", "FilePlacement"} if self.obj.Source is None else set()
        self.fields.show_rows(
            {
                "allowance": {"Kind", "Allowance"},
                "solid": rays | {"Deflection"},
                "mesh": rays | files,
            }[self.obj.Kind]
        )
        self.tell("")

    def check(self):
        obj = self.obj
        if obj.Kind == "solid" and not hasattr(obj.Source, "Shape"):
            raise InputError("gui.choose_solid", "Choose the solid that is the stock.")
        if obj.Kind == "mesh" and not (hasattr(obj.Source, "Mesh") or obj.File):
            raise InputError("gui.choose_mesh", "Choose the mesh: an object or a file.")


def _belts(document):
    return [obj for obj in document.Objects if type_of(obj) == Belt.TYPE]


class BeltMachinePanel(Panel):
    """Edits a BeltMachine."""

    def __init__(self, obj):
        title = translate("BeltGrinding", "Belt machine")
        super().__init__(obj, title, "BeltGrinding_BeltMachine")
        wheel = Form(obj, translate("BeltGrinding", "Contact wheel"))
        wheel.add("WheelRadius", translate("BeltGrinding", "Radius"))
        wheel.add("WheelWidth", translate("BeltGrinding", "Width"))
        wheel.add("CrownRadius", translate("BeltGrinding", "Crown radius (0: cylinder)"))
        models = {
            "wheel_rim": translate("BeltGrinding", "Wheel rim"),
            "bonded_layer": translate("BeltGrinding", "Bonded layer"),
            "half_space": translate("BeltGrinding", "Half-space"),
            "elastic_foundation": translate("BeltGrinding", "Elastic foundation"),
            "surrogate": translate("BeltGrinding", "Surrogate (trained)"),
            "geometric": translate("BeltGrinding", "Rigid (geometric)"),
        }
        wheel.add("Compliance", translate("BeltGrinding", "Elasticity"), models)
        wheel.add("YoungsModulus", translate("BeltGrinding", "Young's modulus"))
        self.hardness = HardnessField(wheel)
        wheel.add("PoissonsRatio", translate("BeltGrinding", "Poisson's ratio"))
        wheel.add("RimThickness", translate("BeltGrinding", "Rim thickness"))
        wheel.add("BeltTension", translate("BeltGrinding", "Belt tension"), unit="N/mm")
        wheel.add("BeltBending", translate("BeltGrinding", "Belt bending"), unit="N mm")
        wheel.add(
            "Stiffness", translate("BeltGrinding", "Stiffness (0: of the rim)"), unit="MPa/mm"
        )
        text = translate("BeltGrinding", "Dynamic modulus")
        wheel.add("DynamicModulusFactor", text, unit="×")
        text = translate("BeltGrinding", "Density (0: no growth)")
        wheel.add("WheelDensity", text, unit="kg/m³")
        trained = translate("BeltGrinding", "Surrogate")
        wheel.add("SurrogateFile", trained, f"{trained} (*.npz)")
        belt = Form(obj, translate("BeltGrinding", "Belt and control"))
        belt.add("BeltSpeed", translate("BeltGrinding", "Belt speed"))
        belt.add("Belt", translate("BeltGrinding", "Belt"), _belts(obj.Document))
        belt.add("BeltWear", translate("BeltGrinding", "Cutting ability (fresh: 1)"))
        control = {
            "force": translate("BeltGrinding", "Force"),
            "position": translate("BeltGrinding", "Position"),
        }
        belt.add("Control", translate("BeltGrinding", "Control"), control)
        belt.add("Force", translate("BeltGrinding", "Force"))
        belt.add("ForceTravel", translate("BeltGrinding", "Travel of the force control"))
        dynamics = {
            "ideal": translate("BeltGrinding", "At every moment"),
            "lag": translate("BeltGrinding", "With a lag"),
            "actuator": translate("BeltGrinding", "Mass and damping"),
        }
        belt.add("ForceModel", translate("BeltGrinding", "Force is met"), dynamics)
        belt.add("ForceLag", translate("BeltGrinding", "Regulator's lag"), unit="s")
        belt.add("MovingMass", translate("BeltGrinding", "Moving mass"), unit="kg")
        belt.add("Damping", translate("BeltGrinding", "Damping"), unit="N s/mm")
        belt.add("SpeedLimit", translate("BeltGrinding", "Speed limit (0: none)"))
        text = translate("BeltGrinding", "Overshoot told from")
        belt.add("OvershootLimit", text)
        belt.add("BounceTime", translate("BeltGrinding", "Bounces told within"), unit="s")
        text = translate("BeltGrinding", "Robot's stiffness (0: rigid)")
        belt.add("RobotStiffness", text, unit="N/mm")
        self.body.addWidget(PresetForm(obj, (wheel, belt), self.hardness))
        for form in (wheel, belt):
            form.changed = self.arrange
            self.body.addWidget(form)
        self.belt, self.wheel = belt, wheel
        self.finish()
        self.arrange()

    def arrange(self):
        """Shows the fields that the elasticity and the control use."""
        moving = {"ForceLag", "OvershootLimit", "BounceTime"}
        dynamics = {
            "ideal": set(),
            "lag": {"ForceLag"},
            "actuator": moving | {"MovingMass", "Damping", "SpeedLimit"},
        }[self.obj.ForceModel]
        force = {
            "force": {"Force", "ForceTravel", "ForceModel"} | dynamics,
            "position": {"RobotStiffness"},
        }[self.obj.Control]
        rubber = {"YoungsModulus", "ShoreA", "PoissonsRatio"}
        rim = rubber | {"RimThickness"}
        belt = {"BeltTension", "BeltBending"}
        used = {
            "wheel_rim": rim | belt,
            "bonded_layer": rim,
            "half_space": rubber,
            "surrogate": rim | belt | {"SurrogateFile"},
            "geometric": set(),
            "elastic_foundation": {"Stiffness"}
            | (rim | belt if self.obj.Stiffness <= 0 else set()),
        }
        shape = {"WheelRadius", "WheelWidth", "CrownRadius", "Compliance"}
        if self.obj.Compliance != "geometric":
            shape |= {"DynamicModulusFactor"}
            shape |= {"WheelDensity"} if self.obj.Control == "position" else set()
        self.wheel.show_rows(shape | used[self.obj.Compliance])
        self.belt.show_rows({"BeltSpeed", "Belt", "BeltWear", "Control"} | force)
        self.hardness.follow()
        self.tell("")

    def check(self):
        if self.obj.WheelRadius.Value <= 0:
            raise InputError("gui.wheel_radius", "The wheel's radius must be positive.")
        if self.obj.WheelWidth.Value <= 0:
            raise InputError("gui.wheel_width", "The wheel's width must be positive.")
        if self.obj.BeltSpeed.Value <= 0:
            raise InputError("gui.belt_speed", "The belt speed must be positive.")
        rim = self.obj.Compliance in ("wheel_rim", "bonded_layer")
        if rim and not 0 < self.obj.RimThickness.Value < self.obj.WheelRadius.Value:
            raise InputError(
                "gui.rim_too_thick", "The rim must be thinner than the wheel's radius."
            )
        if self.obj.Compliance != "elastic_foundation" and self.obj.YoungsModulus.Value <= 0:
            raise InputError("gui.youngs_modulus", "Young's modulus must be positive.")
        if self.obj.Compliance == "surrogate" and not self.obj.SurrogateFile:
            raise InputError(
                "gui.choose_surrogate", "Choose the file that `beltgrind surrogate` wrote."
            )
        if self.obj.Compliance == "geometric" and self.obj.Control == "force":
            raise InputError(
                "gui.rigid_force", "A rigid tool has no force: set the control to position."
            )
        if not 0 <= self.obj.PoissonsRatio <= 0.499:
            raise InputError("gui.poissons_ratio", "Poisson's ratio lies from 0 to 0.499.")
