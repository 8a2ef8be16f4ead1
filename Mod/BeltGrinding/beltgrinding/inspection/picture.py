"""Pictures of a ground part without a display: front, back, and close-ups of the worst spots.

Rays are cast by ``core.Renderer``; the colours are the deviation's. A view knows where every point of
the part is on the picture, so that marks and captions can be laid over it.
"""

import io
from typing import NamedTuple

import numpy as np
from PIL import Image

from ..engine import core

PART_COLOUR = 0xB9BDC3FF  # of what is not ground: neutral, unlike any deviation
WIDTH, HEIGHT = 1600, 1200  # pixels
PIXELS = WIDTH * HEIGHT  # of a picture whose sides follow the part
NARROWEST, WIDEST = 0.8, 1.7  # width by height of such a picture
CLOSE_WIDTH, CLOSE_HEIGHT = 800, 600
MARGIN = 1.06  # of the extents in the picture
CHORD = 1e-3  # chord error of the rest of the part, of its diagonal
TURN, TILT = 25.0, 20.0  # degrees by which a view leaves the surface's normal, to look like a body
STEEP = 30.0  # degrees from an axis within which it cannot be up
CLOSED = 0.3  # of the area: a mean normal shorter than that says nothing
CLOSE_UP = 40  # samples from the lower to the upper border of a close-up, at least
CLOSEST_SHARE = 0.3  # of the field's diagonal, at most
HIDDEN = 2.0  # samples that a point may lie behind what the picture shows there


