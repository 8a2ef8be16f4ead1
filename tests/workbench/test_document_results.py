"""A document's result is one: its files are known by their sums, and half a result is none."""

from test_document import BLOCK


def test_files_of_a_result_are_known_by_their_sums(freecad):
    freecad.run(
        BLOCK
        + """
from beltgrinding.objects import result_files
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
"""
    )


def test_the_steps_of_a_recording_come_back_as_they_were(freecad):
    freecad.run(
        BLOCK
        + """
import tempfile
import numpy as np
from beltgrinding.engine import core
from beltgrinding.objects import api, job_inputs, result_files, simulation as simulations
from beltgrinding.simulation import run as runs

doc = FreeCAD.newDocument("steps")
job = make(block(doc))
result = runs.run(job_inputs.to_data(job, tempfile.mkdtemp()), None, core.Recording())
assert len(result.steps["time"]) > 10
simulation = api.store_result(job, result, "x")

def compare(simulation):
    recording, steps = simulation.Proxy.recording(simulation)
    assert recording.bytes > 0 and set(steps) == set(result.steps)
    for name, values in result.steps.items():
        assert (steps[name] == values).all() and steps[name].flags.writeable, name
        assert steps[name].dtype == np.array(values.tolist()).dtype, name

compare(simulation)
doc.saveAs(str(Path("steps.FCStd").resolve()))
FreeCAD.closeDocument(doc.Name)
doc = FreeCAD.openDocument(str(Path("steps.FCStd").resolve()))
simulation = next(o for o in doc.Objects if hasattr(o, "FileSums"))
compare(simulation)

# An older version wrote them as lists of numbers.
older = {"steps": {name: values.tolist() for name, values in result.steps.items()}}
result_files.store(simulation, {"Recording": result.recording.hdf5(json.dumps(older))})
compare(simulation)
"""
    )
