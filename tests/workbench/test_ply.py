"""PLY files of all kinds: what is a surface is read as one, and what is not understood is refused, never a cloud."""

import os
import struct
from pathlib import Path

import numpy as np
import pytest

from beltgrinding.engine import InputError, core
from beltgrinding.scan import file as scan_file

SHARED = Path(os.environ.get("BELTGRINDING_SHARED", Path(__file__).parents[3] / "shared"))
SQUARE = "0 0 0\n2 0 0\n2 2 0\n0 2 0\n"
VERTICES = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"


def read(tmp_path, header, body, form="ascii"):
    path = tmp_path / "part.ply"
    text = f"ply\nformat {form} 1.0\n{header}end_header\n".encode()
    path.write_bytes(text + (body if isinstance(body, bytes) else body.encode()))
    return core.read_ply(str(path))


def area(vertices, triangles):
    a, b, c = (np.asarray(vertices)[np.asarray(triangles)[:, k]] for k in range(3))
    return 0.5 * np.cross(b - a, c - a).sum(axis=0)


def test_strips_are_triangles():
    path = SHARED / "faults" / "strips.ply"
    if not path.exists():
        pytest.skip("the shared inputs are not here")
    scan = scan_file.read(path)
    assert len(scan.triangles) == 400
    np.testing.assert_allclose(area(scan.points, scan.triangles), [0, 0, 200], atol=1e-9)
    np.testing.assert_allclose(scan.points.min(axis=0), [0, 0, 10])
    np.testing.assert_allclose(scan.points.max(axis=0), [20, 10, 10])


STRIP = "element tristrips 1\nproperty list int int vertex_indices\n"


@pytest.mark.parametrize(
    "strip, whole",
    [
        ("4 0 1 3 2", 4.0),
        ("7 0 1 3 -1 1 2 3", 4.0),  # a new strip begins with the first sense
        ("9 0 1 3 3 1 1 1 2 3", 4.0),  # joined by corners named twice
        ("5 -1 0 1 3 -1", 2.0),
    ],
)
def test_a_strip_turns_every_second_triangle(tmp_path, strip, whole):
    vertices, triangles, _ = read(tmp_path, VERTICES + STRIP, SQUARE + strip + "\n")
    np.testing.assert_allclose(area(vertices, triangles), [0, 0, whole])
    assert all(len(set(t)) == 3 for t in triangles.tolist())


@pytest.mark.parametrize("order, form", [("<", "little"), (">", "big")])
def test_strips_in_binary(tmp_path, order, form):
    body = struct.pack(f"{order}12f", *map(float, SQUARE.split()))
    body += struct.pack(f"{order}i5i", 5, -1, 0, 1, 3, 2)
    vertices, triangles, _ = read(tmp_path, VERTICES + STRIP, body, f"binary_{form}_endian")
    np.testing.assert_allclose(area(vertices, triangles), [0, 0, 4])


@pytest.mark.parametrize(
    "name, number",
    [("vertex_indices", "int"), ("vertex_index", "uint"), ("vertex_index", "ushort")],
)
def test_polygons_with_more_about_them(tmp_path, name, number):
    header = (
        "comment made by hand\n" + VERTICES + "property float nx\nproperty uchar red\n"
        f"element face 2\nproperty uchar flags\nproperty list uchar {number} {name}\n"
        "property list uchar float texcoord\nelement material 1\nproperty int shininess\n"
    )
    rows = "".join(f"{line} 0.5 255\n" for line in SQUARE.splitlines())
    body = rows + "1 4 0 1 2 3 2 0.5 +0.5\n0 0 0\n7\n"
    vertices, triangles, _ = read(tmp_path, header, body)
    np.testing.assert_allclose(area(vertices, triangles), [0, 0, 4])


def test_a_hollow_polygon_is_covered_once_or_refused(tmp_path):
    head = VERTICES.replace("4", "5") + "element face 1\nproperty list uchar int vertex_indices\n"
    dart = "0 0 0\n4 0 0\n1 1 0\n0 4 0\n0 2 0\n"  # hollow at its third corner
    vertices, triangles, _ = read(tmp_path, head, dart + "5 0 1 2 3 4\n")
    corners = np.asarray(vertices)[np.asarray(triangles)]
    each = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    assert (each >= 0).all() and each.sum() / 2 == pytest.approx(4.0)
    head = head.replace("5", "8").replace("vertex_indices", "vertex_index")
    comb = "0 0 0\n6 0 0\n6 4 0\n4 4 0\n4 1 0\n2 1 0\n2 4 0\n0 4 0\n"  # a U
    with pytest.raises(InputError, match="face 0 is a hollow polygon of 8 corners"):
        read(tmp_path, head, comb + "8 0 1 2 3 4 5 6 7\n")


FACE = VERTICES + "element face 1\nproperty list uchar int vertex_indices\n"


