"""Run by the FreeCAD of a fresh system: the workbench is there, the example blade is ground, the
manual opens. Ends FreeCAD with a status; report.txt in the home says what was seen.
"""

import os
import sys
import traceback
from pathlib import Path

MOD = Path("/usr/share/freecad/Mod/BeltGrinding")


def work():
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    import FreeCAD
    import FreeCADGui as Gui

    assert "BeltGrindingWorkbench" in Gui.listWorkbenches(), list(Gui.listWorkbenches())
    from support import hands

    Gui.activateWorkbench("BeltGrindingWorkbench")
    import beltgrinding

    assert Path(beltgrinding.__file__).parents[1] == MOD, beltgrinding.__file__
    hands.menu("Example: compressor blade")
    doc = FreeCAD.ActiveDocument
    hands.menu("Simulate")
    hands.wait(lambda: doc.getObject("Simulation") is not None, 300)
    hands.press("Deviation")
    deviation = doc.Deviation
    assert deviation.ViewObject.Coloring
    assert 5 < deviation.InTolerance < 95 and deviation.Minimum < 0 < deviation.Maximum
    hands.press("OK")
    hands.menu("Help")
    assert "tutorial" in hands.field("BeltGrinding_ManualView").toPlainText().lower()
    version = ".".join(FreeCAD.Version()[:2])
    return f"FreeCAD {version}: {deviation.InTolerance:.1f} % of the blade in tolerance"


status, report = 1, ""
try:
    report = work()
    status = 0
except BaseException:
    report = traceback.format_exc()
finally:
    Path.home().joinpath("report.txt").write_text(report + "\n")
    os._exit(status)
