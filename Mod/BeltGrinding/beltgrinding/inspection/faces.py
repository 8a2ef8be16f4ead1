"""The faces of a part: their numbers and what they are like, as a table and as a picture, for people who
choose faces without FreeCAD."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Iterable, Sequence
from typing import Any
from typing import NamedTuple, Optional

import numpy as np
from PIL import Image, ImageDraw
from numpy.typing import NDArray

from ..base.kinds import Array, Context, Floats
from ..engine import InputError, core
from ..job.spacing import curvatures
from . import picture

SAMPLES = 60_000  # over the part
OF_A_FACE = 300  # at least, for its radii
SHARE = 0.05  # of a face's area: what is more curved is left out of its radii
FLAT = 20.0  # of a face's size: with a larger radius it is as good as flat
SIZES = 26, 14  # of letters, pixels
MOST_NEIGHBOURS = 12  # in the table
ROOM = 0.62  # of a label's size, between its middle and the face's border in the picture
HUE = 0.381966  # of a turn from colour to colour: the golden section


class Face(NamedTuple):
    """A face of a part; lengths in mm, in the part's frame."""

    number: int  # from 1, as FreeCAD counts
    kind: str  # of surface
    area: float  # mm2; NaN: cannot be found
    centroid: Optional[tuple[float, ...]]  # of its area; on a curved face not on it
    centre: Optional[
        tuple[float, ...]
    ]  # on the face, nearest to that, or in the middle of its parameters
    normal: Optional[tuple[float, ...]]  # unit, outwards, there
    convex_radius: Optional[float]  # smallest radius where it bulges out; None: nowhere
    concave_radius: Optional[float]  # smallest radius where it is hollow; None: nowhere
    neighbours: tuple[int, ...]  # numbers of the faces with a common border
    solid: bool  # it bounds a solid

    def data(self) -> dict[str, Any]:
        """As JSON has it."""
        return {
            "face": self.number,
            "type": self.kind,
            "area_mm2": self.area if math.isfinite(self.area) else None,
            "centroid_mm": self.centroid and list(self.centroid),
            "centre_mm": self.centre and list(self.centre),
            "normal": self.normal and list(self.normal),
            "convex_radius_mm": self.convex_radius,
            "concave_radius_mm": self.concave_radius,
            "neighbours": list(self.neighbours),
            "bounds_solid": self.solid,
        }


def faces_of(shape: core.Shape, context: Context = None) -> list[Face]:
    """List of ``Face`` of a core.Shape. A face that cannot be sampled has neither centre nor radii. Raises
    Cancelled."""
    try:
        beside = shape.neighbours(context)
    except InputError:
        beside = [[] for _ in range(shape.face_count)]
    return [_face(shape, number, beside[number], context) for number in range(shape.face_count)]


def _face(shape: core.Shape, number: int, beside: Sequence[int], context: Context) -> Face:
    centroid = centre = normal = convex = concave = None
    try:
        area = shape.face_area(number)
        field, _ = core.sample_faces(shape, [number], math.sqrt(area / OF_A_FACE), context=context)
    except InputError:
        area = math.nan
    else:
        centroid, centre, normal = (tuple(_plain(v)) for v in _middle(shape, number, field))
        bend, areas = curvatures(field)
        flat = FLAT * math.sqrt(area)
        convex, concave = _radius(bend[:, 1], areas, flat), _radius(-bend[:, 0], areas, flat)
    return Face(
        number + 1,
        shape.surface_type(number),
        area,
        centroid,
        centre,
        normal,
        convex,
        concave,
        tuple(other + 1 for other in beside),
        shape.bounds_solid(number),
    )


def _middle(shape: core.Shape, number: int, field: core.HeightField) -> tuple[Array, Array, Array]:
    """(centroid, centre, outward unit normal there) of a face, and its samples. Where the face has neither at its
    middle, as a ring, they are those of a sample away from its borders."""
    weights = field.areas.astype(float)
    middle = (field.points * weights[:, None]).sum(axis=0) / max(weights.sum(), 1e-300)
    found = shape.face_centre(number)
    centroid, centre, normal = (middle, middle, np.zeros(3)) if found is None else found
    hole = not np.any(normal)
    near = np.linalg.norm(field.points - (centroid if hole else centre), axis=1)
    if hole:
        border = (np.asarray(field.flags) & core.ON_BOUNDARY) != 0
        near = np.where(border, np.inf, near) if not border.all() else near
    nearest = int(np.argmin(near))
    outward = np.asarray(field.normals[nearest], dtype=float)
    if hole:
        return centroid, field.points[nearest], outward
    return centroid, centre, normal if np.dot(normal, outward) > 0 else -np.asarray(normal)


def _plain(vector: Iterable[float]) -> list[float]:
    return [round(float(value), 6) + 0.0 for value in vector]


