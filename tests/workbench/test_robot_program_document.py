"""The program for the whole robot in a document: planned by a macro, kept in its file, written from it."""

import json

import pytest
import FreeCAD
import Part

import beltgrinding
from beltgrinding.engine import InputError
from beltgrinding.programs import read_program

pytestmark = pytest.mark.freecad
HOME = [60, -90, 90, 0, 60, 0]


@pytest.mark.slow
def test_it_is_planned_kept_and_written(tmp_path):
    doc = FreeCAD.newDocument("work")
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="2 mm")
    beltgrinding.make_stock(job, Allowance="0.2 mm")
    machine = beltgrinding.make_belt_machine(job, WheelRadius=30, WheelWidth="15 mm", Force="30 N")
    machine.Robot = "kuka_kr6_r900"
    machine.BaseFromRobot.Base = FreeCAD.Vector(-450, 30, -350)
    machine.FlangeFromTcp.Base = FreeCAD.Vector(0, 0, 150)
    beltgrinding.make_raster(
        job, Along="direction", Direction=FreeCAD.Vector(1, 0, 0), StepOver="30 mm", Feed="90 mm/s"
    )
    doc.recompute()
    with pytest.raises(InputError, match="home_joints_deg"):
        beltgrinding.make_robot_program(job)
    assert doc.getObject("RobotProgram") is None
    machine.RobotProgram = json.dumps({"home_joints_deg": HOME})
    doc.recompute()
    program = beltgrinding.make_robot_program(job)
    assert program.Passes >= 1 and not program.Refused and not program.OutOfDate
    way = program.Proxy.walk(program)

    doc.saveAs(str(tmp_path / "kept.FCStd"))
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(str(tmp_path / "kept.FCStd"))
    program = doc.RobotProgram
    assert program.Proxy.walk(program) == way and not program.OutOfDate
    for name in ("whole.src", "whole.mod", "whole.script"):
        beltgrinding.write_robot_program(program, tmp_path / name)
        assert len(read_program(tmp_path / name).motions) == program.Motions
    doc.BeltMachine.FlangeFromTcp.Base = FreeCAD.Vector(0, 0, 160)
    doc.recompute()
    assert program.OutOfDate
    with pytest.raises(InputError, match="plan again"):
        beltgrinding.write_robot_program(program, tmp_path / "late.src")
    assert not (tmp_path / "late.src").exists()
