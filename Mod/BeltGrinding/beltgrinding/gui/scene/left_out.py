"""What a raster path leaves out, laid over the faces in a colour for each reason."""

import numpy as np
from pivy import coin

from ...objects.raster_path import NO_PASS, NO_ROOM
from .shapes3d import material, separator, triangles, unpickable

COLOURS = {NO_ROOM: (0.76, 0.13, 0.52), NO_PASS: (0.98, 0.62, 0.12)}
CREASE = 0.6  # rad
NEARER = -2.0  # polygon offset: in front of the face that it lies in


def left_out(points, indices, states):
    """Coin node of triangles (m, 3) on points (n, 3) mm with ``states`` (n,): each in the colour of most of its
    corners that are left out."""
    root = separator(unpickable())
    if not len(indices):
        return root
    offset = coin.SoPolygonOffset()
    offset.factor, offset.units = NEARER, NEARER
    root.addChild(offset)
    corners = np.asarray(states)[indices]
    counts = {state: (corners == state).sum(axis=1) for state in COLOURS}
    no_room = counts[NO_ROOM] >= counts[NO_PASS]
    for state, mine in ((NO_ROOM, no_room), (NO_PASS, ~no_room)):
        if mine.any():
            root.addChild(
                separator(material(COLOURS[state]), triangles(points, indices[mine], CREASE))
            )
    return root
