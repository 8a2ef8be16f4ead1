"""Contact wheels that may stand in place of a job's own: sizes of a series, the presets that have a size, and those that are given."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

from ..base import records
from ..base.kinds import Json
from ..engine import InputError, core
from ..job import machine as machines
from ..job.typed import typed
from ..presets import library
from ..raster import proposal

OWN, ANY = "own", "any"
WIDER = 2.0  # times the job's own wheel: the widest of the series
NARROWER = 2  # of the series, that are tried of the job's own radius
CROWN = 4.0  # times the width: the crown's radius of a wheel that is tried with one
GIVEN = re.compile(
    r"(?P<radius>\d+(?:\.\d+)?)x(?P<width>\d+(?:\.\d+)?)(?:c(?P<crown>\d+(?:\.\d+)?))?"
)


class Wheel(NamedTuple):
    """Sizes in mm; a crown of 0: a cylinder."""

    radius: float
    width: float
    crown: float = 0.0


def series(own: Wheel) -> list[Wheel]:
    """The radii of a series, each with the largest width that is not above its radius, nor ``WIDER`` times that of ``own``; the own radius narrower,
    and the own wheel with a crown."""
    widths = [w for w in proposal.WIDTHS if w <= WIDER * own.width] or [proposal.WIDTHS[0]]
    found = []
    for radius in proposal.RADII:
        wide = max((w for w in widths if w <= min(radius, own.width * WIDER)), default=widths[0])
        found.append(Wheel(radius, wide))
    narrower = sorted((w for w in proposal.WIDTHS if w < own.width), reverse=True)[:NARROWER]
    found += [Wheel(own.radius, width) for width in narrower]
    if not own.crown:
        found.append(own._replace(crown=CROWN * own.width))
    return [one for one in found if one != own]


def of_presets() -> list[Wheel]:
    """Those of the presets, the user's own among them, whose diameter and width are known."""
    found = []
    for one in library.wheels():
        if "diameter" in one and "width" in one:
            diameter, width = (library.middle(one[name]) for name in ("diameter", "width"))
            found.append(Wheel(0.5 * diameter, width))
    return found


def given(text: str) -> list[Wheel]:
    """Such as 20x15,10x8c40: radius x width, mm, and the crown's radius. Raises InputError."""
    found = []
    for part in text.split(","):
        match = GIVEN.fullmatch(part.strip())
        sizes = [float(size or 0.0) for size in match.groups()] if match else []
        if not sizes or not all(sizes[:2]):
            raise InputError(
                "planning.wheel",
                "'{given}' is no wheel: write radius x width in mm as 20x15, with a crown's radius as 20x15c60, '{own}' or '{any}'",
                given=part.strip(),
                own=OWN,
                any=ANY,
            )
        found.append(Wheel(*sizes))
    return found


def own(job: Json) -> Wheel:
    """That of a validated job."""
    wheel = typed(job).belt_machine.wheel
    return Wheel(wheel.radius_mm, wheel.width_mm, wheel.crown_radius_mm)


def mounted(job: Json, wheels: Sequence[Wheel]) -> tuple[dict[str, Any], ...]:
    """Belt machines of a validated job with each of the wheels, and with rim and force to it; none twice, nor the job's own wheel. Those of a machine that has no contact
    wheel: none."""
    machine = typed(job).belt_machine
    if not machines.wheel_presses(machine):
        return ()
    found = []
    for one in dict.fromkeys(wheels):
        if one != own(job):
            with_it = proposal.mounted(machine, one.radius, one.width, one.crown)
            found.append(dict(records.plain(with_it)))
    return tuple(found)


def name(wheel: Json) -> core.Fact:
    """Of a job's wheel, as a text."""
    sizes = {"radius": wheel["radius_mm"], "width": wheel["width_mm"]}
    if wheel["crown_radius_mm"]:
        return core.Fact(
            "planning.wheel_crowned",
            "a wheel of {radius:g} mm radius, {width:g} mm wide, with a crown of {crown:g} mm",
            crown=wheel["crown_radius_mm"],
            **sizes,
        )
    return core.Fact(
        "planning.wheel_plain", "a wheel of {radius:g} mm radius, {width:g} mm wide", **sizes
    )
