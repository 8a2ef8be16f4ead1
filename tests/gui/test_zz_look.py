from test_examples import PREPARE


def test_look(freecad):
    freecad.run(
        PREPARE
        + """
menu("Example: tap spout on a free belt")
doc = FreeCAD.ActiveDocument
from beltgrinding.gui.common.compat import QtGui
def cell(name, pose=40, side=(-0.9, 0.1, 0.35)):
    Gui.runCommand("BeltGrinding_Cell"); settle()
    window.findChild(QtGui.QSpinBox, "pose").setValue(pose) if window.findChild(QtGui.QSpinBox, "pose") else [s for s in window.findChildren(QtGui.QSlider) if s.isVisible()][0].setValue(pose)
    settle()
    Gui.ActiveDocument.ActiveView.setAnimationEnabled(False)
    from pivy import coin
    from pivy import coin; import numpy as np
    view = Gui.ActiveDocument.ActiveView
    look(side)
    cam = view.getCameraNode()
    c = coin.SbVec3f(0, 0, 80); d = cam.orientation.getValue().multVec(coin.SbVec3f(0, 0, 1))
    cam.position.setValue(c + d * 3000); cam.height.setValue(420)
    Path(name).write_bytes(shot(1000, 600))
    press("Cancel")
doc.RobotPath.ViewObject.Visibility = False
m = doc.BeltMachine
cell("/tmp/look/cell_belt.png")
m.Kind = "platen"
m.PlatenLayers = '[{"thickness_mm": 5, "youngs_modulus_MPa": 2, "poissons_ratio": 0.4}]'
m.PlatenLength = 120
doc.recompute()
cell("/tmp/look/cell_platen.png")
from beltgrinding.gui.panels.panel import edit
for kind in ("contact_wheel", "free_belt", "platen"):
    m.Kind = kind
    edit(m)
    settle()
    window.grab().save("/tmp/look/panel_%s.png" % kind)
    bar = [s for s in window.findChildren(QtGui.QScrollBar) if s.isVisible() and s.maximum() > 100]
    for b in bar: b.setValue(b.maximum() // 2)
    settle()
    window.grab().save("/tmp/look/panel_%s_2.png" % kind)
    press("Cancel")
""",
        window=True,
        fresh=True,
    )
