"""The ground part's mesh and a scan as document objects, without a window."""

import os

import numpy as np
import pytest
import FreeCAD

import beltgrinding
from beltgrinding import InputError
from support.block import block, make, near, write_pass


@pytest.mark.freecad
def test_the_ground_part_becomes_a_mesh_of_the_document():
    write_pass()
    doc = FreeCAD.newDocument("mesh")
    job = make(block(doc))
    try:
        beltgrinding.make_ground_mesh(job)
        raise AssertionError("a mesh without a result")
    except InputError as error:
        assert "simulate first" in str(error)
    simulation = beltgrinding.simulate(job)
    part = beltgrinding.make_ground_mesh(job)
    assert part in job.Group and part.Closed and not part.OutOfDate
    assert part.Mesh.isSolid() and not part.Mesh.hasNonManifolds()
    assert len(part.VertexColors) == part.Mesh.CountPoints
    left = simulation.StockVolume.Value - simulation.RemovedVolume.Value
    assert near(part.Volume.Value - part.DesignVolume.Value, left, 0.005)
    assert near(part.Mesh.Volume, part.Volume.Value, 1e-3)

    # Another tolerance leaves it; another stock makes it stale, and a new simulation with it anew sound.
    job.ToleranceUpper = "0.1 mm"
    doc.recompute()
    assert not part.OutOfDate
    job.Group[0].Allowance = "0.1 mm"
    doc.recompute()
    assert part.OutOfDate
    try:
        beltgrinding.make_ground_mesh(job)
        raise AssertionError("a mesh of a stale result")
    except InputError as error:
        assert "out of date" in str(error)
    beltgrinding.simulate(job)
    doc.recompute()
    assert part.OutOfDate
    assert beltgrinding.make_ground_mesh(job) == part and not part.OutOfDate
    doc.saveAs(os.path.abspath("mesh.FCStd"))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(os.path.abspath("mesh.FCStd"))
    part = doc.GroundPart
    assert part.Closed and part.Mesh.CountPoints == len(part.VertexColors) > 1000


@pytest.mark.freecad
def test_a_scan_colours_the_deviation():
    write_pass()
    doc = FreeCAD.newDocument("scan")
    job = make(block(doc))
    simulation = beltgrinding.simulate(job)
    deviation = beltgrinding.make_deviation(job)
    part = beltgrinding.make_ground_mesh(job)
    scanned = part.Mesh.copy()
    scanned.translate(0.0, 0.0, 0.03)  # laid on the sides, as if less had been ground
    scanned.write(os.path.abspath("scan.stl"))
    figures = beltgrinding.compare_scan(job, "scan.stl", aligned=True)
    assert abs(figures["difference_mm"]["mean"] - 0.03) < 0.002, figures["difference_mm"]
    assert near(simulation.DifferenceMean.Value, figures["difference_mm"]["mean"])
    assert simulation.ScanShare > 95.0 and not simulation.OutOfDate
    deviation.ColourBy = "difference"
    doc.recompute()
    one = deviation.VertexColors
    deviation.ColourBy = "measured"
    doc.recompute()
    assert deviation.VertexColors != one
    doc.saveAs(os.path.abspath("scan.FCStd"))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(os.path.abspath("scan.FCStd"))
    field = doc.Simulation.Proxy.field(doc.Simulation)
    assert np.isfinite(field.measured).mean() > 0.95
    job = doc.Simulation.getParentGroup()
    before = job.LawCoefficient
    learned = beltgrinding.learn_scan(job, scatter=0.01)  # 0.03 mm more is left
    assert learned.factor < 0.97 and job.LawCoefficient < 0.98 * before
    assert (
        near(job.LawCoefficient, learned.law["coefficient_mm2_per_N"]) and doc.Simulation.OutOfDate
    )
    try:
        beltgrinding.learn_scan(job)
        assert False, "of another result"
    except beltgrinding.InputError as error:
        assert "out of date" in str(error)
    beltgrinding.simulate(job)  # another result: the measurement was of the old one
    assert doc.Simulation.ScanFigures == ""
    assert len(doc.Simulation.Proxy.field(doc.Simulation).measured) == 0
