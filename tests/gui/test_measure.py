"""The ground part's mesh and the comparison with a scan, by the menu and the panel."""

import os
import threading
import time

import pytest
import FreeCAD
import FreeCADGui
import Part

import beltgrinding
from beltgrinding.gui.common.compat import QtGui
from beltgrinding.gui.panels import scan_panel
from support.hands import field, menu, press, settle, type_in, wait

pytestmark = pytest.mark.freecad(window=True)


def test_the_menu_makes_the_mesh_and_compares_a_scan():
    doc = FreeCAD.newDocument("measure")
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    job = beltgrinding.make_job(part, ["Face6"], Spacing="0.6 mm")
    beltgrinding.make_stock(job, Allowance="0.2 mm")
    beltgrinding.make_belt_machine(job, WheelRadius=60, WheelWidth="15 mm", Force="30 N")
    rows = [f"{x},20,20.2,0,1,0,0,30" for x in range(10, 51, 5)]
    open("pass.csv", "w").write("x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s\n" + "\n".join(rows) + "\n")
    beltgrinding.import_program(job, "pass.csv")
    beltgrinding.simulate(job)
    deviation = beltgrinding.make_deviation(job)
    FreeCADGui.activateWorkbench("BeltGrindingWorkbench")
    FreeCADGui.Selection.clearSelection()

    menu("Ground part as mesh")
    ground = doc.GroundPart
    assert ground.Closed and ground.ViewObject.Coloring
    assert len(ground.VertexColors) == ground.Mesh.CountPoints
    doc.undo()
    assert doc.getObject("GroundPart") is None
    doc.redo()
    assert doc.getObject("GroundPart") is not None
    ground = doc.GroundPart

    scan = ground.Mesh.copy()
    scan.translate(0.4, -0.3, 0.5)
    scan.write(os.path.abspath("scan.stl"))
    menu("Compare a scan...")
    assert not field("correctLaw").isEnabled()
    type_in("scan", os.path.abspath("scan.stl"))
    press("Compare")
    table = field("figures")
    (note,) = table.parentWidget().findChildren(QtGui.QLabel, "note")  # not shown while it works
    wait(lambda: field("compare").isEnabled())
    settle()
    assert table.rowCount() == 9, note.text()
    simulation = doc.Simulation
    assert abs(simulation.DifferenceMean.Value) < 0.01, simulation.DifferenceMean
    assert simulation.ScanResidual.Value < 0.02
    assert deviation.ColourBy == "difference"
    # A law that removes as the scan shows stays; one that removes too little is corrected.
    coefficient = job.LawCoefficient
    held = threading.Event()

    def slow(*arguments, context):
        held.set()
        while True:
            context.throw_if_cancelled()
            time.sleep(0.01)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(scan_panel.learning, "learn", slow)
        press("Correct the law")
        assert field("taskBar").isVisible() and not field("correctLaw").isEnabled()
        field("taskCancel").click()
        wait(lambda: field("correctLaw").isEnabled(), 5)
    assert held.is_set() and job.LawCoefficient == coefficient
    press("Correct the law")
    wait(lambda: "the next part" in note.text(), 120)
    assert (
        abs(job.LawCoefficient / coefficient - 1.0) < 0.03 and job.Calibration
    ), job.LawCoefficient
    assert simulation.OutOfDate and not field("correctLaw").isEnabled()
    FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    settle()
    press("Cancel")
    assert not getattr(doc.Simulation, "ScanFigures", "")
    assert job.LawCoefficient == coefficient
    assert deviation.ColourBy == "deviation"
    assert len(simulation.Proxy.field(simulation).measured) == 0

    # What is held stays as it starts: the scan lies 0.5 mm too high.
    menu("Compare a scan...")
    type_in("scan", os.path.abspath("scan.stl"))
    for name in ("tz", "rx", "ry", "rz"):
        field(name).setChecked(True)
    field("share").setValue(95)
    press("Compare")
    wait(lambda: field("compare").isEnabled())
    settle()
    assert 0.4 < simulation.DifferenceMean.Value < 0.6, simulation.DifferenceMean
    # The view has the scan's field, not the one that it drew before.
    crisp = doc.Deviation.ViewObject.Proxy.crisp
    doc.Deviation.ViewObject.Visibility = False
    doc.Deviation.ViewObject.Visibility = True
    assert crisp.shown() and len(crisp.field.measured) == crisp.field.size
    press("Cancel")
    FreeCAD.closeDocument(doc.Name)
