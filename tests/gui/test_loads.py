"""Force, feed and the belt's travel as arrows at the contact: where the cell is drawn, for every machine and mounting."""

import os

import numpy as np
import pytest
import FreeCADGui as Gui
from PySide import QtGui

from beltgrinding.base.frames import base_from_tcp, work_from_frames
from beltgrinding.gui.scene import cell_view, loads
from beltgrinding.objects import robot_path
from support.hands import field, menu, prepare, press, screenshot, settle, wait
from support.playing import prepared, record
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)
SHOTS = os.environ.get("BELTGRINDING_SHOTS")


def watched():
    """A list that every cell which is drawn from now on joins."""
    cells, init = [], cell_view.CellView.__init__

    def began(self, *arguments):
        cells.append(self)
        init(self, *arguments)

    patch(cell_view.CellView, "__init__", began)
    texts, label = {}, loads.label

    def named(text, colour):
        node = label(text, colour)
        texts[colour] = text
        return node

    patch(loads, "label", named)
    return cells, texts


def drawn(cell):
    """{colour: (tail, unit direction), in the part's frame} of a cell's arrows."""
    found = {}
    if not cell.loads.getNumChildren():
        return found
    contact = cell.frames()["contact"]
    node = cell.loads.getChild(0)
    for k in range(2, node.getNumChildren()):
        tone, place, _ = (node.getChild(k).getChild(0).getChild(i) for i in range(3))
        frame = contact @ np.array(place.matrix.getValue().getValue()).T
        assert np.linalg.det(frame[:3, :3]) > 0
        size = np.linalg.norm(frame[:3, 1])
        colour = loads._packed(tone.rgb[0].getValue())
        found[colour] = frame[:3, 3], frame[:3, 1] / size, size
    return found


FORCE, FEED, BELT = "#c2148c", "#00859e", "#6b40cc"  # of the arrows


@pytest.mark.parametrize("kind", ["contact_wheel", "small_wheel", "free_belt", "platen"])
def test_the_arrows_say_what_acts(kind):
    job = prepare()
    doc, machine, path = job.Document, job.Document.BeltMachine, job.Document.RobotPath
    machine.Kind = kind
    cells, texts = watched()
    # With the part in hand the robot's poses are other ones; the contact runs over the part as it did.
    contacts = work_from_frames(path.Proxy.arrays(path)["frames"], **machine.Proxy.cell(machine))
    contacts = contacts["contact"]
    for holding in ("tool_in_hand", "part_in_hand"):
        machine.Holding = holding
        cell = machine.Proxy.cell(machine)
        cell["tcp_from_work"][:3, 3] = 3, -4, 50
        view = cell_view.CellView(doc, machine)
        view.cell = lambda cell=cell: cell
        view.set_path(base_from_tcp(contacts, **cell), robot_path.as_run(path))
        for pose in (0, 4, 8):
            view.set_pose(pose)
            arrows = drawn(view)
            tail, way, length = arrows[FORCE]
            # From the wheel into the part, whose upper face looks along z; its tip lies at the contact.
            np.testing.assert_allclose(way, [0, 0, -1], atol=1e-6)
            np.testing.assert_allclose(tail + length * way, contacts[pose][:3, 3], atol=1e-4)
            tail, way, length = arrows[FEED]
            np.testing.assert_allclose(tail, contacts[pose][:3, 3], atol=1e-4)
            np.testing.assert_allclose(way, [1, 0, 0], atol=1e-6)  # the pass goes along x
            tail, way, length = arrows[BELT]
            np.testing.assert_allclose(way, contacts[pose][:3, 0], atol=1e-6)
            # Beside what presses, along its axis.
            aside = contacts[pose][:3, :3].T @ (tail - contacts[pose][:3, 3])
            across = (
                machine.WheelWidth if kind in ("contact_wheel", "small_wheel") else machine.RunWidth
            )
            np.testing.assert_allclose(aside[[0, 2]], 0, atol=1e-4)
            assert 0.5 * across.Value < aside[1] < across.Value
        assert texts[FORCE] == "Force 30 N"
        assert texts[FEED] in ("Feed 30 mm/s", "Feed of the part 30 mm/s")
        assert texts[BELT] == "Belt 20 m/s"
        if holding == "part_in_hand":
            # The part is seen moving: the arrow is its own feed, along which its points are drawn to go.
            view.set_moving(True)
            point, seen = np.append(contacts[3][:3, 3], 1.0), []
            for pose in (3, 4):
                view.set_pose(pose)
                carried = view.carried(view.frames())
                seen.append(carried @ point)
            view.set_pose(3)
            carried = view.carried(view.frames())
            way = carried[:3, :3] @ drawn(view)[FEED][1]
            goes = (seen[1] - seen[0])[:3]
            np.testing.assert_allclose(way, goes / np.linalg.norm(goes), atol=1e-6)
            assert texts[FEED].startswith("Feed of the part ")
        view.close()


