"""The job as document objects, without a window: what a macro does."""

import json
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import Mesh
import Part

import beltgrinding
from beltgrinding import InputError
from beltgrinding.objects import importer
from beltgrinding.presets import robot
from support.block import HEADER, REMOVED, block, make, near, write_pass
from support.freecad import SHARED

# A block of 60 x 40 x 20 mm whose top, Face6, is ground in one pass along x.


@pytest.mark.freecad
def test_a_macro_makes_a_job_and_its_result_survives():
    write_pass()
    doc = FreeCAD.newDocument("life")
    job = make(block(doc))
    simulation = beltgrinding.simulate(job)
    deviation = beltgrinding.make_deviation(job)
    assert near(simulation.RemovedVolume.Value, REMOVED), simulation.RemovedVolume
    assert near(simulation.StockVolume.Value, 480.0)
    assert [o.Name for o in job.Group] == [
        "Stock",
        "BeltMachine",
        "RobotPath",
        "Simulation",
        "Deviation",
    ]
    path = doc.RobotPath
    assert path.PoseCount == 9 and near(path.PathLength.Value, 40.0) and near(path.Duration, 4 / 3)
    assert path.Path.Size == 9
    assert deviation.Mesh.CountPoints == len(deviation.VertexColors) == simulation.Samples
    assert near(deviation.Maximum.Value, 0.2) and deviation.Minimum.Value < 0.19
    assert not any("Touched" in o.State for o in doc.Objects)

    # The tolerance recolours; it asks for no new simulation.
    before = deviation.InTolerance
    job.ToleranceUpper = "0.25 mm"
    doc.recompute()
    assert deviation.InTolerance > 99.9 > before, (before, deviation.InTolerance, deviation.Minimum)
    assert not simulation.OutOfDate

    # Any input of the result puts it out of date, and back.
    for obj, name, other in (
        (doc.BeltMachine, "Force", "31 N"),
        (doc.BeltMachine, "BeltSpeed", "19 m/s"),
        (doc.Stock, "Allowance", "0.25 mm"),
        (job, "LawCoefficient", 2e-4),
        (job, "Spacing", "0.7 mm"),
        (job, "Precision", "0.01 mm"),
        (job, "EdgeSpacing", "0.05 mm"),
        (path, "FeedOverride", "31 mm/s"),
        (doc.Block, "Placement", FreeCAD.Placement(FreeCAD.Vector(0, 0, 0.01), FreeCAD.Rotation())),
    ):
        old = getattr(obj, name)
        setattr(obj, name, other)
        doc.recompute()
        assert simulation.OutOfDate and deviation.OutOfDate, name
        setattr(obj, name, old)
        doc.recompute()
        assert not simulation.OutOfDate and not deviation.OutOfDate, name

    doc.saveAs("life.FCStd")
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument("life.FCStd")
    job, simulation, deviation = doc.BeltGrindingJob, doc.Simulation, doc.Deviation
    doc.recompute()
    assert not simulation.OutOfDate and near(simulation.RemovedVolume.Value, REMOVED)
    assert simulation.Proxy.field(simulation).size == simulation.Samples
    assert len(deviation.VertexColors) == simulation.Samples
    assert job.ToleranceUpper.Value == 0.25 and doc.BeltMachine.Force.getValueAs("N") == 30
    height = simulation.Proxy.field(simulation).height
    again = beltgrinding.simulate(job)
    assert again.Name == "Simulation" and (again.Proxy.field(again).height == height).all()


@pytest.mark.freecad
def test_a_result_of_the_same_numbers_is_up_to_date():
    write_pass()
    doc = FreeCAD.newDocument("digits")
    job = make(block(doc))
    beltgrinding.export_job(job, "digits.json")
    data = json.loads(Path("digits.json").read_text())

    def comes_back(**design):
        data["design"].update(design)
        Path("digits.json").write_text(json.dumps(data))
        beltgrinding.run("digits.json").write("out")
        return not beltgrinding.import_result(job, "out").OutOfDate

    # FreeCAD changes a shape's text by drawing and saving it, and a rotation in its last digit.
    shape = Part.Shape()
    shape.importBrepFromString(data["design"]["brep"])
    shape.tessellate(0.1)
    text = shape.exportBrepToString() + "\n"
    assert text != data["design"]["brep"]
    for pose in data["programs"][0]["poses"]:
        for key in ("qw", "qx", "qy", "qz"):
            pose[key] = -float(np.nextafter(pose[key], 2.0))
    assert comes_back(brep=text)
    # Another shape, or another pose, is another job.
    taller = Part.makeBox(60, 40, 20.001).exportBrepToString()
    assert not comes_back(brep=taller)
    data["programs"][0]["poses"][0]["x_mm"] += 1e-3
    assert not comes_back(brep=text)


