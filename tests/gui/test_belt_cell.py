"""What is drawn of belts without a wheel: a curved platen, the frame, the belt as the part presses it."""

import os
from types import SimpleNamespace

import numpy as np
import pytest
import FreeCADGui as Gui
from PySide import QtGui

from beltgrinding.gui.scene import belt_shapes, cell_view
from support.hands import field, menu, prepare, press, screenshot, settle, type_in, widgets
from support.restoring import patch

pytestmark = pytest.mark.freecad(window=True)


def shown(name):
    return bool([w for w in widgets(QtGui.QWidget, name) if w.isVisible()])


def prepared():
    SHOTS = os.environ.get("BELTGRINDING_SHOTS")

    def shot(name):
        if SHOTS:
            screenshot(f"{SHOTS}/{name}.png")

    cells, init = [], cell_view.CellView.__init__

    def watched(self, *arguments):
        cells.append(self)
        init(self, *arguments)

    patch(cell_view.CellView, "__init__", watched)

    def drawn(name):
        """Points (n, 3) of the nodes of a body, in the contact frame."""
        from pivy import coin

        search = coin.SoSearchAction()
        search.setType(coin.SoCoordinate3.getClassTypeId())
        search.setInterest(coin.SoSearchAction.ALL)
        node = cells[-1].bodies[name]
        if name == "":
            node = next(
                node.getChild(k)
                for k in range(node.getNumChildren())
                if node.getChild(k).getName() == belt_shapes.BELT_NODE
            )
        search.apply(node)
        found = []
        for k in range(search.getPaths().getLength()):
            points = search.getPaths()[k].getTail().point
            found += [tuple(points[i].getValue()) for i in range(points.getNum())]
        return np.array(found)

    job = prepare()
    doc, machine = job.Document, job.Document.BeltMachine
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    return SimpleNamespace(cells=cells, doc=doc, drawn=drawn, machine=machine, shot=shot, view=view)


@pytest.mark.freecad(window=True, fresh=True)
def test_a_curved_platen_is_entered_and_drawn():
    here = prepared()
    cells, drawn, machine, shot, view = here.cells, here.drawn, here.machine, here.shot, here.view
    menu("Belt machine")
    box = field("Kind", QtGui.QComboBox)
    box.setCurrentIndex(box.findText("Platen"))
    settle()
    flat = field("machineDrawing").grab().toImage()
    press("Add layer")
    type_in("PlatenRadius", "50 mm")
    settle()
    press("OK")  # its plate is 120 mm long
    assert Gui.Control.activeDialog() and "60 degrees" in field("note").text(), field("note").text()
    type_in("PlatenRadius", "90 mm")
    settle()
    assert field("machineDrawing").grab().toImage() != flat
    field("foldFrame").click()
    assert not shown("FrameSpread") and not shown("FrameArmSides")
    type_in("FrameLength", "10 mm")
    press("OK")  # the rollers' radius is 25
    assert Gui.Control.activeDialog() and "pulleys" in field("note").text(), field("note").text()
    type_in("FrameLength", "120 mm")
    assert shown("FrameSpread") and not shown("FrameArmSides")
    type_in("FrameArmThickness", "6 mm")
    assert shown("FrameArmSides")
    shot("curved-panel")
    press("OK")
    assert not Gui.Control.activeDialog()
    assert machine.PlatenRadius.Value == 90 and machine.FrameLength.Value == 120
    data = machine.Proxy.to_job(machine)["belt_machine"]
    assert data["platen"]["radius_mm"] == 90 and data["frame"]["arm_sides"] == "both"
    menu("Cell")
    assert set(cells[-1].bodies) == {
        "",
        "roller_before",
        "roller_behind",
        "platen",
        "belt_before",
        "belt_behind",
        "arms",
    }
    view.viewFront()
    view.fitAll()
    settle()
    shot("curved-cell")
    # The belt lies round the plate, on its layers.
    belt = drawn("")
    on = np.abs(belt[:, 0]) < 50
    radii = np.hypot(belt[on][:, 0], belt[on][:, 2] + 91.0)
    assert np.isclose(radii, 91.0, atol=0.03).any() and radii.max() < 91.05
    plate = drawn("platen")
    assert np.hypot(plate[:, 0], plate[:, 2] + 91.0).max() < 85.1  # 5 mm of layer and the belt
    press("Cancel")
    # A radius that cannot be: the cell and the drawing show it flat.
    machine.PlatenRadius = 10
    menu("Cell")
    assert np.ptp(drawn("platen")[:, 2]) < 10.01
    press("Cancel")


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_belt_is_drawn_as_the_part_presses_it():
    here = prepared()
    cells, doc, drawn, machine, shot, view = (
        here.cells,
        here.doc,
        here.drawn,
        here.machine,
        here.shot,
        here.view,
    )
    machine.Kind, machine.RunTension, machine.RunWidth = "free_belt", 3, 30
    doc.recompute()

    def go(z):
        # Pressing down in the middle of the block of 60 x 40 x 20 mm.
        frame = np.diag([1.0, -1.0, -1.0, 1.0])
        frame[:3, 3] = 30, 20, z
        cells[-1].set_frame(frame)
        settle()

    menu("Cell")
    view.viewFront()
    view.fitAll()
    go(30)
    free = drawn("")
    assert free[:, 2].max() < 1e-9 and np.isclose(free[:, 2].max(), 0.0)
    go(16)  # 4 mm into it
    shot("pressed")
    belt = drawn("")
    face = belt[(np.abs(belt[:, 0]) < 29) & (belt[:, 1] > 0)]
    assert np.isclose(face[:, 2].max(), -4.0, atol=0.01), face[:, 2].max()
    # From roller to roller, straight: at 65 mm half of the way down from 30 mm on.
    away = belt[(np.abs(np.abs(belt[:, 0]) - 65.0) < 1.5) & (belt[:, 2] > -5)]
    assert np.isclose(away[:, 2].max(), -2.0, atol=0.15), away
    go(30)
    assert np.isclose(drawn("")[:, 2].max(), 0.0)
    # On a platen it is pressed in where the part is, alone.
    press("Cancel")
    machine.Kind = "platen"
    doc.recompute()
    menu("Cell")
    go(16)
    belt = drawn("")
    away = belt[(np.abs(np.abs(belt[:, 0]) - 65.0) < 1.5) & (belt[:, 2] > -5)]
    assert np.isclose(away[:, 2].max(), 0.0, atol=1e-6), away
    shot("pressed-platen")
    press("Cancel")