def test_the_arrows_follow_program_and_control():
    job = prepare()
    doc, machine, path = job.Document, job.Document.BeltMachine, job.Document.RobotPath
    cells, texts = watched()
    path.ForceOverride, path.FeedOverride = "12 N", "20 mm/s"
    path.Rapid = [False] * 5 + [True] + [False] * 3
    doc.recompute()
    menu("Cell")
    assert {FORCE, FEED, BELT} == set(drawn(cells[-1]))
    assert texts[FORCE] == "Force 12 N" and texts[FEED] == "Feed 20 mm/s"
    field("poseNumber").setValue(5)  # the motion that begins here is rapid
    assert {FEED, BELT} == set(drawn(cells[-1])) and texts[FEED] == "Feed rapid"
    # The view's property turns them off and on, at once, here and after undo.
    doc.openTransaction("off")
    machine.ViewObject.Loads = False
    settle()
    assert not drawn(cells[-1])
    machine.ViewObject.Loads = True
    settle()
    assert drawn(cells[-1])
    machine.BeltSpeed = "12 m/s"
    settle()
    assert texts[BELT] == "Belt 12 m/s"
    press("Cancel")
    # Under position control nobody sets a force.
    machine.Control = "position"
    path.ViewObject.Proxy.doubleClicked(path.ViewObject)
    settle()
    assert {FEED, BELT} == set(drawn(cells[-1]))
    press("Cancel")


def test_a_playback_shows_the_force_of_the_moment():
    job, doc, view = prepared()
    cells, texts = watched()
    dock = record()
    scene, machine = dock.scene, doc.BeltMachine
    dock.go(0.5 * scene.duration)
    settle()
    arrows = drawn(scene.cell)
    np.testing.assert_allclose(arrows[FORCE][1], [0, 0, -1], atol=1e-6)
    np.testing.assert_allclose(arrows[FEED][1], [1, 0, 0], atol=1e-6)
    assert texts[FORCE] == "Force 30 N" and texts[FEED] == "Feed 30 mm/s", texts
    for moment in (0.0, scene.duration):  # the ends of the program move, too
        dock.go(moment)
        np.testing.assert_allclose(drawn(scene.cell)[FEED][1], [1, 0, 0], atol=1e-6)
    # Nothing presses where the recording has no step.
    assert loads.at_moment(scene.steps, -5.0, np.zeros(3), np.zeros(3)).force == 0.0
    dock.go(0.5 * scene.duration)
    view.viewIsometric()
    view.fitAll()
    settle()
    if SHOTS:
        screenshot(f"{SHOTS}/loads-playback.png")
    seen = _pixels(view, "with.png")
    machine.ViewObject.Loads = False
    settle()
    assert not drawn(scene.cell)
    without = _pixels(view, "without.png")
    assert seen > without + 200, (seen, without)
    dock.close()


def _pixels(view, name):
    """How many pixels have the colour of the force's or the feed's arrow."""
    view.saveImage(name, 500, 400, "White")
    image, wanted = QtGui.QImage(name), (FORCE, FEED)
    tones = {QtGui.QColor(one).getRgb()[:3] for one in wanted}
    return sum(image.pixelColor(x, y).getRgb()[:3] in tones for x in range(500) for y in range(400))
