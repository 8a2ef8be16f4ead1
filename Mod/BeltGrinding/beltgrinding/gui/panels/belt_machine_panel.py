"""Task panel of the belt machine: only what its kind needs, with a drawing of it."""

from __future__ import annotations

from typing import Any

from ...engine import InputError
from ...objects import belt_machine as machines
from ...objects.belt import Belt
from ...objects.belt_machine import KIND_KEYS, LAYERS, layers_of
from ...objects.kinds import Document, DocumentObject
from ...objects.properties import set_value, to_job
from ...objects.proxy import type_of
from ..common.compat import translate
from ..widgets.form import SIGNED, Form
from ..widgets.layer_rows import LayerRows
from ..widgets.machine_drawing import MachineDrawing
from .machine_form import kinds
from .panel import Panel
from .preset_form import HardnessField, PresetForm


def _belts(document: Document) -> list[DocumentObject]:
    return [obj for obj in document.Objects if type_of(obj) == Belt.TYPE]


class BeltMachinePanel(Panel):
    """Edits a BeltMachine."""

    def __init__(self, obj: DocumentObject) -> None:
        title = translate("BeltGrinding", "Belt machine")
        super().__init__(obj, title, "BeltGrinding_BeltMachine")
        kind = Form(obj, translate("BeltGrinding", "Kind of machine"))
        kind.add("Kind", translate("BeltGrinding", "Kind"), kinds())
        self.drawing = MachineDrawing(obj)
        kind.layout_.addRow(self.drawing)
        self.run = _run_form(obj)
        self.platen = Form(obj, translate("BeltGrinding", "Platen"))
        self.platen.add("PlatenLength", translate("BeltGrinding", "Length"))
        self.platen.add("PlatenRadius", translate("BeltGrinding", "Radius (0: flat)"))
        self.platen.add("PlateThickness", translate("BeltGrinding", "Plate's thickness"))
        text = translate("BeltGrinding", "Its back (0: same)")
        self.platen.add("LayerStiffness", text, unit="MPa/mm")
        self.layers = LayerRows(layers_of(obj))
        self.layers.changed = self._layers_changed
        self.platen.layout_.addRow(self.layers)
        self.frame = _frame_form(obj)
        self.fork = Form(obj, translate("BeltGrinding", "Fork, for collisions"))
        self.fork.add("ForkLength", translate("BeltGrinding", "Axle to pulleys"))
        self.fork.add("ForkSpread", translate("BeltGrinding", "Between the runs"))
        self.fork.add("ForkBeltThickness", translate("BeltGrinding", "Belt's thickness"))
        self.fork.add("ForkArmThickness", translate("BeltGrinding", "Arms (0: none)"))
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
        belt = Form(obj, translate("BeltGrinding", "Belt"))
        belt.add("BeltSpeed", translate("BeltGrinding", "Belt speed"))
        belt.add("Belt", translate("BeltGrinding", "Belt"), _belts(obj.Document))
        belt.add("BeltWear", translate("BeltGrinding", "Cutting ability (fresh: 1)"))
        control = Form(obj, translate("BeltGrinding", "Control"))
        controls = {
            "force": translate("BeltGrinding", "Force"),
            "position": translate("BeltGrinding", "Position"),
        }
        control.add("Control", translate("BeltGrinding", "Control"), controls)
        control.add("Force", translate("BeltGrinding", "Force"))
        control.add("ForceTravel", translate("BeltGrinding", "Travel of the force control"))
        dynamics = {
            "ideal": translate("BeltGrinding", "At every moment"),
            "lag": translate("BeltGrinding", "With a lag"),
            "actuator": translate("BeltGrinding", "Mass and damping"),
        }
        control.add("ForceModel", translate("BeltGrinding", "Force is met"), dynamics)
        control.add("ForceLag", translate("BeltGrinding", "Regulator's lag"), unit="s")
        control.add("MovingMass", translate("BeltGrinding", "Moving mass"), unit="kg")
        control.add("Damping", translate("BeltGrinding", "Damping"), unit="N s/mm")
        control.add("SpeedLimit", translate("BeltGrinding", "Speed limit (0: none)"))
        text = translate("BeltGrinding", "Overshoot told from")
        control.add("OvershootLimit", text)
        control.add("BounceTime", translate("BeltGrinding", "Bounces told within"), unit="s")
        text = translate("BeltGrinding", "Robot's stiffness (0: rigid)")
        control.add("RobotStiffness", text, unit="N/mm")
        device = Form(obj, translate("BeltGrinding", "Force in programs"))
        devices = {
            "none": translate("BeltGrinding", "Not at all"),
            "analog": translate("BeltGrinding", "Analog output"),
            "controller": translate("BeltGrinding", "Force control of the robot"),
            "call": translate("BeltGrinding", "Subprogram"),
            "template": translate("BeltGrinding", "Statement of your own"),
        }
        device.add("ForceDevice", translate("BeltGrinding", "Programs set it by"), devices)
        device.add("DeviceName", translate("BeltGrinding", "Name"))
        device.add("DeviceOutput", translate("BeltGrinding", "Output number"))
        device.add("DeviceTemplate", translate("BeltGrinding", "Statement"))
        device.add("DeviceScale", translate("BeltGrinding", "Value per newton"), SIGNED, "1/N")
        device.add("DeviceOffset", translate("BeltGrinding", "Value at 0 N"), SIGNED)
        device.add("DeviceLeast", translate("BeltGrinding", "Least force"))
        device.add("DeviceGreatest", translate("BeltGrinding", "Greatest force (0: any)"))
        device.add("DeviceRamp", translate("BeltGrinding", "Ramp (0: at once)"), unit="N/s")
        device.add("DeviceDeadTime", translate("BeltGrinding", "Dead time"), unit="s")
        device.add("DeviceResolution", translate("BeltGrinding", "Steps of the force (0: any)"))
        self.control, self.device, self.wheel = control, device, wheel
        forms = (kind, wheel, self.fork, self.run, self.platen, self.frame, belt, control, device)
        self.presets = PresetForm(obj, forms, self.hardness)
        self.add_fold("foldKind", "BeltMachine", kind)
        self.add_fold("foldPresets", "ApplyTemplate", self.presets)
        self.of_wheel = self.add_fold("foldWheel", "Wheel", wheel)
        self.of_fork = self.add_fold("foldFork", "Cell", self.fork, True)
        self.of_run = self.add_fold("foldRun", "Belt", self.run)
        self.of_platen = self.add_fold("foldPlaten", "Contact", self.platen)
        self.of_frame = self.add_fold("foldFrame", "Cell", self.frame, True)
        self.add_fold("foldBelt", "Belt", belt)
        self.add_fold("foldControl", "Force", control)
        choice = device.rows["ForceDevice"][1]
        none = obj.ForceDevice == "none"
        self.of_device = self.add_fold(
            "foldDevice", "ExportProgram", device, none, lambda: str(choice.currentText())
        )
        for form in forms:
            form.changed = self.arrange
        self.finish()
        self.arrange()

    def arrange(self) -> None:
        """Shows the fields that the kind, the elasticity and the control use."""
        of_wheel = self.obj.Kind in machines.WHEELS
        self.of_wheel.setVisible(of_wheel)
        self.of_run.setVisible(not of_wheel)
        self.of_frame.setVisible(not of_wheel)
        arms = {"FrameSpread", "FrameArmThickness"} if self.obj.FrameLength.Value > 0.0 else set()
        if arms and self.obj.FrameArmThickness.Value > 0.0:
            arms |= {"FrameArmSides"}
        self.frame.show_rows({"FrameLength"} | arms)
        self.of_fork.setVisible(self.obj.Kind == machines.SMALL_WHEEL)
        self.of_platen.setVisible(self.obj.Kind == machines.PLATEN)
        self.presets.show_kind(self.obj.Kind)
        if not self.layers.same(layers_of(self.obj)):
            self.layers.show_layers(layers_of(self.obj))
        self.drawing.update()
        moving = {"ForceLag", "OvershootLimit", "BounceTime"}
        dynamics: dict[str, set[str]] = {
            "ideal": set(),
            "lag": {"ForceLag"},
            "actuator": moving | {"MovingMass", "Damping", "SpeedLimit"},
        }
        force = {
            "force": {"Force", "ForceTravel", "ForceModel"} | dynamics[self.obj.ForceModel],
            "position": {"RobotStiffness"},
        }[self.obj.Control]
        rubber = {"YoungsModulus", "ShoreA", "PoissonsRatio"}
        rim = rubber | {"RimThickness"}
        belt = {"BeltTension", "BeltBending"}
        used: dict[str, set[str]] = {
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
        self.control.show_rows({"Control"} | force)
        by_force = self.obj.Control == "force"
        self.device.show_rows({"ForceDevice"} | self._device() if by_force else ())
        self.of_device.setVisible(by_force)
        self.hardness.follow()
        self.tell("")

    def _device(self) -> set[str]:
        """The rows that the force device uses."""
        value = {"DeviceName", "DeviceScale", "DeviceOffset"}
        used: dict[str, set[str]] = {
            "none": set(),
            "analog": value | {"DeviceOutput"},
            "controller": set(),
            "call": value,
            "template": {"DeviceTemplate"},
        }
        bounds = {
            "DeviceLeast",
            "DeviceGreatest",
            "DeviceRamp",
            "DeviceDeadTime",
            "DeviceResolution",
        }
        device = self.obj.ForceDevice
        return used[device] | (bounds if device != "none" else set())

    def _layers_changed(self) -> None:
        try:
            set_value(self.obj, LAYERS, self.layers.values())
        except InputError:
            return  # told below the rows, and again by OK
        self.drawing.update()

    def apply(self) -> None:
        if self.obj.Kind != machines.PLATEN:
            return
        wanted = self.layers.values()
        # What stood in the property may have been no list of layers.
        if layers_of(self.obj) != wanted or (self.obj.PlatenLayers and not wanted):
            set_value(self.obj, LAYERS, wanted)

    def check(self) -> None:
        if self.obj.BeltSpeed.Value <= 0:
            raise InputError("gui.belt_speed", "The belt speed must be positive.")
        if self.obj.Kind in machines.WHEELS:
            self._check_wheel()
        machine: dict[str, Any] = {}
        keys = (key for key in KIND_KEYS[self.obj.Kind] if key is not LAYERS)
        to_job(self.obj, (*keys, *machines.KEYS), machine)
        if self.obj.Kind == machines.PLATEN:
            machine["belt_machine"]["platen"]["layers"] = self.layers.values()
        machines.check_run(machine["belt_machine"])
        machines.check_device(self.obj)

    def _check_wheel(self) -> None:
        if self.obj.WheelRadius.Value <= 0:
            raise InputError("gui.wheel_radius", "The wheel's radius must be positive.")
        if self.obj.WheelWidth.Value <= 0:
            raise InputError("gui.wheel_width", "The wheel's width must be positive.")
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


def _run_form(obj: DocumentObject) -> Form:
    """The belt between its rollers."""
    form = Form(obj, translate("BeltGrinding", "Belt between rollers"))
    form.add("RunLength", translate("BeltGrinding", "Free length"))
    form.add("RunPosition", translate("BeltGrinding", "Contact off the middle"), SIGNED)
    rollers = {
        "tensioned": translate("BeltGrinding", "Tensioned: keep the pull"),
        "fixed": translate("BeltGrinding", "Fixed: the belt stretches"),
    }
    form.add("Rollers", translate("BeltGrinding", "Rollers"), rollers)
    form.add("RollerRadius", translate("BeltGrinding", "Rollers' radius"))
    form.add("RunWidth", translate("BeltGrinding", "Belt's width"))
    form.add("RunThickness", translate("BeltGrinding", "Belt's thickness"))
    form.add("RunTension", translate("BeltGrinding", "Tension"), unit="N/mm")
    form.add("RunModulus", translate("BeltGrinding", "Young's modulus"))
    form.add("RunPoissonsRatio", translate("BeltGrinding", "Poisson's ratio"))
    text = translate("BeltGrinding", "Belt's face (0: own)")
    form.add("FaceStiffness", text, unit="MPa/mm")
    return form


def _frame_form(obj: DocumentObject) -> Form:
    """What holds the rollers, and the belt's way to them."""
    form = Form(obj, translate("BeltGrinding", "Frame, for collisions"))
    form.add("FrameLength", translate("BeltGrinding", "Rollers to pulleys (0: none)"))
    form.add("FrameSpread", translate("BeltGrinding", "Between the runs"))
    form.add("FrameArmThickness", translate("BeltGrinding", "Arms (0: none)"))
    sides = {
        "both": translate("BeltGrinding", "Both"),
        "minus_y": translate("BeltGrinding", "At −y"),
        "plus_y": translate("BeltGrinding", "At +y"),
    }
    form.add("FrameArmSides", translate("BeltGrinding", "Sides with arms"), sides)
    return form
