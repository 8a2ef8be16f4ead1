"""The belt machine in the document: what presses the belt, the belt, control, the cell's frames, the robot."""

from __future__ import annotations

from typing import Any

from ..base import schemas
from ..engine import InputError
from ..job.machine import FREE_BELT, PLATEN, SMALL_WHEEL, WHEEL, WHEELS, check_run
from ..programs.force_device import ForceDevice, device_of, of_job
from .belt import Belt
from .geometry import matrix, placement_to_job
from .kinds import DocumentObject
from .properties import Key, add_keys, check_limits, get_value, rule, to_job
from .proxy import Proxy, checking, type_of

KIND = Key("Kind", "Enumeration", "Machine", "belt_machine.kind")
RUN_KEYS = (
    Key("RunLength", "Length", "Free run", "belt_machine.free_run.length_mm"),
    Key("RunPosition", "Distance", "Free run", "belt_machine.free_run.position_mm"),
    Key("Rollers", "Enumeration", "Free run", "belt_machine.free_run.rollers"),
    Key("RollerRadius", "Length", "Free run", "belt_machine.free_run.roller_radius_mm"),
    Key("RunWidth", "Length", "Free run", "belt_machine.free_run.width_mm"),
    Key("RunThickness", "Length", "Free run", "belt_machine.free_run.thickness_mm"),
    Key("RunTension", "Float", "Free run", "belt_machine.free_run.tension_N_per_mm"),
    Key("RunModulus", "Pressure", "Free run", "belt_machine.free_run.youngs_modulus_MPa"),
    Key("RunPoissonsRatio", "Float", "Free run", "belt_machine.free_run.poissons_ratio"),
    Key("FaceStiffness", "Float", "Free run", "belt_machine.free_run.surface_stiffness_MPa_per_mm"),
)
PLATEN_KEYS = (
    Key("PlatenLength", "Length", "Platen", "belt_machine.platen.length_mm"),
    Key("PlatenRadius", "Length", "Platen", "belt_machine.platen.radius_mm"),
    Key("PlatenLayers", "JSON", "Platen", "belt_machine.platen.layers"),
    Key("LayerStiffness", "Float", "Platen", "belt_machine.platen.surface_stiffness_MPa_per_mm"),
    Key("PlateThickness", "Length", "Platen", "belt_machine.platen.plate_thickness_mm"),
)
FRAME_KEYS = (
    Key("FrameLength", "Length", "Frame", "belt_machine.frame.length_mm"),
    Key("FrameSpread", "Length", "Frame", "belt_machine.frame.spread_mm"),
    Key("FrameArmThickness", "Length", "Frame", "belt_machine.frame.arm_thickness_mm"),
    Key("FrameArmSides", "Enumeration", "Frame", "belt_machine.frame.arm_sides"),
)
FORK_KEYS = (
    Key("ForkLength", "Length", "Fork", "belt_machine.fork.length_mm"),
    Key("ForkSpread", "Length", "Fork", "belt_machine.fork.spread_mm"),
    Key("ForkBeltThickness", "Length", "Fork", "belt_machine.fork.belt_thickness_mm"),
    Key("ForkArmThickness", "Length", "Fork", "belt_machine.fork.arm_thickness_mm"),
)
# What a job has only of such a machine; a contact wheel's is that of earlier versions.
KIND_KEYS = {
    WHEEL: (),
    FREE_BELT: (KIND, *RUN_KEYS, *FRAME_KEYS),
    PLATEN: (KIND, *RUN_KEYS, *PLATEN_KEYS, *FRAME_KEYS),
    SMALL_WHEEL: (KIND, *FORK_KEYS),
}
DEVICE_KEYS = (
    Key("ForceDevice", "Enumeration", "Force device", "belt_machine.force_device.kind"),
    Key("DeviceName", "String", "Force device", "belt_machine.force_device.name"),
    Key("DeviceOutput", "Integer", "Force device", "belt_machine.force_device.output"),
    Key("DeviceTemplate", "String", "Force device", "belt_machine.force_device.template"),
    Key("DeviceScale", "Float", "Force device", "belt_machine.force_device.scale_per_N"),
    Key("DeviceOffset", "Float", "Force device", "belt_machine.force_device.offset"),
    Key("DeviceLeast", "Force", "Force device", "belt_machine.force_device.least_N"),
    Key("DeviceGreatest", "Force", "Force device", "belt_machine.force_device.greatest_N"),
    Key("DeviceRamp", "Float", "Force device", "belt_machine.force_device.ramp_N_s"),
    Key("DeviceDeadTime", "Float", "Force device", "belt_machine.force_device.dead_time_s"),
    Key("DeviceResolution", "Force", "Force device", "belt_machine.force_device.resolution_N"),
)
KEYS = (
    Key("WheelRadius", "Length", "Wheel", "belt_machine.wheel.radius_mm"),
    Key("WheelWidth", "Length", "Wheel", "belt_machine.wheel.width_mm"),
    Key("CrownRadius", "Length", "Wheel", "belt_machine.wheel.crown_radius_mm"),
    Key("Profile", "VectorList", "Wheel", "belt_machine.wheel.profile_mm"),
    Key("Compliance", "Enumeration", "Elasticity", "belt_machine.compliance.model"),
    Key("YoungsModulus", "Pressure", "Elasticity", "belt_machine.compliance.youngs_modulus_MPa"),
    Key("PoissonsRatio", "Float", "Elasticity", "belt_machine.compliance.poissons_ratio"),
    Key("RimThickness", "Length", "Elasticity", "belt_machine.compliance.rim_thickness_mm"),
    Key("BeltTension", "Float", "Elasticity", "belt_machine.compliance.belt_tension_N_per_mm"),
    Key("BeltBending", "Float", "Elasticity", "belt_machine.compliance.belt_bending_N_mm"),
    Key("Stiffness", "Float", "Elasticity", "belt_machine.compliance.stiffness_MPa_per_mm"),
    Key(
        "DynamicModulusFactor",
        "Float",
        "Elasticity",
        "belt_machine.compliance.dynamic_modulus_factor",
    ),
    Key("WheelDensity", "Float", "Elasticity", "belt_machine.wheel_density_kg_m3"),
    Key("SurrogateFile", "File", "Elasticity", "belt_machine.compliance.surrogate_file"),
    Key("BeltSpeed", "Speed", "Belt", "belt_machine.belt_speed_m_s", 1000.0),
    Key("BeltWear", "Float", "Belt", "belt_machine.belt_wear"),
    Key("Control", "Enumeration", "Control", "belt_machine.control"),
    Key("Force", "Force", "Control", "belt_machine.force_N"),
    Key("ForceTravel", "Length", "Control", "belt_machine.force_travel_mm"),
    Key("ForceModel", "Enumeration", "Control", "belt_machine.force_dynamics.model"),
    Key("ForceLag", "Float", "Control", "belt_machine.force_dynamics.lag_s"),
    Key("MovingMass", "Float", "Control", "belt_machine.force_dynamics.moving_mass_kg"),
    Key("Damping", "Float", "Control", "belt_machine.force_dynamics.damping_N_s_per_mm"),
    Key("SpeedLimit", "Speed", "Control", "belt_machine.force_dynamics.speed_limit_mm_s"),
    Key("OvershootLimit", "Float", "Control", "belt_machine.force_dynamics.overshoot_limit"),
    Key("BounceTime", "Float", "Control", "belt_machine.force_dynamics.bounce_s"),
    *DEVICE_KEYS,
    Key("RobotStiffness", "Float", "Control", "belt_machine.robot_stiffness_N_per_mm"),
    Key("ContactSpacing", "Length", "Contact", "belt_machine.contact_spacing_mm"),
    Key("ContactTolerance", "Float", "Contact", "belt_machine.contact_tolerance"),
    Key("Holding", "Enumeration", "Cell", "cell.holding"),
    Key("CheckCollisions", "Bool", "Bodies", "cell.check_collisions"),
    Key("Clearance", "Length", "Bodies", "cell.clearance_mm"),
    Key("WheelInset", "Length", "Bodies", "cell.wheel_inset_mm"),
    Key("Robot", "String", "Robot", "robot.preset"),
    Key("Controller", "String", "Robot", "robot.controller"),
    Key("RobotModel", "JSON", "Robot", "robot.model"),
    Key("RobotPackages", "JSON", "Robot", "robot.packages"),
    Key("Load", "JSON", "Robot", "robot.load"),
    Key("ExternalAxes", "JSON", "Robot", "robot.external_axes"),
    Key("RobotProgram", "JSON", "Robot", "robot.program"),
    Key("StartJoints", "JSON", "Robot", "robot.start_joints_deg"),
    Key("LinkRadii", "JSON", "Robot", "robot.link_radii_mm"),
    Key("SingularityAngle", "Angle", "Robot", "robot.singularity_deg"),
    Key("FlipAngle", "Angle", "Robot", "robot.flip_deg"),
)
ALL_KEYS = (KIND, *RUN_KEYS, *PLATEN_KEYS, *FRAME_KEYS, *FORK_KEYS, *KEYS)
OF_KINDS = (
    "Free run",
    "Platen",
    "Frame",
    "Fork",
    "Wheel",
    "Elasticity",
)  # groups that not all kinds use
FRAMES = {
    "BaseFromWork": ("base_from_work", "tool in hand: the document's origin in the base frame"),
    "TcpFromContact": ("tcp_from_contact", "tool in hand: the contact frame in the tool frame"),
    "TcpFromWork": ("tcp_from_work", "part in hand: the document's origin in the tool frame"),
    "BaseFromContact": ("base_from_contact", "part in hand: the contact frame in the base frame"),
}
# property: (frame that its objects' coordinates are taken in, text)
BODIES = {
    "BodiesInBase": ("base", "what stands still in the cell, in the base frame"),
    "BodiesInTool": ("tool", "what the robot carries (gripper, tool), in the tool frame"),
    "BodiesAtWheel": ("contact", "what goes with the wheel (housing), in the contact frame"),
    "BodiesAtPart": ("part", "what goes with the part (clamps), in the document's coordinates"),
}
ROBOT_FRAMES = {
    "BaseFromRobot": ("base_from_robot", "the robot's own base in the base frame of the programs"),
    "FlangeFromTcp": ("flange_from_tcp", "the tool frame of the programs in the robot's flange"),
}


