"""Free belts and platens in documents: what is kept, what a job has of it, what cannot be."""

import json
from pathlib import Path

import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding.engine import InputError
from beltgrinding.objects import job_inputs


def block(doc):
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    return part


def make(doc, **machine):
    job = beltgrinding.make_job(block(doc), ["Face6"], Spacing="1 mm")
    beltgrinding.make_stock(job, Allowance="0.1 mm")
    beltgrinding.make_belt_machine(job, Force="20 N", ForceTravel="30 mm", **machine)
    beltgrinding.import_program(job, "pass.csv")
    doc.recompute()
    return job


def with_job():
    Path("pass.csv").write_text(
        "x_mm,y_mm,z_mm,qx,qy,qz,qw,feed_mm_s\n10,20,20,1,0,0,0,20\n50,20,20,1,0,0,0,20\n"
    )

    BELT = dict(
        Kind="free_belt", RunWidth="15 mm", RunTension=6.0, RunPosition="-20 mm", Rollers="fixed"
    )
    LAYERS = [{"thickness_mm": 5.0, "youngs_modulus_MPa": 2.0, "poissons_ratio": 0.4}]
    return BELT, LAYERS


@pytest.mark.slow
@pytest.mark.freecad
def test_a_document_grinds_as_its_job_file_and_keeps_its_machine():
    BELT, LAYERS = with_job()
    for machine in (
        BELT,
        dict(BELT, Kind="platen", RunPosition=0, PlatenLayers=json.dumps(LAYERS)),
    ):
        doc = FreeCAD.newDocument("there")
        job = make(doc, **machine)
        here = beltgrinding.simulate(job)
        beltgrinding.export_job(job, "job.json")
        data = json.loads(Path("job.json").read_text())["belt_machine"]
        assert data["kind"] == machine["Kind"] and data["free_run"]["width_mm"] == 15.0
        assert data["free_run"]["rollers"] == "fixed" and ("platen" in data) == (
            data["kind"] == "platen"
        )
        assert data["free_run"]["position_mm"] == (-20.0 if data["kind"] == "free_belt" else 0.0)
        result = beltgrinding.run("job.json")
        assert result.summary["removed_volume_mm3"] > 0.1
        assert abs(result.summary["removed_volume_mm3"] - here.RemovedVolume.Value) < 1e-9
        result.write("out")
        assert not beltgrinding.import_result(job, "out").OutOfDate

        # The file becomes a job in another document, which gives the same file again.
        other = FreeCAD.newDocument("other")
        beltgrinding.export_job(beltgrinding.open_job(other, "job.json"), "copy.json")
        copy = json.loads(Path("copy.json").read_text())["belt_machine"]
        assert copy == data, (copy, data)

        # So does the document that is saved and opened, whose result is still that of its job.
        doc.saveAs(str(Path("there.FCStd").resolve()))
        FreeCAD.closeDocument(doc.Name)
        doc = FreeCAD.openDocument(str(Path("there.FCStd").resolve()))
        assert doc.BeltMachine.Kind == machine["Kind"] and doc.BeltMachine.Rollers == "fixed"
        doc.recompute()
        assert not doc.Simulation.OutOfDate
        if machine["Kind"] == "platen":
            doc.BeltMachine.PlatenLength = 100
            doc.recompute()
            assert doc.Simulation.OutOfDate
        FreeCAD.closeDocument(doc.Name)


@pytest.mark.freecad
def test_a_wheels_job_has_no_key_of_the_others():
    with_job()
    doc = FreeCAD.newDocument("wheel")
    job = make(doc)
    before = job_inputs.fingerprint(job)
    machine = doc.BeltMachine
    assert not {"kind", "free_run", "platen"} & set(machine.Proxy.to_job(machine)["belt_machine"])
    machine.RunLength = 333  # of no account: nothing is out of date by it
    assert job_inputs.fingerprint(job) == before
    machine.Kind = "platen"
    assert job_inputs.fingerprint(job) != before
    hidden = lambda name: "Hidden" in machine.getEditorMode(name)
    assert hidden("WheelRadius") and not hidden("PlatenLength") and not hidden("RunLength")
    machine.Kind = "free_belt"
    assert hidden("PlatenLength") and not hidden("RunLength") and not hidden("Force")
    machine.Kind = "contact_wheel"
    assert hidden("RunLength") and not hidden("WheelRadius")
    assert job_inputs.fingerprint(job) == before

    # A document from before there were other kinds: its machine is a wheel's, and asks for nothing.
    for name in list(machine.PropertiesList):
        if machine.getGroupOfProperty(name) in ("Free run", "Platen", "Machine"):
            machine.removeProperty(name)
    doc.saveAs(str(Path("old.FCStd").resolve()))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(str(Path("old.FCStd").resolve()))
    assert doc.BeltMachine.Kind == "contact_wheel"
    assert job_inputs.fingerprint(doc.BeltGrindingJob) == before


@pytest.mark.freecad
def test_what_cannot_be_is_told_at_the_machine():
    BELT, _ = with_job()
    doc = FreeCAD.newDocument("wrong")
    job = make(doc, **BELT)
    machine = doc.BeltMachine

    def refused(code, **values):
        before = {name: getattr(machine, name) for name in values}
        for name, value in values.items():
            setattr(machine, name, value)
        try:
            machine.Proxy.execute(machine)
            raise AssertionError(values)
        except InputError as error:
            assert error.code == code, error
        for name, value in before.items():
            setattr(machine, name, value)
        machine.Proxy.execute(machine)

    refused("job.belt_position", RunPosition=120)
    refused("objects.not_above", RunTension=0.0)
    refused("job.platen_length", Kind="platen", PlatenLength=180)
    refused("objects.not_json", Kind="platen", RunPosition=0, PlatenLayers="[{")
    refused("base.missing_key", Kind="platen", RunPosition=0, PlatenLayers='[{"thickness_mm": 5}]')
    job.Law = "geometric"
    try:
        beltgrinding.simulate(job)
        raise AssertionError("a belt that is rigid")
    except InputError as error:
        assert error.code in ("job.belt_is_not_rigid", "job.rigid_force"), error
