"""The spacing of samples that is chosen, and what is told of one that is too coarse."""

import json
import math
from pathlib import Path

import pytest
import Part

from beltgrinding.engine import InputError, core
from beltgrinding.job import load, spacing, workpiece
from beltgrinding.simulation import run as runs
from beltgrinding.simulation.convergence import scaled


@pytest.fixture
def parts(freecad, tmp_path):
    """BREP files: a block of 60 x 40 x 20 mm, rods of 5 and 0.05 mm, a sheet with a strip."""
    freecad.call(make_parts, tmp_path)
    return tmp_path


def job_of(path, faces, **sampling):
    return load.validate(
        {
            "schema": 1,
            "design": {"file": str(path), "faces": faces},
            "sampling": sampling,
            "stock": {"allowance_mm": 0.2},
            "programs": [{"poses": []}],
        }
    )


def settled(job):
    told = []
    found, chosen = spacing.settled(job, workpiece.read_design(job["design"]), told)
    return found["sampling"]["spacing_mm"], chosen, [fact.code for fact in told]


def test_a_plain_part_gets_the_usual_spacing(parts):
    assert settled(job_of(parts / "block.brep", [6])) == (0.5, True, [])
    assert settled(job_of(parts / "block.brep", [6], spacing_mm=0.7)) == (0.7, False, [])


def test_a_thin_rod_gets_enough_samples_and_a_coarse_spacing_is_told(parts):
    chosen, was, told = settled(job_of(parts / "rod.brep", [1]))
    assert was and chosen <= math.sqrt(8 * 2.5 * 0.1 * 0.1) and chosen < 0.4
    assert told in ([], ["job.few_cells_in_contact"])
    _, was, told = settled(job_of(parts / "rod.brep", [1], spacing_mm=3.0))
    assert not was
    assert {"job.few_samples_in_contact", "job.coarse_chords"} <= set(told)


def test_a_narrow_face_is_named(parts):
    shape = core.Shape.read(str(parts / "strip.brep"))
    strip = next(i for i in range(6) if shape.face_area(i) == pytest.approx(48.0)) + 1
    job = job_of(parts / "strip.brep", [strip], spacing_mm=0.5)
    told = []
    spacing.settled(job, shape, told)
    assert [f.arguments["face"] for f in told if f.code == "job.few_samples_on_face"] == [strip]
    assert settled(job_of(parts / "strip.brep", [strip]))[0] <= 0.2


def test_a_part_in_another_unit_is_told_of(parts):
    told = settled(job_of(parts / "wire.brep", [1]))[2]
    assert "job.within_contact" in told
    job = job_of(parts / "block.brep", [6])
    job["design"]["unit_mm"] = 1000.0
    with pytest.raises(InputError, match=r"6e\+04 mm large.*design.unit_mm"):
        settled(job)


def test_a_raster_tells_of_another_unit_before_it_computes(parts):
    from beltgrinding.raster.raster_path import raster

    job = job_of(parts / "block.brep", [6])
    job["design"]["unit_mm"] = 1000.0
    with pytest.raises(InputError, match=r"6e\+04 mm large.*design.unit_mm") as error:
        raster(job, {"along": "u"})
    assert error.value.code == "raster.too_large"
    found = raster(job_of(parts / "wire.brep", [1]), {"along": "v", "min_length_mm": 0.0})
    assert "job.within_contact" in [fact.code for fact in found["warnings"]]


def test_the_principal_curvatures_are_those_of_the_surface(parts):
    shape = core.Shape.read(str(parts / "rod.brep"))
    side = max(range(3), key=shape.face_area)
    field, _ = core.sample_faces(shape, [side], 0.3)
    found, areas = spacing.curvatures(field)
    mean = (found * areas[:, None]).sum(axis=0) / areas.sum()
    assert mean == pytest.approx([0.0, 0.4], abs=2e-3)