@pytest.mark.freecad
def test_a_job_goes_to_the_command_line_and_comes_back():
    write_pass()
    doc = FreeCAD.newDocument("there")
    job = make(block(doc))
    here = beltgrinding.simulate(job)
    beltgrinding.export_job(job, "job.json")
    result = beltgrinding.run("job.json")
    assert abs(result.summary["removed_volume_mm3"] - here.RemovedVolume.Value) < 1e-9
    result.write("out")
    back = beltgrinding.import_result(job, "out")
    assert back.Name == here.Name and not back.OutOfDate
    doc.BeltMachine.Force = "35 N"
    assert beltgrinding.import_result(job, "out").OutOfDate

    # The file becomes a job in another document, which gives the same file again.
    other = FreeCAD.newDocument("other")
    copy = beltgrinding.open_job(other, "job.json")
    beltgrinding.export_job(copy, "copy.json")
    a, b = (json.loads(Path(name).read_text()) for name in ("job.json", "copy.json"))
    for data in (a, b):
        data["design"].pop("brep")
    assert a == b, (a, b)

    assert (
        abs(beltgrinding.simulate(copy).RemovedVolume.Value - result.summary["removed_volume_mm3"])
        < 1e-9
    )


@pytest.mark.freecad
def test_a_robot_goes_through_the_document():
    write_pass()
    doc = FreeCAD.newDocument("reach")
    job = make(block(doc))
    machine = doc.BeltMachine
    machine.Robot = "kuka_kr16_2"
    machine.BaseFromRobot = FreeCAD.Placement(FreeCAD.Vector(-900, 0, -500), FreeCAD.Rotation())
    machine.FlangeFromTcp = FreeCAD.Placement(FreeCAD.Vector(0, 0, 150), FreeCAD.Rotation())
    close = beltgrinding.simulate(job)
    assert not any("reach" in text for text in close.Events), close.Events
    machine.BaseFromRobot = FreeCAD.Placement(FreeCAD.Vector(-4000, 0, 0), FreeCAD.Rotation())
    doc.recompute()
    assert close.OutOfDate
    far = beltgrinding.simulate(job)
    assert any(
        "out_of_reach" in text and "mm are missing" in text for text in far.Events
    ), far.Events
    machine.StartJoints = "[0, -90, 90, 0, 0, 0]"
    machine.RobotProgram = '{"home_joints_deg": [0, -90, 90, 0, 60, 0], "seed": 5}'
    machine.SingularityAngle = "7 deg"
    beltgrinding.export_job(job, "job.json")
    data = json.loads(Path("job.json").read_text())["robot"]
    assert data["preset"] == "kuka_kr16_2" and data["singularity_deg"] == 7
    assert data["start_joints_deg"] == [0, -90, 90, 0, 0, 0]
    assert data["program"]["seed"] == 5 and data["program"]["home_joints_deg"][4] == 60
    assert data["base_from_robot"]["position_mm"] == [-4000, 0, 0]
    other = FreeCAD.newDocument("other")
    beltgrinding.export_job(beltgrinding.open_job(other, "job.json"), "copy.json")
    assert json.loads(Path("copy.json").read_text())["robot"] == data

    # A model of one's own.
    whole = json.loads(Path("job.json").read_text())
    whole["robot"].update(preset="", model=robot.load_preset("ur5e"))
    Path("own.json").write_text(json.dumps(whole))
    beltgrinding.export_job(
        beltgrinding.open_job(FreeCAD.newDocument("own"), "own.json"), "back.json"
    )
    assert json.loads(Path("back.json").read_text())["robot"]["model"] == whole["robot"]["model"]


