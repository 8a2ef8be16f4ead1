"""The steps of docs/tutorial.md, as a person does them; imported inside FreeCAD.

tests/gui/test_tutorial.py walks them and compares the page's figures and pictures.
"""

import re

import FreeCAD
import FreeCADGui as Gui
from PySide import QtCore, QtGui

from support import hands


def walk():
    """Walks the tutorial and takes its pictures. Returns its figures, as the page writes them."""
    figures = {}
    Gui.activateWorkbench("BeltGrindingWorkbench")
    hands.whole_screen()
    hands.example("Compressor blade")
    doc = FreeCAD.ActiveDocument
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    drawn = hands.view_widget()
    for key in "1VF":
        hands.strike(drawn, key)
    assert view.getViewDirection().isEqual(FreeCAD.Vector(0, 1, 0), 1e-6)
    hands.picture("tutorial-blade")

    open_panel(doc.RobotPath)
    hands.field("poseNumber").setValue(100)
    hands.picture("tutorial-pose")
    hands.press("Cancel")

    hands.menu("Simulate")
    hands.wait(lambda: doc.getObject("Simulation") is not None, 200)
    hands.picture("tutorial-simulation")
    hands.press("Deviation")
    toggle(doc.RobotPath, True)
    toggle(doc.RobotPath, False)
    hands.picture("tutorial-deviation")
    figures.update(statistics())
    hands.press("OK")

    hands.menu("Belt machine")
    hands.type_in("Force", "36 N")
    hands.press("OK")
    assert doc.Simulation.OutOfDate
    hands.picture("tutorial-out-of-date")
    figures["36 N"] = again(doc)
    hands.picture("tutorial-more-force")

    hands.menu("Belt machine")
    hands.type_in("Force", "30 N")
    hands.press("OK")
    figures["30 N"] = again(doc)

    hands.menu("Deviation")
    hands.type_in("ToleranceLower", "-0.03 mm")
    hands.type_in("ToleranceUpper", "0.03 mm")
    figures["0.03 mm"] = statistics()["In tolerance"]
    hands.press("Cancel")
    return figures


def open_panel(obj):
    """A double click in the tree."""
    obj.ViewObject.Proxy.doubleClicked(obj.ViewObject)
    hands.settle()


def toggle(obj, shown):
    """The space bar over the tree, in the tab Model; then back to the panel."""
    panel = hands.field("statistics")
    exactly = QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive
    tree = next(
        tree
        for tree in hands.widgets(QtGui.QTreeWidget)
        if tree.metaObject().className() == "Gui::TreeWidget"
    )
    hands.bring_up(tree)

    def chosen():
        """The tree passes a choice over while it brings itself up to date: then once more, as one would."""
        found = tree.findItems(obj.Label, exactly, 0)
        if found and obj not in Gui.Selection.getSelection():
            tree.clearSelection()
            tree.setCurrentItem(found[0])
            found[0].setSelected(True)
            hands.settle()
        return obj in Gui.Selection.getSelection()

    hands.wait(chosen, 20)
    # Without a window manager a stroke may miss the tree: the command is called that it stands for.
    command = "Std_ToggleVisibility"
    assert Gui.Command.get(command).getShortcut() == "Space"
    Gui.runCommand(command)
    hands.settle()
    assert obj.ViewObject.Visibility == shown
    Gui.Selection.clearSelection()
    hands.bring_up(panel)


def again(doc):
    """Simulates anew; returns the share in tolerance that the panel tells."""
    hands.menu("Simulate")
    hands.wait(lambda: not doc.Simulation.OutOfDate, 200)
    share = re.search(r"[\d.]+ %(?= in tolerance)", hands.field("state").text()).group()
    hands.press("Close")
    return share


def statistics():
    """What the deviation's panel says: {row: text}."""
    table = hands.field("statistics")
    rows = range(table.rowCount())
    return {table.item(row, 0).text(): table.item(row, 1).text() for row in rows}
