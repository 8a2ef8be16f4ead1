"""Raster paths: contact passes side by side on faces of a job's design. No FreeCAD in here.

The settings are Resources/schema/raster.schema.json; every default stands there and nowhere else.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import schemas
from ..base.files import in_file
from ..base.kinds import Array, Context, Facts, Floats, Json
from ..engine import InputError, core
from ..job import engine_input, load as jobs, machine as machines, spacing as sampling
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import read_design
from ..programs.program import Motion, Program, corner_of
from . import (
    around,
    direction,
    edges,
    filling,
    footprint,
    joined,
    passes,
    path_check,
    reachable,
    region,
    telling,
)
from .clearing import Clearing
from .entry import Entry
from .footprint import belt_extents, contact_width, plane_extents
from .kinds import Extents, Levels, Piece
from .sheets import surfaces

if TYPE_CHECKING:
    from ..job.engine_input import EngineInput

SAMPLES = 40_000  # on the faces, about: fine enough for passes, and 0.1 s
LEAST_SAMPLES = 400
MOST_SAMPLES = 400_000
STEP_SAMPLES = 4  # between neighbouring passes, at least
POSE_SAMPLES = 3  # between neighbouring poses, at least
WELD = 0.1  # of the sampling: vertices of neighbouring faces so near are one
ONE_LEVEL = 1.5
UNCOVERED = 0.01  # of the area; more is warned of


def schema() -> dict[str, Any]:
    """The JSON Schema of the settings, as a dict."""
    return schemas.schema("raster")


def validate(settings: Json) -> dict[str, Any]:
    """A copy of ``settings`` with all defaults filled in. Raises InputError naming the key."""
    return schemas.checked(settings, schema(), "raster")


def load_job(path: Path | str) -> dict[str, Any]:
    """A validated job from a file that need not have a program yet. Raises InputError."""
    path = Path(path)
    data = schemas.read_json(path)
    if isinstance(data, dict) and not data.get("programs"):
        data["programs"] = [{"poses": []}]
    try:
        return jobs.validate(data, path.resolve().parent)
    except InputError as error:
        raise in_file(error, path) from None


def raster(
    job: Job | Json, settings: Json, context: Context = None, looked_at: bool = True
) -> dict[str, Any]:
    """Lays passes on faces of a validated job's design. ``looked_at``: what they do is looked at, for warnings; else fit, reachable
    and check are left away, and places may be.

    Returns dict(frames (n, 4, 4) base_from_tcp mm, feeds (n,) mm/s, forces (n,) N, -1: the job's,
    rapid (n,) bool, lines (n,) 0, as ``core.ToolPath`` takes them, the raster's own passes and then its further groups; contacts (n, 4, 4)
    work_from_contact; passes: list of dict(first, last (poses from 0), level, length_mm), fit (n,)
    mm how deep the undeformed wheel reaches into the part, cuts, beside, stuck (as ``passes.assemble``),
    step_over_mm, contact_width_mm (None if the step-over was given), usual_width_mm (else None; on a plane, of a belt on the median curvatures), contact_length_mm, footprint (as
    ``footprint.solved``, and plain_mm, the width on a cylinder), area_mm2, no_room (bool: the wheel fits nowhere, and
    the passes lie as if it did), along, direction: the way that they go, tried (as ``direction.best``), places (as
    ``reachable.look``), reachable (as ``reachable.told``), check (as ``path_check.check``), warnings). Raises
    InputError, Cancelled.
    """
    read, settings = typed(job), validate(settings)
    context = context or core.RunContext()
    shape = read_design(read.design, context)
    chosen = settings["faces"] or read.design.faces or range(1, shape.face_count + 1)
    faces = _checked_faces(chosen, shape)
    given = engine_input.of(read)

    def lay(settings: Json, context: Context) -> dict[str, Any]:
        return _laid(read, given, shape, faces, settings, [], context, False)[0]

    def group(settings: Json) -> tuple[dict[str, Any], Clearing]:
        one, levels, clearing = _laid(read, given, shape, faces, settings, warnings, context)
        if found and one["no_room"]:  # else the first group's warnings would speak for it
            raise InputError(
                "raster.no_room_for_group",
                "{tool} fits nowhere there; give another direction or belt angle",
                tool=clearing.tool.name,
            )
        if looked_at and "places" not in one:
            one["places"] = _places(read, shape, faces, settings, one, levels, clearing, context)
        return one, clearing

    tried: list[dict[str, Any]] = []
    if settings["along"] == "auto":
        first = joined.groups(settings)[0]
        way, tried = direction.best(read, given, shape, faces, first, lay, context)
        settings = {**settings, **way}
    warnings: Facts = []
    found: list[tuple[dict[str, Any], Clearing]] = []
    for number, one in enumerate(joined.groups(settings)):
        try:
            found.append(group(one))
        except InputError as error:
            if number:
                raise error.within(
                    "raster.of_group", "{key}[{index}]: ", key=joined.KEY, index=number - 1
                ) from None
            raise
    result, clearing = joined.join([one for one, _ in found]), found[0][1]
    if looked_at:
        telling.ends(result, settings, warnings)
        telling.ways(clearing, result, warnings)
        result["fit"] = telling.fit(clearing, settings, result, warnings)
        result["reachable"] = reachable.told(result["places"], clearing.tool, settings, warnings)
        result["check"] = path_check.check(read, settings, result, context)
        warnings += result["check"]["problems"]
        if settings["repeats"] > 1:
            telling.way_back(clearing, result, warnings)
    joined.repeat(result, settings["repeats"])
    result.update(along=settings["along"], direction=settings["direction"], tried=tried)
    result["warnings"] = list({str(one): one for one in warnings}.values())  # of a group each
    return result


def _laid(
    job: Job,
    given: EngineInput,
    shape: core.Shape,
    faces: Sequence[int],
    settings: Json,
    warnings: Facts,
    context: Context,
    fill: bool = True,
) -> tuple[dict[str, Any], Levels, Clearing]:
    """(the path on faces (from 0) of a core.Shape, along a way that is given; its level lines; the Clearing).
    ``fill``: with passes besides, where the even ones miss what the wheel gets to."""
    area = sum(shape.face_area(face) for face in faces)
    _check_size(job, shape, faces, settings, warnings, context)
    spacing = settings["sampling_mm"] or _sampling(area, settings)
    sheets = surfaces(job, shape, faces, spacing, settings, warnings, context)
    cell = passes.cell_of(job)
    lever = passes.lever(cell, np.vstack([s["points"] for s in sheets]))
    step_over, seen = settings["step_over_mm"], {"width_mm": None}
    belt, advance = None, 0.0
    if not machines.wheel_presses(job.belt_machine):
        belt = belt_extents(job, given, settings, sheets, warnings)
        seen, advance = {"width_mm": None, "gap_mm": belt["gap_mm"]}, belt["advance_mm"]
    if step_over == 0:
        plain = belt["width_mm"] if belt else contact_width(given, settings, sheets, warnings)
        seen = {**seen, "width_mm": plain, "plain_mm": plain, "length_mm": None}
        if settings["footprint"] == "solved":
            # Where the contact is looked at, passes as the plain width wants them are near enough.
            about = settings["step_over_share"] * plain
            first = _lines(sheets, settings, about, spacing, lever, [], context)
            along = footprint.solved(job, given, shape, faces, first, settings, plain, context)
            seen = {**seen, **(along or {})}
            if belt and along is None:
                warnings.append(
                    core.Fact(
                        "raster.belt_not_solved",
                        "at too few places along the passes the belt's contact could be solved: its width is that on the "
                        "faces' median curvatures",
                    )
                )
            elif belt and along is not None:
                telling.beyond(along["beyond"], warnings)
        step_over = settings["step_over_share"] * seen["width_mm"]
    finer = _finer(area, step_over)
    if not settings["sampling_mm"] and spacing > finer:
        spacing = finer
        sheets = surfaces(job, shape, faces, spacing, settings, [], context)
    levels: Levels = _lines(sheets, settings, step_over, spacing, lever, warnings, context)
    if settings["along"] == "rings" and settings["order"] != "helix":
        telling.open_rings(levels, warnings)
    wanted = _wanted(settings, seen["width_mm"] or step_over)
    if wanted is not None:
        region.check(wanted[0], np.vstack([s["points"] for s in sheets]), wanted[1])
        levels = region.restricted(levels, *wanted)
        if not any(levels):
            raise InputError(
                "raster.no_pass_in_region",
                "no pass comes near the region; lower step_over_mm, or enlarge region_mm",
            )
    length = seen.get("length_mm")
    usual: tuple[float, float] | tuple[None, None] = None, None
    if belt:
        usual = belt["length_mm"], belt["width_mm"]
    elif not length or seen["width_mm"] is None:
        usual = plane_extents(job, given, settings)
    length = length or usual[0]
    assert length is not None
    clearing = Clearing(job, shape, settings, warnings, context, advance)
    kept = None
    if settings["keep_edge_mm"] > 0.0:
        sizes: list[tuple[float | None, float | None]] = [(length, seen["width_mm"]), usual]
        sizes += [] if belt else [plane_extents(job, given, settings)]
        kept = edges.Kept(shape, faces, spacing, sizes, settings, clearing)
        levels = kept.spared(levels)
        kept.refuse(levels)
    entry = Entry(job, shape, faces, settings, context, length, clearing.tool)
    cleared = clearing.cleared(levels)
    result = passes.assemble(cleared, settings, cell, entry, clearing)
    no_room = not result["passes"] and any(levels)
    if no_room:
        warned = {**settings, "where_it_collides": "warn"}
        clearing = Clearing(job, shape, warned, [], context, advance)
        result = passes.assemble(levels, settings, cell, entry, clearing)
        telling.no_room(result, clearing, warnings)
    if not result["passes"]:
        raise InputError(
            "raster.no_pass",
            "no pass is left on the faces; lower min_length_mm, or give another direction",
        )
    result.update(
        step_over_mm=float(step_over),
        contact_width_mm=seen["width_mm"],
        usual_width_mm=usual[1],
        contact_length_mm=length,
        footprint=seen,
        area_mm2=area,
        no_room=no_room,
    )
    if fill and not no_room and settings["where_it_collides"] != "warn" and _overlap(result):

        def levels_of(step_over: float, points: Floats, margin: float) -> Levels:
            near = points, margin
            found: Levels = _lines(sheets, settings, step_over, spacing, lever, [], context, near)
            for some in (near, wanted):
                found = found if some is None else region.restricted(found, *some)
            return found if kept is None else kept.spared(found)

        places = _places(job, shape, faces, settings, result, levels, clearing, context)
        extents = _extents(settings, result)
        added = filling.more(levels_of, places, clearing, settings, step_over, extents)
        if added:
            result.update(passes.assemble([*cleared, *added], settings, cell, entry, clearing))
        else:
            result["places"] = places
    return result, levels, clearing


def _overlap(result: dict[str, Any]) -> bool:
    """Whether the passes are near enough for their contacts to overlap; else stripes between them are wanted."""
    return result["contact_width_mm"] is not None


def _wanted(settings: Json, width: float) -> tuple[Floats, float] | None:
    """(points (n, 3), mm round them) of the region, None: everywhere; ``width``: of the contact, mm."""
    if not settings["region_points"]:
        return None
    return np.array(settings["region_points"], dtype=float), region.margin_of(settings, width)


def _places(
    job: Job,
    shape: core.Shape,
    faces: Sequence[int],
    settings: Json,
    result: dict[str, Any],
    levels: Levels,
    clearing: Clearing,
    context: Context,
) -> dict[str, Any]:
    """What ``reachable.look`` finds of a path."""
    contacts = [result["contacts"][p["first"] : p["last"] + 1] for p in result["passes"]]
    if result["no_room"]:  # none that may be ground
        contacts = []
    return reachable.look(
        shape,
        faces,
        levels,
        contacts,
        clearing,
        settings,
        _extents(settings, result),
        _wanted(settings, result["contact_width_mm"] or result["step_over_mm"]),
        context,
    )


def _extents(settings: Json, result: dict[str, Any]) -> Extents:
    """(mm along, mm across the belt's travel, mm of the gap at its edge or None) of the contact."""
    along = result["contact_length_mm"]
    across = result["contact_width_mm"] or result["usual_width_mm"]
    turn = abs(math.sin(math.radians(settings["belt_angle_deg"])))
    gap = result["footprint"].get("gap_mm")
    return (along, across, gap) if turn < math.sqrt(0.5) else (across, along, gap)


def _check_size(
    job: Job,
    shape: core.Shape,
    faces: Sequence[int],
    settings: Json,
    warnings: Facts,
    context: Context,
) -> None:
    """Tells of faces in another unit, probably, before anything is computed on them."""
    seen = sampling.size(job, shape, faces, context)
    warnings += sampling.unit_doubts(seen)
    if not (settings["step_over_mm"] or seen["plane"]):
        return  # told later: a rigid tool has no contact
    step_over = settings["step_over_mm"] or settings["step_over_share"] * seen["plane"]
    if seen["area"] / (step_over * settings["max_distance_mm"]) > joined.MOST_POSES:
        raise InputError(
            "raster.too_large",
            "the faces are {size:.4g} mm large: passes {step_over:.3g} mm apart have more than {poses} poses. "
            "Check the unit (design.unit_mm), choose fewer faces, or enlarge step-over and distance of the "
            "poses",
            size=seen["size"],
            step_over=step_over,
            poses=joined.MOST_POSES,
        )


def _checked_faces(numbers: Iterable[int], shape: core.Shape) -> list[int]:
    for number in numbers:
        if number > shape.face_count:
            raise InputError(
                "job.no_such_face",
                "{key}: there is no face {face}; the shape has {count}",
                key="raster.faces",
                face=number,
                count=shape.face_count,
            )
    return sorted({number - 1 for number in numbers})


def _sampling(area: float, settings: Json) -> float:
    """mm: as fine as poses and passes need, for not too many samples."""
    side = math.sqrt(max(area, 1e-6))
    wanted = [settings["max_distance_mm"] / POSE_SAMPLES, side / math.sqrt(LEAST_SAMPLES)]
    if settings["step_over_mm"] > 0:
        wanted.append(settings["step_over_mm"] / STEP_SAMPLES)
    return max(min(*wanted, side / math.sqrt(SAMPLES)), side / math.sqrt(MOST_SAMPLES))


def _finer(area: float, step_over: float) -> float:
    """mm that ``step_over`` asks for, within bounds: between samples, passes are interpolated."""
    return max(step_over / STEP_SAMPLES, math.sqrt(area / MOST_SAMPLES))


def _beside(surface: Json, points: Floats, margin: float) -> Array:
    """(triangles,) bool: those on which ``region.restricted`` may keep a pass, and some more: it keeps what is within
    ``margin`` mm of one of the points, and gaps shorter than that, whose middle is half as much farther off.
    """
    corners = surface["points"][surface["triangles"]]
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    near = region.beside(surface["points"], points, 1.5 * margin + float(edges.max(initial=0.0)))
    return near[surface["triangles"]].any(axis=1)


def _lines(
    surfaces: Sequence[Json],
    settings: Json,
    step_over: float,
    spacing: float,
    lever: float,
    warnings: Facts,
    context: Context,
    near: tuple[Floats, float] | None = None,
) -> list[list[dict[str, Any]]]:
    """Pieces of passes of all surfaces: list of levels, each a list of the core's lines; ``near``: only about there,
    by points (n, 3) and mm from them."""
    levels, laid = [], settings["spacing"]
    if settings["order"] == "helix":
        surfaces, laid = around.helix(surfaces, step_over), "lines"
        step_over *= ONE_LEVEL  # of a period, which is no more than a step-over
    for surface in surfaces:
        found = core.raster_lines(
            surface["points"],
            surface["normals"],
            surface["triangles"],
            surface["scalars"],
            period=surface["period"],
            step_over=step_over,
            spacing=laid,
            weld=0.0 if surface["name"] else WELD * spacing,
            split_turn=math.radians(settings["edge_turn_deg"]),
            smoothing=settings["smoothing_mm"],
            chord_error=settings["chord_error_mm"],
            max_distance=settings["max_distance_mm"],
            max_turn=math.radians(settings["max_turn_deg"]),
            lever=lever,
            context=context,
            wanted=np.empty(0, dtype=bool) if near is None else _beside(surface, *near),
        )
        if found["uncovered_area"] > UNCOVERED * found["area"]:
            share = 100.0 * found["uncovered_area"] / found["area"]
            where = f"{surface['name']}: " if surface["name"] else ""
            warnings.append(
                core.Fact(
                    "raster.uncovered",
                    "{where}{share:.0f} % of the area lies along the cuts and may stay without a "
                    "pass; lay passes in another direction there",
                    where=where,
                    share=share,
                )
            )
        mine: dict[int, list[Piece]] = {}
        for line in found["lines"]:
            mine.setdefault(line["level"], []).append(line)
        levels += [mine[level] for level in sorted(mine)]
    return levels


def program(result: Json, tool: str = "", base: str = "") -> Program:
    """The path as a ``programs.Program``, for ``programs.write_program``. ``tool``, ``base``: what its
    frames are, in words.
    """
    rows = zip(*(result[name].tolist() for name in ("feeds", "forces", "rapid", "zones")))
    made = Program("raster", "raster")
    for pose, (feed, force, rapid, zone) in zip(result["frames"], rows):
        kind = "PTP" if rapid else "LIN"
        given = None if force < 0 else force
        corner = corner_of(zone)
        made.motions.append(Motion(kind, pose, 0, "", feed, given, tool, base, **corner))
    return made


def summary(result: dict[str, Any]) -> dict[str, Any]:
    """The figures of a raster, as the command line prints them."""
    ground = [p["length_mm"] for p in result["passes"]]
    return {
        "poses": len(result["frames"]),
        "passes": len(ground),
        "length_mm": sum(ground),
        "step_over_mm": result["step_over_mm"],
        "contact_width_mm": result["contact_width_mm"],
        "contact_width_on_cylinder_mm": result["footprint"].get("plain_mm"),
        "area_mm2": result["area_mm2"],
        "along": result["along"],
        "direction": result["direction"] if result["along"] == "direction" else None,
        "tried": [
            {**one, "error": str(one["error"]) if one.get("error") else None}
            for one in result["tried"]
        ],
        "ends_without_room": result["beside"],
        "reachable": result["reachable"],
        "check": {k: v for k, v in result["check"].items() if k != "problems"},
        "warnings": result["warnings"],
    }