@pytest.mark.freecad
def test_stock_from_objects_where_they_lie():
    write_pass()
    doc = FreeCAD.newDocument("stock")
    part = block(doc)
    raw = doc.addObject("Part::Feature", "Raw")
    raw.Shape = Part.makeBox(70, 50, 25)
    raw.Placement.Base = FreeCAD.Vector(-5, -5, -4.7)  # its top lies at 20.3
    scan = doc.addObject("Mesh::Feature", "Scan")
    scan.Mesh = Mesh.createBox(80, 80, 10)  # its middle at the origin, its top at 5
    scan.Placement = FreeCAD.Placement(FreeCAD.Vector(30, 20, 15.4), FreeCAD.Rotation(30, 0, 0))
    for source, height in ((raw, 0.3), (scan, 0.4)):
        job = make(part, source=source, SearchAbove=2, SearchBelow=2)
        simulation = beltgrinding.simulate(job)
        field = simulation.Proxy.field(simulation)
        assert abs(field.stock_height - height).max() < 1e-4, (
            source.Name,
            field.stock_height.max(),
        )
        assert simulation.MissedRays == 0
        source.Placement.Base.z += 0.1
        doc.recompute()
        assert simulation.OutOfDate

    # A mesh's file, in metres.
    mesh = Mesh.createBox(0.08, 0.08, 0.01)
    mesh.write("scan.stl")
    job = make(
        part,
        source="scan.stl",
        FileUnit=1000.0,
        SearchAbove=2,
        SearchBelow=2,
        FilePlacement=FreeCAD.Placement(FreeCAD.Vector(30, 20, 15.4), FreeCAD.Rotation()),
    )
    simulation = beltgrinding.simulate(job)
    assert abs(simulation.Proxy.field(simulation).stock_height - 0.4).max() < 1e-4


@pytest.mark.freecad
def test_a_part_in_a_moved_container_is_ground_where_it_lies():
    write_pass()
    doc = FreeCAD.newDocument("moved")
    part = block(doc)
    container = doc.addObject("App::Part", "Container")
    container.addObject(part)
    container.Placement = FreeCAD.Placement(FreeCAD.Vector(300, 0, 0), FreeCAD.Rotation(90, 0, 0))
    job = make(part)
    move = FreeCAD.Placement(FreeCAD.Vector(300, 0, 0), FreeCAD.Rotation(90, 0, 0))
    try:
        beltgrinding.simulate(job)
        raise SystemExit("the wheel cannot have touched")
    except InputError as error:
        assert "never touches" in str(error)
    doc.BeltMachine.BaseFromWork = move.inverse()  # the robot's base is moved like the part
    assert near(beltgrinding.simulate(job).RemovedVolume.Value, REMOVED)
    doc.RobotPath.Poses = [move.multiply(p) for p in doc.RobotPath.Poses]
    doc.BeltMachine.BaseFromWork = FreeCAD.Placement()
    assert near(beltgrinding.simulate(job).RemovedVolume.Value, REMOVED)


