"""What blade shops inspect of a section: chord, greatest thickness, radii of both edges, thickness near them.

They are taken of three profiles: the design, the stock before, and what is ground. A profile is the outline that
the plane cuts out of the sampled faces, the one nearest to the section's point.

- *Chord*: the greatest distance between two points of the outline.
- *Greatest thickness*: the diameter of the largest circle inside.
- *Edge radius*: of the circle that fits the outline best, but for a tenth of its turning at both flanks. These
  begin where the edge is as deep as it is thick.
- *Thickness at d*: across the edge's own middle line, d from its tip.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ..base import records
from ..base.kinds import Facts, Floats, Json
from ..engine import InputError, core
from ..job.settings import InspectedSection
from . import profile
from .outline import MISSED, OPEN, End, Outline

if TYPE_CHECKING:
    from ..job.settings import Job

PROFILES = ("design", "stock", "ground")
EDGES = ("leading", "trailing")
UNKNOWN = "not_known"
THICKER_AT = 0.02  # of the chord: the thicker edge there leads unless told otherwise
Row: TypeAlias = "tuple[str, str | None, float | None, list[float | str]]"


def of_sections(job: Job, field: core.HeightField, notes: Facts) -> list[dict[str, Any]]:
    """The figures of each of a job's ``inspection.sections``, as the verdict has them; what a plane misses has
    None, and a note says why."""
    found = []
    for asked in job.inspection.sections or ():
        try:
            found.append(of_field(field, asked))
        except InputError as error:
            notes.append(
                core.Fact(
                    "inspection.no_section",
                    "section '{name}' of the verdict: {reason}",
                    name=asked.name,
                    reason=error,
                )
            )
            distances = list(asked.edge_distances_mm or ())
            told = {"name": asked.name, "edge_distances_mm": distances}
            found.append({**told, **dict.fromkeys(PROFILES)})
    return found


def of_field(field: core.HeightField, asked: InspectedSection | Json) -> dict[str, Any]:
    """The figures of one section. Raises InputError where the plane misses the faces."""
    asked = records.made(InspectedSection, asked)
    distances = list(asked.edge_distances_mm or ())
    cut = core.section_by_plane(field, asked.point_mm, asked.normal)
    told = of_section(cut, asked.point_mm, asked.leading, distances)
    return {"name": asked.name, "edge_distances_mm": distances, **told}


def rows(section: Json) -> Iterator[Row]:
    """The rows of a section's table: (key of the figure, edge or None, distance from its tip or None, [what the
    design, the stock and the ground outline have]: a number in mm or, where there is none, a state).
    """
    for row in _all_rows(section):
        if any(cell != UNKNOWN for cell in row[-1]):
            yield row


def _all_rows(section: Json) -> Iterator[Row]:
    found = [section[name] for name in PROFILES]
    for key in ("chord_mm", "thickness_mm"):
        yield key, None, None, [_number(one and one[key], _why(one)) for one in found]
    for edge in EDGES:
        states = [one[edge]["state"] if one else UNKNOWN for one in found]
        radii = [one and one[edge]["radius_mm"] for one in found]
        yield "radius_mm", edge, None, [_number(*one) for one in zip(radii, states)]
        for k, distance in enumerate(section["edge_distances_mm"]):
            across = [one and one[edge]["thicknesses_mm"][k] for one in found]
            yield "thicknesses_mm", edge, distance, [_number(one, UNKNOWN) for one in across]


def _why(figures: Json | None) -> str:
    """Why an outline has no chord."""
    states = [figures[edge]["state"] for edge in EDGES] if figures else []
    return next((state for state in states if state in (OPEN, MISSED)), UNKNOWN)


def _number(value: float | None, state: str) -> float | str:
    return state if value is None else float(value)


def of_section(
    section: Json,
    point: Sequence[float],
    leading: Sequence[float] | None = None,
    distances: Sequence[float] = (),
) -> dict[str, Any]:
    """{profile: figures} of a section (``inspection.section``) at the outline that is nearest to ``point``.

    ``leading``: the direction towards the leading edge, work frame; None: the design's thicker edge leads.
    ``distances``: mm from the tips, where the thickness is measured.
    """
    axes = np.column_stack(profile.axes(np.asarray(section["normal"], dtype=float)))
    found = profile.chains(section["pieces"])
    away = [np.linalg.norm(one["points"] - np.asarray(point), axis=1).min() for one in found]
    chain = found[int(np.argmin(away))]
    points, rays = chain["points"] @ axes, chain["rays"] @ axes
    heights = {"design": np.zeros(len(points)), "stock": chain["stock"], "ground": chain["height"]}
    design = Outline(points, chain["closed"])
    ends = design.ends()
    swapped = len(ends) == 2 and _trails(design, ends, leading, axes)
    told = {}
    for name in PROFILES:
        line = points + heights[name][:, None] * rays
        if np.isnan(line).any():
            told[name] = _unknown(MISSED, distances)
            continue
        told[name] = _figures(Outline(line, chain["closed"]), ends, swapped, distances)
    return told


def _trails(
    design: Outline, ends: list[End], leading: Sequence[float] | None, axes: Floats
) -> bool:
    """Whether the first of two ends is the trailing edge."""
    if leading is not None:
        return bool(ends[0][0] @ (np.asarray(leading, dtype=float) @ axes) < 0)
    first, last = (
        design.thickness_at(design.nose(out, long), THICKER_AT * long, long) or 0.0
        for out, long in ends
    )
    return first < last


def _unknown(state: str, distances: Sequence[float]) -> dict[str, Any]:
    edge: dict[str, Any] = {"state": state, "radius_mm": None, "residual_mm": None}
    edge["thicknesses_mm"] = [None] * len(distances)
    return {"chord_mm": None, "thickness_mm": None, **{name: dict(edge) for name in EDGES}}


def _figures(
    outline: Outline, ends: list[End], swapped: bool, distances: Sequence[float]
) -> dict[str, Any]:
    noses = [outline.nose(*end) for end in ends]
    told = _unknown(OPEN, distances)
    names = EDGES[::-1] if swapped else EDGES
    for name, nose, (_, long) in zip(names, noses, ends):
        told[name] = {
            "state": nose.state,
            "radius_mm": nose.radius,
            "residual_mm": nose.residual,
            "thicknesses_mm": [outline.thickness_at(nose, d, long) for d in distances],
        }
    if outline.closed:
        told["chord_mm"] = outline.chord(noses)
        told["thickness_mm"] = outline.greatest_thickness()
    return told
