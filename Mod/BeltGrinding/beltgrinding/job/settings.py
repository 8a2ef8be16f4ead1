"""A job's settings as frozen dataclasses, one of each object of its schema. Made by tools/job_settings.py; not to be edited.

Units stand in the names. Defaults, ranges and what each means: Resources/schema/job.schema.json. A key that a job may
leave out, and for which the schema has no default, is None.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal


@dataclass(frozen=True, kw_only=True)
class Frame:
    """A frame in a job."""

    position_mm: tuple[float, float, float]
    quaternion_wxyz: tuple[float, float, float, float] | None = None
    abc_deg: tuple[float, float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class Design:
    """``design`` of a job."""

    file: str | None = None
    brep: str | None = None
    faces: tuple[int, ...]
    unit_mm: float
    flip_normals: bool
    flip_faces: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Sampling:
    """``sampling`` of a job."""

    spacing_mm: float
    precision_mm: float
    edge_spacing_mm: float
    depth_mm: float


@dataclass(frozen=True, kw_only=True)
class Stock:
    """``stock`` of a job."""

    kind: Literal["allowance", "solid", "mesh", "left"]
    allowance_mm: float
    file: str | None = None
    brep: str | None = None
    deflection_mm: float
    unit_mm: float
    placement: Frame | None = None
    offset_mm: float
    search_above_mm: float
    search_below_mm: float
    left_by: str | None = None


@dataclass(frozen=True, kw_only=True)
class Wheel:
    """``belt_machine.wheel`` of a job."""

    radius_mm: float
    width_mm: float
    crown_radius_mm: float
    profile_mm: tuple[tuple[float, float], ...]


@dataclass(frozen=True, kw_only=True)
class FreeRun:
    """``belt_machine.free_run`` of a job."""

    length_mm: float
    position_mm: float
    rollers: Literal["fixed", "tensioned"]
    roller_radius_mm: float
    width_mm: float
    thickness_mm: float
    youngs_modulus_MPa: float
    poissons_ratio: float
    tension_N_per_mm: float
    surface_stiffness_MPa_per_mm: float


@dataclass(frozen=True, kw_only=True)
class Fork:
    """``belt_machine.fork`` of a job."""

    length_mm: float
    spread_mm: float
    belt_thickness_mm: float
    arm_thickness_mm: float


@dataclass(frozen=True, kw_only=True)
class Layer:
    """``belt_machine.platen.layers`` of a job."""

    thickness_mm: float
    youngs_modulus_MPa: float
    poissons_ratio: float


@dataclass(frozen=True, kw_only=True)
class Platen:
    """``belt_machine.platen`` of a job."""

    length_mm: float
    radius_mm: float
    layers: tuple[Layer, ...]
    surface_stiffness_MPa_per_mm: float
    plate_thickness_mm: float


@dataclass(frozen=True, kw_only=True)
class BeltFrame:
    """``belt_machine.frame`` of a job."""

    length_mm: float
    spread_mm: float
    arm_thickness_mm: float
    arm_sides: Literal["both", "minus_y", "plus_y"]


@dataclass(frozen=True, kw_only=True)
class Belt:
    """``belt_machine.belt`` of a job."""

    work_J: float
    removed_mm3: float
    hours: float
    loading: float


@dataclass(frozen=True, kw_only=True)
class Compliance:
    """``belt_machine.compliance`` of a job."""

    model: Literal[
        "wheel_rim", "bonded_layer", "half_space", "elastic_foundation", "surrogate", "geometric"
    ]
    youngs_modulus_MPa: float
    poissons_ratio: float
    rim_thickness_mm: float
    layers: tuple[Layer, ...]
    belt_tension_N_per_mm: float
    belt_bending_N_mm: float
    dynamic_modulus_factor: float
    stiffness_MPa_per_mm: float
    surrogate_file: str


@dataclass(frozen=True, kw_only=True)
class ForceDynamics:
    """``belt_machine.force_dynamics`` of a job."""

    model: Literal["ideal", "lag", "actuator"]
    lag_s: float
    moving_mass_kg: float
    damping_N_s_per_mm: float
    speed_limit_mm_s: float
    overshoot_limit: float
    bounce_s: float


@dataclass(frozen=True, kw_only=True)
class ForceDevice:
    """``belt_machine.force_device`` of a job."""

    kind: Literal["none", "analog", "controller", "call", "template"]
    name: str
    output: int
    template: str
    scale_per_N: float
    offset: float
    least_N: float
    greatest_N: float
    ramp_N_s: float
    dead_time_s: float
    resolution_N: float


@dataclass(frozen=True, kw_only=True)
class BeltMachine:
    """``belt_machine`` of a job."""

    wheel: Wheel
    kind: Literal["contact_wheel", "free_belt", "platen", "small_wheel"] | None = None
    free_run: FreeRun | None = None
    fork: Fork | None = None
    platen: Platen | None = None
    frame: BeltFrame | None = None
    belt_speed_m_s: float
    belt_wear: float
    belt: Belt
    compliance: Compliance
    control: Literal["force", "position"]
    force_N: float
    force_travel_mm: float
    robot_stiffness_N_per_mm: float
    wheel_density_kg_m3: float
    force_dynamics: ForceDynamics
    force_device: ForceDevice
    contact_spacing_mm: float
    contact_tolerance: float


@dataclass(frozen=True, kw_only=True)
class Wear:
    """``law.wear`` of a job."""

    model: Literal["none", "exponential", "two_stage", "power", "curve"]
    variable: Literal["work", "volume"]
    scale: float
    rest: float
    first_share: float
    first_scale: float
    exponent: float
    loading_share: float
    loading_scale: float
    loading_recovery_s: float
    dressing_rest: float
    curve: tuple[tuple[float, float], ...]


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """``law.calibration`` of a job."""

    parameters: tuple[str, ...] | None = None
    covariance: tuple[tuple[float, ...], ...] | None = None
    scatter: float | None = None
    freedom: float | None = None
    widening: float | None = None
    fit: Mapping[str, Any] | None = None


@dataclass(frozen=True, kw_only=True)
class Law:
    """``law`` of a job."""

    model: Literal["local_linear", "local", "hammann", "geometric"]
    coefficient_mm2_per_N: float
    pressure_threshold_MPa: float
    pressure_exponent: float
    reference_pressure_MPa: float
    saturation_pressure_MPa: float
    speed_exponent: float
    reference_speed_m_s: float
    feed_exponent: float
    reference_feed_mm_s: float
    land_share: float
    pressure_curve: tuple[tuple[float, float], ...]
    speed_curve: tuple[tuple[float, float], ...]
    feed_curve: tuple[tuple[float, float], ...]
    land_curve: tuple[tuple[float, float], ...]
    heat_limit_MPa_m_s: float
    pressure_limit_MPa: float
    wear: Wear
    calibration: Calibration


@dataclass(frozen=True, kw_only=True)
class Heat:
    """``heat`` of a job."""

    material: str
    conductivity_W_mK: float
    heat_capacity_J_kgK: float
    density_kg_m3: float
    friction: tuple[float, float]
    partition: tuple[float, float]
    start_temperature_C: float
    burn_temperature_C: float
    burn_source: str


@dataclass(frozen=True, kw_only=True)
class FinishRanges:
    """``finish.model.ranges`` of a job."""

    grit: tuple[float, float]
    pressure_MPa: tuple[float, float]
    belt_speed_m_s: tuple[float, float]
    feed_mm_s: tuple[float, float]
    remaining_cut: tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class FinishModel:
    """``finish.model`` of a job."""

    coefficient_um: float
    grit_exponent: float
    pressure_exponent: float
    belt_speed_exponent: float
    feed_exponent: float
    wear_exponent: float
    reference_grit: float
    reference_pressure_MPa: float
    reference_belt_speed_m_s: float
    reference_feed_mm_s: float
    rest_per_pass: float | None = None
    ln_deviation: float | None = None
    ranges: FinishRanges
    source: str
    calibration: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class Finish:
    """``finish`` of a job."""

    initial_Ra_um: float | None = None
    grit: float | None = None
    rest_per_pass: float | None = None
    crossing_angle_deg: float
    model: FinishModel | None = None


@dataclass(frozen=True, kw_only=True)
class Body:
    """``cell.bodies`` of a job."""

    name: str
    file: str | None = None
    brep: str | None = None
    unit_mm: float
    frame: Literal["base", "tool", "wheel", "part"]
    placement: Frame | None = None


@dataclass(frozen=True, kw_only=True)
class Cell:
    """``cell`` of a job."""

    holding: Literal["tool_in_hand", "part_in_hand"]
    base_from_work: Frame | None = None
    tcp_from_contact: Frame | None = None
    tcp_from_work: Frame | None = None
    base_from_contact: Frame | None = None
    check_collisions: bool
    clearance_mm: float
    wheel_inset_mm: float
    bodies: tuple[Body, ...]


@dataclass(frozen=True, kw_only=True)
class Joint:
    """``robot.model.joints`` of a job."""

    origin_mm: tuple[float, float, float]
    rpy_deg: tuple[float, float, float]
    axis: tuple[float, float, float]
    a_mm: float
    alpha_deg: float
    d_mm: float
    theta_deg: float
    direction: Literal[1, -1]
    lower_deg: float
    upper_deg: float
    max_speed_deg_s: float


@dataclass(frozen=True, kw_only=True)
class RobotModel:
    """``robot.model`` of a job."""

    convention: Literal["urdf", "standard_dh", "modified_dh"]
    joints: tuple[Joint, ...]
    joint6_from_flange: Frame | None = None
    coupling: Literal[0, 1, -1]
    floor_mm: float
    urdf: str
    base_link: str
    tip_link: str


@dataclass(frozen=True, kw_only=True)
class Load:
    """``robot.load`` of a job."""

    mass_kg: float
    centre_mm: tuple[float, float, float]
    inertia_kg_m2: tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class ExternalAxis:
    """``robot.external_axes`` of a job."""

    kind: Literal["linear", "rotary"]
    carries: Literal["robot", "part"]
    origin_mm: tuple[float, float, float]
    axis: tuple[float, float, float]
    lower: float
    upper: float
    max_speed: float
    motion: Literal["indexed", "coordinated"]
    home: float
    position: float


@dataclass(frozen=True, kw_only=True)
class RobotProgram:
    """``robot.program`` of a job."""

    home_joints_deg: tuple[float, ...]
    base: str
    safe_joints_deg: tuple[tuple[float, float, float, float, float, float], ...]
    order: Literal["program", "least_way"]
    roll_deg: float
    lean_deg: float
    shift_share: float
    retract_mm: float
    retract_feed_mm_s: float
    clearance_mm: float
    joint_speed_percent: float
    joint_acceleration_deg_s2: tuple[float, ...]
    joint_jerk_deg_s3: tuple[float, ...]
    seed: int


@dataclass(frozen=True, kw_only=True)
class Robot:
    """``robot`` of a job."""

    controller: str
    preset: str
    model: RobotModel
    packages: tuple[str, ...]
    load: Load
    external_axes: tuple[ExternalAxis, ...]
    base_from_robot: Frame | None = None
    flange_from_tcp: Frame | None = None
    program: RobotProgram
    start_joints_deg: tuple[float, ...]
    link_radii_mm: tuple[float, ...]
    singularity_deg: float
    flip_deg: float


@dataclass(frozen=True, kw_only=True)
class Program:
    """``programs`` of a job."""

    file: str | None = None
    poses: Sequence[Mapping[str, Any]] | None = None
    name: str | None = None
    values: str | Mapping[str, Any] | None = None
    roll: Literal["hold", "along", "fixed"] | None = None
    roll_direction: tuple[float, float, float] | None = None
    force_N: float | None = None
    feed_mm_s: float | None = None
    pause_s: float | None = None
    dress: bool | None = None
    unresolved: int


@dataclass(frozen=True, kw_only=True)
class Resolution:
    """``resolution`` of a job."""

    mode: Literal["full", "coarse"]


@dataclass(frozen=True, kw_only=True)
class Simulation:
    """``simulation`` of a job."""

    max_travel_mm: float
    max_angle_deg: float
    timing: Literal["constant_feed", "trapezoidal"]
    path_acceleration_mm_s2: float
    angular_acceleration_deg_s2: float
    rotation_speed_deg_s: float
    default_zone_mm: float
    orientation_jump_deg: float
    tilt_limit_deg: float


@dataclass(frozen=True, kw_only=True)
class ZoneFinish:
    """``inspection.zones.finish`` of a job."""

    Ra_max_um: float | None = None
    acceptance: Literal["Tmax", "T16%"]
    lay: Literal["=", "⊥", "X", "M", "C", "R", "P"] | None = None
    lay_direction: tuple[float, float, float] | None = None
    lay_centre_mm: tuple[float, float, float] | None = None
    lay_tolerance_deg: float


@dataclass(frozen=True, kw_only=True)
class Zone:
    """``inspection.zones`` of a job."""

    name: str
    faces: tuple[int, ...]
    tolerance_mm: tuple[float, float] | None = None
    edge_radius_mm: float | None = None
    thickness_mm: tuple[float, float] | None = None
    finish: ZoneFinish | None = None


@dataclass(frozen=True, kw_only=True)
class InspectedSection:
    """``inspection.sections`` of a job."""

    name: str
    point_mm: tuple[float, float, float]
    normal: tuple[float, float, float]
    leading: tuple[float, float, float] | None = None
    edge_distances_mm: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class Inspection:
    """``inspection`` of a job."""

    tolerance_mm: tuple[float, float]
    colour_limit_mm: float
    zones: tuple[Zone, ...]
    sections: tuple[InspectedSection, ...]


@dataclass(frozen=True, kw_only=True)
class Job:
    """A whole job."""

    schema: int
    design: Design
    sampling: Sampling
    stock: Stock
    belt_machine: BeltMachine
    law: Law
    heat: Heat | None = None
    finish: Finish | None = None
    cell: Cell
    robot: Robot
    programs: tuple[Program, ...]
    resolution: Resolution
    simulation: Simulation
    inspection: Inspection
