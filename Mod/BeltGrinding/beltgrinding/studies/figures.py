"""The figures of a run: those of its verdict and its summary, flat, by names that stay.

A figure's name is its path in verdict.json (``in_share``, ``worst.beyond_mm``, ``zones.edge.in_share``, ``faces.3.rms``), or,
where the verdict has none, in summary.json (``process_time_s``, ``deviation_mm.p95``, ``events.not_converged``). Times of
the computer are none: a run gives the same figures wherever it is made.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..base.kinds import Json, known
from ..engine import core

if TYPE_CHECKING:
    from ..simulation.result import Result

USUAL = """
    overall
    in_share
    above_share
    below_share
    deviation_mm.min
    deviation_mm.max
    deviation_mm.mean
    deviation_mm.rms
    deviation_mm.p05
    deviation_mm.p50
    deviation_mm.p95
    worst.beyond_mm
    untouched_area_mm2
    removed_volume_mm3
    excess_volume_mm3
    gouge_volume_mm3
    missed_rays
    process_time_s
    peak_pressure_MPa
    peak_force_N
    belt.remaining_cut
    lost_volume_mm3
    not_converged_events
    extrapolated_law_events
    unresolved_motions
    events_in_all
""".split()
OF_HEAT = ("heat.worst.temperature_C", "heat.worst.greatest_C", "heat.burnt_share")
OF_FINISH = ("finish.Ra_um.mean", "finish.Ra_um.p95", "finish.Ra_um.max", "finish.crossed_share")
OF_ZONES_FINISH = {
    "Ra_max_um": "finish.Ra.max_um",
    "lay": "finish.lay.off_share",
}  # by what they call for
OF_ZONES = ("verdict", "in_share", "above_share", "below_share")
LEFT_OUT = ("format", "tolerance_mm", "point_mm", "versions", "wall_time_s", "inputs", "models")
REST = "rest"  # the zone of all that lies in none


def of_result(result: Result) -> dict[str, Any]:
    """{name: number, text, bool or None} of a ``simulation.result.Result`` with its verdict."""
    summary, verdict = result.summary, known(result.verdict)
    found = dict(_flat(verdict))
    for zone in verdict["zones"]:
        found.update(_flat(zone, f"zones.{REST if zone['name'] is None else zone['name']}."))
    for face in verdict["faces"]:
        found.update(_flat(face, f"faces.{face['face']}."))
    for name, value in _flat(summary):
        found.setdefault(name, value)
    found.update(peak_pressure_MPa=0.0, peak_force_N=0.0)
    steps = result.steps
    if steps is not None and len(steps["time"]) > 0:
        found["peak_pressure_MPa"] = float(steps["peak_pressure"].max())
        found["peak_force_N"] = float(steps["force"].max())
    counts = summary["events"]
    for kind in core.event_kinds():
        found[f"events.{kind['code']}"] = counts.get(kind["code"], 0)
    found["events_in_all"] = sum(counts.values())
    return {name: _plain(value) for name, value in found.items()}


def usual(job: Json) -> list[str]:
    """Names of the columns of a table, for a validated job: ``USUAL``, and what its heat, its finish and its zones have."""
    more = (*(OF_HEAT if "heat" in job else ()), *(OF_FINISH if "finish" in job else ()))
    found = [*USUAL, *more]
    for zone in job["inspection"]["zones"]:
        asked = zone.get("finish", {})
        texture = (name for key, name in OF_ZONES_FINISH.items() if key in asked)
        found += (f"zones.{zone['name']}.{name}" for name in (*OF_ZONES, *texture))
    return found


def _flat(held: Json, before: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in held.items():
        if name in LEFT_OUT or isinstance(value, (list, tuple)):
            continue
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{name}.")
        else:
            yield f"{before}{name}", value


def _plain(value: Any) -> Any:
    """As JSON has it: what is not finite is nothing."""
    if hasattr(value, "item"):  # numpy's
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value
