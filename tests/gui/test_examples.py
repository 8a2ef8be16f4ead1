"""The examples beside the blade: from the menu to deviation and playback, and the pictures of them."""

import json
from pathlib import Path

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
from PIL import Image
from PySide import QtGui

from beltgrinding.objects.fields import field_of
from support import animation, tutorial
from support import pictures, synthetic_finish
from support.hands import (
    choose,
    example,
    field,
    menu,
    picture,
    press,
    settle,
    type_in,
    wait,
    walked,
    whole_screen,
    window,
)


def ground(direction):
    """Grinds the example, seen along a direction; the panel of the deviation is open."""
    doc = FreeCAD.ActiveDocument
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None, 200)
    press("Deviation")
    look(direction)
    return doc


def look(direction):
    view = Gui.ActiveDocument.ActiveView
    away = FreeCAD.Vector(*direction).normalize()
    level = FreeCAD.Vector(0, 0, 1).cross(-away).normalize()
    up = (-away).cross(level)
    view.setCameraOrientation(
        FreeCAD.Placement(
            FreeCAD.Matrix(
                level.x, up.x, -away.x, 0, level.y, up.y, -away.y, 0, level.z, up.z, -away.z, 0
            )
        ).Rotation.Q
    )
    view.fitAll()
    settle()


def nearer(share):
    Gui.ActiveDocument.ActiveView.getCameraNode().height.setValue(
        share * Gui.ActiveDocument.ActiveView.getCameraNode().height.getValue()
    )
    settle()


def shot(width, height):
    """The 3D view alone, as the bytes of a PNG."""
    settle()
    Gui.ActiveDocument.ActiveView.saveImage("shot.png", width, height, "White")
    return Path("shot.png").read_bytes()


def prepared():
    Gui.activateWorkbench("BeltGrindingWorkbench")
    whole_screen()
    settle()


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_tap():
    prepared()
    example("Mixer tap")
    doc = ground((-0.75, 0.55, -0.45))
    assert 85 < float(tutorial.statistics()["In tolerance"].split()[0]) < 95
    picture("example-tap")
    press("OK")
    doc.RobotPath.ViewObject.Visibility = False
    nearer(0.78)
    pictures.keep("tap", shot(1000, 600))

    # The wheel runs over it, and leaves the hollow brown.
    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    wait(lambda: dock.scene is not None, 200)
    scene = dock.scene
    scene.cell.root.removeChild(scene.cell.robot.root)  # it stands between the eye and the tap
    assert 50_000 < len(animation.play(dock, "tap")) < 1_500_000
    dock.close()
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_tap_on_a_free_belt():
    prepared()
    example("Tap spout on a free belt")
    doc = ground((-0.75, 0.55, -0.45))
    assert 65 < float(tutorial.statistics()["In tolerance"].split()[0]) < 85
    picture("example-tap-belt")
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_blade_with_fillet_and_edges():
    prepared()
    example("Blade with fillet and edges")
    doc = ground((0.85, -0.6, -0.35))
    assert 85 < float(tutorial.statistics()["In tolerance"].split()[0]) < 95
    picture("example-vane")
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_edges_of_a_blade():
    prepared()
    example("Edges of a compressor blade")
    ground((0.85, -0.6, -0.35))
    press("OK")
    menu("Verdict")
    wait(lambda: field("sections").rowCount() == 8)
    told = [field("sections").item(0, k).text() for k in range(4)]
    assert told[:3] == ["mid span: chord", "39.999", "40.199"]
    assert 39.95 < float(told[3]) < 40.05


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_knife():
    prepared()
    example("Chef's knife")
    doc = ground((-0.5, 0.8, -0.4))
    assert 90 < float(tutorial.statistics()["In tolerance"].split()[0]) < 98
    picture("example-knife")
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_blades_temperatures():
    prepared()
    example("Compressor blade")
    job = FreeCAD.ActiveDocument.BeltGrindingJob
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    field("foldHeat").click()
    choice = field("thermalPreset", QtGui.QComboBox)
    choice.setCurrentIndex(choice.findText("Titanium alloy Ti-6Al-4V"))
    press("OK")
    doc = ground((-0.5, 2, -0.6))
    deviation = doc.Deviation
    assert 20 < deviation.GreatestTemperature < deviation.GreatestTemperatureAtMost
    colours = field("ColourBy", QtGui.QComboBox)
    colours.setCurrentIndex(colours.findText("Greatest temperature"))
    settle()
    picture("heat-blade")
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_the_blades_finish():
    prepared()
    example("Compressor blade")
    job = FreeCAD.ActiveDocument.BeltGrindingJob
    job.ViewObject.Proxy.doubleClicked(job.ViewObject)
    settle()
    field("foldFinish").click()
    field("finishChoice", QtGui.QComboBox).setCurrentIndex(1)
    Path("roughness.json").write_text(json.dumps(synthetic_finish.model()))
    choose("roughness.json")
    field("readFinishModel").click()
    type_in("grit", "120")
    type_in("initial_Ra_um", "1.6")
    press("OK")
    doc = ground((-0.5, 2, -0.6))
    assert 0.2 < doc.Deviation.MeanRoughness < 1.2
    # Rougher than it was before at a border alone, as far as the greatest pressure there makes it by the model.
    field_there = field_of(doc.Deviation.Simulation)
    found = np.asarray(field_there.finish["roughness"], dtype=float)
    roughest = int(np.nanargmax(found))
    assert np.nanpercentile(found, 99.9) < 1.61
    pressed = float(field_there.trace["peak_pressure"][roughest])
    most = {"grit": 120, "pressure_MPa": pressed, "belt_speed_m_s": 20, "feed_mm_s": 50}
    assert found[roughest] <= synthetic_finish.steady({**most, "remaining_cut": 1.0})
    colours = field("ColourBy", QtGui.QComboBox)
    colours.setCurrentIndex(colours.findText("Roughness"))
    settle()
    picture("finish-blade")
    pictures.check(*walked())


def test_the_readme_shows_an_animation():
    kept = pictures.IMAGES / "tap.gif"
    assert "docs/images/tap.gif" in (pictures.ROOT / "README.md").read_text()
    with Image.open(kept) as shown:
        seconds = sum(time_of(shown, k) for k in range(shown.n_frames)) / 1000.0
    assert kept.stat().st_size < 1_500_000 and 3.0 <= seconds <= 6.0


def time_of(image, frame):
    image.seek(frame)
    return image.info["duration"]
