"""Pictures of a ground part without a display: front, back, and close-ups of the worst spots.

``core.Renderer`` draws them; the colours are the deviation's. A view knows where every point of
the part is on the picture, so that marks and captions can be laid over it.
"""

from __future__ import annotations
import io
from typing import Any
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageFont
from PIL.PngImagePlugin import PngInfo
from numpy.typing import ArrayLike, NDArray

from ..base.kinds import Array, Context, Floats
from ..engine import core
from . import sight

PART_COLOUR = 0xB9BDC3FF  # of what is not ground: neutral, unlike any deviation
WIDTH, HEIGHT = 1600, 1200  # pixels
PIXELS = WIDTH * HEIGHT  # of a picture whose sides follow the part
NARROWEST, WIDEST = 0.8, 1.7  # width by height of such a picture
CLOSE_WIDTH, CLOSE_HEIGHT = 800, 600
MARGIN = 1.06  # of the extents in the picture
CHORD = 1e-3  # chord error of the rest of the part, of its diagonal
UPRIGHT = (0.0, 0.0, 1.0)
AROUND, SAME_SIDE = 200, 0.2  # samples around a spot, at most; cosine between normals of one side
STEEP = 30.0  # degrees from an axis within which it cannot be up
CLOSE_UP = 40  # samples from the lower to the upper border of a close-up, at least
CLOSEST_SHARE = 0.3  # of the field's diagonal, at most
FONT = "DejaVuSans-Bold.ttf"
PNG_LEVEL = 4  # of 9: half the time of 6 for a twentieth more bytes
HIDDEN = 2.0  # samples that a point may lie behind what the picture shows there


class View(NamedTuple):
    """A picture and its camera. Frame: work, mm."""

    pixels: Array  # (rows, columns, 3) uint8, sRGB
    depth: Array  # (rows, columns) mm beyond ``target``, NaN where there is nothing
    target: Array
    direction: Array  # unit, into the picture
    up: Array  # unit, at a right angle to it
    height: float  # mm from the lower to the upper border

    @property
    def scale(self) -> float:
        """Pixels a mm."""
        return self.pixels.shape[0] / self.height

    def project(self, points: Array) -> Floats:
        """(n, 3) of points (n, 3): column and row in pixels, mm beyond the target."""
        away = np.asarray(points, dtype=float).reshape(-1, 3) - self.target
        right = np.cross(self.direction, self.up)
        rows, columns = self.depth.shape
        return np.column_stack(
            [
                0.5 * columns + self.scale * (away @ right),
                0.5 * rows - self.scale * (away @ self.up),
                away @ self.direction,
            ]
        )

    def shows(self, points: Array, slack: float) -> NDArray[np.bool_]:
        """(n,) bool: in the picture, and not hidden by more than ``slack`` mm."""
        x, y, depth = self.project(points).T
        rows, columns = self.depth.shape
        inside = (x >= 0) & (x < columns) & (y >= 0) & (y < rows)
        there = self.depth[
            np.clip(y, 0, rows - 1).astype(int), np.clip(x, 0, columns - 1).astype(int)
        ]
        return inside & ~(depth > there + slack)


