"""The bodies of a URDF's links: meshes by the reader's process, boxes, cylinders and spheres, in mm."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from ..base import kept
from ..base.kinds import Array, Floats, Json
from ..base.regular_files import read_regular
from ..engine import InputError, core
from ..geometry import solids
from ..geometry.solids import Mesh
from .urdf import LIMIT, METRE, Arm, Tree, arm_of

COLLISION, VISUAL = ("collision", "visual"), (
    "visual",
    "collision",
)  # what is taken, the first first
SUFFIXES = (".stl", ".dae", ".obj", ".ply")
PACKAGE, FILE = "package://", "file://"
AROUND, ACROSS = 24, 12  # corners of a cylinder and a sphere; rings of a sphere
VERTEX_BYTES = 40  # in memory, about, with its triangles


class Piece(NamedTuple):
    """A geometry element of a link, and where it lies in the robot's base at joint angles 0."""

    link: str
    number: int  # of the body that carries it: 0 the foot, k what joint k carries
    frame: Floats
    element: ElementTree.Element


def bodies(model: Json, packages: Sequence[str], wanted: tuple[str, str]) -> list[Mesh] | None:
    """(points (n, 3) mm, triangles (m, 3)) of foot and links 1 to 6, where they lie in the robot's base at joint angles
    0, of a ``robot.model`` with its defaults that names a URDF. ``wanted``: COLLISION or VISUAL. None: the file has no
    body at all. Raises InputError.
    """
    arm = arm_of(model)
    pieces = list(_pieces(arm, wanted))
    meshes = _files_of(arm.tree, pieces, packages)

    def read() -> list[Mesh]:
        found: list[list[Mesh]] = [[] for _ in range(len(arm.moving()) + 1)]
        for piece in pieces:
            found[piece.number].append(_mesh(arm.tree, piece, packages))
        return [_joined(one) for one in found]

    if not pieces:
        return None
    return kept.get(
        "urdf",
        lambda: (arm.tree.data, [read_regular(one, LIMIT) for one in meshes], dict(model), wanted),
        read,
        _bytes,
    )  # fmt: skip


def _bytes(found: list[Mesh]) -> float:
    return float(VERTEX_BYTES * sum(len(points) for points, _ in found))


def files(model: Json, packages: Sequence[str]) -> list[Path]:
    """The URDF and all meshes that it names. Raises InputError for one that is not there."""
    arm = arm_of(model)
    pieces = [*_pieces(arm, COLLISION), *_pieces(arm, VISUAL)]
    return list(dict.fromkeys([arm.tree.file, *_files_of(arm.tree, pieces, packages)]))


def _files_of(tree: Tree, pieces: Sequence[Piece], packages: Sequence[str]) -> list[Path]:
    return [
        _located(tree, piece, packages)
        for piece in pieces
        if piece.element.find("mesh") is not None
    ]


def _pieces(arm: Arm, wanted: tuple[str, str]) -> Iterator[Piece]:
    for link, (number, frame) in _placed(arm).items():
        element = arm.tree.links[link]
        found = element.findall(wanted[0]) or element.findall(wanted[1])
        for one in found:
            shape = one.find("geometry")
            if shape is None or not len(shape):
                raise arm.tree.fault(
                    "presets.urdf_geometry", "link {link}: a body has no geometry", link=link
                )
            yield Piece(link, number, frame @ arm.tree.origin(one, link), shape)


def _placed(arm: Arm) -> dict[str, tuple[int, Floats]]:
    """{link: (number of the body that it goes with, its frame in the base with all joints at zero)}. What hangs on a
    joint beside the arm goes with what that hangs on."""
    numbers = {joint.name: k for k, joint in enumerate(arm.moving(), 1)}
    found, open_links = {arm.base: (0, np.eye(4))}, [arm.base]
    while open_links:
        link = open_links.pop()
        number, at = found[link]
        for joint in arm.tree.joints:
            if joint.parent == link and joint.child not in found:
                found[joint.child] = numbers.get(joint.name, number), at @ joint.frame
                open_links.append(joint.child)
            elif joint.child == link and joint.parent not in found:
                found[joint.parent] = number, at @ np.linalg.inv(joint.frame)
                open_links.append(joint.parent)
    return found


