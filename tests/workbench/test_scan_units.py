"""Scans and meshes in another unit, or inside out: refused by the unit's name, or turned with a word; pieces of a part, and
tables under it, stay what they are."""

import json
import zipfile

import numpy as np
import pytest
import Part
from test_ground_mesh import block_job
from test_job import cli

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs, sizes, workpiece
from beltgrinding.scan import comparison as scan, file as scan_file, stock as scan_stock

pytest.importorskip("beltgrinding_scan", reason="beltgrinding_scan is not built (no nanoflann)")


@pytest.fixture(scope="module")
def result():
    return beltgrinding.run(block_job())


@pytest.fixture(scope="module")
def ground(result):
    """(vertices, triangles) of the part as ground."""
    mesh = beltgrinding.ground_mesh(result)
    return np.array(mesh.vertices, dtype=float), np.array(mesh.triangles)


def write(path, vertices, triangles=()):
    """A text PLY."""
    rows = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    rows += [f"property double {axis}" for axis in "xyz"]
    rows += [
        f"element face {len(triangles)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    rows += [" ".join(f"{value:.9g}" for value in vertex) for vertex in vertices]
    rows += [f"3 {a} {b} {c}" for a, b, c in triangles]
    path.write_text("\n".join(rows) + "\n")
    return path


def spread(vertices, triangles, count=60_000):
    """(count, 3) points evenly on the surface."""
    return scan_file.Scan(vertices, triangles).spread(count)[0]


def top(vertices, triangles):
    """The triangles that look up: an open scan from above."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    return triangles[normal[:, 2] > 0.5 * np.linalg.norm(normal, axis=1)]


@pytest.mark.slow
@pytest.mark.parametrize("unit", [0.001, 10.0, 25.4, 304.8, 1000.0])
@pytest.mark.parametrize("kind", ["mesh", "cloud"])
def test_a_scan_in_another_unit_is_refused_by_its_name(result, ground, tmp_path, unit, kind):
    vertices, triangles = ground
    if kind == "cloud":
        vertices, triangles = spread(vertices, triangles), ()
    path = write(tmp_path / "scan.ply", vertices / unit, triangles)
    for start in (None, "principal"):
        with pytest.raises(InputError, match="it would fit in") as caught:
            scan.compare(result, path, start=start)
        assert caught.value.arguments["unit"] == unit
    figures = scan.compare(result, path, unit)
    assert figures["difference_mm"]["rms"] < 0.02 and figures["warnings"] == []


def test_millimetres_read_as_inches_are_refused(result, ground, tmp_path):
    path = write(tmp_path / "scan.ply", *ground)
    with pytest.raises(InputError, match="fit in millimetres"):
        scan.compare(result, path, 25.4)


def test_a_turned_scan_far_away_in_inches_is_refused(result, ground, tmp_path):
    vertices, triangles = ground
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    path = write(tmp_path / "scan.ply", vertices @ turn.T / 25.4 + [300, 20, -7], triangles)
    with pytest.raises(InputError, match="fit in inches"):
        scan.compare(result, path, start="principal")


def test_half_a_part_in_inches_is_refused(result, ground, tmp_path):
    vertices, triangles = ground
    half = triangles[(vertices[triangles][:, :, 0] < 30.0).all(axis=1)]
    path = write(tmp_path / "scan.ply", vertices / 25.4, half)
    with pytest.raises(InputError, match="fit in inches"):
        scan.compare(result, path)


@pytest.mark.parametrize("share", [0.75, 0.5, 0.3])
def test_a_piece_of_the_part_is_no_error(result, ground, tmp_path, share):
    points = spread(*ground)
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    piece = points[(points <= low + share * size + [0, 0, 99]).all(axis=1)]
    figures = scan.compare(result, write(tmp_path / "scan.ply", piece))
    assert not [one for one in figures["warnings"] if "unit" in str(one)]
    assert figures["difference_mm"]["rms"] < 0.05  # hardly any points at the edges


def test_the_ground_side_alone_in_inches_is_refused(result, ground, tmp_path):
    vertices, triangles = ground
    path = write(tmp_path / "scan.ply", vertices / 25.4, top(vertices, triangles))
    with pytest.raises(InputError, match="fit in inches"):
        scan.compare(result, path)


def test_pairs_tell_the_unit(result, ground, tmp_path):
    path = write(tmp_path / "scan.ply", ground[0] / 25.4, ground[1])
    places = np.array([[0, 0, 0], [60, 0, 0], [0, 40, -12.0]])
    pairs = np.stack([places / 25.4, places], axis=1)
    with pytest.raises(InputError, match="25.4"):
        scan.compare(result, path, pairs=pairs)
    assert scan.compare(result, path, 25.4, pairs=pairs)["pairs_rms_mm"] < 1e-9


@pytest.mark.slow
def test_a_closed_scan_inside_out_is_turned_with_a_word(result, ground, tmp_path):
    vertices, triangles = ground
    right = scan.compare(result, write(tmp_path / "right.ply", vertices, triangles))
    for name in ("turned.ply", "turned.stl"):
        path = tmp_path / name
        if name.endswith(".ply"):
            write(path, vertices, triangles[:, ::-1])
        else:
            core_mesh(path, vertices, triangles[:, ::-1])
        figures = scan.compare(result, path)
        assert [one.code for one in figures["warnings"]] == ["mesh.turned"]
        assert figures["difference_mm"]["rms"] == pytest.approx(
            right["difference_mm"]["rms"], abs=1e-4
        )
        assert figures["measured_area_share"] == pytest.approx(right["measured_area_share"])


def core_mesh(path, vertices, triangles):
    """A text STL."""
    rows = ["solid part"]
    for corners in vertices[triangles]:
        rows += ["facet normal 0 0 0", "outer loop"]
        rows += ["vertex " + " ".join(f"{value:.9g}" for value in corner) for corner in corners]
        rows += ["endloop", "endfacet"]
    path.write_text("\n".join([*rows, "endsolid part"]) + "\n")


def test_a_design_inside_out_is_turned_with_a_word(tmp_path):
    """A box: to find the faces of the ground mesh takes most of a minute."""
    corners = np.array([(x, y, z) for z in (0, 12) for y in (0, 20) for x in (0, 30)], float)
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    vertices, triangles = corners, np.array(
        [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    )
    for name, seen, told in (
        ("right", triangles, []),
        ("turned", triangles[:, ::-1], ["mesh.turned"]),
    ):
        path = tmp_path / f"{name}.stl"
        core_mesh(path, vertices, seen)
        design = {"file": str(path), "unit_mm": 1.0}
        for _ in range(2):  # read, and kept
            shape = workpiece.read_design(design)
            codes = [one.code for one in workpiece.shape_warnings(shape)]
            assert [code for code in codes if code.startswith("mesh.")] == told


def test_an_open_scan_inside_out_is_turned_with_a_word(result, ground, tmp_path):
    vertices, triangles = ground
    seen = triangles[vertices[triangles][:, :, 2].max(axis=1) > -11.9]  # all but the bottom
    right = scan.compare(result, write(tmp_path / "right.ply", vertices, seen))
    assert not right["alignment"]["turned"]
    figures = scan.compare(result, write(tmp_path / "turned.ply", vertices, seen[:, ::-1]))
    assert figures["alignment"]["turned"]
    told = [one.code for one in figures["warnings"]]
    assert sorted(told) == sorted(["scan.turned", *(one.code for one in right["warnings"])])
    assert figures["difference_mm"]["rms"] == pytest.approx(right["difference_mm"]["rms"], abs=2e-3)
    with pytest.raises(InputError, match="inside out"):
        scan.compare(result, tmp_path / "turned.ply", aligned=True)


def test_stock_by_a_mesh(ground, tmp_path):
    vertices, triangles = ground
    job = block_job()
    raw = vertices + 0.4 * np.array([0, 0, 1]) * (vertices[:, 2:] > -6)

    def stock(name, points, faces, unit=1.0):
        path = write(tmp_path / name, points, faces)
        return jobs.validate({**job, "stock": {"kind": "mesh", "file": str(path), "unit_mm": unit}})

    right = beltgrinding.run(stock("right.ply", raw, triangles)).summary
    for name, faces in (("turned.ply", triangles[:, ::-1]),):
        told = beltgrinding.run(stock(name, raw, faces)).summary
        assert told["stock_volume_mm3"] == pytest.approx(right["stock_volume_mm3"], rel=1e-6)
        assert any("inside out" in str(one) for one in told["warnings"])
    with pytest.raises(InputError, match="stock.unit_mm: .*fit in inches.* 25.4 mm"):
        beltgrinding.run(stock("inch.ply", raw / 25.4, triangles))
    with pytest.raises(InputError, match="stock.unit_mm: .*fit in millimetres"):
        beltgrinding.run(stock("twice.ply", raw, triangles, 25.4))
    with pytest.raises(InputError, match="inside out"):
        beltgrinding.run(stock("open.ply", raw, top(raw, triangles)[:, ::-1]))


def three_mf(path, vertices, triangles, unit):
    """A 3MF by hand."""
    points = "".join('<vertex x="%.9g" y="%.9g" z="%.9g"/>' % tuple(v) for v in vertices)
    faces = "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % tuple(t) for t in triangles)
    schema = "http://schemas.microsoft.com/3dmanufacturing"
    model = (
        f'<?xml version="1.0" encoding="UTF-8"?><model unit="{unit}" xml:lang="en-US" xmlns="{schema}/core/2015/02">'
        f'<resources><object id="1" type="model"><mesh><vertices>{points}</vertices><triangles>{faces}</triangles>'
        '</mesh></object></resources><build><item objectid="1"/></build></model>'
    )
    package = "http://schemas.openxmlformats.org/package/2006"
    types = (
        f'<?xml version="1.0" encoding="UTF-8"?><Types xmlns="{package}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
    )
    rels = (
        f'<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="{package}/relationships">'
        f'<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="{schema}/2013/01/3dmodel"/></Relationships>'
    )
    with zipfile.ZipFile(path, "w") as made:
        made.writestr("[Content_Types].xml", types)
        made.writestr("_rels/.rels", rels)
        made.writestr("3D/3dmodel.model", model)
    return path


@pytest.mark.parametrize(
    "unit, mm",
    [("millimeter", 1.0), ("inch", 25.4), ("meter", 1000.0), ("micron", 0.001), ("foot", 304.8)],
)
def test_a_3mf_tells_its_unit(ground, tmp_path, unit, mm):
    vertices, triangles = ground
    path = three_mf(tmp_path / "part.3mf", vertices / mm, triangles, unit)
    for given in (1.0, mm):
        told = {}
        mesh = core.read_mesh(str(path), given, report=told)
        assert told["unit_mm"] == mm
        np.testing.assert_allclose(
            np.ptp(mesh.vertices, axis=0), np.ptp(vertices, axis=0), rtol=1e-5
        )


def test_sizes_are_compared_as_they_are_turned():
    random = np.random.default_rng(1)
    points = random.uniform(-0.5, 0.5, (4000, 3)) * [100, 40, 10]
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
    np.testing.assert_allclose(sizes.spread(points @ turn), sizes.spread(points), rtol=0.05)
    design = sizes.spread(points)
    for unit in (0.001, 10.0, 25.4, 304.8, 1000.0):
        assert sizes.fitting(design / unit, [design], 1.0) == unit
        assert sizes.fitting(design * unit, [design], unit) == 1.0
    for piece in ([0.5, 1, 1], [0.1, 0.3, 1], [0.05, 0.05, 1], [0.04, 0.04, 0.1]):
        assert sizes.fitting(design * piece, [design], 1.0) is None


def test_the_command_line_refuses_and_says_how(result, ground, tmp_path):
    result.write(tmp_path / "out")
    write(tmp_path / "scan.ply", ground[0] / 25.4, ground[1])
    done = cli("scan", "out", "scan.ply", cwd=tmp_path)
    assert done.returncode == 2 and "--unit-mm 25.4" in done.stderr and "inches" in done.stderr
    done = cli("scan", "out", "scan.ply", "--unit-mm", "25.4", cwd=tmp_path)
    assert done.returncode == 0 and json.loads(done.stdout)["unit_mm"] == 25.4


def test_a_casting_in_inches_is_refused(ground, tmp_path):
    path = write(tmp_path / "raw.ply", ground[0] / 25.4, ground[1])
    with pytest.raises(InputError, match="fit in inches"):
        scan_stock.as_stock(jobs.validate(block_job()), path)
    job, _ = scan_stock.as_stock(jobs.validate(block_job()), path, 25.4)
    assert job["stock"]["unit_mm"] == 25.4
    assert scan_file.read(path, 25.4).unit_mm == 25.4


def test_an_iges_in_inches_comes_in_millimetres(freecad, tmp_path):
    path = tmp_path / "box.igs"
    freecad.call(make_box, path)
    text = path.read_bytes()
    assert b",2,2HMM," in text
    path.write_bytes(text.replace(b",2,2HMM,", b",1,2HIN,"))
    np.testing.assert_allclose(
        core.Shape.read(str(path)).extents()[1], [76.2, 50.8, 25.4], rtol=1e-5
    )


def make_box(path):
    Part.makeBox(3, 2, 1).exportIges(str(path))