@pytest.mark.parametrize(
    "header, body, told",
    [
        (FACE, SQUARE + "3 0 1 9\n", "vertex that is not there"),
        (FACE, SQUARE + "3 0 1 -1\n", "line 14, face 0: a vertex index"),
        (FACE, SQUARE + "3 0 1 1.5\n", "line 14, face 0: a vertex index"),
        (FACE, SQUARE + "2 0 1\n", "none with three corners"),
        (FACE, SQUARE + "0\n", "none with three corners"),
        (FACE, SQUARE + "3 0 1 2\n3 0 2 3\n", "goes on"),
        (
            FACE,
            SQUARE.replace("2 2 0", "2 2 0 9") + "3 0 1 2\n",
            "line 12, vertex 2: it has not as many",
        ),
        (
            FACE,
            SQUARE.replace("2 2 0", "2 2") + "3 0 1 2\n",
            "line 12, vertex 2: it has not as many",
        ),
        (FACE, SQUARE.replace("2 2 0", "2 two 0") + "3 0 1 2\n", "line 12, vertex 2: 'two' is no"),
        (FACE.replace("vertex_indices", "indices"), SQUARE + "3 0 1 2\n", "element 'face' has not"),
        (VERTICES + "element face 1\n", SQUARE + "\n", "element 'face' has not"),
        (VERTICES + "element face 1\nproperty int vertex_indices\n", SQUARE + "3\n", "has not one"),
        (FACE.replace("face", "trifans"), SQUARE + "4 0 1 2 3\n", "'trifans' names vertices"),
        (
            FACE + "element face 1\nproperty list uchar int vertex_index\n",
            SQUARE + "3 0 1 2\n3 0 1 2\n",
            "twice",
        ),
        (
            VERTICES + "element edge 1\nproperty int vertex1\nproperty int vertex2\n",
            SQUARE + "0 1\n",
            "none with three corners",
        ),
        (FACE.replace("float y", "float x"), SQUARE + "3 0 1 2\n", "no x, y and z"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path, header, body, told):
    with pytest.raises(InputError, match=told) as caught:
        read(tmp_path, header, body)
    assert "part.ply" in str(caught.value)


@pytest.mark.parametrize(
    "more, rows",
    [
        ("", ""),
        ("element face 0\nproperty list uchar int vertex_indices\n", ""),
        ("element range_grid 2\nproperty list uchar int vertex_indices\n", "1 0\n0\n"),
        ("element camera 1\nproperty float view\n", "1\n"),
    ],
)
def test_a_cloud_stays_a_cloud(tmp_path, more, rows):
    vertices, triangles, _ = read(tmp_path, VERTICES + more, SQUARE + rows)
    assert len(vertices) == 4 and len(triangles) == 0


def cube(turned=False, shift=0.0, size=1.0):
    """(vertices (8, 3), triangles (12, 3)) of a cube from 0 to ``size``."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return corners * size + shift, faces[:, ::-1] if turned else faces


def volume(vertices, triangles):
    a, b, c = (np.asarray(vertices, dtype=float)[np.asarray(triangles)[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def written(tmp_path, *pieces):
    path, count, rows, faces = tmp_path / "mesh.off", 0, [], []
    for vertices, triangles in pieces:
        rows += [" ".join(map(repr, map(float, v))) for v in vertices]
        faces += ["3 " + " ".join(str(count + i) for i in t) for t in triangles]
        count += len(vertices)
    path.write_text("\n".join(["OFF", f"{count} {len(faces)} 0", *rows, *faces]) + "\n")
    return path


@pytest.mark.parametrize(
    "pieces, right, turned",
    [
        ([cube()], 1.0, 0),
        ([cube(True)], 1.0, 1),
        ([cube(True), cube(shift=5.0)], 2.0, 1),  # one of two bodies
        ([cube(size=10.0), cube(True, 4.0)], 999.0, 0),  # a cavity
        ([cube(True, size=10.0), cube(False, 4.0)], 999.0, 2),  # the same, inside out
    ],
)
def test_a_closed_mesh_is_turned_outward(tmp_path, pieces, right, turned):
    told = {}
    mesh = core.read_mesh(str(written(tmp_path, *pieces)), report=told)
    assert volume(mesh.vertices, mesh.triangles) == pytest.approx(right, rel=1e-5)
    facts = [fact for fact in told["warnings"] if fact.code == "mesh.turned"]
    assert [fact.arguments["count"] for fact in facts] == ([turned] if turned else [])


def test_an_open_mesh_keeps_its_sense(tmp_path):
    vertices, triangles = cube(True)
    mesh = core.read_mesh(str(written(tmp_path, (vertices, triangles[2:]))))
    assert volume(mesh.vertices, mesh.triangles) < 0


def test_a_size_that_no_part_has_is_told(tmp_path):
    told = {}
    core.read_mesh(str(written(tmp_path, cube(size=0.02))), report=told)
    assert [fact.code for fact in told["warnings"]] == ["mesh.size"]