def _mesh(tree: Tree, piece: Piece, packages: Sequence[str]) -> Mesh:
    shape, what = piece.element[0], piece.link
    if shape.tag == "mesh":
        points, faces = _read(tree, _located(tree, piece, packages), piece)
    elif shape.tag == "box":
        half = 0.5 * METRE * tree.vector(shape, "size", "", what)
        points, faces = solids.box(-half, half)
    elif shape.tag == "cylinder":
        radius, length = (METRE * tree.number(shape.get(k), what) for k in ("radius", "length"))
        points, faces = _turned([(radius, -0.5 * length), (radius, 0.5 * length)])
    elif shape.tag == "sphere":
        radius = METRE * tree.number(shape.get("radius"), what)
        angles = np.linspace(-0.5 * math.pi, 0.5 * math.pi, ACROSS + 1)[1:-1]
        points, faces = _turned(
            [(radius * math.cos(one), radius * math.sin(one)) for one in angles], radius
        )
    else:
        raise tree.fault(
            "presets.urdf_shape",
            "link {link}: the shape '{shape}' is not known; it is mesh, box, cylinder or sphere",
            link=what,
            shape=shape.tag,
        )
    return points @ piece.frame[:3, :3].T + piece.frame[:3, 3], faces


def _read(tree: Tree, file: Path, piece: Piece) -> Mesh:
    try:
        mesh = core.read_mesh(str(file), METRE)
    except InputError as error:
        error = error.within("presets.urdf_of_link", "link {link}: ", link=piece.link)
        raise error.within("files.in_file", "{file}: ", file=tree.file) from None
    scale = tree.vector(piece.element[0], "scale", "1 1 1", piece.link)
    faces = np.asarray(mesh.triangles, dtype=int)
    if np.prod(scale) < 0.0:  # mirrored: outside stays outside
        faces = faces[:, ::-1]
    return np.asarray(mesh.vertices, dtype=float) * scale, faces


def _located(tree: Tree, piece: Piece, packages: Sequence[str]) -> Path:
    """The mesh's file: a package's folder lies in one of ``packages``, is one of them, or lies about the URDF."""
    mesh = piece.element.find("mesh")
    name = "" if mesh is None else mesh.get("filename", "")
    if Path(name).suffix.lower() not in SUFFIXES:
        raise tree.fault(
            "presets.urdf_format",
            "link {link}: the mesh '{mesh}' is no STL, DAE, OBJ or PLY",
            link=piece.link,
            mesh=name,
        )
    if not name.startswith(PACKAGE):
        found = Path(tree.file.parent, name.removeprefix(FILE))
        if found.is_file():
            return found
        raise tree.fault(
            "presets.urdf_no_mesh",
            "link {link}: there is no mesh '{mesh}'",
            link=piece.link,
            mesh=name,
        )
    package, _, rest = name.removeprefix(PACKAGE).partition("/")
    for folder in (*map(Path, packages), *tree.file.absolute().parents):
        for root in (folder, folder / package):
            if root.name == package and (root / rest).is_file():
                return root / rest
    raise tree.fault(
        "presets.urdf_no_package",
        "link {link}: there is no mesh '{mesh}'; put the folder of the package '{package}' among robot.packages",
        link=piece.link,
        mesh=name,
        package=package,
    )


def _turned(profile: Sequence[tuple[float, float]], pole: float | None = None) -> Mesh:
    """A closed body of revolution about z: (radius, z) from below, its ends flat, or at z = -+pole."""
    ends = (profile[0][1], profile[-1][1]) if pole is None else (-pole, pole)
    angles = np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(AROUND)], axis=1)
    points = [ring * [r, r, 1.0] + [0.0, 0.0, z] for r, z in profile]
    last = AROUND * len(profile)
    a = np.arange(AROUND)
    b = (a + 1) % AROUND
    faces = [np.stack([np.full(AROUND, last), b, a], axis=1)]
    for k in range(len(profile) - 1):
        low = AROUND * k
        quads = np.stack([low + a, low + b, low + AROUND + b, low + AROUND + a], axis=1)
        faces.append(solids.triangles(quads))
    top = last - AROUND
    faces.append(np.stack([np.full(AROUND, last + 1), top + a, top + b], axis=1))
    return np.concatenate([*points, [[0.0, 0.0, z] for z in ends]]), np.concatenate(faces)


def _joined(meshes: Sequence[Mesh]) -> Mesh:
    points: list[Array] = [np.zeros((0, 3)), *(one for one, _ in meshes)]
    begins = np.cumsum([0, *(len(one) for one in points[1:])])
    faces = [np.zeros((0, 3), int), *(one + begin for (_, one), begin in zip(meshes, begins))]
    return np.concatenate(points), np.concatenate(faces)
