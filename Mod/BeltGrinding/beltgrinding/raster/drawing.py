"""A raster path on its part, as a picture for people without FreeCAD: passes, and what of the faces is left out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from PIL import Image, ImageDraw

from ..base.kinds import Array, Context, Floats, Json
from ..engine import core
from ..inspection import picture
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import read_design
from . import reachable

if TYPE_CHECKING:
    from ..inspection.picture import View

SAMPLES = 60_000  # on the faces
COLOURS = {
    reachable.GROUND: 0xD9E2ECFF,
    reachable.NO_ROOM: 0xC22185FF,
    reachable.NO_PASS: 0xFA9E1FFF,
    reachable.NOT_WANTED: 0xEDEDEDFF,
}
WORDS = {
    reachable.GROUND: "ground by a pass",
    reachable.NO_ROOM: "left out: no room",
    reachable.NO_PASS: "has room, no pass touches it",
    reachable.NOT_WANTED: "not in the region",
}
PASS, BEGIN = (22, 62, 122), (12, 140, 60)  # RGB of passes, and of where they begin
STEP = 3.0  # pixels from place to place on a pass, of which each is looked at: is it hidden?
DOT = 5  # pixels
LETTERS, ROW = 24, 34  # pixels


def draw(job: Job | Json, result: dict[str, Any], context: Context = None) -> bytes:
    """Bytes of a PNG: the part from two sides with the passes of ``raster_path.raster``'s result, a dot where
    each begins, and the faces in the colour of what is ground and why the rest is not. Raises InputError, Cancelled.
    """
    shape = read_design(typed(job).design, context)
    places = result["places"]
    faces = np.unique(places["faces"]).tolist()
    area = sum(shape.face_area(face) for face in faces)
    field, _ = core.sample_faces(shape, faces, math.sqrt(area / SAMPLES), context=context)
    states = places["state"][reachable.nearest(field.points, places["points"])]
    colours = np.array([COLOURS[state] for state in states], dtype=np.uint32)
    studio = picture.Studio(field, colours, shape, context)
    ways = [result["contacts"][p["first"] : p["last"] + 1] for p in result["passes"]]
    sides = [_with_passes(view, ways, field.spacing) for view in studio.both(context)]
    told = [state for state in COLOURS if (places["state"] == state).any()]
    whole = Image.new(
        "RGB",
        (sum(side.width for side in sides), sides[0].height + ROW * (len(told) + 1)),
        "white",
    )
    whole.paste(sides[0], (0, 0))
    whole.paste(sides[1], (sides[0].width, 0))
    _legend(whole, sides[0].height, told, places, len(ways))
    return picture.png(np.asarray(whole))


def _with_passes(view: View, ways: Sequence[Floats], spacing: float) -> Any:
    image = Image.fromarray(view.pixels)
    pen = ImageDraw.Draw(image)
    slack = picture.HIDDEN * spacing
    for frames in ways:
        fine = _between(frames[:, :3, 3], STEP / view.scale)
        seen = view.shows(fine, slack) & _faces_us(frames, fine, view)
        at = view.project(fine)[:, :2]
        for k in np.flatnonzero(seen[:-1] & seen[1:]):
            pen.line([tuple(at[k]), tuple(at[k + 1])], fill=PASS, width=3)
        if seen[0]:
            x, y = at[0]
            pen.ellipse([x - DOT, y - DOT, x + DOT, y + DOT], fill=BEGIN)
    return image


def _faces_us(frames: Floats, fine: Floats, view: View) -> Array:
    """(n,) bool of places on a pass: its surface is turned to the camera there."""
    near = reachable.nearest(fine, frames[:, :3, 3])
    return frames[near, :3, 2] @ view.direction > 0.0


def _between(points: Floats, spacing: float) -> Floats:
    """Points (k, 3) on the way over points (n, 3), ``spacing`` mm apart at most."""
    count = np.maximum(
        np.ceil(np.linalg.norm(np.diff(points, axis=0), axis=1) / spacing), 1
    ).astype(int)
    i = np.repeat(np.arange(len(count)), count)
    share = (np.arange(len(i)) - np.repeat(np.cumsum(count) - count, count)) / count[i]
    return np.vstack([points[i] + share[:, None] * (points[i + 1] - points[i]), points[-1:]])


def _legend(image: Any, top: int, states: Sequence[int], places: Json, count: int) -> None:
    pen, font = ImageDraw.Draw(image), picture.font(LETTERS)
    areas = places["counted"] if places["counted"].sum() > 0.0 else places["areas"]
    for row, state in enumerate(states):
        y = top + ROW * row + 5
        red, green, blue = (COLOURS[state] >> shift & 0xFF for shift in (24, 16, 8))
        pen.rectangle([12, y, 12 + LETTERS, y + LETTERS], fill=(red, green, blue), outline="black")
        share = ""
        if state != reachable.NOT_WANTED:
            share = f", {100.0 * areas[places['state'] == state].sum() / areas.sum():.1f} %"
        pen.text((24 + LETTERS, y - 2), WORDS[state] + share, font=font, fill="black")
    y = top + ROW * len(states) + 5
    pen.line([12, y + LETTERS / 2, 12 + LETTERS, y + LETTERS / 2], fill=PASS, width=3)
    pen.ellipse([12, y + 7, 12 + 2 * DOT, y + 7 + 2 * DOT], fill=BEGIN)
    pen.text((24 + LETTERS, y - 2), f"{count} passes, each from its dot", font=font, fill="black")
