"""Single contacts of a wheel, for people who study it: with an analytic workpiece, or at a pose."""

import json
from pathlib import Path

import numpy as np

from . import InputError, core, job as jobs, schemas
from .result import write_whole

DEFAULT_MODULUS = 5.0  # MPa


def gent(shore_a):
    """Young's modulus in MPa of a rubber of Shore A hardness: A. N. Gent, Rubber Chemistry and
    Technology 31 (1958). Other formulas differ by up to 40 %.
    """
    return 0.0981 * (56.0 + 7.62336 * shore_a) / (0.137505 * (254.0 - 2.54 * shore_a))


def load(path):
    """Reads and validates a contact file (contact.schema.json). Raises InputError."""
    path = Path(path)
    try:
        return validate(schemas.read_json(path))
    except InputError as error:
        raise InputError(str(error) if str(path) in str(error) else f"{path}: {error}") from None


def validate(contact):
    """A copy of ``contact`` with all defaults. Raises InputError naming the key that is wrong."""
    contact = schemas.checked(contact, schemas.schema("contact"), "contact")
    if ("force_N" in contact) == ("approach_mm" in contact):
        raise InputError("contact: give exactly one of 'force_N' or 'approach_mm'")
    wheel, workpiece = contact["wheel"], contact["workpiece"]
    if "shore_a" in wheel and "youngs_modulus_MPa" in wheel:
        raise InputError("wheel: give 'youngs_modulus_MPa' or 'shore_a', not both")
    if workpiece["shape"] in ("cylinder", "sphere") and not workpiece.get("radius_mm"):
        raise InputError(f"workpiece: a {workpiece['shape']} needs a 'radius_mm' other than 0")
    if workpiece["shape"] == "strip" and "width_mm" not in workpiece:
        raise InputError("workpiece: a strip needs a 'width_mm'")
    return contact


def run(contact):
    """Solves a validated contact. Returns dict(x (nx,) mm along the circumference, y (ny,) mm along
    the axis, pressure (ny, nx) MPa, force N, approach mm, contact_area mm2, peak_pressure MPa,
    iterations, converged, time s, model, cell_area mm2).
    """
    wheel, workpiece = contact["wheel"], contact["workpiece"]
    modulus = wheel.get("youngs_modulus_MPa", DEFAULT_MODULUS)
    if "shore_a" in wheel:
        modulus = gent(wheel["shore_a"])
    given = {"shape": workpiece["shape"], "axis_angle_deg": float(workpiece["axis_angle_deg"])}
    for key, name in (("radius_mm", "radius"), ("width_mm", "width")):
        if key in workpiece:
            given[name] = float(workpiece[key])
    return core.single_contact(
        {
            "radius": float(wheel["outer_radius_mm"]),
            "width": float(wheel["width_mm"]),
            "crown_radius": float(wheel["crown_radius_mm"]),
        },
        given,
        jobs.compliance_arguments(
            {
                "model": contact["model"],
                "youngs_modulus_MPa": modulus,
                "poissons_ratio": wheel["poissons_ratio"],
                "rim_thickness_mm": wheel["rim_thickness_mm"],
                "belt_tension_N_per_mm": wheel["belt_tension_N_per_mm"],
                "belt_bending_N_mm": wheel["belt_bending_N_mm"],
                "stiffness_MPa_per_mm": wheel["stiffness_MPa_per_mm"],
                "layers": [],
            }
        ),
        contact.get("force_N"),
        contact.get("approach_mm"),
        float(contact["spacing_mm"]),
        float(contact["tolerance"]),
    )


def summary(result):
    """The figures of a contact, as the command line prints them."""
    return {
        "force_N": result["force"],
        "approach_mm": result["approach"],
        "peak_pressure_MPa": result["peak_pressure"],
        "contact_area_mm2": result["contact_area"],
        "iterations": result["iterations"],
        "time_ms": 1000.0 * result["time"],
        "converged": result["converged"],
        "model": result["model"],
    }


def write_csv(result, path):
    """Writes x_mm, y_mm, p_MPa of every cell of the footprint. Raises InputError."""
    x, y = np.meshgrid(result["x"], result["y"])
    rows = np.column_stack([x.ravel(), y.ravel(), result["pressure"].ravel() + 0.0])
    lines = ["x_mm,y_mm,p_MPa", *(f"{a:.6g},{b:.6g},{p:.8g}" for a, b, p in rows.tolist()), ""]
    try:
        write_whole(Path(path), "\n".join(lines).encode())
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def to_json(result):
    """One line of JSON for the command line."""
    return json.dumps(summary(result))
