"""A job of a document that grinds on what another has left."""

import json
from pathlib import Path

import numpy as np
import pytest
import FreeCAD

import beltgrinding
from beltgrinding import InputError
from support.block import block, make, write_pass


def heights(simulation):
    return np.asarray(simulation.Proxy.field(simulation).height)


def refused(action, word):
    try:
        action()
    except InputError as error:
        assert word in str(error), error
    else:
        raise AssertionError("not refused")


@pytest.mark.freecad
def test_the_second_job_begins_where_the_first_ends():
    write_pass()
    doc = FreeCAD.newDocument("stages")
    part = block(doc)
    first, second = make(part), make(part)
    second.Label = "Finish"
    stock = beltgrinding.make_stock(second)
    stock.Kind = "left"
    doc.recompute()
    assert "Invalid" in stock.State
    refused(lambda: beltgrinding.simulate(second), "choose the result")
    refused(lambda: beltgrinding.make_stock(second, first), "no result")

    before = beltgrinding.simulate(first)
    assert beltgrinding.make_stock(second, first) == stock and stock.Source == before
    doc.recompute()
    after = beltgrinding.simulate(second)
    assert stock.isValid() and not after.OutOfDate
    field = after.Proxy.field(after)
    worn, end, fresh = heights(before), heights(after), np.asarray(field.stock_height)
    taken = ((fresh - end) * np.asarray(field.areas)).sum()  # of both
    assert after.RemovedVolume.Value == pytest.approx(taken, rel=1e-6)
    assert (end <= worn + 1e-9).all() and (end < worn - 1e-4).any() and (worn < fresh - 1e-4).any()

    # The command line has the same file and gives the same.
    beltgrinding.export_job(second, "second.json")
    data = json.loads(Path("second.json").read_text())["stock"]
    assert data["left_by"] == "second_left.h5"
    assert data["allowance_mm"] == pytest.approx(worn.max())
    result = beltgrinding.run("second.json")
    np.testing.assert_array_equal(np.asarray(result.field.height), end)
    result.write("out")
    assert not beltgrinding.import_result(second, "out").OutOfDate

    # Once the first leaves something else, the second is out of date.
    machine = next(one for one in first.Group if hasattr(one, "Force"))
    machine.Force = machine.Force * 1.5
    doc.recompute()
    assert before.OutOfDate and not after.OutOfDate
    refused(lambda: beltgrinding.simulate(second), "simulate it first")
    beltgrinding.simulate(first)
    assert after.OutOfDate
    beltgrinding.simulate(second)
    assert not after.OutOfDate and heights(after).sum() < end.sum()

    doc.saveAs(str(Path("stages.FCStd").resolve()))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(str(Path("stages.FCStd").resolve()))
    stock = next(one for one in doc.Objects if getattr(one, "Kind", "") == "left")
    second = stock.getParentGroup()
    doc.recompute()
    assert not beltgrinding.simulate(second).OutOfDate
    doc.removeObject(stock.Source.Name)
    doc.recompute()
    refused(lambda: beltgrinding.simulate(second), "choose the result")


@pytest.mark.freecad
def test_a_job_does_not_begin_with_what_it_leaves_itself():
    write_pass()
    doc = FreeCAD.newDocument("itself")
    job = make(block(doc))
    simulation = beltgrinding.simulate(job)
    stock = beltgrinding.make_stock(job)
    stock.Kind, stock.Source = "left", simulation
    doc.recompute()
    assert "Invalid" in stock.State
    refused(lambda: beltgrinding.simulate(job), "another job")


def test_a_job_file_without_what_was_left_is_refused(tmp_path):
    job = {"design": {"file": "part.step"}, "stock": {"kind": "left"}, "programs": [{"poses": []}]}
    (tmp_path / "job.json").write_text(json.dumps(job))
    refused(lambda: beltgrinding.run(tmp_path / "job.json"), "left_by")
