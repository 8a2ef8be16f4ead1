"""The belt machine in the document: contact wheel, belt, control, the cell's frames, the robot."""

from .belt import Belt
from .geometry import matrix, placement_to_job
from .properties import Key, add_keys, check_limits, to_job
from .proxy import Proxy, checking, type_of

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
    Key("RobotStiffness", "Float", "Control", "belt_machine.robot_stiffness_N_per_mm"),
    Key("ContactSpacing", "Length", "Contact", "belt_machine.contact_spacing_mm"),
    Key("ContactTolerance", "Float", "Contact", "belt_machine.contact_tolerance"),
    Key("Holding", "Enumeration", "Cell", "cell.holding"),
    Key("CheckCollisions", "Bool", "Bodies", "cell.check_collisions"),
    Key("Clearance", "Length", "Bodies", "cell.clearance_mm"),
    Key("WheelInset", "Length", "Bodies", "cell.wheel_inset_mm"),
    Key("Robot", "String", "Robot", "robot.preset"),
    Key("RobotModel", "JSON", "Robot", "robot.model"),
    Key("StartJoints", "JSON", "Robot", "robot.start_joints_deg"),
    Key("LinkRadii", "JSON", "Robot", "robot.link_radii_mm"),
    Key("SingularityAngle", "Angle", "Robot", "robot.singularity_deg"),
    Key("FlipAngle", "Angle", "Robot", "robot.flip_deg"),
)
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


class BeltMachine(Proxy):
    """Proxy."""

    TYPE = "BeltGrinding::BeltMachine"
    VIEW = "BeltMachineView"

    def add_properties(self, obj):
        add_keys(obj, KEYS)
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

    def execute(self, obj):
        """Raises InputError for a machine that cannot be; the tree shows it there."""
        with checking(obj):
            check_limits(obj, KEYS)

    def to_job(self, obj):
        """The parts of a job under 'belt_machine', 'cell' and 'robot'."""
        job = {}
        to_job(obj, KEYS, job)
        if type_of(obj.Belt) == Belt.TYPE:
            job["belt_machine"]["belt"] = obj.Belt.Proxy.state(obj.Belt)
        for name, (key, _) in FRAMES.items():
            job["cell"][key] = placement_to_job(getattr(obj, name))
        for name, (key, _) in ROBOT_FRAMES.items():
            job["robot"][key] = placement_to_job(getattr(obj, name))
        return job

    def robot(self, obj):
        """The part of a job under 'robot'."""
        return self.to_job(obj)["robot"]

    def cell(self, obj):
        """The cell's frames as core.ToolPath takes them: 4 x 4 in mm, by name."""
        cell = {"holding": obj.Holding}
        for name, (key, _) in FRAMES.items():
            cell[key] = matrix(getattr(obj, name))
        return cell