@pytest.mark.freecad
def test_wrong_input_names_the_culprit_and_leaves_the_document():
    write_pass()
    doc = FreeCAD.newDocument("bad")
    part = block(doc)
    empty = doc.addObject("Part::Feature", "Empty")
    Path("empty.csv").write_text(HEADER + "\n")
    Path("rubbish.src").write_bytes(bytes(range(256)) * 40)
    Path("no_json.json").write_text("{")

    def refuse(call, *culprits):
        names = [o.Name for o in doc.Objects]
        try:
            call()
        except InputError as error:
            assert all(c in str(error) for c in culprits), (str(error), culprits)
            assert len(str(error).splitlines()) == 1, str(error)
            assert "sErrMsg" not in str(error), str(error)  # FreeCAD's own errors say a dict
        else:
            raise SystemExit(f"not refused: {culprits}")
        assert [o.Name for o in doc.Objects] == names, culprits

    refuse(lambda: beltgrinding.make_job(empty), "Empty", "shape")
    refuse(lambda: beltgrinding.make_job([]), "part")
    refuse(lambda: beltgrinding.make_job(part, ["Face9"]), "Block", "Face9", "6 faces")
    refuse(lambda: beltgrinding.make_job(part, ["Edge1"]), "Edge1", "no face")
    refuse(lambda: beltgrinding.make_job(part, Spcing=1), "Spcing", "Spacing")
    refuse(lambda: beltgrinding.make_job(part, Spacing="1 kg"), "Spacing", "Unit")
    refuse(lambda: beltgrinding.make_job(part, Spacing="1 +"), "Spacing", "syntax")
    job = beltgrinding.make_job(part, [6])
    refuse(lambda: beltgrinding.simulate(job), "belt machine")
    beltgrinding.make_belt_machine(job)
    refuse(lambda: beltgrinding.simulate(job), "stock")
    refuse(lambda: beltgrinding.make_stock(job, Allowanse=1), "Allowance")
    beltgrinding.make_stock(job)
    refuse(lambda: beltgrinding.simulate(job), "robot program")
    refuse(lambda: beltgrinding.make_deviation(job), "simulate first")
    refuse(lambda: beltgrinding.import_program(job, "absent.src"), "absent.src")
    refuse(lambda: beltgrinding.import_program(job, "empty.csv"), "empty.csv", "0 Cartesian")
    refuse(lambda: beltgrinding.import_program(job, "rubbish.src"), "rubbish.src")
    refuse(lambda: beltgrinding.import_program(job, "pass.txt"), "pass.txt")
    refuse(lambda: beltgrinding.open_job(doc, "no_json.json"), "no_json.json")
    refuse(lambda: beltgrinding.import_result(job, "nowhere"), "nowhere")
    beltgrinding.import_program(job, "pass.csv")
    doc.Stock.Kind = "solid"
    refuse(lambda: beltgrinding.simulate(job), "Stock", "solid")
    doc.Stock.Kind = "mesh"
    refuse(lambda: beltgrinding.simulate(job), "Stock", "mesh")
    doc.Stock.File = "absent.stl"
    refuse(lambda: beltgrinding.simulate(job), "absent.stl")
    doc.Stock.Kind = "allowance"
    job.Depth = 0
    refuse(lambda: beltgrinding.simulate(job), "depth")
    job.Depth = 1
    job.Spacing = "0.1 um"
    refuse(lambda: beltgrinding.simulate(job), "spacing")
    job.Spacing = 1
    doc.BeltMachine.WheelRadius = 0
    refuse(lambda: beltgrinding.simulate(job), "radius")
    doc.BeltMachine.WheelRadius = 50
    job.DesignFaces = []
    refuse(lambda: beltgrinding.simulate(job), "no faces")
    job.DesignFaces = [(part, ("Face6",))]
    part.Shape = Part.makeSphere(5)  # the face that the job names is gone
    refuse(lambda: beltgrinding.simulate(job), "Face6")
    doc.recompute()  # must not raise either


@pytest.mark.freecad
def test_undo_takes_back_what_a_macro_made():
    write_pass()
    doc = FreeCAD.newDocument("undo")
    doc.UndoMode = 1
    part = block(doc)
    doc.openTransaction("job")
    job = make(part)
    doc.commitTransaction()
    doc.openTransaction("simulate")
    beltgrinding.simulate(job)
    beltgrinding.make_deviation(job)
    doc.commitTransaction()
    count = len(doc.Objects)
    doc.undo()
    assert [o.Name for o in job.Group] == ["Stock", "BeltMachine", "RobotPath"]
    doc.redo()
    assert len(doc.Objects) == count
    assert doc.Simulation.Proxy.field(doc.Simulation).size == doc.Simulation.Samples
    assert len(doc.Deviation.VertexColors) == doc.Deviation.Mesh.CountPoints
    doc.undo()
    doc.undo()
    assert [o.Name for o in doc.Objects] == ["Block"]


@pytest.mark.freecad
def test_file_open_and_import_read_programs():
    write_pass()
    assert "beltgrinding.objects.importer" in str(FreeCAD.getImportType("src"))
    opened = importer.open("pass.csv")
    assert [o.PoseCount for o in opened.Objects] == [9]
    doc = FreeCAD.newDocument("into")
    job = make(block(doc))
    importer.insert("pass.csv", doc.Name)
    assert len([o for o in job.Group if o.Name.startswith("RobotPath")]) == 2