class Studio:
    """A ground field on its part, ready for pictures.

    ``colours``: (n,) uint32 0xRRGGBBAA, one a sample. ``shape``: the design's core.Shape, of which all
    but the field's faces is shown in grey; None: the field alone.
    """

    def __init__(
        self,
        field: core.HeightField,
        colours: Array,
        shape: core.Shape | None = None,
        context: Context = None,
    ) -> None:
        self.field = field
        self.points = field.points + field.height[:, None] * field.rays
        surfaces = [
            {
                "vertices": self.points,
                "triangles": field.triangles,
                "normals": field.normals,
                "colours": colours,
            }
        ]
        rest = [] if shape is None else rest_of(shape, field)
        if shape is not None and rest:
            low, high = shape.extents()
            chord = CHORD * float(np.linalg.norm(np.subtract(high, low)))
            mesh = core.triangulate(shape, max(chord, 1e-6), context, rest)
            surfaces.append(
                {
                    "vertices": mesh.vertices.astype(float),
                    "triangles": mesh.triangles,
                    "normals": smooth_normals(mesh),
                    "colours": np.array([PART_COLOUR], dtype=np.uint32),
                }
            )
        self.renderer = core.Renderer(surfaces, context)
        self.corners = self.renderer.farthest(_ways())
        columns = field.points.T  # faster than by rows
        self.lengths = np.array([np.ptp(column) for column in columns])

    def view(
        self,
        target: ArrayLike,
        direction: ArrayLike,
        up: ArrayLike,
        height: float,
        columns: int = WIDTH,
        rows: int = HEIGHT,
        near: float = np.inf,
        context: Context = None,
    ) -> View:
        """A ``View``; ``up`` is made square to ``direction``. What stands more than ``near`` mm
        before the target is cut away.
        """
        direction, up = square(direction, up)
        pixels, depth = self.renderer.render(
            target, direction, up, height, columns, rows, near, context
        )
        return View(pixels, depth, np.asarray(target, dtype=float), direction, up, float(height))

    def whole(
        self,
        direction: ArrayLike,
        up: ArrayLike,
        columns: int | None = None,
        rows: int | None = None,
        context: Context = None,
    ) -> View:
        """A ``View`` that just holds the part; without a size, of the part's own proportions."""
        away, upright = square(direction, up)
        axes = np.stack([np.cross(away, upright), upright, away])
        seen = self.corners @ axes.T
        low, high = seen.min(axis=0), seen.max(axis=0)
        wide, tall = (high - low)[:2]
        if columns is None or rows is None:
            shape = float(np.clip(wide / max(tall, 1e-9), NARROWEST, WIDEST))
            columns, rows = (int(round((PIXELS * f) ** 0.5)) for f in (shape, 1.0 / shape))
        height = MARGIN * max(tall, wide * rows / columns, 1e-6)
        return self.view(
            0.5 * (low + high) @ axes, away, upright, height, columns, rows, context=context
        )

    def both(self, context: Context = None) -> tuple[View, View]:
        """The ``View`` that shows most of the ground faces and, as large, the one that shows most of what
        the first does not; both upright, and not along an axis, so that the part looks like a body.
        """
        field, slack = self.field, HIDDEN * self.field.spacing
        sides = sight.Sides(self.renderer, self.points, field.normals, field.areas, slack)
        front = self.whole(-sides.front(), UPRIGHT, context=context)
        rows, columns = front.depth.shape
        back = self.whole(-sides.back(), UPRIGHT, columns, rows, context)
        return front, back

    def close_up(
        self, point: ArrayLike, normal: ArrayLike, extent: float = 0.0, context: Context = None
    ) -> View:
        """A ``View`` straight on ``point`` along its ``normal`` or, where something stands in the way, from
        where it is seen; ``extent`` mm and some around. What hides the point from everywhere is cut away.
        """
        spot: Floats = np.asarray(point, dtype=float)
        out: Floats = np.asarray(normal, dtype=float)
        low, high = self.renderer.extents
        most = MARGIN * float(np.linalg.norm(np.subtract(high, low)))
        largest = CLOSEST_SHARE * float(np.linalg.norm(self.lengths))
        height = min(max(min(2.0 * extent, largest), CLOSE_UP * self.field.spacing), most)
        slack = HIDDEN * self.field.spacing
        away, _ = sight.towards(self.renderer, *self._around(spot, out, extent), out, slack)
        up, near = _up_for(away, self.lengths), 2.0 * most
        while True:
            size = CLOSE_WIDTH, CLOSE_HEIGHT
            view = self.view(spot, -away, up, height, *size, near, context)
            if near < slack or view.shows(spot, slack)[0]:
                return view
            near = 0.5 * min(near, float(-view.depth[CLOSE_HEIGHT // 2, CLOSE_WIDTH // 2]))

    def _around(self, point: Floats, normal: Floats, extent: float) -> tuple[Array, Array]:
        """(points, normals) of a place: the point itself, and the samples around on its side."""
        reach = max(0.5 * extent, 2.0 * self.field.spacing)
        near = np.flatnonzero(np.abs(self.field.points[:, 0] - point[0]) < reach)
        near = near[np.linalg.norm(self.field.points[near] - point, axis=1) < reach]
        near = near[self.field.normals[near] @ normal > SAME_SIDE]
        near = near[sight.thinned(len(near), AROUND)]
        points = np.vstack([point, self.points[near]])
        return points, np.vstack([normal, self.field.normals[near]])


def rest_of(shape: core.Shape, field: core.HeightField) -> list[int]:
    """The faces of the shape that the field does not cover, from 0."""
    return np.setdiff1d(np.arange(shape.face_count), field.faces).tolist()


def smooth_normals(mesh: core.TriangleMesh) -> NDArray[np.float32]:
    """(n, 3) float32: mean normals at a mesh's vertices, which two faces never share."""
    corners = mesh.vertices[mesh.triangles].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    found = np.zeros((len(mesh.vertices), 3))
    for k in range(3):
        np.add.at(found, mesh.triangles[:, k], normals)
    length = np.linalg.norm(found, axis=1, keepdims=True)
    return (found / np.maximum(length, 1e-300)).astype(np.float32)


def _ways() -> Floats:
    """(n, 3) directions all around: the points that are farthest along them have the extents of all in any
    direction, or nearly so.
    """
    step = np.linspace(0.0, np.pi, 13)[:-1]
    return np.array(
        [
            [np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)]
            for a in step
            for b in np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)
        ]
    )


def square(direction: ArrayLike, up: ArrayLike) -> tuple[Floats, Floats]:
    """(direction, up) as unit vectors at a right angle."""
    away: Floats = np.asarray(direction, dtype=float)
    away = away / np.linalg.norm(away)
    upright: Floats = np.asarray(up, dtype=float)
    upright = upright - np.dot(upright, away) * away
    return away, upright / np.linalg.norm(upright)


def _up_for(out: Floats, lengths: Floats) -> Floats:
    """The axis of the part that is upright where one looks against ``out``: z if it can be, else the
    one along which the field is longest. ``lengths``: the field's along the axes.
    """
    if abs(out[2]) < np.cos(np.radians(STEEP)):
        return np.array([0.0, 0.0, 1.0])
    return np.eye(3)[0 if lengths[0] < lengths[1] and abs(out[0]) < 0.7 else 1]


def font(size: int) -> Any:
    """Pillow's font for what is written on pictures, of ``size`` pixels."""
    try:
        return ImageFont.truetype(FONT, size)
    except OSError:  # not installed: the small one that comes with Pillow
        return ImageFont.load_default()


def png(pixels: Array) -> bytes:
    """Bytes of a PNG file of (rows, columns, 3) uint8, which says by what it was made."""
    file, about = io.BytesIO(), PngInfo()
    about.add_text("Software", "BeltGrinding")
    try:
        Image.fromarray(pixels).save(file, "PNG", pnginfo=about, compress_level=PNG_LEVEL)
    except OSError as error:  # of zlib, which tells so that it has no memory; no disk is written to
        raise MemoryError(str(error)) from None
    return file.getvalue()
