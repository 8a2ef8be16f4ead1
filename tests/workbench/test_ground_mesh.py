"""The closed mesh of the ground part: files, and the command line."""

import json
import zipfile

import numpy as np
import pytest

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.inspection import closed_mesh
from test_job import cli, plate_job

SIZE = (60.0, 40.0, 12.0)


def block():
    """A faceted block under the plate of test_job; its top is a face of its own."""
    corners = np.array([[x, y, z] for z in (-12, 0) for y in (0, 40) for x in (0, 60)], np.float32)
    quads = [(4, 5, 7, 6), (0, 2, 3, 1), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return core.shape_from_mesh(core.TriangleMesh(corners, np.array(triangles, np.uint32)))


def block_job():
    """The job of test_job on the block's top."""
    shape = block()
    tops = []
    for face in range(shape.face_count):
        field, _ = core.sample_faces(shape, [face], 5.0)
        if field.normals[0][2] > 0.9:
            tops.append(face + 1)
    job = plate_job()
    job["design"] = {"brep": shape.write_brep(), "faces": tops}
    return job


@pytest.fixture(scope="module")
def result():
    return beltgrinding.run(block_job())


@pytest.fixture(scope="module")
def mesh(result):
    return beltgrinding.ground_mesh(result)


def test_it_is_closed_and_holds_what_was_left(result, mesh):
    figures = closed_mesh.summary(mesh)
    assert figures["closed"] and figures["euler_characteristic"] == 2
    assert figures["turned_triangles"] == 0 and figures["warnings"] == []
    left = figures["volume_mm3"] - figures["design_volume_mm3"]
    summary = result.summary
    assert figures["design_volume_mm3"] == pytest.approx(np.prod(SIZE), rel=1e-6)
    expected = summary["stock_volume_mm3"] - summary["removed_volume_mm3"]
    assert left == pytest.approx(expected, rel=0.002)


def test_vertices_stand_on_the_design_at_their_deviation(result, mesh):
    ground = mesh.standing == closed_mesh.STANDING.index("ground")
    np.testing.assert_allclose(mesh.vertices[ground, 2], mesh.deviation[ground], atol=1e-6)
    border = mesh.standing == closed_mesh.STANDING.index("border")
    np.testing.assert_allclose(mesh.vertices[border, 2], mesh.deviation[border], atol=1e-6)
    assert border.any() and np.isnan(mesh.deviation[~(ground | border)]).all()
    # Between the samples the height is linear: no vertex is above the highest, below the lowest.
    assert mesh.deviation[ground].max() <= result.field.height.max() + 1e-6
    assert mesh.deviation[ground].min() >= result.field.height.min() - 1e-6
    design = beltgrinding.ground_mesh(result, ground=False)
    assert design.vertices[:, 2].max() == 0.0
    np.testing.assert_array_equal(design.triangles, mesh.triangles)


@pytest.mark.parametrize("suffix", closed_mesh.SUFFIXES)
def test_files_hold_the_same_mesh(result, mesh, tmp_path, suffix):
    path = tmp_path / f"part{suffix}"
    beltgrinding.ground_mesh(result, path)
    read = core.read_mesh(str(path))
    assert len(read.triangles) == len(mesh.triangles)
    corners = np.asarray(read.vertices)[np.asarray(read.triangles)]
    mine = mesh.vertices[mesh.triangles]
    np.testing.assert_allclose(corners, mine, atol=5e-6)  # single precision of 60 mm
    assert not list(tmp_path.glob("*.part"))


def test_colours_tell_ground_faces_from_others(result, mesh, tmp_path):
    beltgrinding.ground_mesh(result, tmp_path / "part.ply")
    head, data = (tmp_path / "part.ply").read_bytes().split(b"end_header\n", 1)
    assert b"property float deviation" in head
    row = np.dtype([("p", "<f4", 3), ("rgba", "u1", 4), ("deviation", "<f4")])
    rows = np.frombuffer(data, row, len(mesh.vertices))
    np.testing.assert_array_equal(rows["deviation"], mesh.deviation)
    other = np.isnan(rows["deviation"])
    assert len(np.unique(rows["rgba"][other], axis=0)) == 1
    assert len(np.unique(rows["rgba"][~other], axis=0)) > 10


def test_a_3mf_is_a_package_in_millimetres(result, tmp_path):
    beltgrinding.ground_mesh(result, tmp_path / "part.3mf")
    with zipfile.ZipFile(tmp_path / "part.3mf") as package:
        assert package.testzip() is None
        parts = {"[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"}
        assert set(package.namelist()) == parts
        model = package.read("3D/3dmodel.model")
    assert b'unit="millimeter"' in model and b"<m:colorgroup" in model


def test_the_command_line_writes_and_tells(result, tmp_path):
    result.write(tmp_path / "out")
    done = cli("mesh", "out", "-o", "part.stl", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["closed"] and told["volume_mm3"] > told["design_volume_mm3"]
    assert (tmp_path / "part.stl").stat().st_size == 84 + 50 * told["triangles"]
    design = json.loads(cli("mesh", "out", "-o", "d.stl", "--design", cwd=tmp_path).stdout)
    assert design["volume_mm3"] == told["design_volume_mm3"]
    bad = cli("mesh", "out", "-o", "part.step", cwd=tmp_path)
    assert bad.returncode == 2 and ".3mf" in bad.stderr and len(bad.stderr.splitlines()) == 1


def test_a_field_of_another_shape_is_refused(result):
    corners = np.array([[0, 0, 900], [9, 0, 900], [0, 9, 900]], np.float32)
    far = core.shape_from_mesh(core.TriangleMesh(corners, np.array([[0, 1, 2]], np.uint32)))
    with pytest.raises(InputError, match="not of this shape"):
        core.ground_mesh(far, result.field)


def test_a_damaged_3mf_is_refused_by_name(result, tmp_path):
    beltgrinding.ground_mesh(result, tmp_path / "part.3mf")
    whole = (tmp_path / "part.3mf").read_bytes()
    with zipfile.ZipFile(tmp_path / "part.3mf") as package:
        parts = {name: package.read(name) for name in package.namelist()}
    damaged = {"half": whole[: len(whole) // 2], "empty": b"", "text": b"no package"}
    for name in parts:
        path = tmp_path / "less.3mf"
        with zipfile.ZipFile(path, "w") as package:
            for other in parts:
                if other != name:
                    package.writestr(other, parts[other])
        damaged[f"without {name}"] = path.read_bytes()
    changed = {**parts, "_rels/.rels": parts["_rels/.rels"].replace(b"3dmodel.model", b"gone")}
    with zipfile.ZipFile(tmp_path / "less.3mf", "w") as package:
        for name, data in changed.items():
            package.writestr(name, data)
    damaged["relation to nothing"] = (tmp_path / "less.3mf").read_bytes()
    refused = 0
    for what, data in damaged.items():
        path = tmp_path / "damaged.3mf"
        path.write_bytes(data)
        try:
            core.read_mesh(str(path))
        except InputError as error:
            refused += 1
            assert "damaged.3mf" in str(error) and "\n" not in str(error), what
    assert refused >= len(damaged) - 1  # it may be read without its list of content types
