"""What a model of the finish holds for and says, in the language of the window."""

from __future__ import annotations

from collections.abc import Mapping

from ..common.compat import translate
from ..common.kinds import Json, Numbers

RANGES = ("grit", "pressure_MPa", "belt_speed_m_s", "feed_mm_s", "remaining_cut")


def spans(ranges: Mapping[str, Numbers]) -> str:
    """What was measured, by the ``ranges`` of a model; from least to greatest."""
    units = {
        "grit": translate("BeltGrinding", "grit"),
        "pressure_MPa": "MPa",
        "belt_speed_m_s": "m/s",
        "feed_mm_s": "mm/s",
        "remaining_cut": translate("BeltGrinding", "of a fresh belt's cut"),
    }
    return "; ".join(f"{_span(*ranges[key])} {units[key]}" for key in RANGES)


def exponents(model: Json) -> str:
    """The exponents of a model's Ra; of what was not varied there is none."""
    return "; ".join(
        f"{model[key]:+.2g} {text}"
        for key, text in (
            ("grit_exponent", translate("BeltGrinding", "grit")),
            ("pressure_exponent", translate("BeltGrinding", "pressure")),
            ("belt_speed_exponent", translate("BeltGrinding", "belt speed")),
            ("feed_exponent", translate("BeltGrinding", "feed")),
            ("wear_exponent", translate("BeltGrinding", "remaining cut")),
        )
        if model[key] != 0.0
    )


def parameter(name: str) -> str:
    """What a parameter of the fit is called."""
    return {
        "coefficient_um": translate("BeltGrinding", "Ra at the references, µm"),
        "grit_exponent": translate("BeltGrinding", "exponent of the grit"),
        "pressure_exponent": translate("BeltGrinding", "exponent of the pressure"),
        "belt_speed_exponent": translate("BeltGrinding", "exponent of the belt speed"),
        "feed_exponent": translate("BeltGrinding", "exponent of the feed"),
        "wear_exponent": translate("BeltGrinding", "exponent of the remaining cut"),
        "rest_per_pass": translate("BeltGrinding", "left by a pass, share"),
    }[name]


def _span(low: float, high: float) -> str:
    return f"{low:.4g} … {high:.4g}" if low < high else f"{low:.4g}"
