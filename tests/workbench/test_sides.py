"""Loose faces are ground from outside, whichever way the file has them."""

import numpy as np
import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding.engine import InputError, core
from beltgrinding.job import workpiece
from beltgrinding.objects import sides


# A block of 60 x 40 x 20 mm in six faces that share no edge, Face2 and Face6 (its top) inside out.
def loose_block(doc):
    faces = [face.copy() for face in Part.makeBox(60, 40, 20).Faces]
    faces = [face.reversed() if i in (1, 5) else face for i, face in enumerate(faces)]
    part = doc.addObject("Part::Feature", "Loose")
    part.Shape = Part.Compound(faces)
    return part


def job_of(part):
    job = beltgrinding.make_job(part, ["Face6"], Spacing="2 mm")
    beltgrinding.make_stock(job, Allowance="0.2 mm")
    beltgrinding.make_belt_machine(job, WheelRadius=60, WheelWidth="15 mm", Force="30 N")
    beltgrinding.make_raster(job)
    return job


@pytest.fixture
def brep(freecad, tmp_path):
    """The text of the loose block."""
    path = tmp_path / "loose.brep"
    freecad.call(make_brep, path)
    return path


def mean_normal(design):
    shape = workpiece.read_design(design)
    field, _ = core.sample_faces(shape, [design["faces"][0] - 1], 4.0)
    return np.asarray(field.normals).mean(axis=0)


def test_a_job_grinds_them_from_outside_and_flips_as_it_is_told(brep):
    design = {"file": str(brep), "faces": [6], "unit_mm": 1.0}
    assert mean_normal(design)[2] == pytest.approx(1.0)
    assert mean_normal({**design, "flip_faces": [6]})[2] == pytest.approx(-1.0)
    assert mean_normal({**design, "flip_normals": True})[2] == pytest.approx(-1.0)
    assert mean_normal({**design, "flip_normals": True, "flip_faces": [6]})[2] == pytest.approx(1.0)
    told = workpiece.read_design(design).warnings()
    assert [fact.code for fact in told] == ["brep.turned"] and "faces 2, 6 are turned" in told[0]
    with pytest.raises(InputError, match=r"design.flip_faces: .* has no face 7"):
        workpiece.read_design({**design, "flip_faces": [7]})


def test_a_unit_is_applied_to_every_kind_of_file(brep):
    design = {"file": str(brep), "faces": [6], "unit_mm": 25.4}
    low, high = workpiece.read_design(design).extents()
    assert np.asarray(high) - low == pytest.approx([60 * 25.4, 40 * 25.4, 20 * 25.4], rel=1e-5)
    text = {"brep": brep.read_text(), "faces": [6], "unit_mm": 0.1}
    assert workpiece.read_design(text).face_area(5) == pytest.approx(24.0)


@pytest.mark.slow
@pytest.mark.freecad
def test_in_a_document_they_are_flipped_per_face():
    doc = FreeCAD.newDocument("sides")
    part = loose_block(doc)
    job = job_of(part)
    doc.recompute()

    def side():
        doc.recompute()
        return (
            doc.RasterPath.Path.Commands[-1].Placement.Base.z > 20
        )  # it retracts away from the face

    assert sides.loose_faces(part.Shape) == [1, 2, 3, 4, 5, 6]
    assert [fact.code for fact in sides.notes(job)] == ["brep.turned"]
    assert side()
    digest = doc.RasterPath.Inputs
    job.FlipFaces = [(part, ("Face6",))]
    assert not side() and doc.RasterPath.Inputs != digest
    assert [fact.code for fact in sides.notes(job)] == ["brep.turned", "brep.flipped_inwards"]
    job.FlipFaces = []
    assert side() and doc.RasterPath.Inputs == digest
    job.FlipNormals = True
    assert not side()


def make_brep(path):
    loose_block(FreeCAD.newDocument("loose")).Shape.exportBrep(str(path))