class View(NamedTuple):
    """A picture and its camera. Frame: work, mm."""

    pixels: np.ndarray  # (rows, columns, 3) uint8, sRGB
    depth: np.ndarray  # (rows, columns) mm beyond ``target``, NaN where there is nothing
    target: np.ndarray
    direction: np.ndarray  # unit, into the picture
    up: np.ndarray  # unit, at a right angle to it
    height: float  # mm from the lower to the upper border

    @property
    def scale(self):
        """Pixels a mm."""
        return self.pixels.shape[0] / self.height

    def project(self, points):
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

    def shows(self, points, slack):
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

    def __init__(self, field, colours, shape=None, context=None):
        self.field = field
        points = field.points + field.height[:, None] * field.normals
        surfaces = [
            {
                "vertices": points,
                "triangles": field.triangles,
                "normals": field.normals,
                "colours": colours,
            }
        ]
        rest = [] if shape is None else _rest(shape, field)
        if rest:
            low, high = shape.extents()
            chord = CHORD * float(np.linalg.norm(np.subtract(high, low)))
            mesh = core.triangulate(shape, max(chord, 1e-6), context, rest)
            surfaces.append(
                {
                    "vertices": mesh.vertices.astype(float),
                    "triangles": mesh.triangles,
                    "normals": _smooth(mesh),
                    "colours": np.array([PART_COLOUR], dtype=np.uint32),
                }
            )
        self.corners = [_corners(points)] + [_corners(s["vertices"]) for s in surfaces[1:]]
        self.renderer = core.Renderer(surfaces, context)

    def view(
        self, target, direction, up, height, columns=WIDTH, rows=HEIGHT, near=np.inf, context=None
    ):
        """A ``View``; ``up`` is made square to ``direction``. What stands more than ``near`` mm
        before the target is cut away.
        """
        direction, up = square(direction, up)
        pixels, depth = self.renderer.render(
            target, direction, up, height, columns, rows, near, context
        )
        return View(pixels, depth, np.asarray(target, dtype=float), direction, up, float(height))

    def whole(self, direction, up, columns=None, rows=None, context=None):
        """A ``View`` that just holds the part; without a size, of the part's own proportions."""
        direction, up = square(direction, up)
        axes = np.stack([np.cross(direction, up), up, direction])
        seen = np.vstack(self.corners) @ axes.T
        low, high = seen.min(axis=0), seen.max(axis=0)
        wide, tall = (high - low)[:2]
        if columns is None:
            shape = float(np.clip(wide / max(tall, 1e-9), NARROWEST, WIDEST))
            columns, rows = (int(round((PIXELS * f) ** 0.5)) for f in (shape, 1.0 / shape))
        height = MARGIN * max(tall, wide * rows / columns, 1e-6)
        return self.view(
            0.5 * (low + high) @ axes, direction, up, height, columns, rows, context=context
        )

    def both(self, context=None):
        """The ``View`` in which the ground faces show best, and as large the one from the other side:
        half a turn about what is upright.
        """
        direction, up = front_camera(self.field)
        front = self.whole(direction, up, context=context)
        rows, columns = front.depth.shape
        back = self.whole(turned(direction, up), up, columns, rows, context)
        return front, back

    def close_up(self, point, normal, extent=0.0, context=None):
        """A ``View`` straight on ``point`` along its ``normal``, ``extent`` mm and some around. What
        hides the point is cut away.
        """
        normal = np.asarray(normal, dtype=float)
        low, high = self.renderer.extents
        most = MARGIN * float(np.linalg.norm(np.subtract(high, low)))
        largest = CLOSEST_SHARE * float(np.linalg.norm(np.ptp(self.field.points, axis=0)))
        height = min(max(min(2.0 * extent, largest), CLOSE_UP * self.field.spacing), most)
        up, near = _up_for(normal, self.field), 2.0 * most
        while True:
            size = CLOSE_WIDTH, CLOSE_HEIGHT
            view = self.view(point, -normal, up, height, *size, near, context)
            slack = HIDDEN * self.field.spacing
            if near < slack or view.shows(point, slack)[0]:
                return view
            near = 0.5 * min(near, float(-view.depth[CLOSE_HEIGHT // 2, CLOSE_WIDTH // 2]))


def _rest(shape, field):
    """The faces of the shape that the field does not cover, from 0."""
    return np.setdiff1d(np.arange(shape.face_count), field.faces).tolist()


def _smooth(mesh):
    """(n, 3) float32: mean normals at a mesh's vertices, which two faces never share."""
    corners = mesh.vertices[mesh.triangles].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    found = np.zeros((len(mesh.vertices), 3))
    for k in range(3):
        np.add.at(found, mesh.triangles[:, k], normals)
    length = np.linalg.norm(found, axis=1, keepdims=True)
    return (found / np.maximum(length, 1e-300)).astype(np.float32)


def _corners(points):
    """Points whose extents are those of ``points`` in any direction, or nearly so: the farthest ones
    along directions all around.
    """
    step = np.linspace(0.0, np.pi, 13)[:-1]
    ways = [
        [np.cos(a) * np.cos(b), np.sin(a) * np.cos(b), np.sin(b)]
        for a in step
        for b in np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)
    ]
    found = np.unique([k for way in ways for k in _ends(points @ np.array(way))])
    return points[found]


def _ends(values):
    return int(np.argmin(values)), int(np.argmax(values))


def square(direction, up):
    """(direction, up) as unit vectors at a right angle."""
    direction = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    up = np.asarray(up, dtype=float) - np.dot(up, direction) * direction
    return direction, up / np.linalg.norm(up)


def front_camera(field):
    """(direction, up) from which the ground faces are seen best: against their mean normal or, where
    they close around the part, along the axis against which most of their area faces; turned and
    tilted a little, and with an axis of the part upright, so that the part looks like a body.
    """
    area = field.areas.astype(float)[:, None]
    mean = (area * field.normals).sum(axis=0) / max(area.sum(), 1e-300)
    if np.linalg.norm(mean) < CLOSED:
        axes = np.vstack([np.eye(3), -np.eye(3)])
        facing = (area * np.clip(field.normals @ axes.T, 0.0, None)).sum(axis=0)
        mean = axes[int(np.argmax(np.round(facing / facing.max(), 3)))]
    out = mean / np.linalg.norm(mean)
    up = _up_for(out, field)
    side = np.cross(up, out)
    turn, tilt = np.radians(TURN), np.radians(TILT)
    level = np.cos(turn) * out + np.sin(turn) * side
    return -(np.cos(tilt) * level + np.sin(tilt) * up), up


def turned(direction, up):
    """A direction after half a turn about ``up``: the other side, seen from as high."""
    up = up / np.linalg.norm(up)
    return 2.0 * np.dot(direction, up) * up - direction


def _up_for(out, field):
    """The axis of the part that is upright where one looks against ``out``: z if it can be, else the
    one along which the field is longest.
    """
    if abs(out[2]) < np.cos(np.radians(STEEP)):
        return np.array([0.0, 0.0, 1.0])
    lengths = np.ptp(field.points, axis=0)
    return np.eye(3)[0 if lengths[0] < lengths[1] and abs(out[0]) < 0.7 else 1]


def png(pixels):
    """Bytes of a PNG file of (rows, columns, 3) uint8."""
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return file.getvalue()
