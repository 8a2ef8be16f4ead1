"""Young's modulus of a rubber from its Shore A hardness: the formulas, and how far they differ.

Their equations, sources and ranges stand in Resources/presets/rubber.json.
"""

from __future__ import annotations

import math
from functools import lru_cache
from statistics import NormalDist
from typing import Any

from ..base import schemas
from ..base.kinds import Json
from ..base.resources import resources
from ..engine import InputError

DEFAULT = "gent"


def _gent(hardness: float) -> float:
    return 0.0981 * (56.0 + 7.62336 * hardness) / (0.137505 * (254.0 - 2.54 * hardness))


def _bs903(hardness: float) -> float:
    root = NormalDist().inv_cdf((1.0 + hardness / 100.0) / 2.0) / math.sqrt(2.0)  # erf's inverse
    return (root / 3.186e-4) ** 2 * 1e-6


def _qi(hardness: float) -> float:
    return 10.0 ** (0.0235 * hardness - 0.6403)


def _mix_giacomin(hardness: float) -> float:
    force = 0.55 + 0.075 * hardness  # N, spring of the type A durometer
    radius, protrusion = 0.395, 2.5  # mm, of its indenter
    return 3.0 * force / (8.0 * radius * protrusion * (1.0 - hardness / 100.0))


EQUATIONS = {"gent": _gent, "bs903": _bs903, "qi": _qi, "mix_giacomin": _mix_giacomin}


@lru_cache(maxsize=None)
def formulas() -> dict[str, dict[str, Any]]:
    """The formulas by id: dict(name, equation, source, least and greatest hardness)."""
    data = schemas.read_json(resources() / "presets" / "rubber.json")
    found: dict[str, dict[str, Any]] = {}
    for one in data["formulas"]:
        least, greatest = one["shore_a"]["range"]
        source = cite(data["sources"][one["source"]])
        found[one["id"]] = {**one, "source": source, "least": least, "greatest": greatest}
    return found


def cite(source: Json, where: str | None = None) -> str:
    """A source in one line: author, title (year), page or table."""
    year = f" ({source['year']})" if "year" in source else ""
    return f"{source['author']}, {source['title']}{year}" + (f", {where}" if where else "")


def modulus(shore_a: float, formula: str = DEFAULT) -> float:
    """Young's modulus in MPa by one formula. Raises InputError for a hardness outside its range."""
    one = formulas()[formula]
    if not one["least"] <= shore_a <= one["greatest"]:
        raise InputError(
            "presets.hardness_out_of_range",
            "{shore_a:g} Shore A: the formula of {formula} holds from {least:g} to "
            "{greatest:g} Shore A; give Young's modulus itself",
            shore_a=shore_a,
            formula=one["name"],
            least=one["least"],
            greatest=one["greatest"],
        )
    return EQUATIONS[formula](float(shore_a))


def shore_to_modulus(shore_a: float) -> dict[str, tuple[float, str]]:
    """{formula: (Young's modulus in MPa, source)} by every formula whose range has this hardness,
    the default ``DEFAULT`` first. Raises InputError outside of the default's range.
    """
    result = {DEFAULT: (modulus(shore_a), formulas()[DEFAULT]["source"])}
    for name, one in formulas().items():
        if one["least"] <= shore_a <= one["greatest"]:
            result[name] = (modulus(shore_a, name), one["source"])
    return result


def spread(shore_a: float) -> tuple[float, float, float]:
    """The modulus by the default formula, the least and the greatest by any, MPa. Raises
    InputError.
    """
    values = [value for value, _ in shore_to_modulus(shore_a).values()]
    return values[0], min(values), max(values)


def spread_text(shore_a: float) -> str:
    """Such as "60 Shore A: 3.6 MPa (3.5 to 5.9 by the formula)". Raises InputError."""
    value, least, greatest = spread(shore_a)
    return f"{shore_a:g} Shore A: {value:.2g} MPa ({least:.2g} to {greatest:.2g} by the formula)"
