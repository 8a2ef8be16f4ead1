"""A job's settings as the engine takes them: mm, N, s, rad."""

import math

from . import law as laws


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

        asked = {
            **compliance,
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
    result["model"] = compliance["model"]
    result["layers"] = [
        {
            "thickness": float(layer["thickness_mm"]),
            "youngs_modulus": float(layer["youngs_modulus_MPa"]),
            "poissons_ratio": float(layer["poissons_ratio"]),
        }
        for layer in compliance["layers"]
    ]
    return result


def engine_arguments(job):
    """(wheel, compliance, law, options) as core.simulate takes them: mm, N, s, rad."""
    machine = job["belt_machine"]
    wheel = {name[:-3]: value for name, value in machine["wheel"].items()}
    if job["law"]["model"] == "geometric":
        compliance = {"model": "geometric"}
    else:
        compliance = compliance_arguments(machine["compliance"], wheel)
    law = laws.engine_law(job["law"])
    options = {
        "force_control": machine["control"] == "force",
        "force": float(machine["force_N"]),
        "force_travel": float(machine["force_travel_mm"]),
        "robot_stiffness": float(machine["robot_stiffness_N_per_mm"]),
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
    return wheel, compliance, law, options
