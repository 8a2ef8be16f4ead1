"""FreeCAD's own paths as robot programs: CAM paths and trajectories of the Robot workbench."""

from types import SimpleNamespace

import numpy as np
import pytest
import FreeCAD
import Part
import Path
import Robot

import beltgrinding
from beltgrinding.objects import freecad_path, set_up


def prepared():
    doc = FreeCAD.newDocument()
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    job = beltgrinding.make_job(part, ["Face6"], Spacing=0.6)
    beltgrinding.make_stock(job, Allowance=0.2)
    machine = beltgrinding.make_belt_machine(job, WheelRadius=60, WheelWidth=15, Force="30 N")

    def path_of(*commands):
        made = doc.addObject("Path::Feature", "Contour")
        made.Path = Path.Path([Path.Command(name, words) for name, words in commands])
        doc.recompute()
        return made

    def contacts(robot):
        cell = machine.Proxy.cell(machine)
        arrays = robot.Proxy.arrays(robot)
        return beltgrinding.core.ToolPath(**arrays, **cell).work_from_contact()

    return SimpleNamespace(
        contacts=contacts, doc=doc, job=job, machine=machine, part=part, path_of=path_of
    )


@pytest.mark.freecad
def test_a_cam_path_is_ground_where_it_is_drawn():
    here = prepared()
    contacts, doc, job, machine, path_of = (
        here.contacts,
        here.doc,
        here.job,
        here.machine,
        here.path_of,
    )
    milling = path_of(
        ("G0", {"X": 10, "Y": 20, "Z": 30}),
        ("G1", {"Z": 20.2, "F": 10}),
        ("G1", {"X": 50, "F": 30}),
    )
    robot = beltgrinding.follow_path(job, milling)
    assert robot.Language == "FreeCAD path" and robot.Lines == [1, 2, 3] and not robot.Problems
    assert list(robot.Rapid) == [True, False, False] and robot.Feeds[1:] == [10, 30]
    frames = contacts(robot)
    assert np.allclose(frames[-1][:3, 3], [50, 20, 20.2])
    assert np.allclose(frames[-1][:3, :3], [[1, 0, 0], [0, -1, 0], [0, 0, -1]])  # z into the part
    simulation = beltgrinding.simulate(job)
    assert simulation.RemovedVolume.Value > 10

    # Whatever the cell, the contact runs where the path is drawn.
    machine.BaseFromWork = FreeCAD.Placement(
        FreeCAD.Vector(500, 0, 100), FreeCAD.Rotation(30, 0, 0)
    )
    machine.TcpFromContact = FreeCAD.Placement(FreeCAD.Vector(0, 0, 80), FreeCAD.Rotation(0, 45, 0))
    doc.recompute()
    robot.touch()
    doc.recompute()
    assert np.allclose(contacts(robot)[-1][:3, 3], [50, 20, 20.2])
    machine.Holding = "part_in_hand"
    machine.TcpFromWork = FreeCAD.Placement(FreeCAD.Vector(5, 0, 100), FreeCAD.Rotation(0, 10, 0))
    machine.BaseFromContact = FreeCAD.Placement(
        FreeCAD.Vector(900, 0, 400), FreeCAD.Rotation(0, 90, 0)
    )
    robot.touch()
    doc.recompute()
    assert np.allclose(contacts(robot)[-1][:3, 3], [50, 20, 20.2])

    # It follows when the path is changed, or moved.
    milling.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 5, 0), FreeCAD.Rotation())
    doc.recompute()
    assert np.allclose(contacts(robot)[-1][:3, 3], [50, 25, 20.2])


@pytest.mark.freecad
def test_arcs_helices_and_rotary_axes():
    here = prepared()
    path_of = here.path_of
    milling = path_of(
        ("G0", {"X": 30, "Y": 20, "Z": 20}),
        ("G2", {"X": 20, "Y": 10, "I": -10, "F": 30}),
        ("G3", {"X": 20, "Y": 10, "Z": 18, "J": 5}),
    )
    program = freecad_path.program_of(milling)
    arrays = program.path_arrays(50)
    points = arrays["frames"][:, :3, 3]
    first = arrays["lines"] == 2
    # Clockwise from (30, 20) about (20, 20) to (20, 10): through (27.07, 12.93), not the far way.
    assert np.allclose(np.linalg.norm(points[first][:, :2] - [20, 20], axis=1), 10, atol=1e-6)
    assert points[first][:, 1].max() < 20
    helix = points[arrays["lines"] == 3]
    assert np.allclose(np.linalg.norm(helix[:, :2] - [20, 15], axis=1), 5, atol=1e-6)
    assert (np.diff(helix[:, 2]) < 0).all() and abs(helix[-1][2] - 18) < 1e-9 and len(helix) > 40
    assert helix[:, 1].max() > 19.9  # all around

    # A = 90 turns the path about x by -90 degrees, as FreeCAD draws it: z becomes y.
    milling = path_of(
        ("G0", {"X": 0, "Y": 0, "Z": 10}), ("G1", {"X": 5, "Y": 0, "Z": 10, "A": 90, "F": 20})
    )
    last = freecad_path.program_of(milling).motions[-1].pose
    assert np.allclose(last[:3, 3], [5, 10, 0]) and np.allclose(last[:3, 2], [0, -1, 0])
    assert len(freecad_path.program_of(milling).motions) > 20  # the turn is resolved

    milling = path_of(
        ("G0", {"X": 0, "Y": 0, "Z": 10}), ("G81", {"Z": -5, "R": 2}), ("G1", {"X": 5})
    )
    problems = freecad_path.program_of(milling).problems
    assert "G81" in str(problems[0]) and "Contour" in str(problems[0])


