"""The faces of the part that are not ground, and all its edges, for orientation."""

import numpy as np
import Part
from pivy import coin

from ...engine import InputError
from ...objects import job_data

GREY = (0.62, 0.64, 0.67)
EDGE = (0.2, 0.2, 0.22)
DEFLECTION = 0.001  # chord error, as a share of the part's diagonal
SPREAD = 600  # points over a part
REST = "BeltGrindingRest"  # name of the node of the faces that are not ground


def rest_of_part(job):
    """Coin node with the job's part without the faces to be ground, and with its edges; not picked."""
    root = coin.SoSeparator()
    root.setName(REST)
    try:
        shape, numbers = job_data.design(job)
    except InputError:
        return root
    ground = set(numbers)
    others = [face for i, face in enumerate(shape.Faces, 1) if i not in ground]
    deflection = _deflection(shape)
    points, triangles = Part.Compound(others).tessellate(deflection) if others else ([], [])
    pick = coin.SoPickStyle()
    pick.style = coin.SoPickStyle.UNPICKABLE
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    hints.creaseAngle = 0.5
    material = coin.SoMaterial()
    material.diffuseColor = GREY
    coordinates = coin.SoCoordinate3()
    coordinates.point.setValues(0, len(points), [tuple(point) for point in points])
    indices = [index for a, b, c in triangles for index in (a, b, c, -1)]
    faces = coin.SoIndexedFaceSet()
    faces.coordIndex.setValues(0, len(indices), indices)
    root.addChild(pick)
    for node in (hints, material, coordinates, faces) if triangles else ():
        root.addChild(node)
    root.addChild(_edges(shape, deflection))
    return root


def tessellated(shape, whole=None):
    """(points (n, 3), triangles (m, 3)) of a Part shape, as fine as it is drawn here; ``whole``: what it is a
    face of."""
    points, faces = shape.tessellate(_deflection(whole or shape))
    return np.array([tuple(p) for p in points]).reshape(-1, 3), np.array(faces).reshape(-1, 3)


def points_of_part(job):
    """(n, 3) some hundred points spread over a job's part by area, mm; none where it has no part."""
    try:
        points, triangles = tessellated(job_data.design(job)[0])
    except (AttributeError, InputError):  # without a job
        return np.zeros((0, 3))
    a, b, c = points[triangles].transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    if not areas.sum() > 0.0:
        return points[:SPREAD]
    chance = np.random.default_rng(1)  # the same ones every time
    chosen = chance.choice(len(triangles), SPREAD, p=areas / areas.sum())
    u, v = chance.random((2, SPREAD, 1))
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)
    return a[chosen] + u * (b - a)[chosen] + v * (c - a)[chosen]


def edges_of_part(job):
    """Coin node with the edges of the job's part; not picked."""
    root = coin.SoSeparator()
    try:
        shape = job_data.design(job)[0]
    except InputError:
        return root
    pick = coin.SoPickStyle()
    pick.style = coin.SoPickStyle.UNPICKABLE
    root.addChild(pick)
    root.addChild(_edges(shape, _deflection(shape)))
    return root


def _deflection(shape):
    return DEFLECTION * max(shape.BoundBox.DiagonalLength, 1e-6)


def _edges(shape, deflection):
    """The edges as thin lines: without them, faces of one brightness run into one another, and the
    coloured ones have no light."""
    root = coin.SoSeparator()
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    colour = coin.SoBaseColor()
    colour.rgb = EDGE
    points, counts = [], []
    for edge in shape.Edges:
        if edge.Degenerated:
            continue
        line = [tuple(point) for point in edge.discretize(Deflection=deflection)]
        points += line
        counts.append(len(line))
    coordinates = coin.SoCoordinate3()
    coordinates.point.setValues(0, len(points), points)
    lines = coin.SoLineSet()
    lines.numVertices.setValues(0, len(counts), counts)
    for node in (light, colour, coordinates, lines):
        root.addChild(node)
    return root