LAYERS = next(key for key in PLATEN_KEYS if key.name == "PlatenLayers")


def layers_of(machine: DocumentObject) -> list[Any]:
    """A platen's layers, as a job has them; none where what stands in the property is no such list, which ``execute`` tells."""
    try:
        return schemas.checked(get_value(machine, LAYERS), rule(LAYERS.key)[0], LAYERS.key)
    except InputError:
        return []


def check_device(machine: DocumentObject) -> None:
    """Raises InputError for a force device that cannot be."""
    given: dict[str, Any] = {}
    to_job(machine, DEVICE_KEYS, given)
    device_of(given["belt_machine"]["force_device"])


def half_size(machine: DocumentObject) -> float:
    """mm: how far what presses reaches about from the contact, for cameras and arrows; of a wheel its radius."""
    if machine.Kind in WHEELS:
        return machine.WheelRadius.Value
    return 0.5 * machine.RunLength.Value


def across(machine: DocumentObject) -> float:
    """mm: the width of what presses."""
    return (machine.WheelWidth if machine.Kind in WHEELS else machine.RunWidth).Value


class BeltMachine(Proxy):
    """Proxy. Of the properties of the other kinds none is in its job; the property editor hides them."""

    TYPE = "BeltGrinding::BeltMachine"
    VIEW = "BeltMachineView"

    def add_properties(self, obj: DocumentObject) -> None:
        add_keys(obj, ALL_KEYS)
        if "Belt" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyLinkGlobal", "Belt", "Belt", "the belt, none: a fresh one"
            )
        for name, (_, text) in FRAMES.items():
            if name not in obj.PropertiesList:
                obj.addProperty("App::PropertyPlacement", name, "Cell", text)
        for name, (_, text) in BODIES.items():
            if name not in obj.PropertiesList:
                obj.addProperty("App::PropertyLinkListGlobal", name, "Bodies", text)
        for name, (_, text) in ROBOT_FRAMES.items():
            if name not in obj.PropertiesList:
                obj.addProperty("App::PropertyPlacement", name, "Robot", text)
        self.arrange(obj)

    def execute(self, obj: DocumentObject) -> None:
        """Raises InputError for a machine that cannot be; the tree shows it there."""
        with checking(obj):
            check_limits(obj, (*KIND_KEYS[obj.Kind], *KEYS))
            check_device(obj)
            if obj.Kind != WHEEL:
                rules = schemas.schema("job")["properties"]["belt_machine"]
                given = self.to_job(obj)["belt_machine"]
                check_run(schemas.checked(given, rules, "belt_machine"))

    def onChanged(self, obj: DocumentObject, name: str) -> None:
        """Called by FreeCAD: shows the properties of the kind that was chosen."""
        super().onChanged(obj, name)
        if name == KIND.name and obj.Kind in KIND_KEYS:
            self.arrange(obj)

    def arrange(self, obj: DocumentObject) -> None:
        """Hides in the property editor what the kind does not use."""
        used = {key.name for key in KIND_KEYS[obj.Kind]}
        if obj.Kind in WHEELS:
            used |= {key.name for key in KEYS if key.group in ("Wheel", "Elasticity")}
        for key in ALL_KEYS:
            if key.group in OF_KINDS and hasattr(obj, key.name):
                obj.setEditorMode(key.name, 0 if key.name in used else 2)

    def to_job(self, obj: DocumentObject) -> dict[str, Any]:
        """The parts of a job under 'belt_machine', 'cell' and 'robot'."""
        job: dict[str, Any] = {}
        to_job(obj, (*KIND_KEYS[obj.Kind], *KEYS), job)
        if type_of(obj.Belt) == Belt.TYPE:
            job["belt_machine"]["belt"] = obj.Belt.Proxy.state(obj.Belt)
        for name, (key, _) in FRAMES.items():
            job["cell"][key] = placement_to_job(getattr(obj, name))
        for name, (key, _) in ROBOT_FRAMES.items():
            job["robot"][key] = placement_to_job(getattr(obj, name))
        return job

    def force_device(self, obj: DocumentObject) -> ForceDevice | None:
        """What sets the pressing force in programs; None: nothing. Raises InputError."""
        return of_job(self.to_job(obj))

    def robot(self, obj: DocumentObject) -> dict[str, Any]:
        """The part of a job under 'robot'; of nothing else, so that a cell is drawn whatever else is wrong."""
        job: dict[str, Any] = {}
        to_job(obj, [key for key in KEYS if key.key.startswith("robot.")], job)
        for name, (key, _) in ROBOT_FRAMES.items():
            job["robot"][key] = placement_to_job(getattr(obj, name))
        return job["robot"]

    def cell(self, obj: DocumentObject) -> dict[str, Any]:
        """The cell's frames as core.ToolPath takes them: 4 x 4 in mm, by name."""
        cell = {"holding": obj.Holding}
        for name, (key, _) in FRAMES.items():
            cell[key] = matrix(getattr(obj, name))
        return cell
