"""Studies as document objects, without a window: what a macro does."""

from pathlib import Path

import pytest
import FreeCAD
from test_plan_document import raster_job

import beltgrinding
from beltgrinding import InputError
from beltgrinding.objects import job_inputs, study_keys
from beltgrinding.studies import vary
from support.block import near, write_pass

pytest.importorskip("openturns")


def program_job(doc):
    # Its poses do not follow its settings, as those of a program that was read.
    job = raster_job(doc)
    job.Spacing = "3 mm"
    doc.removeObject("RasterPath")
    rows = [f"{x},20,20.2,0,1,0,0,30" for x in range(10, 51, 5)]
    header = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"
    Path("pass.csv").write_text("\n".join([header, *rows]) + "\n")
    path = beltgrinding.import_program(job, "pass.csv")
    doc.recompute()
    return job, path


def with_study():
    VARY = [
        {"name": "force", "key": "belt_machine.force_N", "range": [20, 60]},
        {"name": "allowance", "key": "stock.allowance_mm", "how": "add", "range": [-0.05, 0.05]},
        {"name": "feed", "key": "programs[*].feed_mm_s", "values": [40.0, 80.0]},
        {"name": "lift", "key": "placement.z_mm", "range": [-0.1, 0.1]},
    ]

    def made(doc, **more):
        job, path = program_job(doc)
        return job, beltgrinding.make_study(job, Vary=VARY, Runs=6, Workers=1, **more)

    return made


@pytest.mark.freecad
def test_a_study_is_kept_and_its_rows_become_the_documents_state():
    write_pass()
    made = with_study()
    doc = FreeCAD.newDocument("life")
    doc.UndoMode = 1
    job, study = made(doc)
    machine, stock, path = doc.BeltMachine, doc.Stock, doc.RobotPath
    assert study in job.Group and study.RunsInAll == study.RunsDone == 6 and not study.OutOfDate
    table, answers = study.Proxy.table(study), study.Proxy.answers(study)
    assert len(table) == 6 and list(table.varied) == ["force", "allowance", "feed", "lift"]
    assert answers["runs"]["done"] == 6 and answers["yield"][0]["of"] == "overall"
    before = (machine.Force.Value, stock.Allowance.Value, path.FeedOverride.Value)

    doc.openTransaction("Run 2")
    assert beltgrinding.open_study_run(study, 2) == ([], [])
    doc.commitTransaction()
    force, allowance, feed, lift = (float(table[name][1]) for name in table.varied)
    assert near(machine.Force.getValueAs("N").Value, force, 1e-9)
    assert near(stock.Allowance.Value, 0.2 + allowance, 1e-9) and near(
        path.FeedOverride.Value, feed, 1e-9
    )
    assert near(machine.BaseFromWork.Base.z, lift, 1e-9)
    assert study.OpenedRun == 2 and not study.OutOfDate

    # What is simulated now is what the table has.
    with job_inputs.scratch_folder() as folder:
        result = beltgrinding.run(job_inputs.to_data(job, folder))
    assert near(result.summary["removed_volume_mm3"], table["removed_volume_mm3"][1], 1e-6)
    assert near(result.summary["process_time_s"], table["process_time_s"][1], 1e-9)

    # From one run to another, not added twice.
    beltgrinding.open_study_run(study, 5)
    assert near(stock.Allowance.Value, 0.2 + float(table["allowance"][4]), 1e-9)

    doc.saveAs("study.FCStd")
    FreeCAD.closeDocument("life")
    doc = FreeCAD.openDocument("study.FCStd")
    doc.recompute()
    study = doc.Study
    assert not study.OutOfDate and study.OpenedRun == 5
    again = study.Proxy.table(study)
    assert again.csv_bytes() == table.csv_bytes() and study.Proxy.answers(study) == answers
    doc.BeltMachine.Force = "33 N"
    doc.recompute()
    assert study.OutOfDate
    try:
        beltgrinding.open_study_run(study, 1)
        raise AssertionError("out of date")
    except InputError as error:
        assert error.code == "objects.study_out_of_date"


@pytest.mark.slow
@pytest.mark.freecad
def test_undo_takes_a_row_back_and_finished_runs_are_not_run_again():
    write_pass()
    made = with_study()
    doc = FreeCAD.newDocument("undo")
    doc.UndoMode = 1
    job, study = made(doc)
    force = doc.BeltMachine.Force.Value
    doc.openTransaction("Run 3")
    beltgrinding.open_study_run(study, 3)
    doc.commitTransaction()
    assert doc.BeltMachine.Force.Value != force
    doc.undo()
    doc.recompute()
    assert doc.BeltMachine.Force.Value == force and not study.OutOfDate

    told = []
    beltgrinding.make_study(job, told=told.append)
    assert told[-1].reused == 6 and told[-1].done == 6, told
    told.clear()
    beltgrinding.make_study(job, told=told.append, Method="sobol", Runs=8, Workers=2)
    assert study.RunsInAll == 8 == study.RunsDone and told[-1].reused == 0
    # A fast machine's first worker has made all runs before the second one is there.
    assert any(
        one.workers and not one.done for one in told
    ), "processes of their own, from FreeCAD too"


@pytest.mark.freecad
def test_what_no_property_holds_is_named_and_mistakes_are_told():
    write_pass()
    with_study()
    doc = FreeCAD.newDocument("mistakes")
    job = raster_job(doc)
    job.Spacing = "3 mm"

    def refused(code, call):
        try:
            call()
        except InputError as error:
            assert error.code == code, (error.code, str(error))
            return str(error)
        raise AssertionError(code)

    refused("objects.nothing_varies", lambda: beltgrinding.make_study(job))
    assert not hasattr(doc, "Study"), "nothing is left of it"
    wrong = [{"key": "belt_machine.fors_N", "range": [20, 60]}]
    text = refused("studies.unknown_key", lambda: beltgrinding.make_study(job, Vary=wrong))
    assert "force_N" in text
    poses = [
        {"name": "z", "key": "programs[0].poses[*].z_mm", "how": "add", "range": [-0.1, 0.1]},
        {"name": "force", "key": "belt_machine.force_N", "values": [25.0, 35.0]},
    ]
    study = beltgrinding.make_study(job, Vary=poses, Runs=3, Workers=1)
    assert beltgrinding.open_study_run(study, 2) == (["z"], [doc.RasterPath.Label])
    assert doc.BeltMachine.Force.getValueAs("N").Value == study.Proxy.table(study)["force"][1]
    refused("objects.no_such_run", lambda: beltgrinding.open_study_run(study, 4))
    keys = {one.key: one for one in study_keys.choices(job)}
    assert keys["belt_machine.force_N"].value == study.Proxy.table(study)["force"][1]
    assert keys["inspection.tolerance_mm[1]"].value > 0 and keys["programs[0].feed_mm_s"].value > 0
    assert "force" in keys["belt_machine.control"].choices
    # Every key that is offered may be varied.
    vary.variables({"vary": [{"key": key, "how": "set", "range": [0, 1]} for key in keys]})
