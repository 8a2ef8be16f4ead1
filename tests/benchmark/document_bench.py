"""Run by tools/bench inside FreeCAD with a window: a million samples into a coloured mesh.

Writes Google Benchmark's JSON to BELTGRINDING_BENCH_OUT. The peer is FreeCAD's own reading and
drawing of the same mesh without colours. Figures in ms: the mesh laid into the document and drawn,
the document saved, and opened again until it is drawn.
"""

import json
import os
import tempfile
import time
from pathlib import Path

import FreeCAD
import FreeCADGui
import Mesh

from beltgrinding.engine import core
from beltgrinding.objects import api, deviation, simulation

SAMPLES = 1_000_000
LENGTH, WIDTH, RADIUS = 120.0, 80.0, 200.0  # mm, of the curved plate


def curved_plate():
    import Part

    arc = Part.Arc(
        FreeCAD.Vector(0, 0, 0),
        FreeCAD.Vector(LENGTH / 2, 0, LENGTH**2 / (8 * RADIUS)),
        FreeCAD.Vector(LENGTH, 0, 0),
    )
    return arc.toShape().extrude(FreeCAD.Vector(0, WIDTH, 0))


def result():
    """A result as a simulation leaves it: stock of 0.2 mm, waves ground into it."""
    shape = core.Shape.from_brep(curved_plate().exportBrepToString(), "plate")
    spacing = (shape.face_area(0) / SAMPLES) ** 0.5
    field, _ = core.sample_faces(shape, [0], spacing)
    core.apply_allowance(field, 0.2)
    x = field.points[:, 0]
    field.set_height(0.2 - 0.3 * (x / LENGTH) * (x % 7 < 5))
    return field


def timed(results, name, work):
    start = time.perf_counter()
    value = work()
    FreeCADGui.updateGui()
    results[name] = 1000.0 * (time.perf_counter() - start)
    return value


def main(folder):
    results = {}
    field = result()
    doc = FreeCAD.newDocument("peer")
    ply = folder / "peer.ply"
    ply.write_bytes(core.mesh_ply(field, True))
    timed(results, "document/peer_read_and_draw", lambda: Mesh.insert(str(ply), doc.Name))
    FreeCAD.closeDocument(doc.Name)

    doc = FreeCAD.newDocument("bench")
    part = doc.addObject("Part::Feature", "Plate")
    part.Shape = curved_plate()
    job = api.make_job(part)
    api.make_stock(job)
    api.make_belt_machine(job)
    held = doc.addObject("App::FeaturePython", "Simulation")
    simulation.Simulation(held)
    job.addObject(held)
    h5 = folder / "field.h5"
    field.write_hdf5(str(h5), "{}")
    held.HeightField = str(h5)
    held.Fingerprint = "bench"
    made = timed(results, "document/lay_and_draw", lambda: api.make_deviation(job))
    assert len(made.VertexColors) == made.Mesh.CountPoints == field.size
    path = folder / "bench.FCStd"
    timed(results, "document/save", lambda: doc.saveAs(str(path)))
    FreeCAD.closeDocument(doc.Name)
    timed(results, "document/reopen_and_draw", lambda: FreeCAD.openDocument(str(path)))
    results["document/lay_over_peer_ratio"] = (
        results["document/lay_and_draw"] / results["document/peer_read_and_draw"]
    )
    for name, value in results.items():
        print(f"{name:40} {value:10.2f}   ({field.size} samples)")
    benchmarks = [
        {"name": name, "real_time": value, "time_unit": "ms", "samples": field.size}
        for name, value in results.items()
    ]
    Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
        json.dumps({"context": {}, "benchmarks": benchmarks})
    )


with tempfile.TemporaryDirectory() as name:
    main(Path(name))