@pytest.mark.freecad
def test_a_trajectory_of_the_robot_workbench():
    here = prepared()
    contacts, doc, job = here.contacts, here.doc, here.job
    trajectory = doc.addObject("Robot::TrajectoryObject", "Trajectory")
    content = trajectory.Trajectory
    turn = FreeCAD.Rotation(FreeCAD.Vector(1, 0, 0), 180)
    for x, kind, speed in ((10, "PTP", 100), (30, "LIN", 25), (50, "CIRC", 35)):
        place = FreeCAD.Placement(FreeCAD.Vector(x, 20, 20.2), turn)
        content.insertWaypoints(Robot.Waypoint(place, kind, f"P{x}", float(speed)))
    trajectory.Trajectory = content
    doc.recompute()
    robot = beltgrinding.follow_path(job, trajectory)
    assert list(robot.Rapid) == [True, False, False] and robot.Feeds[1:] == [25, 35]
    assert np.allclose(contacts(robot)[:, :3, 3], [[10, 20, 20.2], [30, 20, 20.2], [50, 20, 20.2]])
    assert "P50" in robot.Problems[0]


@pytest.mark.freecad
def test_what_holds_no_path_is_refused():
    here = prepared()
    doc, job, part, path_of = here.doc, here.job, here.part, here.path_of

    def refuse(source, *parts):
        names = [o.Name for o in doc.Objects]
        try:
            beltgrinding.follow_path(job, source)
            raise AssertionError("it was taken")
        except beltgrinding.InputError as error:
            assert all(text in str(error) for text in parts), error
        assert [o.Name for o in doc.Objects] == names

    refuse(part, "Block", "no path")
    refuse(path_of(("G1", {"X": 1})), "two at least")


@pytest.mark.freecad
def test_a_path_s_roll_is_chosen_and_kept_with_the_document():
    here = prepared()
    contacts, doc, job, path_of = here.contacts, here.doc, here.job, here.path_of
    corner = path_of(
        ("G0", {"X": 10, "Y": 10, "Z": 30}),
        ("G1", {"Z": 20, "F": 10}),
        ("G1", {"X": 50}),
        ("G1", {"Y": 30}),
    )
    robot = beltgrinding.follow_path(job, corner)
    x = lambda: [np.round(f[:3, 0], 6).tolist() for f in contacts(robot)]
    assert x() == [[1, 0, 0]] * 4, x()
    robot.Roll = "fixed"
    robot.RollDirection = FreeCAD.Vector(0, 2, 0)
    doc.recompute()
    assert x() == [[0, 1, 0]] * 4, x()
    robot.Roll = "along"
    doc.recompute()
    assert len(robot.Poses) > 4 and x()[-1] == [0, 1, 0], x()

    open("p.apt", "w").write("UNITS/MM\nGOTO/10,10,20,0,0,1\nGOTO/50,10,20\nGOTO/50,30,20\nFINI\n")
    made = set_up.import_program(job, "p.apt")
    held = [p.Rotation.Q for p in made.Poses]
    made.Roll = "fixed"
    doc.recompute()
    made.RollDirection = FreeCAD.Vector(0, 1, 0)
    doc.recompute()
    assert [p.Rotation.Q for p in made.Poses] != held and made.isValid()
    doc.saveAs("roll.FCStd")
    name = made.Name
    FreeCAD.closeDocument(doc.Name)
    again = FreeCAD.openDocument("roll.FCStd").getObject(name)
    assert again.Roll == "fixed" and again.RollOfPoses.startswith("fixed")
    again.Roll = "hold"
    again.Document.recompute()
    assert np.allclose([p.Rotation.Q for p in again.Poses], held)

    open("p.csv", "w").write("x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,1,0,0,0\n9,0,0,1,0,0,0\n")
    whole = set_up.import_program(again.Document, "p.csv")
    before = list(whole.Poses)
    whole.Roll = "along"
    again.Document.recompute()
    assert not whole.isValid() and list(whole.Poses) == before
