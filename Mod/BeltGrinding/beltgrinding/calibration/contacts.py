"""The contact of a measured grind, by its wheel and part: area, and how uneven the pressure is on it.

A law with an exponent removes by the mean of p^alpha over the contact, which is more than the mean
pressure's; what is fitted to F/A removes too much where the pressure is uneven.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..base.kinds import Floats, Json
from ..contact import single_contact
from ..engine import InputError, core
from ..job import machine as machines

SHARES = 32  # equal parts of the contact's area, by falling pressure
SPACING, LEAST_SPACING = 0.5, 0.06  # mm, of the grid
CELLS = 400  # of a contact at least, where the spacing allows
WHEEL = {  # columns of a table that make a wheel, and the keys of a contact's
    "wheel_radius_mm": "outer_radius_mm",
    "wheel_width_mm": "width_mm",
    "rim_thickness_mm": "rim_thickness_mm",
    "youngs_modulus_MPa": "youngs_modulus_MPa",
}
ASSUMED = "wheel_rim"  # elasticity, unless a machine says another


def of_machine(machine: Json) -> dict[str, Any]:
    """What a job's validated belt_machine says of the contact of its grinds: keys of a contact's file.
    Raises InputError where it has no pressure."""
    if not machines.wheel_presses(machine):
        raise InputError(
            "calibration.no_wheel",
            "calibration: contacts are solved of contact wheels only, and the job's belt machine is a {kind}; give "
            "the contact's area in the table, or a job with a contact wheel",
            kind=machines.kind(machine),
        )
    wheel, compliance = machine["wheel"], machine["compliance"]
    if compliance["model"] == "geometric":
        raise InputError(
            "calibration.rigid_wheel",
            "calibration: the job's wheel is rigid and has no pressure; choose its elasticity",
        )
    return {
        "model": compliance["model"],
        "surrogate_file": compliance["surrogate_file"],
        "wheel": {
            "outer_radius_mm": wheel["radius_mm"],
            **{key: wheel[key] for key in ("width_mm", "crown_radius_mm", "profile_mm")},
            **{
                key: compliance[key]
                for key in (
                    "rim_thickness_mm",
                    "youngs_modulus_MPa",
                    "poissons_ratio",
                    "layers",
                    "belt_tension_N_per_mm",
                    "belt_bending_N_mm",
                    "stiffness_MPa_per_mm",
                )
            },
        },
    }


def of_table(
    columns: Mapping[str, Floats], contact: Json | None, notes: list[Any]
) -> tuple[Floats, Floats]:
    """(areas (n,) mm2, relative pressures (n, SHARES)), nan where the contact is not known: of the
    columns by name, each (n,), what they leave open taken from ``contact`` (``of_machine``, or None).
    Notes what was solved, and with what."""
    count = len(columns["force_N"])
    area, relative = np.full(count, math.nan), np.full((count, SHARES), math.nan)
    base = contact or {}
    machine = base.get("wheel", {})
    missing = [name for name in WHEEL if name not in columns and WHEEL[name] not in machine]
    if missing:
        if len(missing) < len(WHEEL):
            notes.append(
                core.Fact(
                    "calibration.wheel_lacks",
                    "the wheel gives no contact area without {columns}",
                    columns=", ".join(missing),
                )
            )
        return area, relative
    solved, known = {}, 0
    for i in range(count):
        wheel = {
            key: float(columns[name][i])
            for name, key in WHEEL.items()
            if name in columns and not math.isnan(columns[name][i])
        }
        if not set(WHEEL.values()) <= {*wheel, *machine}:
            continue
        part = float(columns["part_radius_mm"][i]) if "part_radius_mm" in columns else math.nan
        key = (float(columns["force_N"][i]), part, *sorted(wheel.items()))
        if key not in solved:
            solved[key] = _solve(key[0], part, {**base, "wheel": {**machine, **wheel}})
        area[i], relative[i] = solved[key]
        known += 1
    if known:
        notes.append(
            core.Fact(
                "calibration.contacts_solved",
                "the contacts of {known} of {count} grinds are solved from wheel and part ({model}): "
                "areas, and pressures that the law is fitted to",
                known=known,
                count=count,
                model=base.get("model", ASSUMED),
            )
        )
    return area, relative


def _solve(force: Any, part: Any, contact: Json) -> tuple[float, Floats]:
    """(area mm2, relative pressures (SHARES,)) of a wheel on a cylinder across its travel (nan: a plane)."""
    workpiece = {"shape": "plane"} if math.isnan(part) else {"shape": "cylinder", "radius_mm": part}
    contact = {"model": ASSUMED, **contact, "workpiece": workpiece, "force_N": force}
    spacing = SPACING
    while True:
        result = single_contact.run(single_contact.validate({**contact, "spacing_mm": spacing}))
        pressure, areas = _pressed(result)
        if len(pressure) >= CELLS or spacing < 2 * LEAST_SPACING:
            break
        spacing /= 2
    falling = np.argsort(-pressure)
    area = np.concatenate([[0.0], np.cumsum(areas[falling])])
    force = np.concatenate([[0.0], np.cumsum((areas * pressure)[falling])])
    at = np.interp(np.linspace(0.0, area[-1], SHARES + 1), area, force)
    return float(area[-1]), np.diff(at) * SHARES / force[-1]


def _pressed(result: Json) -> tuple[Floats, Floats]:
    """(pressures MPa, their areas mm2) of a contact where the rubber has moved to, beside the wheel as well."""
    width = result["x"][1] - result["x"][0]
    pressure = np.concatenate([result["displaced_pressure"].ravel(), result["beside"].ravel()])
    areas = np.concatenate(
        [
            (result["undeformed"]["coverage"] * result["cell_area"]).ravel(),
            (result["reach"] * width).ravel(),
        ]
    )
    pressed = (pressure > 0.0) & (areas > 0.0)
    return pressure[pressed], areas[pressed]


def too_much(exponent: float) -> float:
    """By what factor a law fitted to F/A removes too much under a wheel, about: <p^alpha> / <p>^alpha
    of the pressure of a long Hertzian contact, a semi-ellipse (Johnson, Contact Mechanics, eq. 4.45).
    """
    half = 0.5 * exponent
    mean = 0.5 * math.sqrt(math.pi) * math.gamma(half + 1.0) / math.gamma(half + 1.5)
    return mean / (0.25 * math.pi) ** exponent
