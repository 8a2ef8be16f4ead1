"""Run inside FreeCAD with a window: takes the pictures of docs/workbench.md anew.

    source tools/setup.sh && in_freecad freecad "$root/tools/manual_pictures.py"
"""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))
IMAGES = ROOT / "docs" / "images"

import FreeCAD  # noqa: E402
import FreeCADGui as Gui  # noqa: E402
from support import hands  # noqa: E402


def take(name):
    hands.screenshot(IMAGES / f"{name}.png")


def main():
    sys.path.insert(0, str(ROOT / "Mod" / "BeltGrinding"))
    from beltgrinding.gui.camera import look_at

    Gui.activateWorkbench("BeltGrindingWorkbench")
    hands.window.showMaximized()
    hands.menu("Example: compressor blade")
    doc = FreeCAD.ActiveDocument
    Gui.ActiveDocument.ActiveView.setAnimationEnabled(False)
    look_at(FreeCAD.Vector(0.35, -0.9, 0.3))
    view = doc.BeltGrindingJob.ViewObject
    view.Proxy.doubleClicked(view)
    Gui.Selection.addSelection(doc.Name, "Design", f"{doc.BeltGrindingJob.DesignFaces[0][1][0]}")
    take("workbench-job")
    hands.press("OK")
    Gui.Selection.clearSelection()
    hands.menu("Belt machine")
    take("workbench-belt-machine")
    hands.press("OK")
    view = doc.RobotPath.ViewObject
    view.Proxy.doubleClicked(view)
    hands.settle()
    hands.field("poseNumber").setValue(160)
    take("workbench-program")
    hands.press("OK")
    hands.menu("Cell")
    hands.field("poseNumber").setValue(60)
    take("workbench-cell")
    hands.press("OK")
    shown = [obj.ViewObject for obj in doc.Objects if hasattr(obj, "Poses")]
    for program in shown:
        program.Visibility = False
    doc.Design.ViewObject.Deviation = 0.01  # or coarse triangles hide parts of the passes
    hands.menu("Raster path...")
    hands.type_in("ApproachLength", "20 mm")
    hands.type_in("Clearance", "20 mm")
    hands.wait(lambda: doc.RasterPath.Clearance.Value == 20)
    Gui.SendMsgToActiveView("ViewFit")
    take("workbench-raster")
    hands.press("Cancel")
    for program in shown:
        program.Visibility = True
    hands.menu("Simulate")
    hands.wait(lambda: doc.getObject("Simulation") is not None)
    take("workbench-simulation")
    hands.press("Deviation")
    take("workbench-deviation")
    hands.press("OK")
    hands.menu("Cross-section")
    hands.field("sectionKind").setCurrentIndex(2)
    Gui.SendMsgToActiveView("ViewFit")
    take("workbench-section")
    hands.field("BeltGrinding_SectionDock").close()
    doc.Section.ViewObject.Visibility = False
    hands.menu("Playback")
    dock = hands.field("BeltGrinding_PlaybackDock")
    hands.press("Simulate with recording")
    hands.wait(lambda: dock.scene is not None)
    hands.field("timeSlider").setValue(55_000)
    take("workbench-playback")
    dock.close()
    job = doc.BeltGrindingJob
    job.Law, job.WearModel, job.WearScale = "local", "exponential", 40000
    calibration = {
        "parameters": ["coefficient", "pressure_exponent"],
        "covariance": [[0.0025, 0.001], [0.001, 0.02]],
        "scatter": 0.08,
    }
    job.Calibration = json.dumps(calibration)
    hands.menu("Simulate")
    hands.wait(lambda: not doc.Simulation.OutOfDate and doc.Simulation.RemainingCut < 99)
    hands.press("Deviation")
    box = hands.field("ColourBy")
    box.setCurrentIndex(1)
    hands.settle()
    take("workbench-uncertainty")


main()
