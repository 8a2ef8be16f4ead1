"""A result as the page's 3D view has it: a dict for its script, and packed arrays (``view_mesh.Packed``).

Lengths mm, frame: work. The ground surface is the result's own samples; of more than fit, each that is kept is
as it is, and the view says how many there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple, TYPE_CHECKING

import numpy as np

from ..base import frames
from ..base.kinds import Array, Context, Json
from ..cell import tool_path as tool_paths
from ..cell.collision import wheel_profile
from ..engine import InputError, core
from ..inspection import picture, verdict as verdicts
from ..job import machine as machines
from ..job.poses import program_name
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import frame_of
from . import view_mesh, view_modes

if TYPE_CHECKING:
    from ..simulation.result import Result
    from .content import Content
    from .language import Language
    from .view_mesh import Packed

MOST_SAMPLES = 160_000
MOST_TRIANGLES = 150_000  # of the rest of the part
MOST_BYTES = 5_000_000  # of the packed arrays as text
CHORD = 4e-4  # chord error of the rest of the part, of its diagonal
COARSER = 2.5
MOST_FACES = 500
LEANS = 1.001  # a ray's length, where it is told
ASKED = 20  # faces, whether they bound a solid
MOST_MOMENTS = 4000  # of the wheel's way
SHORTEST = 0.02  # s between two of them


class Data(NamedTuple):
    """``about``: what the script is told (docs/report.md has the page's promises); ``arrays``: the text of
    the packed arrays.
    """

    about: dict[str, Any]
    arrays: str


def data(
    content: Content,
    scale: tuple[float, float, float],
    spots: Sequence[Json],
    sides: Sequence[Array],
    words: Language,
    context: Context = None,
) -> Data:
    """The ``Data`` of a report's ``Content``. ``scale``: (lower, upper, limit) of the deviation, mm;
    ``spots``: as ``worst_spots.worst`` gives them; ``sides``: the directions in which one looks from the
    front and from the back, unit vectors. Raises Cancelled.
    """
    most, rest = MOST_SAMPLES, _rest(content, context)
    while True:
        if context is not None:
            context.throw_if_cancelled()
        made = _made(content, scale, spots, sides, rest, most, words, context)
        if len(made.arrays) <= MOST_BYTES or most <= 1000:
            return made
        most = int(0.9 * most * MOST_BYTES / len(made.arrays))


def _made(
    content: Content,
    scale: tuple[float, float, float],
    spots: Sequence[Json],
    sides: Any,
    rest: Any,
    most: int,
    words: Language,
    context: Context,
) -> Data:
    result, field = content.result, content.result.field
    packed = view_mesh.Packed()
    known = np.where((field.flags & core.MISSED) == 0, field.height, 0.0)
    worst = [
        *(spot["sample"] for spot in spots),
        int(known.argmin()),
        int(known.argmax()),
    ]
    chosen, triangles, outline = _mesh(field, most, worst)
    points, rays = field.points[chosen], field.rays[chosen]
    longer = np.linalg.norm(rays, axis=1)
    corners, normals, faces = rest
    low, high = (f(np.vstack([points, corners]), axis=0) for f in (np.min, np.max))

    packed.add("points", view_mesh.in_box(points, low, high), "u2")
    packed.add("normals", view_mesh.octahedral(rays), "u1")
    if longer.max(initial=1.0) > LEANS:
        packed.add("cosines", np.round(255.0 / longer), "u1")
    view_mesh.add_triangles(packed, "triangles", triangles)
    packed.add("borders", outline, "u4")
    packed.add("rest.points", view_mesh.in_box(corners, low, high), "u2")
    view_mesh.add_triangles(packed, "rest.triangles", faces)
    packed.add("rest.creases", view_mesh.creases(corners, normals, faces), "u4")
    modes = view_modes.modes(content, scale, packed, chosen, words, context)
    front, back = (np.asarray(direction, dtype=float).tolist() for direction in sides)
    about = {
        "title": content.title,
        "language": words.code,
        "box": [low.tolist(), high.tolist()],
        "top": float(np.abs(known).max(initial=0.0)),  # mm off the design, at most
        "samples": len(chosen),
        "of": field.size,
        "spacing": field.spacing,
        "solid": _solid(content.shape, field),
        "camera": {"front": front, "back": back, "up": list(picture.UPRIGHT)},
        "modes": modes,
        "spots": [_spot(spot, words) for spot in spots],
        **_regions(typed(result.job), field, chosen, packed),
        **_motions(result, chosen, packed, words),
        "wheel": _wheel(typed(result.job), packed, words),
        "arrays": packed.index,
    }
    return Data(about, packed.text())


def _mesh(field: core.HeightField, most: int, keep: Any) -> tuple[Array, Array, Array]:
    """(chosen (k,), triangles (m, 3), outline (j, 2)) of a field: about ``most`` of its samples, those of
    ``keep`` among them, and their edges to be drawn.
    """
    few = len(np.unique(field.faces)) <= MOST_FACES  # else they are a mesh's facets
    groups = field.faces if few else np.zeros(field.size, dtype=np.int64)
    chosen, place = view_mesh.thinned(field.points, field.normals, groups, most, keep)
    triangles = field.triangles
    if len(chosen) < field.size:
        triangles = view_mesh.proper_triangles(core.replaced(triangles, place))
    if few:
        return chosen, triangles, view_mesh.borders(triangles)
    sharp = view_mesh.creases(field.points, field.normals, field.triangles)
    return chosen, triangles, view_mesh.proper_edges(place[sharp])


def _rest(content: Content, context: Context) -> tuple[Array, Array, Array]:
    """(corners (n, 3), normals (n, 3), triangles (m, 3)) of the faces that are not ground; empty where there
    are none.
    """
    shape, field = content.shape, content.result.field
    others = [] if shape is None else picture.rest_of(shape, field)
    if not others:
        return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    low, high = shape.extents()
    chord = max(CHORD * float(np.linalg.norm(np.subtract(high, low))), 1e-6)
    for _ in range(4):
        mesh = core.triangulate(shape, chord, context, others)
        if len(mesh.triangles) <= MOST_TRIANGLES:
            break
        chord *= COARSER
    corners, triangles = mesh.vertices.astype(float), mesh.triangles.astype(np.int64)
    normals = picture.smooth_normals(mesh).astype(float)
    if len(triangles) <= MOST_TRIANGLES:
        return corners, normals, triangles
    same = np.zeros(len(corners), dtype=np.int64)
    kept, place = view_mesh.thinned(corners, normals, same, MOST_TRIANGLES // 2)
    return (
        corners[kept],
        normals[kept],
        view_mesh.proper_triangles(core.replaced(triangles, place)),
    )


def _solid(shape: core.Shape | None, field: core.HeightField) -> bool:
    """Whether the ground faces bound a solid, so that what one sees from behind is its inside."""
    if shape is None:
        return False
    return all(shape.bounds_solid(int(face)) for face in np.unique(field.faces)[:ASKED])


def _spot(spot: Json, words: Language) -> dict[str, Any]:
    text = f"{words.number(spot['deviation'], 3, True)} mm, Face{spot['face']}"
    motions = spot["cluster"]["motions"][:1] if "cluster" in spot else ()
    if motions and motions[0]["line"]:
        text += ", " + words("line {line}", line=motions[0]["line"])
    return {
        "number": spot["number"],
        "point": spot["point"],
        "normal": spot["normal"],
        "extent": spot["extent"],
        "above": spot["deviation"] > 0.0,
        "text": text,
    }


def _regions(job: Job, field: core.HeightField, chosen: Array, packed: Packed) -> dict[str, Any]:
    """Which face and which zone every sample belongs to, and the zones' limits."""
    faces, number = np.unique(field.faces, return_inverse=True)
    packed.add("faces", number.reshape(-1)[chosen], "u2" if len(faces) < 65536 else "u4")
    inspection = job.inspection
    zones = inspection.zones
    packed.add("zones", verdicts.zone_of_samples(job, field)[chosen], "u2")
    rest = inspection.tolerance_mm
    limits = [[zone.name, *(zone.tolerance_mm or rest)] for zone in zones]
    return {"faces": (faces + 1).tolist(), "zones": [*limits, [None, *rest]]}


def _motions(result: Result, chosen: Array, packed: Packed, words: Language) -> dict[str, Any]:
    """The motions that removed most and last of every sample (0: none, else from 1), and their names."""
    trace, motions = result.field.trace, result.motions
    if trace is None:
        return {"traced": False, "programs": []}
    for key in ("dominant", "last"):
        numbers = trace[key][chosen].astype(np.int64)
        packed.add(f"motion.{key}", np.where(numbers == core.NEVER, 0, numbers + 1), "u4")
    if motions is not None:
        packed.add("motion.program", motions["program"], "u2")
        packed.add("motion.line", motions["line"], "u4")
    names = [Path(program_name(result.job, i)).name for i in range(len(result.job["programs"]))]
    return {"traced": True, "programs": [words.short(name) for name in names]}


def _wheel(job: Job, packed: Packed, words: Language) -> dict[str, Any] | None:
    """The wheel and its way over the work; None where the programs cannot be read any more, or of a machine without
    a wheel."""
    if not machines.wheel_presses(job.belt_machine):
        return None
    try:
        paths = [tool_paths.tool_path(job, i, []) for i in range(len(job.programs))]
    except InputError:
        return None
    whole = sum(path.duration() for path in paths)
    if not whole > 0.0:
        return None
    step, begin, first = max(whole / MOST_MOMENTS, SHORTEST), 0.0, 0
    times, places, motions = [], [], []
    cell = {
        name: frame_of(getattr(job.cell, name), f"cell.{name}") for name in tool_paths.CELL_FRAMES
    }
    for path in paths:
        moments = np.linspace(0.0, path.duration(), max(int(path.duration() / step), 1) + 1)
        base_from_tcp, poses = zip(*(path.frame_at(float(moment)) for moment in moments))
        found = frames.work_from_frames(np.array(base_from_tcp), job.cell.holding, **cell)
        times.append(begin + moments)
        places.append(found["contact"])
        motions.append(first + np.array(poses, dtype=np.int64))
        begin += path.duration()
        first += len(path)
    times, places, motions = (np.concatenate(each) for each in (times, places, motions))
    turns = frames.to_quaternions(places[:, :3, :3])
    low, high = (f(places[:, :3, 3], axis=0) for f in (np.min, np.max))
    packed.add("wheel.place", view_mesh.in_box(places[:, :3, 3], low, high), "u2")
    packed.add("wheel.turn", np.round((turns + 1.0) * 0.5 * view_mesh.STEPS), "u2")
    packed.add("wheel.time", np.round(times * 1000.0), "u4")
    packed.add("wheel.motion", motions + 1, "u4")
    wheel = job.belt_machine.wheel
    return {
        "radius": wheel.radius_mm,
        "profile": wheel_profile(wheel).tolist(),
        "box": [low.tolist(), high.tolist()],
        "time": whole,
    }
