"""Coin nodes of things that are drawn for orientation: the contact wheel, frames, bodies."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from pivy import coin

from ...objects.kinds import DocumentObject
from ..common.kinds import Array, Node, Rgb, Surface

RUBBER, CORE, BODY = (0.20, 0.22, 0.25), (0.72, 0.74, 0.78), (0.55, 0.60, 0.68)
BELT = (0.48, 0.25, 0.15)  # the grain
BELT_THICKNESS = 0.012  # of the wheel's radius, as it is drawn
AXES = ((0.84, 0.15, 0.16), (0.17, 0.55, 0.20), (0.13, 0.36, 0.78))  # x, y, z
AROUND = 72  # parts of the wheel's circumference
ACROSS = 9  # points of its profile across the width
DEFLECTION = 0.002  # chord error of a body, as a share of its diagonal


def set_matrix(node: Node, frame: Array) -> None:
    """Gives a SoMatrixTransform a (4, 4) frame; Coin multiplies rows from the left."""
    node.matrix.setValue(coin.SbMatrix(*np.asarray(frame, dtype=float).T.ravel().tolist()))


def separator(*nodes: Node) -> Node:
    root = coin.SoSeparator()
    for node in nodes:
        root.addChild(node)
    return root


def material(colour: Rgb, transparency: float = 0.0) -> Node:
    node = coin.SoMaterial()
    node.diffuseColor = colour
    node.transparency = transparency
    return node


def faint() -> Node:
    """A material that makes what comes after it see-through, whatever its colour."""
    node = coin.SoMaterial()
    for name in ("ambientColor", "diffuseColor", "specularColor", "emissiveColor", "shininess"):
        getattr(node, name).setIgnored(True)
    node.transparency = 0.85
    node.setOverride(True)
    return node


def unpickable() -> Node:
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    return style


def triangles(points: Any, indices: Any, crease: float = 0.5, solid: bool = False) -> Node:
    """Faces of points (n, 3) and triangles (m, 3), lit from both sides unless ``solid``."""
    hints = coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.COUNTERCLOCKWISE
    if solid:
        hints.shapeType = coin.SoShapeHints.SOLID
    hints.creaseAngle = crease
    coordinates = coin.SoCoordinate3()
    coordinates.point.setValues(0, len(points), np.asarray(points, dtype=float).tolist())
    ends = np.full((len(indices), 1), -1)
    flat = np.hstack([np.asarray(indices, dtype=int).reshape(-1, 3), ends]).ravel().tolist()
    faces = coin.SoIndexedFaceSet()
    faces.coordIndex.setValues(0, len(flat), flat)
    return separator(hints, coordinates, faces)


def profile(machine: DocumentObject) -> Array:
    """Points [y, radius] (n, 2) in mm across a belt machine's wheel, from one side to the other."""
    radius, width = machine.WheelRadius.Value, machine.WheelWidth.Value
    turned = [(point.x, point.y) for point in machine.Profile]
    if turned:
        y, drop = np.array(turned).T
        return np.stack([y, radius - drop], axis=1)
    y = np.linspace(-0.5 * width, 0.5 * width, ACROSS)
    crown = machine.CrownRadius.Value
    drop = np.zeros(ACROSS)
    if crown > 0.5 * width:
        drop = crown - np.sqrt(crown**2 - y**2)
    return np.stack([y, radius - drop], axis=1)


def revolved(line: Array) -> Surface:
    """(points, triangles) of a line [y, radius] turned about the y axis."""
    angles = np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
    y, radius = line.T
    points = np.stack(
        [
            np.sin(angles)[:, None] * radius,
            np.broadcast_to(y, (AROUND, len(y))),
            np.cos(angles)[:, None] * radius,
        ],
        axis=-1,
    ).reshape(-1, 3)
    count = len(line)
    i, k = np.meshgrid(np.arange(AROUND), np.arange(count - 1), indexing="ij")
    a, b = i * count + k, (i + 1) % AROUND * count + k
    quads = np.stack([a, b, b + 1, a + 1], axis=-1).reshape(-1, 4)
    return points, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def wheel(machine: DocumentObject) -> Node:
    """The contact wheel in the contact frame (its centre at z = -R): core, rim, the belt around it, axes."""
    line = profile(machine)
    radius = machine.WheelRadius.Value
    least = max(float(line[:, 1].min()) - max(machine.RimThickness.Value, 0.02 * radius), 0.0)
    first, last = line[0], line[-1]
    # The belt is a part of the radius: its grain is what touches.
    under = line - [0.0, min(BELT_THICKNESS * radius, 0.5 * (line[:, 1].min() - least))]
    rim = np.vstack([[first[0], least], under, [last[0], least]])
    belt = np.vstack([under[:1], line, under[-1:]])
    core = np.array([[first[0], 0.0], [first[0], least], [last[0], least], [last[0], 0.0]])
    move = coin.SoTranslation()
    move.translation = (0.0, 0.0, -radius)
    return separator(
        separator(
            move,
            separator(material(CORE), triangles(*revolved(core))),
            separator(material(RUBBER), triangles(*revolved(rim))),
            separator(material(BELT), triangles(*revolved(belt))),
        ),
        axes(0.5 * radius),
    )


def axes(length: float) -> Node:
    """Three arrows of mm ``length``: x red, y green, z blue."""
    root = coin.SoSeparator()
    for k, colour in enumerate(AXES):
        line = np.array([[0.0, 0.0], [0.0, 0.012], [0.8, 0.012], [0.8, 0.04], [1.0, 0.0]]) * length
        points, faces = revolved(line)
        # The line turned about y lies along y; the others by a cyclic change of axes.
        points = np.roll(points, k - 1, axis=1)
        root.addChild(separator(material(colour), triangles(points, faces)))
    return root


def body(obj: DocumentObject) -> Node:
    """A Part or Mesh object, its coordinates taken in whatever frame the node is put."""
    points, faces = mesh_of(obj)
    return separator(material(BODY), triangles(points, faces))


def mesh_of(obj: DocumentObject) -> tuple[Sequence[Any], Sequence[Any]]:
    """(points (n, 3), triangles (m, 3)) of a Part or Mesh object, its placement applied."""
    from ...objects.geometry import placed_shape

    if hasattr(obj, "Mesh"):
        points, faces = obj.Mesh.Topology  # in the document's coordinates
        return [tuple(p) for p in points], faces
    shape = placed_shape(obj)
    points, faces = shape.tessellate(DEFLECTION * max(shape.BoundBox.DiagonalLength, 1e-6))
    return [tuple(p) for p in points], faces
