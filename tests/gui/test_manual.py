"""The steps of docs/workbench*.md on the example blade, as a person does them; its pictures are taken here."""

import importlib.util
import json
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from beltgrinding.calibration import calibrate as calibration, plot as calibration_plot
from beltgrinding.gui.scene.camera import look_at
from support import pictures
from support.hands import (
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
    widgets,
)


def edit(obj):
    assert obj.ViewObject.Proxy.doubleClicked(obj.ViewObject)
    settle()


def tree(obj):
    """Waits until the tree, which FreeCAD brings up to date now and then, shows an object."""
    exactly = QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive
    trees = widgets(QtGui.QTreeWidget)
    wait(lambda: any(widget.findItems(obj.Label, exactly, 0) for widget in trees), 10)


def pixels(name, at=None):
    """(n, 3) colours of the 3D view."""
    import numpy as np

    Gui.ActiveDocument.ActiveView.saveImage(name, 400, 300, "White")
    image = QtGui.QImage(name).convertToFormat(QtGui.QImage.Format_RGB888)
    data = bytes(image.constBits())[: image.bytesPerLine() * image.height()]
    rows = np.frombuffer(data, np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, : 3 * image.width()].reshape(-1, 3).astype(int)


def blade():
    Gui.activateWorkbench("BeltGrindingWorkbench")
    whole_screen()
    example("Compressor blade")
    doc = FreeCAD.ActiveDocument
    job = doc.BeltGrindingJob
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    look_at(FreeCAD.Vector(0.35, -0.9, 0.3))

    def simulated():
        menu("Simulate")
        wait(lambda: doc.getObject("Simulation") is not None and not doc.Simulation.OutOfDate, 200)

    return SimpleNamespace(doc=doc, job=job, simulated=simulated, view=view)


def test_every_picture_of_the_manual_is_made_by_one_test():
    shown, made = pictures.referenced(), pictures.made_by()
    assert sorted(set(shown) - set(made)) == [], "shown, and no test makes them"
    assert sorted(set(made) - set(shown)) == [], "made, and no page shows them"
    assert {name: files for name, files in made.items() if len(files) > 1} == {}
    kept = {path.stem for path in pictures.IMAGES.glob("*.png")}
    assert kept == set(shown)


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_setting_up():
    here = blade()
    doc, job = here.doc, here.job
    edit(job)
    face = job.DesignFaces[0][1][0]
    Gui.Selection.addSelection(doc.Name, "Design", face)
    assert "samples" in field("note").text() or field("Spacing").isVisible()
    picture("workbench-job")
    press("OK")
    Gui.Selection.clearSelection()

    menu("Belt machine")
    assert field("WheelRadius").isVisible() and field("wheelPreset").isVisible()
    picture("workbench-belt-machine")
    press("OK")

    edit(doc.RobotPath)
    field("poseNumber").setValue(160)
    assert field("poses").currentIndex().row() == 159
    picture("workbench-program")
    press("OK")

    menu("Cell")
    field("poseNumber").setValue(60)
    assert field("Holding").isVisible() and field("BaseFromWork").isVisible()
    picture("workbench-cell")
    press("OK")

    doc.RobotPath.ViewObject.Visibility = False
    doc.Design.ViewObject.Deviation = 0.01  # or coarse triangles hide parts of the passes
    menu("Raster path...")
    type_in("ApproachLength", "20 mm")
    type_in("Clearance", "20 mm")
    raster = doc.RasterPath
    wait(lambda: raster.Clearance.Value == 20 and raster.PassCount > 5)
    # The panel's timer has its turn, or the passes may be those before the last field.
    for _ in range(2):
        begun = time.monotonic()
        wait(lambda: time.monotonic() > begun + 1.0)
        doc.recompute()
    Gui.SendMsgToActiveView("ViewFit")
    for obj in (raster, doc.Stock, doc.BeltMachine):
        tree(obj)
    picture("workbench-raster")
    press("Cancel")
    assert doc.getObject("RasterPath") is None
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_results():
    here = blade()
    doc, view = here.doc, here.view
    menu("Simulate")
    wait(lambda: "in tolerance" in field("state").text(), 200)
    tree(doc.Simulation)
    picture("workbench-simulation")
    camera = view.getCamera()
    kinds = field("eventKind")
    kinds.setCurrentIndex(kinds.findData("collision"))
    field("events").selectRow(0)
    picture("workbench-events")
    view.setCamera(camera)
    press("Deviation")
    deviation = doc.Deviation
    tree(deviation)
    assert deviation.ViewObject.Coloring and not doc.Design.ViewObject.Visibility
    seen = pixels("deviation.png")
    red, blue = seen[:, 0], seen[:, 2]
    assert (red > blue + 60).sum() > 1500 and (
        blue > red + 60
    ).sum() > 200  # brown and blue, not grey
    picture("workbench-deviation")
    press("OK")

    camera = Gui.ActiveDocument.ActiveView.getCamera()
    menu("Verdict")
    tree(doc.Verdict)
    clusters = field("clusters")
    deep = next(
        k for k in range(clusters.rowCount()) if clusters.item(k, 1).text() == "cut too deep"
    )
    clusters.setCurrentCell(deep, 0)
    settle()
    assert field("motions").rowCount() > 3
    field("motions").setCurrentCell(0, 0)
    assert field("source").textCursor().blockNumber() > 10  # the line is marked
    picture("workbench-verdict")
    field("BeltGrinding_VerdictDock").close()
    Gui.ActiveDocument.ActiveView.setCamera(camera)

    menu("Cross-section")
    field("sectionKind").setCurrentIndex(2)
    Gui.SendMsgToActiveView("ViewFit")
    tree(doc.Section)
    assert field("sectionPlot").plot is not None
    picture("workbench-section")
    field("BeltGrinding_SectionDock").close()
    doc.Section.ViewObject.Visibility = False

    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    wait(lambda: dock.scene is not None, 200)
    field("timeSlider").setValue(55_000)
    settle()
    seen = pixels("half.png")
    assert (seen[:, 0] > seen[:, 2] + 60).sum() > 1500  # what is not ground yet
    picture("workbench-playback")
    dock.close()

    # It is not grey after it was saved and opened again.
    Path("results").mkdir(exist_ok=True)
    path = str(Path("results/blade.FCStd").resolve())
    camera = view.getCamera()
    doc.saveAs(path)
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument(path)
    settle()
    view = Gui.ActiveDocument.ActiveView
    view.setCamera(camera)
    doc.RobotPath.ViewObject.Visibility = False
    seen = pixels("reopened.png")
    red, blue = seen[:, 0], seen[:, 2]
    assert (red > blue + 60).sum() > 1500 and (blue > red + 60).sum() > 200
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.skipif(
    importlib.util.find_spec("beltgrinding_scan") is None, reason="built without nanoflann"
)
@pytest.mark.freecad(window=True, fresh=True)
def test_the_ground_part_and_its_scan():
    here = blade()
    doc, job = here.doc, here.job
    doc.RobotPath.ViewObject.Visibility = False
    said = job.LawCoefficient
    job.LawCoefficient = 1.25 * said  # the real belt takes more than its law says
    menu("Simulate")
    wait(lambda: "in tolerance" in field("state").text(), 200)
    press("Close")
    menu("Ground part as mesh")
    ground = doc.GroundPart
    tree(ground)
    assert ground.Closed and ground.ViewObject.Coloring
    seen = pixels("ground.png")
    assert (seen[:, 0] > seen[:, 2] + 60).sum() > 300
    picture("ground-mesh")
    scan = ground.Mesh.copy()
    scan.translate(0.4, -0.3, 0.5)
    scan.write(str(Path("scan.stl").resolve()))
    ground.ViewObject.Visibility = False

    job.LawCoefficient = said
    menu("Simulate")
    wait(lambda: "in tolerance" in field("state").text(), 200)
    press("Deviation")
    press("OK")
    menu("Compare a scan...")
    type_in("scan", str(Path("scan.stl").resolve()))
    press("Compare")
    wait(lambda: field("compare").isEnabled(), 200)
    assert field("figures").rowCount() == 9
    assert doc.Simulation.DifferenceMean.Value < -0.03
    picture("workbench-scan")
    press("OK")
    pictures.check(*walked())


