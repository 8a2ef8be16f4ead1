"""Run by the FreeCAD of a fresh system: the workbench is there; the example tap is ground, planned and reported, and
the manual opens. Ends FreeCAD with a status; report.txt in the home says what was seen.
"""

import os
import sys
import traceback
from pathlib import Path

QUICK = {"Rounds": 1, "Check": False}


def work():
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    import FreeCAD
    import FreeCADGui as Gui

    assert "BeltGrindingWorkbench" in Gui.listWorkbenches(), list(Gui.listWorkbenches())
    from support import hands

    Gui.activateWorkbench("BeltGrindingWorkbench")
    import beltgrinding

    mod = Path(beltgrinding.__file__).resolve().parents[1]
    assert mod.parts[-2:] == ("Mod", "BeltGrinding"), mod
    assert Path(beltgrinding.core.__file__).parent.samefile(mod), beltgrinding.core.__file__
    hands.example("Mixer tap")
    doc = FreeCAD.ActiveDocument
    hands.menu("Simulate")
    hands.wait(lambda: doc.getObject("Simulation") is not None, 600)
    hands.press("Deviation")
    deviation = doc.Deviation
    assert deviation.ViewObject.Coloring
    assert 5 < deviation.InTolerance < 95 and deviation.Minimum < 0 < deviation.Maximum
    hands.press("OK")
    hands.menu("Help")
    assert "tutorial" in hands.field("BeltGrinding_ManualView").toPlainText().lower()

    job = doc.BeltGrindingJob
    report = Path.home() / "tap.html"
    beltgrinding.write_report(job, report)
    page = report.read_text(encoding="utf-8")
    assert "THREE" in page and "REVISION" in page, "the report has no 3D view"
    plan = beltgrinding.make_plan(job, **QUICK)
    scan = beltgrinding.engine.library.extension("beltgrinding_scan")
    version = ".".join(FreeCAD.Version()[:2])
    return (
        f"FreeCAD {version}, Python {sys.version.split()[0]}: the tap has {deviation.InTolerance:.1f} % in tolerance, "
        f"{plan.InTolerance:.1f} % as planned; report of {len(page) / 1e6:.1f} MB; {scan.__name__} is there"
    )


status, report = 1, ""
try:
    report = work()
    status = 0
except BaseException:
    report = traceback.format_exc()
finally:
    Path.home().joinpath("report.txt").write_text(report + "\n")
    os._exit(status)