def test_the_chosen_spacing_is_that_of_the_run_and_its_convergence(parts, capsys):
    from beltgrinding.simulation.convergence import converge

    job = job_of(parts / "block.brep", [6])
    rows = [(x, 20.0, 20.2) for x in (20.0, 26.0)]
    job["programs"] = [
        {
            "poses": [
                {"x_mm": x, "y_mm": y, "z_mm": z, "qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}
                for x, y, z in rows
            ]
        }
    ]
    job = load.validate(job)
    result = runs.run(job)
    assert result.field.spacing == result.summary["spacing_mm"] == 0.5
    assert result.summary["spacing_chosen"] and result.job["sampling"]["spacing_mm"] == 0.5
    levels = converge(job).convergence["levels"]
    assert [level["spacing_mm"] for level in levels.values()] == [1.0, 0.5, 0.25]
    with_it = {**job, "sampling": {**job["sampling"], "spacing_mm": 0.5}}
    assert json.dumps(runs.run(with_it).summary["deviation_mm"]) == json.dumps(
        result.summary["deviation_mm"]
    )


def test_a_precision_takes_the_place_of_a_finer_spacing_on_curved_faces(parts):
    plain = job_of(parts / "rod.brep", [], spacing_mm=1.0)
    job = job_of(parts / "rod.brep", [], spacing_mm=1.0, precision_mm=0.002)
    assert "job.coarse_chords" in settled(plain)[2] and "job.coarse_chords" not in settled(job)[2]
    shape = workpiece.read_design(job["design"])
    field = workpiece.make_field(job, shape, [], None)
    corners = field.triangles
    for a, b in ((0, 1), (1, 2), (2, 0)):
        way = field.points[corners[:, b]] - field.points[corners[:, a]]
        turn = field.normals[corners[:, b]] - field.normals[corners[:, a]]
        assert (way * turn).sum(axis=1).max() / 8 < 1.1 * 0.002
    exact = sum(shape.face_area(face) for face in range(shape.face_count))
    assert field.areas.sum() == pytest.approx(exact, rel=1e-5)
    assert field.spacing == 1.0
    finer = scaled(job, "fine")["sampling"]
    assert (finer["spacing_mm"], finer["precision_mm"]) == (0.5, 0.0005)


def test_an_edge_that_a_belts_cells_do_not_resolve_is_told(parts):
    path = parts / "rod.brep"
    shape = workpiece.read_design(job_of(path, [])["design"])
    for cell, codes in ((3.5, ["job.few_cells_on_edge"]), (1.0, [])):
        given = job_of(path, [], spacing_mm=0.5, precision_mm=0.002)
        given["belt_machine"]["contact_spacing_mm"] = cell
        given["belt_machine"]["kind"] = "free_belt"
        told = []
        workpiece.make_field(given, shape, told, None)
        assert [fact.code for fact in told] == codes
        given["belt_machine"]["kind"] = "contact_wheel"  # whose cells follow the edge
        assert spacing.edge_doubts(given, workpiece.make_field(given, shape, [], None)) == []


def test_what_is_too_coarse_is_told_before_anything_is_ground(parts):
    job = job_of(parts / "block.brep", [6])
    job["programs"] = [
        {
            "poses": [
                {"x_mm": x, "y_mm": 20.0, "z_mm": 20.2, "qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}
                for x in (20.0, 26.0)
            ]
        }
    ]
    job["sampling"] = {"spacing_mm": 6.0}
    recording, early = core.Recording(), []

    def listen(warnings):
        early.append((warnings, recording.duration))

    result = runs.run(load.validate(job), recording=recording, early=listen)
    ((told, seconds),) = early
    assert "job.few_samples_in_contact" in [fact.code for fact in told] and seconds == 0
    assert result.summary["warnings"][: len(told)] == told and recording.duration > 0


@pytest.mark.parametrize("radius, width", [(20.0, 80.0), (60.0, 3.0), (100.0, 25.0)])
def test_no_contact_on_a_plane_is_larger_than_is_thought(parts, radius, width):
    found = []
    for force in (1.0, 100.0, 3000.0):
        job = job_of(parts / "block.brep", [6])
        job["belt_machine"]["wheel"].update(radius_mm=radius, width_mm=width)
        job["belt_machine"].update(force_N=force, contact_spacing_mm=0.2 * width)
        contact = spacing._contact(job, 0.0)
        if contact is not None:
            found.append(max(contact) / max(2.0 * radius, width))
    assert found and 0.05 < max(found) <= spacing.MOST_ON_PLANE, found


def make_parts(tmp_path):
    folder = Path(str(tmp_path))
    Part.makeBox(60, 40, 20).exportBrep(str(folder / "block.brep"))
    Part.makeCylinder(2.5, 60).exportBrep(str(folder / "rod.brep"))
    Part.makeCylinder(0.025, 0.6).exportBrep(str(folder / "wire.brep"))
    Part.makeBox(60, 0.8, 20).exportBrep(str(folder / "strip.brep"))