def _radius(bend: Floats, areas: Floats, flat: float) -> float | None:
    """The smallest radius in mm but for a share of the area; None where nothing bends so, or less than
    ``flat`` mm does."""
    if not len(bend):
        return None
    order = np.argsort(bend)
    summed = np.cumsum(areas[order])
    at = min(np.searchsorted(summed, (1.0 - SHARE) * summed[-1]), len(bend) - 1)
    found = float(bend[order][at])
    return float(f"{1.0 / found:.4g}") if found * flat > 1.0 else None


def text(faces: Sequence[Face]) -> str:
    """The table, one line a face."""
    rows = [("face", "type", "area mm2", "centre mm", "normal", "radii mm", "neighbours")]
    for one in faces:
        radii = [
            f"{name} {value:.3g}"
            for name, value in (("out", one.convex_radius), ("in", one.concave_radius))
            if value is not None
        ]
        rows.append(
            (
                f"{one.number}" + ("" if one.solid else "*"),
                one.kind,
                f"{one.area:.4g}",
                "-" if one.centre is None else " ".join(f"{v:.1f}" for v in one.centre),
                "-" if one.normal is None else " ".join(f"{v:+.2f}" for v in one.normal),
                ", ".join(radii) or "flat",
                _neighbours(one.neighbours) or "-",
            )
        )
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]) - 1)]
    lines = [
        "  ".join([*(cell.ljust(w) for cell, w in zip(row, widths)), row[-1]]).rstrip()
        for row in rows
    ]
    if not all(one.solid for one in faces):
        lines.append("* bounds no solid")
    return "\n".join(lines)


def _neighbours(numbers: Sequence[int]) -> str:
    told = " ".join(map(str, numbers[:MOST_NEIGHBOURS]))
    return told + (f" ... ({len(numbers)})" if len(numbers) > MOST_NEIGHBOURS else "")


def draw(shape: core.Shape, context: Context = None) -> tuple[bytes, list[int]]:
    """(bytes of a PNG: the part from two sides, every face in a colour of its own with its number; numbers
    from 1 of the faces that it does not name, since they are hidden or too small). Raises InputError,
    Cancelled."""
    area = sum(shape.face_area(face) for face in range(shape.face_count))
    field, _ = core.sample_faces(shape, [], math.sqrt(area / SAMPLES), context=context)
    numbers = np.asarray(field.faces)
    studio = picture.Studio(field, _colours(shape.face_count)[numbers], None, context)
    views = studio.both(context)
    fonts, named, sides = {size: picture.font(size) for size in SIZES}, set(), []
    for view in views:
        image = Image.fromarray(view.pixels)
        pen = ImageDraw.Draw(image)
        for face, (x, y, size) in _places(field, view).items():
            _label(pen, str(face + 1), x, y, fonts[size])
            named.add(face)
        sides.append(image)
    whole = Image.new("RGB", (sum(i.width for i in sides), sides[0].height), "white")
    whole.paste(sides[0], (0, 0))
    whole.paste(sides[1], (sides[0].width, 0))
    missing = [face + 1 for face in range(shape.face_count) if face not in named]
    return picture.png(np.asarray(whole)), missing


def _colours(count: int) -> NDArray[np.uint32]:
    """(count,) uint32 0xRRGGBBAA, light ones that differ from one to the next."""
    found = []
    for k in range(count):
        rgb = colorsys.hls_to_rgb((k * HUE) % 1.0, (0.62, 0.74, 0.54)[k % 3], 0.62)
        red, green, blue = (int(round(255 * value)) for value in rgb)
        found.append(red << 24 | green << 16 | blue << 8 | 0xFF)
    return np.array(found, dtype=np.uint32)


def _places(field: core.HeightField, view: picture.View) -> dict[int, tuple[float, float, int]]:
    """{face from 0: (column, row, size of the label)}: where on the picture most of the face lies around."""
    numbers, slack = np.asarray(field.faces), picture.HIDDEN * field.spacing
    seen = view.shows(field.points, slack) & (field.normals @ view.direction < -0.05)
    places = view.project(field.points)[:, :2]
    border = (np.asarray(field.flags) & core.ON_BOUNDARY) != 0
    found: dict[int, tuple[float, float, int]] = {}
    for face in np.unique(numbers[seen]):
        mine = numbers == face
        inner = places[mine & seen & ~border]
        edge = places[mine & (border | ~seen)]
        if not len(inner):
            continue
        tried = inner[np.linspace(0, len(inner) - 1, min(len(inner), 200)).astype(int)]
        if len(edge):
            room = np.linalg.norm(tried[:, None] - edge[None], axis=2).min(axis=1)
            best = int(np.argmax(room))
            fitting = [size for size in SIZES if room[best] >= ROOM * size]
        else:
            best, fitting = len(tried) // 2, list(SIZES)
        if fitting:
            column, row = tried[best]
            found[int(face)] = (column, row, fitting[0])
    return found


def _label(pen: ImageDraw.ImageDraw, text: str, x: float, y: float, font: Any) -> None:
    left, top, right, bottom = pen.textbbox((0, 0), text, font=font)
    x, y = x - 0.5 * (left + right), y - 0.5 * (top + bottom)
    pen.text((x, y), text, font=font, fill="black", stroke_width=3, stroke_fill="white")
