"""Which programs of a job a run takes, and which a result was made with."""

import json
from pathlib import Path

import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding.objects import ground_by, job_inputs, plan, study_keys

pytestmark = pytest.mark.freecad


def two_programs():
    """A job on a block with the programs "one" and "two", each a pass; and these."""
    doc = FreeCAD.newDocument("two")
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
    beltgrinding.make_stock(job, Allowance="0.2 mm")
    beltgrinding.make_belt_machine(job, WheelRadius="60 mm", WheelWidth="15 mm", Force="30 N")
    paths = []
    for name, y in (("one", 12), ("two", 28)):
        rows = [f"{x},{y},20.2,0,1,0,0,30" for x in range(10, 51, 10)]
        head = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"
        Path(f"{name}.csv").write_text("\n".join([head, *rows]) + "\n")
        paths.append(beltgrinding.import_program(job, f"{name}.csv"))
    doc.recompute()
    return job, *paths


def names(paths):
    return [path.Label for path in paths]


def test_what_is_left_out_is_in_no_run_plan_or_study(tmp_path):
    job, one, two = two_programs()
    assert one.Active and names(ground_by.required(job)) == ["one", "two"]
    both = job_inputs.fingerprint(job)
    one.Active = False
    assert job_inputs.fingerprint(job) != both
    data = job_inputs.to_data(job, str(tmp_path))
    assert [program["name"] for program in data["programs"]] == ["two"]
    assert names(plan.paths_of(job)) == ["two"] and len(job_inputs.tool_paths(job)) == 1
    assert len(study_keys.base(job)["programs"]) == 1
    path = beltgrinding.export_job(job, tmp_path / "job.json")
    assert [program["name"] for program in json.loads(path.read_text())["programs"]] == ["two"]
    one.Active = True
    assert job_inputs.fingerprint(job) == both
    one.Active = two.Active = False
    with pytest.raises(beltgrinding.InputError, match="all its robot programs are left out"):
        beltgrinding.simulate(job)
    job.removeObjects([one, two])
    with pytest.raises(beltgrinding.InputError, match="has no robot program; import one"):
        beltgrinding.simulate(job)


def test_a_result_knows_its_programs():
    job, one, two = two_programs()
    simulation = beltgrinding.simulate(job)
    made_with = simulation.Programs
    assert list(made_with) == ["one", "two"]
    one.Active = False
    job.Document.recompute()
    assert simulation.OutOfDate
    assert ground_by.of_result(job, made_with) == [one, two]
    one.Active = True
    one.Label = "renamed"
    assert ground_by.of_result(job, made_with) == [one, two]
    assert ground_by.of_result(job, []) == [one, two]  # older results name none
    # Which one it was cannot be known with another name and others active.
    one.Active = False
    with pytest.raises(beltgrinding.InputError, match="made with one, which is not there"):
        ground_by.of_result(job, made_with)
    one.Label, one.Active = "one", True
    job.Document.removeObject(one.Name)
    with pytest.raises(beltgrinding.InputError, match="simulate again"):
        ground_by.of_result(job, made_with)


def test_an_older_documents_programs_are_active():
    job, one, _ = two_programs()
    one.removeProperty("Active")
    file = str(Path("older.FCStd").absolute())
    job.Document.saveAs(file)
    FreeCAD.closeDocument(job.Document.Name)
    doc = FreeCAD.openDocument(file)
    assert all(path.Active for path in (doc.RobotPath, doc.RobotPath001))
    assert len(ground_by.active(doc.BeltGrindingJob)) == 2