@pytest.mark.slow
@pytest.mark.skipif(not (SHARED / "data").is_dir(), reason=f"no shared data at {SHARED}")
@pytest.mark.freecad
def test_a_real_part_and_program_in_a_document():
    data = SHARED / "data"
    doc = FreeCAD.newDocument("water")
    part = doc.addObject("Part::Feature", "Airfoil")
    part.Shape = Part.read(str(data / "cad" / "blade_airfoil_periodic.igs"))
    job = beltgrinding.make_job(part, Spacing="2 mm")
    beltgrinding.make_stock(job, Allowance="0.3 mm")
    beltgrinding.make_belt_machine(job)
    beltgrinding.import_program(job, data / "programs" / "same_path_crs_part5" / "crs_part5.src")
    try:
        beltgrinding.simulate(job)
    except beltgrinding.InputError as error:
        assert "never touches" in str(error)  # another part's program
    assert doc.RobotPath.Path.Size == doc.RobotPath.PoseCount >= 423  # arcs are cut into chords


@pytest.mark.freecad
def test_a_belt_carries_its_loading_and_programs_free_it():
    write_pass()
    doc = FreeCAD.newDocument("loading")
    job = make(block(doc))
    work = 30.0 * 20.0 * 4 / 3  # F V_b t, J
    job.LoadingShare, job.LoadingScale, job.LoadingRecovery = 0.4, work, 10.0
    job.DressingRest = 0.5
    first = beltgrinding.simulate(job)
    full = 1.0 - 1.0 / 2.71828
    assert near(first.RemainingCut, 100.0 * (1.0 - 0.4 * full), 0.02), first.RemainingCut
    fresh = first.RemovedVolume.Value
    belt = beltgrinding.wear_belt(job)
    assert near(belt.Loading, full, 0.02)
    loaded = beltgrinding.simulate(job).RemovedVolume.Value
    assert loaded < 0.95 * fresh
    path = [one for one in job.Group if one.Name.startswith("RobotPath")][0]
    path.PauseBefore, path.DressBefore = 25.0, True
    doc.recompute()
    assert first.OutOfDate
    freed = beltgrinding.simulate(job).RemovedVolume.Value
    assert loaded * 1.02 < freed < fresh
    beltgrinding.export_job(job, "loading.json")
    data = json.loads(Path("loading.json").read_text())
    assert data["programs"][0]["pause_s"] == 25.0 and data["programs"][0]["dress"] is True
    assert near(data["belt_machine"]["belt"]["loading"], full, 0.02)
    copy = beltgrinding.open_job(FreeCAD.newDocument("loading2"), "loading.json")
    opened = [one for one in copy.Group if one.Name.startswith("RobotPath")][0]
    assert opened.PauseBefore == 25.0 and opened.DressBefore
    assert near(beltgrinding.simulate(copy).RemovedVolume.Value, freed, 1e-3)
    belt.Proxy.reset(belt)
    assert belt.Loading == 0.0


@pytest.mark.freecad
def test_a_belt_carries_its_wear_between_jobs():
    write_pass()
    doc = FreeCAD.newDocument("belt")
    job = make(block(doc))
    work = 30.0 * 20.0 * 4 / 3  # F V_b t, J
    job.WearModel, job.WearScale = "exponential", work
    first = beltgrinding.simulate(job)
    assert near(first.RemainingCut, 100 / 2.71828, 0.02), first.RemainingCut
    belt = beltgrinding.wear_belt(job)
    doc.recompute()
    assert near(belt.WorkDone, work, 0.02) and near(belt.Hours, 4 / 3 / 3600, 0.05)
    assert near(belt.RemainingCut, first.RemainingCut, 1e-6)
    assert doc.BeltMachine.Belt == belt and not first.OutOfDate
    try:
        beltgrinding.wear_belt(job)
        raise AssertionError("counted twice")
    except InputError as error:
        assert "counted already" in str(error)
    fresh = first.RemovedVolume.Value
    again = beltgrinding.simulate(job)
    assert near(again.RemovedVolume.Value, fresh / 2.71828, 0.03)
    beltgrinding.wear_belt(job)
    assert near(belt.WorkDone, 2 * work, 0.02)

    other = make(block(doc))
    machine = [o for o in other.Group if o.Name.startswith("BeltMachine")][0]
    machine.Belt = belt
    beltgrinding.export_job(other, "other.json")
    assert near(
        json.loads(Path("other.json").read_text())["belt_machine"]["belt"]["work_J"], 2 * work, 0.02
    )
    opened = beltgrinding.open_job(FreeCAD.newDocument("opened"), "other.json")
    assert near(opened.Document.Belt.WorkDone, belt.WorkDone, 1e-9)
    belt.Proxy.reset(belt)
    assert belt.WorkDone == 0 and belt.RemainingCut == 100
    assert near(beltgrinding.simulate(job).RemovedVolume.Value, fresh, 1e-6)


