"""Places of the faces, laid over them in a colour for each state: what passes leave out, what stays out of tolerance."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from pivy import coin

from ...objects.raster_path import NO_PASS, NO_ROOM
from ..common.compat import translate
from ..common.kinds import Array, Node, Rgb
from .legend_picture import Mark, Spec, packed
from .shapes3d import material, separator, triangles, unpickable

COLOURS = {NO_ROOM: (0.76, 0.13, 0.52), NO_PASS: (0.98, 0.62, 0.12)}  # of what passes leave out
CREASE = 0.6  # rad
NEARER = -2.0  # polygon offset: in front of the face that it lies in


def spec(name: str, states: Array) -> Spec:
    """The legend of what passes leave out."""
    words = (
        (NO_ROOM, translate("BeltGrinding", "without room")),
        (NO_PASS, translate("BeltGrinding", "without a pass")),
    )
    marks = tuple(Mark(packed(COLOURS[state]), text) for state, text in words if state in states)
    title = translate("BeltGrinding", "left out by the passes")
    return Spec([], {}, title, ("", ""), (False, False), "", name, marks)


def left_out(
    points: Array, indices: Array, states: Array, colours: Mapping[int, Rgb] = COLOURS
) -> Node:
    """Coin node of triangles (m, 3) on points (n, 3) mm with ``states`` (n,): each in the colour of most of its
    corners. ``colours``: {state: (red, green, blue) in [0, 1]}; other states are not drawn."""
    root = separator(unpickable())
    if not len(indices):
        return root
    light = coin.SoLightModel()  # none: a shade would change what a colour says
    light.model = coin.SoLightModel.BASE_COLOR
    root.addChild(light)
    offset = coin.SoPolygonOffset()
    offset.factor, offset.units = NEARER, NEARER
    root.addChild(offset)
    corners = np.asarray(states)[indices]
    kinds = list(colours)
    counts = np.stack([(corners == state).sum(axis=1) for state in kinds])
    most = np.where(counts.any(axis=0), counts.argmax(axis=0), -1)
    for k, state in enumerate(kinds):
        mine = most == k
        if mine.any():
            root.addChild(
                separator(material(colours[state]), triangles(points, indices[mine], CREASE))
            )
    return root
