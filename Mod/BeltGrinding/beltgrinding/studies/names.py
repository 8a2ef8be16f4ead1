"""What a figure of a table is called where people read it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..base.kinds import Json

if TYPE_CHECKING:
    from ..reporting.language import Language

NAMES = {
    "overall": "whole part",
    "in_share": "area in tolerance, share",
    "above_share": "area with too much left, share",
    "below_share": "area cut too deep, share",
    "deviation_mm.min": "least deviation, mm",
    "deviation_mm.max": "greatest deviation, mm",
    "deviation_mm.mean": "mean deviation, mm",
    "deviation_mm.rms": "rms deviation, mm",
    "deviation_mm.p05": "deviation, 5th percentile, mm",
    "deviation_mm.p50": "deviation, median, mm",
    "deviation_mm.p95": "deviation, 95th percentile, mm",
    "worst.beyond_mm": "worst place beyond its limit, mm",
    "untouched_area_mm2": "untouched area, mm²",
    "removed_volume_mm3": "removed volume, mm³",
    "excess_volume_mm3": "volume left too much, mm³",
    "gouge_volume_mm3": "volume cut too deep, mm³",
    "missed_rays": "places without stock",
    "process_time_s": "grinding time, s",
    "peak_pressure_MPa": "greatest pressure, MPa",
    "peak_force_N": "greatest force, N",
    "belt.remaining_cut": "cut left in the belt",
    "lost_volume_mm3": "volume not removed for want of contact, mm³",
    "events_in_all": "events",
    "heat.worst.temperature_C": "greatest temperature, °C",
    "heat.worst.greatest_C": "greatest temperature, at most, °C",
    "heat.burnt_share": "burnt area, share",
    "finish.Ra_um.mean": "mean Ra, µm",
    "finish.Ra_um.p95": "Ra, 95th percentile, µm",
    "finish.Ra_um.max": "greatest Ra, µm",
    "finish.crossed_share": "area with crossed scratches, share",
}
OF_ZONE = {
    "verdict": "zone {zone}",
    "in_share": "zone {zone}: area in tolerance, share",
    "above_share": "zone {zone}: area with too much left, share",
    "below_share": "zone {zone}: area cut too deep, share",
    "finish.Ra.max_um": "zone {zone}: greatest Ra, µm",
    "finish.lay.off_share": "zone {zone}: area with a wrong lay, share",
}


def figure(name: str, words: Language) -> str:
    """The name of a figure in the words of a ``reporting.language.Language``; its column where it has no other."""
    if name in NAMES:
        return words(NAMES[name])
    if name.startswith("zones."):
        rest = name[len("zones.") :]
        for last, text in OF_ZONE.items():
            zone = rest.removesuffix(f".{last}")
            if zone != rest and zone:
                return words(text, zone=zone)
    return name


def yielded(one: Json, words: Language) -> str:
    """What an entry of the yield is about."""
    if one["of"] == "zone":
        return words("zone {zone}", zone=one["name"])
    texts = {
        "overall": "whole part passes",
        "not_above": "nowhere too much left",
        "not_below": "nowhere cut too deep",
    }
    return words(texts[one["of"]])
