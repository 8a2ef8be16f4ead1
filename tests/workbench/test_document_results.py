"""A document's result is one: its files are known by their sums, and half a result is none."""

import gc
import json
import os
import tempfile
from pathlib import Path

import numpy as np
import pytest
import FreeCAD

import beltgrinding
from beltgrinding import InputError
from beltgrinding.engine import core
from beltgrinding.objects import api, deviation, job_inputs, result_files, simulation as results
from beltgrinding.simulation import run as runs
from support.block import block, make, write_pass


@pytest.mark.freecad
def test_files_of_a_result_are_known_by_their_sums():
    write_pass()
    doc = FreeCAD.newDocument("sums")
    job = make(block(doc))
    simulation = beltgrinding.simulate(job)
    assert set(json.loads(simulation.FileSums)) == {"HeightField"}
    heights = simulation.Proxy.field(simulation).height.copy()
    data = bytearray(Path(simulation.HeightField).read_bytes())
    data[len(data) // 2] ^= 1
    Path(simulation.HeightField).write_bytes(data)
    try:
        simulation.Proxy.field(simulation)
        raise AssertionError("a flipped bit was not seen")
    except InputError as error:
        assert "HeightField is not the one of this result" in str(error)

    # Simulated again it is sound, also after a save and a load.
    simulation = beltgrinding.simulate(job)
    doc.saveAs(str(Path("sums.FCStd").resolve()))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(str(Path("sums.FCStd").resolve()))
    simulation = next(o for o in doc.Objects if hasattr(o, "FileSums"))
    assert (simulation.Proxy.field(simulation).height == heights).all()

    # One that cannot be stored to its end is none, rather than two in one.
    job = next(o for o in doc.Objects if hasattr(o, "DesignFaces"))
    real = result_files.store

    def broken(obj, contents):
        real(obj, contents)
        raise InputError("test.broken", "no room")

    result_files.store = broken
    try:
        beltgrinding.simulate(job)
        raise AssertionError("it was stored")
    except InputError:
        assert simulation.Fingerprint == ""
    result_files.store = real
    beltgrinding.simulate(job)
    assert simulation.Fingerprint and (simulation.Proxy.field(simulation).height == heights).all()


@pytest.mark.freecad
def test_the_steps_of_a_recording_come_back_as_they_were():
    write_pass()
    doc = FreeCAD.newDocument("steps")
    job = make(block(doc))
    result = runs.run(job_inputs.to_data(job, tempfile.mkdtemp()), None, core.Recording())
    assert len(result.steps["time"]) > 10
    simulation = api.store_result(job, result, "x")
    job_name = job.Name
    assert not simulation.KeepRecording

    def compare(simulation):
        recording, steps = simulation.Proxy.recording(simulation)
        assert recording.bytes > 0 and set(steps) == set(result.steps)
        for name, values in result.steps.items():
            assert (steps[name] == values).all() and steps[name].flags.writeable, name
            assert steps[name].dtype == np.array(values.tolist()).dtype, name

    def saved(doc):
        doc.saveAs(str(Path("steps.FCStd").resolve()))
        FreeCAD.closeDocument(doc.Name)
        size = Path("steps.FCStd").stat().st_size
        doc = FreeCAD.openDocument(str(Path("steps.FCStd").resolve()))
        return doc, next(o for o in doc.Objects if hasattr(o, "FileSums")), size

    compare(simulation)
    simulation.KeepRecording = True
    doc, simulation, large = saved(doc)
    compare(simulation)
    assert simulation.KeepRecording

    # It is saved only where that is wanted, also after another run.
    simulation.KeepRecording = False
    doc, simulation, small = saved(doc)
    assert simulation.Proxy.recording(simulation) is None and results.lost_recording(simulation)
    assert small < large - 0.3 * result.recording.bytes, (small, large, result.recording.bytes)
    api.store_result(next(o for o in doc.Objects if o.Name == job_name), result, "x")
    compare(simulation)
    doc, simulation, small_again = saved(doc)
    assert simulation.Proxy.recording(simulation) is None and abs(small_again - small) < 5000
    simulation.KeepRecording = True
    result_files.store(simulation, {"Recording": b""})

    # An older version wrote them as lists of numbers.
    older = {"steps": {name: values.tolist() for name, values in result.steps.items()}}
    result_files.store(simulation, {"Recording": result.recording.hdf5(json.dumps(older))})
    compare(simulation)


@pytest.mark.freecad
def test_files_are_handed_to_the_document_where_they_lie_and_leave_nothing_behind():
    write_pass()
    doc = FreeCAD.newDocument("handed")
    doc.UndoMode = 1
    job = make(block(doc))

    def files():
        return {
            p.name: p.stat().st_ino for p in Path(doc.TransientDir).iterdir() if p.suffix == ".h5"
        }

    def simulated(force):
        doc.openTransaction("run")
        doc.BeltMachine.Force = f"{force} N"
        found = beltgrinding.simulate(job)
        doc.commitTransaction()
        return found, found.Proxy.field(found).height.copy()

    simulation, first = simulated(20)
    assert list(files()) == [Path(simulation.HeightField).name]
    # The file is not copied: FreeCAD has what was written.
    whole = Path(simulation.HeightField).read_bytes()
    written = result_files.Written({"HeightField": whole}, doc.TransientDir)
    number = written.paths["HeightField"].stat().st_ino
    result_files.store(simulation, written)
    assert os.stat(simulation.HeightField).st_ino == number
    assert (simulation.Proxy.field(simulation).height == first).all()

    _, second = simulated(30)
    assert (second != first).any()
    doc.undo()
    assert (simulation.Proxy.field(simulation).height == first).all()
    doc.redo()
    assert (simulation.Proxy.field(simulation).height == second).all()
    doc.clearUndos()
    doc.UndoMode = 0
    simulated(25)
    before = len(files())
    for force in (26, 27, 28):
        simulated(force)
    assert len(files()) == before, files()

    # What is never stored goes, and so does what cannot be written to its end.
    held = result_files.Written({"HeightField": b"x"}, doc.TransientDir)
    assert len(files()) == before + 1
    del held
    gc.collect()
    assert len(files()) == before
    real = result_files.write_new

    def full(path, data, **options):
        real(path, data[:1], **options)
        raise OSError(28, "No space left on device")

    result_files.write_new = full
    try:
        result_files.Written({"HeightField": b"xyz"}, doc.TransientDir)
        raise AssertionError("it was written")
    except InputError as error:
        assert "No space left" in str(error)
    result_files.write_new = real
    gc.collect()
    assert len(files()) == before
    # A document that is gone has no place for them.
    folder = doc.TransientDir
    FreeCAD.closeDocument(doc.Name)
    elsewhere = result_files.Written({"HeightField": b"x"}, folder)
    assert not os.path.exists(folder) and elsewhere.paths["HeightField"].exists()
    elsewhere.discard()
    assert not elsewhere.paths["HeightField"].exists()


@pytest.mark.freecad
def test_a_mesh_that_is_there_is_not_made_again_but_any_other_is():
    write_pass()
    doc = FreeCAD.newDocument("meshes")
    doc.UndoMode = 1
    job = make(block(doc))
    made, real = [], deviation._mesh

    def counted(ply):
        made.append(1)
        return real(ply)

    deviation._mesh = counted

    def run(**values):
        doc.openTransaction("run")
        for name, value in values.items():
            obj, _, prop = name.rpartition("_")
            setattr(getattr(doc, obj) if obj else job, prop, value)
        found = beltgrinding.simulate(job)
        doc.commitTransaction()
        return found

    def right():
        field = doc.Simulation.Proxy.field(doc.Simulation)
        tops = np.array([tuple(p.Vector) for p in doc.Deviation.Mesh.Points])
        assert np.abs(tops - field.points - field.height[:, None] * field.normals).max() < 1e-4
        assert len(doc.Deviation.VertexColors) == field.size

    run()
    shown = beltgrinding.make_deviation(job)
    assert len(made) == 1
    right()
    colours = list(shown.VertexColors)
    run(ToleranceUpper="0.02 mm", ToleranceLower="-0.02 mm")
    assert len(made) == 1 and list(shown.VertexColors) != colours
    right()
    run(BeltMachine_Force="35 N")
    assert len(made) == 2
    right()
    doc.undo()
    right()
    run(BeltMachine_Force="35 N")  # after the undo the mesh is that of the weaker force again
    assert len(made) == 3
    right()
    # One that somebody has changed is put right.
    shown.Mesh = real(deviation._ply(doc.Simulation.Proxy.field(doc.Simulation))[0])
    other = shown.Mesh.copy()
    other.decimate(0.0, 0.5)
    shown.Mesh = other
    run(ToleranceUpper="0.03 mm")
    assert len(made) == 4
    right()
    # A worker leaves it out only for the surface that is shown.
    field = doc.Simulation.Proxy.field(doc.Simulation)
    deviation.prepare(field, [-0.1, 0.1], shown.MeshOf)
    assert len(made) == 4 and deviation._ready[0].mesh is None
    deviation.prepare(field, [-0.1, 0.1], "another")
    assert len(made) == 5 and deviation._ready[0].mesh is not None
    deviation.forget_prepared()
