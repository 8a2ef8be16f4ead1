"""What the engine takes of a job: its records as they are, and what follows from them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Union

import numpy as np

from ..base import records
from ..engine import InputError
from . import law as laws, machine as machines, surrogate_file
from .settings import BeltMachine, Compliance, Job, Law, Layer, Simulation, Wheel
from .surrogate_file import Surrogate
from .typed import typed

TONNES_PER_MM3 = 1e-12  # of kg/m3

Elasticity = Union[Compliance, Surrogate]
Range = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class HeatInput:
    """How hot the part becomes (HeatRequest, beltgrinding/simulation.h)."""

    part: Any  # core.PartHeat; of what is digested: what it was made of
    friction: float
    partition: float  # share of the heat that flows into the work
    low: float  # of the rise
    high: float
    start: float  # degrees C
    burn: float  # degrees C; 0: not known


@dataclass(frozen=True, kw_only=True)
class FinishInput:
    """What finish the passes leave (FinishRequest, beltgrinding/simulation.h), whose defaults stand for None."""

    before: float | None = None  # um
    rest: float | None = None
    roughness: float  # um; 0: none is computed
    pressure_exponent: float | None = None
    speed_exponent: float | None = None
    feed_exponent: float | None = None
    cut_exponent: float | None = None
    reference_pressure: float | None = None  # MPa
    reference_speed: float | None = None  # mm/s
    reference_feed: float | None = None  # mm/s
    pressure: Range | None = None  # MPa
    speed: Range | None = None  # mm/s
    feed: Range | None = None  # mm/s
    cut: Range | None = None


@dataclass(frozen=True, kw_only=True)
class EngineInput:
    """What core.simulate and core.contact_at are given, which read it as it is (src/python/simulation_settings.cpp)."""

    machine: BeltMachine
    law: Law
    simulation: Simulation
    elasticity: Elasticity | None  # None: no wheel presses the belt
    wheel_growth: float = 0.0  # mm
    shifted_laws: tuple[Law, ...] = ()
    belt: Mapping[str, float] | None = None  # as a result has it; None: the machine's
    pause_s: float = 0.0  # before the program, in which the belt runs free
    max_angle: float | None = None  # rad, in place of the simulation's
    must_touch: bool = True
    trace: bool = True
    first_motion: int = 0
    cell_errors: bool = True
    influence: bool = False
    force_influence: bool = False
    lower_limits: np.ndarray[Any, np.dtype[np.float32]] | None = None  # mm
    heat: HeatInput | None = None
    finish: FinishInput | None = None

    @property
    def rigid(self) -> bool:
        """Whether a tool presses that has no pressure."""
        return self.elasticity is not None and self.elasticity.model == "geometric"


def of(job: Job | Mapping[str, Any]) -> EngineInput:
    """The input of a validated job. Raises InputError for a surrogate's file that does not fit, and for an actuator that
    nothing holds back."""
    job = typed(job)
    machine = job.belt_machine
    elasticity: Elasticity | None = None
    if machines.wheel_presses(machine):
        if job.law.model == "geometric":
            elasticity = replace(machine.compliance, model="geometric")
        else:
            elasticity = elasticity_of(machine.compliance, machine.wheel)
    _check_dynamics(machine)
    rigid = elasticity is not None and elasticity.model == "geometric"
    return EngineInput(
        machine=machine,
        law=job.law,
        simulation=job.simulation,
        elasticity=elasticity,
        wheel_growth=0.0 if rigid else wheel_growth(machine),
        shifted_laws=tuple(laws.shifted_laws(job.law)),
    )


def at_program(given: EngineInput, job: Job | Mapping[str, Any], index: int) -> EngineInput:
    """``given`` for a program (from 0), with what happens to the belt before it: a pause, which the engine counts, and a
    dressing. Raises InputError for a dressing of a belt that does not load."""
    program = typed(job).programs[index]
    given = replace(given, pause_s=program.pause_s or 0.0)
    if not program.dress:
        return given
    wear = laws.engine_wear(given.law)
    if not wear.loading_share > 0.0:
        raise InputError(
            "job.dress_without_loading",
            "{key}: the belt is dressed, and law.wear.loading_share is 0; set that share, or leave out 'dress'",
            key=f"programs[{index}].dress",
        )
    belt = given.belt or laws.engine_belt(records.plain(given.machine.belt))
    return replace(given, belt=laws.dressed(wear, belt))


def elasticity_of(compliance: Compliance, wheel: Wheel) -> Elasticity:
    """A compliance, or the surrogate that it names. Raises InputError for a surrogate's file that does not fit."""
    if compliance.model != "surrogate":
        return compliance
    factor = compliance.dynamic_modulus_factor
    asked = {
        **records.plain(compliance),
        "youngs_modulus_MPa": factor * compliance.youngs_modulus_MPa,
        "outer_radius_mm": wheel.radius_mm,
        "width_mm": wheel.width_mm,
        "crown_radius_mm": wheel.crown_radius_mm,
        "profile_mm": wheel.profile_mm,
    }
    return surrogate_file.arguments(compliance.surrogate_file, asked)


def wheel_growth(machine: BeltMachine | Mapping[str, Any]) -> float:
    """mm by which the rim grows by its rotation: rho V_b^2 / R times the integral of (h - x) / M over its thickness, x from
    the core, with M of the slow modulus, since the load stands still against the rubber. 0 without a density, under
    force control and for a rigid tool.
    """
    machine = records.made(BeltMachine, machine)
    compliance = machine.compliance
    if not machines.wheel_presses(machine):
        return 0.0
    if machine.control == "force" or compliance.model == "geometric":
        return 0.0
    whole = Layer(
        thickness_mm=compliance.rim_thickness_mm,
        youngs_modulus_MPa=compliance.youngs_modulus_MPa,
        poissons_ratio=compliance.poissons_ratio,
    )
    above, integral = 0.0, 0.0  # mm; mm2/MPa
    for layer in reversed(compliance.layers or (whole,)):
        thickness, nu = layer.thickness_mm, layer.poissons_ratio
        modulus = layer.youngs_modulus_MPa * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
        integral += (above + 0.5 * thickness) * thickness / modulus
        above += thickness
    density = TONNES_PER_MM3 * machine.wheel_density_kg_m3
    speed = 1000.0 * machine.belt_speed_m_s
    return density * speed**2 * integral / machine.wheel.radius_mm


def _check_dynamics(machine: BeltMachine) -> None:
    given = machine.force_dynamics
    if given.model != "actuator":
        return
    if not given.moving_mass_kg > 0.0 and not given.damping_N_s_per_mm > 0.0:
        raise InputError(
            "job.actuator_without_inertia",
            "{key}: an actuator needs a moving mass or a damping; for a force that only lags choose the model lag",
            key="belt_machine.force_dynamics",
        )


def time_law(simulation: Simulation | Mapping[str, Any]) -> dict[str, Any]:
    """The dict that core.ToolPath takes for a job's ``simulation``: mm, s, rad."""
    simulation = records.made(Simulation, simulation)
    return {
        "timing": simulation.timing,
        "acceleration": float(simulation.path_acceleration_mm_s2),
        "angular_acceleration": math.radians(simulation.angular_acceleration_deg_s2),
        "rotation_speed": math.radians(simulation.rotation_speed_deg_s),
        "default_zone": float(simulation.default_zone_mm),
    }
