"""Short strokes on the ground part along which the last pass scratched it; where scratches of two directions stay, in
another colour."""

from __future__ import annotations

import json

import numpy as np
from pivy import coin

from ...inspection import finish
from ...objects.fields import field_of
from ...objects.kinds import DocumentObject, Field
from ..common.kinds import Array, Node, Rgb
from ..common.compat import translate
from .legend_picture import Mark, packed
from .shapes3d import separator, unpickable

MOST = 1000  # strokes: enough to see the lay, few enough to see what lies below
LENGTH = 0.7  # of a stroke, of the distance between neighbouring ones
ABOVE = 0.01  # of that distance: off the surface, so that it does not hide them
WIDTH = 1.5  # pixels
PLAIN, CROSSED = (0.10, 0.10, 0.12), (0.85, 0.10, 0.10)


def lay_strokes(obj: DocumentObject) -> Node | None:
    """Coin node of the strokes of a Deviation; None where its result has no lay, or another result is shown."""
    simulation: DocumentObject = getattr(obj, "Simulation", None)
    field = None if simulation is None else field_of(simulation)
    if field is None or field.finish is None or field.size != obj.Mesh.CountPoints:
        return None
    told = json.loads(simulation.VerdictData or "{}").get("verdict", {}).get("finish")
    if told is None:
        return None
    ends, across = strokes(field, told["rest_per_pass"], told["crossing_angle_deg"])
    if not len(ends):
        return None
    light, style = coin.SoLightModel(), coin.SoDrawStyle()
    light.model = coin.SoLightModel.BASE_COLOR
    style.lineWidth = WIDTH
    root = separator(unpickable(), light, style)
    for chosen, colour in ((~across, PLAIN), (across, CROSSED)):
        if chosen.any():
            root.addChild(_lines(ends[chosen], colour))
    return root


def marks(lay: Node) -> list[Mark]:
    """What a legend says of the strokes in a node."""
    colours = coin.SoSearchAction()
    colours.setType(coin.SoBaseColor.getClassTypeId())
    colours.setInterest(coin.SoSearchAction.ALL)
    colours.setSearchingAll(True)
    colours.apply(lay)
    paths = colours.getPaths()
    drawn = [
        tuple(round(v, 3) for v in paths[k].getTail().rgb[0].getValue())
        for k in range(paths.getLength())
    ]
    words = (
        (PLAIN, translate("BeltGrinding", "scratches")),
        (CROSSED, translate("BeltGrinding", "crossed scratches")),
    )
    return [Mark(packed(colour), text, True) for colour, text in words if colour in drawn]


def strokes(field: Field, rest: float, angle_deg: float, most: int = MOST) -> tuple[Array, Array]:
    """((k, 2, 3) mm, ends of strokes along the lay on the surface as it was ground, at most some more than ``most``;
    (k,) whether scratches of another direction stay there). ``rest``, ``angle_deg``: as of ``finish.crossed``.
    """
    lay = np.asarray(field.finish["lay"], dtype=float)
    laid = np.flatnonzero(lay.any(axis=1))
    if not len(laid):
        return np.zeros((0, 2, 3)), np.zeros(0, dtype=bool)
    area = float(np.asarray(field.areas, dtype=float)[laid].sum())
    apart = max(float(np.sqrt(area / most)), field.spacing)
    # One sample of each cube of the space: evenly apart, whatever the sampling.
    points = np.asarray(field.points, dtype=float)[laid]
    cubes = np.floor((points - points.min(axis=0)) / apart).astype(np.int64)
    _, first = np.unique(cubes, axis=0, return_index=True)
    chosen = laid[first]
    normals = np.asarray(field.normals, dtype=float)[chosen]
    tops = np.asarray(field.points, dtype=float)[chosen]
    tops = tops + np.asarray(field.height)[chosen, None] * np.asarray(field.rays)[chosen]
    middle = tops + ABOVE * apart * normals
    half = 0.5 * LENGTH * apart * lay[chosen]
    across = finish.crossed(field, rest, angle_deg)
    known = np.zeros(len(chosen), dtype=bool) if across is None else across[chosen]
    return np.stack([middle - half, middle + half], axis=1), known


def _lines(ends: Array, colour: Rgb) -> Node:
    tone, coordinates, lines = coin.SoBaseColor(), coin.SoCoordinate3(), coin.SoLineSet()
    tone.rgb = colour
    points = ends.reshape(-1, 3)
    coordinates.point.setValues(0, len(points), points.tolist())
    lines.numVertices.setValues(0, len(ends), [2] * len(ends))
    return separator(tone, coordinates, lines)