@pytest.mark.freecad
def test_a_calibrated_law_colours_its_uncertainty():
    write_pass()
    doc = FreeCAD.newDocument("sure")
    job = make(block(doc))
    job.Law = "local"
    calibration = {"parameters": ["coefficient"], "covariance": [[0.0025]], "scatter": 0.1}
    job.Calibration = json.dumps(calibration)
    job.PressureCurve = [(0.01, 0.1, 0), (0.1, 1, 0), (1, 10, 0)]
    simulation = beltgrinding.simulate(job)
    assert near(simulation.RemovedVolume.Value, REMOVED), simulation.RemovedVolume
    deviation = beltgrinding.make_deviation(job)
    assert 0 < deviation.UncertaintyMean.Value < deviation.Uncertainty95.Value
    assert deviation.Uncertainty95 <= deviation.UncertaintyLimit
    assert 0 < deviation.ExpectedInTolerance < 100
    before = list(deviation.VertexColors)
    deviation.ColourBy = "uncertainty"
    doc.recompute()
    assert list(deviation.VertexColors) != before
    deviation.ColourBy = "deviation"
    doc.recompute()
    assert list(deviation.VertexColors) == before
    beltgrinding.export_job(job, "sure.json")
    law = json.loads(Path("sure.json").read_text())["law"]
    assert law["calibration"] == calibration and law["pressure_curve"][1] == [0.1, 1.0], law
    opened = beltgrinding.open_job(FreeCAD.newDocument("opened"), "sure.json")
    assert json.loads(opened.Calibration) == calibration and len(opened.PressureCurve) == 3


@pytest.mark.freecad
def test_the_robots_timing_and_a_document_from_before_it():
    write_pass()
    doc = FreeCAD.newDocument("timing")
    job = make(block(doc))
    simulation = beltgrinding.simulate(job)
    assert near(simulation.ProcessTime, 4 / 3)
    job.Timing, job.PathAcceleration = "trapezoidal", "100 mm/s^2"
    doc.recompute()
    assert simulation.OutOfDate
    beltgrinding.simulate(job)
    assert near(simulation.ProcessTime, 4 / 3 + 0.3, 1e-9)  # v / a; between the poses no stop
    assert near(simulation.RemovedVolume.Value, REMOVED * (1 + 0.3 / (4 / 3)))
    beltgrinding.export_job(job, "job.json")
    exported = json.loads(Path("job.json").read_text())
    assert exported["simulation"]["path_acceleration_mm_s2"] == 100
    assert not any("zone_mm" in pose for pose in exported["programs"][0]["poses"])
    path = doc.RobotPath
    path.Zones = [0.0] * len(path.Poses)
    doc.recompute()
    assert simulation.OutOfDate
    beltgrinding.simulate(job)
    assert near(simulation.ProcessTime, 8 * 2 * (5 / 100) ** 0.5, 1e-9)

    path.removeProperty("Zones")
    for name in (
        "Timing",
        "PathAcceleration",
        "AngularAcceleration",
        "RotationSpeed",
        "DefaultZone",
    ):
        job.removeProperty(name)
    doc.saveAs("old.FCStd")
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument("old.FCStd")
    job, path = doc.BeltGrindingJob, doc.RobotPath
    assert job.Timing == "constant_feed" and job.DefaultZone.Value == 1.0
    assert job.PathAcceleration.Value == 1200 and len(path.Proxy.arrays(path)["zones"]) == 9
    assert near(beltgrinding.simulate(job).ProcessTime, 4 / 3, 1e-9)
