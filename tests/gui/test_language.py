"""FreeCAD in German: menus, panels and messages of the workbench."""

LANGUAGE = """
import FreeCAD
general = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/General")
general.SetString("Language", "German")
FreeCAD.saveParameter("User parameter")
"""

GERMAN = """
import os
from support.hands import *

Gui.activateWorkbench("BeltGrindingWorkbench")
window.showMaximized()
settle()
names = [a.text().replace("&", "") for a in window.menuBar().actions()]
assert "Bandschleifen" in names, names
assert Gui.getWorkbench("BeltGrindingWorkbench").MenuText == "Bandschleifen"
bar = next(a for a in window.menuBar().actions() if a.text().replace("&", "") == "Bandschleifen")
entries = [a.text().replace("&", "") for a in bar.menu().actions() if a.text()]
assert entries[:3] == ["Neuer Auftrag", "Rohteil", "Bandschleifmaschine"], entries
assert not {"Simulate", "Deviation", "New job"} & set(entries), entries
Gui.runCommand("BeltGrinding_ExampleBlade")
settle()
doc = FreeCAD.ActiveDocument
for name in ("BeltGrindingJob", "Stock", "BeltMachine", "RobotPath"):
    view = doc.getObject(name).ViewObject
    assert view.Proxy.doubleClicked(view)
    settle()
    if "PICTURES" in os.environ:
        screenshot(Path(os.environ["PICTURES"], f"{name}.png"))
    if name == "BeltGrindingJob":
        labels = {w.text() for w in window.findChildren(QtGui.QLabel) if w.isVisible()}
        assert "Abtastabstand" in labels and "Sample spacing" not in labels, labels
        type_in("LawCoefficient", "0,07")  # a comma, as Germans write it
        assert doc.BeltGrindingJob.LawCoefficient == 0.07
    buttons = [b for b in window.findChildren(QtGui.QPushButton) if b.isVisible()]
    next(b for b in buttons if b.text().replace("&", "") in ("OK", "Ok")).click()
    settle()
Gui.Selection.clearSelection()
Gui.Selection.addSelection(doc.BeltGrindingJob)
Gui.runCommand("BeltGrinding_Simulate")
wait(lambda: doc.getObject("Simulation") is not None, 120)
assert field("state").text() == "Fertig."
if "PICTURES" in os.environ:
    screenshot(Path(os.environ["PICTURES"], "simulation.png"))
"""


def test_german(freecad):
    freecad.run(LANGUAGE)
    freecad.run(GERMAN, window=True, fresh=True)
