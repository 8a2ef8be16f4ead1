"""A job's settings as the engine takes them: mm, N, s, rad."""

import math

from ..engine import InputError
from . import law as laws, machine as machines

TONNES_PER_KG = 1e-3  # t: N s2/mm
TONNES_PER_MM3 = 1e-12  # of kg/m3


def time_law(simulation):
    """The dict that core.ToolPath takes for a job's ``simulation``: mm, s, rad."""
    return {
        "timing": simulation["timing"],
        "acceleration": float(simulation["path_acceleration_mm_s2"]),
        "angular_acceleration": math.radians(simulation["angular_acceleration_deg_s2"]),
        "rotation_speed": math.radians(simulation["rotation_speed_deg_s"]),
        "default_zone": float(simulation["default_zone_mm"]),
    }


def compliance_arguments(compliance, wheel):
    """The dict that core takes for the elasticity of a wheel (dict of radius, width, crown_radius,
    mm). Raises InputError for a surrogate's file that does not fit.
    """
    if compliance["model"] == "surrogate":
        from . import surrogate_file

        factor = compliance.get("dynamic_modulus_factor", 1.0)
        asked = {
            **compliance,
            "youngs_modulus_MPa": factor * compliance["youngs_modulus_MPa"],
            "outer_radius_mm": wheel["radius"],
            "width_mm": wheel["width"],
            "crown_radius_mm": wheel["crown_radius"],
            "profile_mm": wheel["profile"],
        }
        return surrogate_file.arguments(compliance["surrogate_file"], asked)
    names = {
        "youngs_modulus_MPa": "youngs_modulus",
        "poissons_ratio": "poissons_ratio",
        "rim_thickness_mm": "rim_thickness",
        "belt_tension_N_per_mm": "belt_tension",
        "belt_bending_N_mm": "belt_bending",
        "stiffness_MPa_per_mm": "stiffness",
    }
    result = {name: float(compliance[key]) for key, name in names.items()}
    factor = float(compliance.get("dynamic_modulus_factor", 1.0))
    for name in ("youngs_modulus", "stiffness"):
        result[name] *= factor
    result["model"] = compliance["model"]
    result["layers"] = [
        {
            "thickness": float(layer["thickness_mm"]),
            "youngs_modulus": factor * float(layer["youngs_modulus_MPa"]),
            "poissons_ratio": float(layer["poissons_ratio"]),
        }
        for layer in compliance["layers"]
    ]
    return result


def wheel_growth(machine):
    """mm by which the rim grows by its rotation: rho V_b^2 / R times the integral of (h - x) / M over its thickness, x from
    the core, with M of the slow modulus, since the load stands still against the rubber. 0 without a density, under
    force control and for a rigid tool.
    """
    compliance = machine["compliance"]
    if not machines.wheel_presses(machine):
        return 0.0
    if machine["control"] == "force" or compliance["model"] == "geometric":
        return 0.0
    layers = compliance["layers"] or [
        {
            "thickness_mm": compliance["rim_thickness_mm"],
            "youngs_modulus_MPa": compliance["youngs_modulus_MPa"],
            "poissons_ratio": compliance["poissons_ratio"],
        }
    ]
    above, integral = 0.0, 0.0  # mm; mm2/MPa
    for layer in reversed(layers):
        thickness, nu = layer["thickness_mm"], layer["poissons_ratio"]
        modulus = layer["youngs_modulus_MPa"] * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
        integral += (above + 0.5 * thickness) * thickness / modulus
        above += thickness
    density = TONNES_PER_MM3 * machine["wheel_density_kg_m3"]
    speed = 1000.0 * machine["belt_speed_m_s"]
    return density * speed**2 * integral / machine["wheel"]["radius_mm"]


def force_dynamics(machine):
    """The dict that core.simulate takes for a job's ``belt_machine.force_dynamics``: s, N s2/mm, N s/mm, mm/s."""
    given = machine["force_dynamics"]
    dynamics = {"overshoot": float(given["overshoot_limit"]), "bounce": float(given["bounce_s"])}
    if given["model"] != "ideal":
        dynamics["lag"] = float(given["lag_s"])
    if given["model"] == "actuator":
        if not given["moving_mass_kg"] > 0.0 and not given["damping_N_s_per_mm"] > 0.0:
            raise InputError(
                "job.actuator_without_inertia",
                "{key}: an actuator needs a moving mass or a damping; for a force that only lags choose the model lag",
                key="belt_machine.force_dynamics",
            )
        dynamics["mass"] = TONNES_PER_KG * given["moving_mass_kg"]
        dynamics["damping"] = float(given["damping_N_s_per_mm"])
        dynamics["speed_limit"] = float(given["speed_limit_mm_s"])
    return dynamics


def engine_arguments(job):
    """(wheel, compliance, law, options) as core.simulate takes them: mm, N, s, rad. Of a free belt or a platen the
    compliance is empty, and the options have a ``machine``."""
    machine = job["belt_machine"]
    wheel = {name[:-3]: value for name, value in machine["wheel"].items()}
    wheel_presses = machines.wheel_presses(machine)
    if not wheel_presses:
        compliance = {}
    elif job["law"]["model"] == "geometric":
        compliance = {"model": "geometric"}
    else:
        compliance = compliance_arguments(machine["compliance"], wheel)
    law = laws.engine_law(job["law"])
    options = {
        "force_control": machine["control"] == "force",
        "force": float(machine["force_N"]),
        "force_travel": float(machine["force_travel_mm"]),
        "robot_stiffness": float(machine["robot_stiffness_N_per_mm"]),
        "force_dynamics": force_dynamics(machine),
        "wheel_growth": wheel_growth(machine) if compliance.get("model") != "geometric" else 0.0,
        "belt_speed": 1000.0 * machine["belt_speed_m_s"],
        "belt_wear": float(machine["belt_wear"]),
        "wear": laws.engine_wear(job["law"]),
        "belt": laws.engine_belt(machine["belt"]),
        "heat_limit": 1000.0 * job["law"]["heat_limit_MPa_m_s"],
        "pressure_limit": float(job["law"]["pressure_limit_MPa"]),
        "orientation_jump": math.radians(job["simulation"]["orientation_jump_deg"]),
        "tilt_limit": math.radians(job["simulation"]["tilt_limit_deg"]),
        "shifted_laws": laws.shifted_laws(job["law"]),
        "contact_spacing": float(machine["contact_spacing_mm"]),
        "contact_tolerance": float(machine["contact_tolerance"]),
        "max_travel": float(job["simulation"]["max_travel_mm"]),
        "max_angle": math.radians(job["simulation"]["max_angle_deg"]),
    }
    if not wheel_presses:
        options["machine"] = machines.engine_machine(machine)
    return wheel, compliance, law, options
