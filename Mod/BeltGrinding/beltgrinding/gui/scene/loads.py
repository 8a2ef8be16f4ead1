"""Loads at the contact as arrows with their names: the pressing force, the feed, the belt's travel.

All kinds of machines have the same contact frame: its origin lies on the belt, z points into the part, x along the belt's
travel. So the same arrows hold for each of them, whoever holds the part.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from pivy import coin

from ...objects.kinds import DocumentObject
from ..common.compat import translate
from ..common.kinds import Array, Node, Rgb
from .labels import label
from .shapes3d import revolved, separator, set_matrix, triangles, unpickable

FORCE, FEED, BELT = (0.76, 0.08, 0.55), (0.0, 0.52, 0.62), (0.42, 0.25, 0.80)
HEAD, SHAFT, TIP = 0.3, 0.02, 0.07  # of an arrow's length: its head; radii of shaft and head
GAP = 1.15  # of half the width: where the belt's arrow lies, beside the wheel
STILL = 1e-6  # mm, mm/s: less is no travel
MOMENT = 1e-3  # s to both sides, over which a speed is taken


class Load(NamedTuple):
    """What acts at a moment."""

    force: float = 0.0  # N, pressing; 0: none, or not known
    travel: tuple[float, ...] = (0.0, 0.0, 0.0)  # way of the contact over the part, in its frame
    speed: float | None = None  # mm/s; None: a rapid motion, whose speed the controller chooses


def of_motion(arrays: Mapping[str, Array], machine: DocumentObject, to: int, travel: Array) -> Load:
    """The load as programmed on the motion to pose ``to``. ``arrays``: feeds in mm/s, forces in N (negative: the
    machine's), rapid; ``travel``: (3,) mm, the way of the contact in the part's frame."""
    rapid = bool(arrays["rapid"][to])
    force = 0.0
    if machine.Control == "force" and not rapid:
        force = float(arrays["forces"][to])
        force = machine.Force.getValueAs("N").Value if force < 0.0 else force
    return Load(force, tuple(travel.tolist()), None if rapid else float(arrays["feeds"][to]))


def at_moment(steps: Mapping[str, Array], time: float, before: Array, after: Array) -> Load:
    """The load of a simulation at ``time``, s. ``steps``: of its recording; ``before``, ``after``: (3,) mm, the contact
    in the part's frame ``MOMENT`` earlier and later."""
    inside = np.abs(steps["time"] - time) <= 0.5 * steps["duration"] + MOMENT
    force = float(np.asarray(steps["force"])[inside].max()) if inside.any() else 0.0
    velocity = (after - before) / (2.0 * MOMENT)
    return Load(force, tuple(velocity.tolist()), float(np.linalg.norm(velocity)))


def arrows(machine: DocumentObject, load: Load, contact: Array, part_moves: bool) -> Node:
    """Coin node in the contact frame. ``contact``: its 4 x 4 frame in the part's; ``part_moves``: the part is drawn
    moving past what grinds, so its own feed is shown, which is the opposite one."""
    from ...objects import belt_machine  # not above: who draws no cell needs none

    half = 0.5 * belt_machine.across(machine)
    length = max(belt_machine.half_size(machine), half)
    root = coin.SoAnnotation()  # over the wheel, in which the force's arrow lies
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    for node in (unpickable(), light):
        root.addChild(node)
    if load.force > 0.0:
        text = translate("BeltGrinding", "Force {:.3g} N").format(load.force)
        root.addChild(_arrow((0, 0, -length), (0, 0, 1), length, FORCE, text, at_tail=True))
    way = contact[:3, :3].T @ np.array(load.travel)
    size = float(np.linalg.norm(way))
    if size > STILL:
        text = translate("BeltGrinding", "Feed {}")
        if part_moves:
            way, text = -way, translate("BeltGrinding", "Feed of the part {}")
        speed = translate("BeltGrinding", "rapid")
        if load.speed is not None:
            speed = translate("BeltGrinding", "{:.3g} mm/s").format(load.speed)
        node = _arrow((0, 0, 0), way / size, length, FEED, text.format(speed), below=True)
        root.addChild(node)
    speed = machine.BeltSpeed.getValueAs("m/s").Value
    text = translate("BeltGrinding", "Belt {:.3g} m/s").format(speed)
    root.addChild(_arrow((0, GAP * half, 0), (1, 0, 0), length, BELT, text))
    return root


def _arrow(
    tail: Any,
    way: Any,
    length: float,
    colour: Rgb,
    text: str,
    at_tail: bool = False,
    below: bool = False,
) -> Node:
    """An arrow from ``tail`` along the unit vector ``way``, mm, with its name at the tip or tail, above or below it."""
    tail, way = np.array(tail, dtype=float), np.array(way, dtype=float)
    other = np.eye(3)[np.abs(way).argmin()]
    side = np.cross(way, other)
    side /= np.linalg.norm(side)
    frame = np.eye(4)
    frame[:3, :3] = length * np.column_stack([np.cross(way, side), way, side])
    frame[:3, 3] = tail
    place, tone, move = coin.SoMatrixTransform(), coin.SoBaseColor(), coin.SoTranslation()
    set_matrix(place, frame)
    tone.rgb = colour
    move.translation = tuple(tail if at_tail else tail + length * way)
    name = label(text, _packed(colour))
    name.vertAlignment = coin.SoImage.TOP if below else coin.SoImage.BOTTOM
    return separator(separator(tone, place, _shape()), separator(move, name))


def _packed(colour: Rgb) -> str:
    return "#" + "".join(f"{round(255 * one):02x}" for one in colour)


@cache
def _shape() -> Node:
    """An arrow of length 1 along y."""
    line = [[0.0, 0.0], [0.0, SHAFT], [1.0 - HEAD, SHAFT], [1.0 - HEAD, TIP], [1.0, 0.0]]
    return triangles(*revolved(np.array(line)))