@pytest.mark.slow
@pytest.mark.freecad(window=True, fresh=True)
def test_uncertainty():
    here = blade()
    doc, job, simulated = here.doc, here.job, here.simulated
    job.Law, job.WearModel, job.WearScale = "local", "exponential", 40000
    calibration = {
        "parameters": ["coefficient", "pressure_exponent"],
        "covariance": [[0.0025, 0.001], [0.001, 0.02]],
        "scatter": 0.08,
    }
    job.Calibration = json.dumps(calibration)
    simulated()
    assert doc.Simulation.RemainingCut < 99
    press("Deviation")
    field("ColourBy").setCurrentIndex(1)
    settle()
    assert doc.Deviation.Uncertainty95.Value > 0
    picture("workbench-uncertainty")
    press("OK")
    pictures.check(*walked())


def test_the_report_of_a_calibration():
    """Grinds of a law that is made up, two of them spoilt."""
    random, count = np.random.default_rng(4), 48
    force = random.choice([10.0, 20.0, 35.0, 60.0], count)
    speed = random.choice([12.0, 18.0, 25.0, 32.0], count)
    area = random.choice([80.0, 150.0, 300.0], count)
    time = random.choice([5.0, 10.0, 20.0], count)
    work = np.cumsum(force * speed * time)
    rate = 1.5e-6 * 20e3 * (speed / 20) ** 1.2 * 0.1 * (force / area / 0.1) ** 1.4
    removed = area * time * rate * np.exp(-work / 4e5) * np.exp(0.07 * random.normal(size=count))
    removed[[7, 30]] *= (1.9, 0.5)  # a burr left on, a slipped part
    table = {
        "force_N": force,
        "belt_speed_m_s": speed,
        "area_mm2": area,
        "time_s": time,
        "work_J": work,
        "removed_volume_mm3": removed,
    }
    report = calibration.fit(table)["report"]
    pictures.keep("calibration", calibration_plot.render(report, dpi=80))
    pictures.check(pictures.RELEASE, ["calibration"])
