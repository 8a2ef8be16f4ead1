"""What changes a number without being meant to: the mouse wheel over a panel, Enter in the property
editor."""

import pytest
import FreeCAD
import FreeCADGui as Gui
from FreeCAD import Units
from PySide import QtCore, QtGui

import beltgrinding
from beltgrinding.gui.widgets.quantity_entry import QuantityEntry, written
from support.hands import (
    eventually,
    field,
    menu,
    prepare,
    press,
    settle,
    type_in,
    view_widget,
    visible,
    wait,
    whole_screen,
    window,
)

pytestmark = pytest.mark.freecad(window=True)


def prepared():
    job = prepare()
    doc = job.Document
    return doc, job


def shown(widget):
    if hasattr(widget, "rawValue"):
        return widget.text()
    line = widget.findChild(QtGui.QLineEdit)
    for name in ("currentIndex", "value"):
        found = getattr(widget, name, None)
        if found is not None:
            return found() if callable(found) else found, line and line.text()
    return line.text()


def turn(widget):
    centre = QtCore.QPointF(widget.width() / 2, widget.height() / 2)
    place = QtCore.QPointF(widget.mapToGlobal(centre.toPoint()))
    for steps in (120, 120, -120, -120, -120):
        event = QtGui.QWheelEvent(
            centre,
            place,
            QtCore.QPoint(),
            QtCore.QPoint(0, steps),
            QtCore.Qt.NoButton,
            QtCore.Qt.NoModifier,
            QtCore.Qt.NoScrollPhase,
            False,
        )
        QtGui.QApplication.sendEvent(widget, event)


def wheel():
    KINDS = QtGui.QAbstractSpinBox, QtGui.QComboBox, QtGui.QSlider

    def fields():
        entries = [w for w in visible(QtGui.QLineEdit) if hasattr(w, "rawValue")]
        return entries + [
            w for kind in KINDS for w in visible(kind) if not isinstance(w, QtGui.QScrollBar)
        ]

    def turn_over_all(before):
        view_widget().setFocus()
        found = [w for w in fields() if w not in before]
        for widget in found:
            was = shown(widget)
            turn(widget)
            assert shown(widget) == was, (widget.objectName(), was, shown(widget))
            assert not widget.hasFocus()
            # Nor one that has the keyboard, as the first of a panel, or by the tab key.
            widget.setFocus(QtCore.Qt.TabFocusReason)
            settle()
            turn(widget)
            assert shown(widget) == was, (widget.objectName(), was, shown(widget))
            view_widget().setFocus()
        return len(found)

    return fields, turn_over_all


@pytest.mark.slow
def test_the_mouse_wheel_over_a_panel_changes_no_field():
    doc, job = prepared()
    fields, turn_over_all = wheel()
    raster = beltgrinding.make_raster(job)
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    press("Deviation")
    press("OK")
    others = fields()  # FreeCAD's own
    settings = {o.Name: o.dumpContent() for o in doc.Objects}
    PANELS = {
        "Stock": 1,
        "Belt machine": 10,
        "Belt": 0,
        "Cell": 10,
        "Tolerance zones...": 0,
        "Contact at a pose...": 2,
        "Deviation": 2,
        "Compare a scan...": 2,
    }
    for text, least in PANELS.items():
        menu(text)
        looked = turn_over_all(others)
        assert looked >= least, (text, looked)
        Gui.Control.closeDialog()
        settle()
    for obj in (job, raster, doc.RobotPath):
        Gui.ActiveDocument.setEdit(obj.Name)
        settle()
        assert turn_over_all(others) > 1, obj.Name
        Gui.Control.closeDialog()
        settle()
    menu("Playback")
    wait(lambda: field("BeltGrinding_PlaybackDock").scene is not None)
    assert turn_over_all(others) > 1
    menu("Cross-section")
    assert turn_over_all(others) > 3

    # One that is clicked into is turned by it as ever.
    menu("Belt machine")
    radius = field("WheelRadius")

    def clicked():
        window.activateWindow()  # without a window manager nobody else does
        radius.setFocus()
        settle()
        return radius.hasFocus()

    wait(clicked)
    line = radius if isinstance(radius, QtGui.QLineEdit) else radius.findChild(QtGui.QLineEdit)
    at, button = QtCore.QPointF(3, 3), QtCore.Qt.LeftButton
    for kind in (QtCore.QEvent.MouseButtonPress, QtCore.QEvent.MouseButtonRelease):
        event = QtGui.QMouseEvent(kind, at, button, button, QtCore.Qt.NoModifier)
        QtGui.QApplication.sendEvent(line or radius, event)
    turn(radius)
    settle()
    assert doc.BeltMachine.WheelRadius.Value != 60
    Gui.Control.closeDialog()


def rows(model, parent):
    for row in range(model.rowCount(parent)):
        index = model.index(row, 0, parent)
        yield index
        if not parent.isValid():
            yield from rows(model, index)


def trees():
    return [
        tree
        for tree in visible(QtGui.QTreeView)
        if tree.metaObject().className().endswith("PropertyEditor")
    ]


def listed():
    """{what FreeCAD's property editor calls a property: (its tree, its index)}."""
    return {
        index.data(): (tree, index)
        for tree in trees()
        for index in rows(tree.model(), QtCore.QModelIndex())
        if index.parent().isValid()
    }


def choose_alone(obj):
    """Chooses an object, and waits until the property editor has let go of the last one's properties and has
    this one's. Timers of FreeCAD's do both, and pass a choice over now and then while they are late, on a busy
    machine: then once more, as one would.
    """
    for patience in (1, 2, 4, 8, 16, 32, 64):
        Gui.Selection.clearSelection()
        wait(lambda: not listed())
        settle()
        Gui.Selection.addSelection(obj)
        if eventually(listed, patience):
            return
    raise AssertionError(f"FreeCAD's property editor does not show {obj.Name}")


def editor(obj, name):
    """The open field of a property in FreeCAD's property editor; None: it cannot be edited there."""
    choose_alone(obj)
    label = "".join(" " + c if c.isupper() and i else c for i, c in enumerate(name))
    wait(lambda: label in listed())
    tree, index = listed()[label]
    cell = index.sibling(index.row(), 1)
    tree.setCurrentIndex(cell)
    tree.edit(cell)

    def boxes():
        return [box for box in visible(QtGui.QAbstractSpinBox) if tree.viewport().isAncestorOf(box)]

    return (eventually(boxes, 1) or [None])[0]


def enter(box):
    for kind in (QtCore.QEvent.KeyPress, QtCore.QEvent.KeyRelease):
        key = QtGui.QKeyEvent(kind, QtCore.Qt.Key_Return, QtCore.Qt.NoModifier, chr(13))
        QtGui.QApplication.sendEvent(box, key)
    settle()


def plain(value):
    return float(getattr(value, "Value", value))


def editing():
    KINDS = "Float Precision Length Distance Pressure Force Speed Angle Acceleration".split()

    def enter_everywhere(objects):
        looked = 0
        for obj in objects:
            for name in obj.PropertiesList:
                kind = obj.getTypeIdOfProperty(name).replace("App::Property", "")
                modes = obj.getEditorMode(name)
                if kind not in KINDS or "ReadOnly" in modes or "Hidden" in modes:
                    continue
                setattr(obj, name, 0.000125)
                box = editor(obj, name)
                if box is None:
                    continue
                if kind in ("Float", "Precision"):
                    assert "0.000125" in box.findChild(QtGui.QLineEdit).text(), (obj.Name, name)
                enter(box)
                assert plain(getattr(obj, name)) == 0.000125, (obj.Name, name, getattr(obj, name))
                looked += 1
        return looked

    return enter_everywhere


@pytest.mark.slow
def test_enter_in_the_property_editor_changes_no_number():
    whole_screen()
    doc, job = prepared()
    enter_everywhere = editing()
    assert job.LawCoefficient == 0.000125
    raster = beltgrinding.make_raster(job)
    looked = enter_everywhere([job, doc.Stock, doc.BeltMachine, raster])
    assert looked > 50, looked
    # What is out of bounds is still told, not cut to size without a word.
    job.LawCoefficient = -1.0
    assert job.LawCoefficient == -1.0
    job.SpeedExponent = -0.5
    doc.saveAs("small.FCStd")
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument("small.FCStd")
    job = doc.BeltGrindingJob
    assert job.LawCoefficient == -1.0 and job.SpeedExponent == -0.5
    job.LawCoefficient = -2.0
    assert job.LawCoefficient == -2.0


def test_numbers_of_an_older_document_are_kept_with_their_expressions():
    doc, job = prepared()

    def old(name, value):
        job.removeProperty(name)
        job.addProperty("App::PropertyFloat", name, "Law", "")
        setattr(job, name, value)

    old("LawCoefficient", 4.5e-6)
    old("SpeedExponent", -0.25)
    job.setExpression("SpeedExponent", "-0.125 * 2")
    doc.recompute()
    doc.saveAs("old.FCStd")
    FreeCAD.closeDocument(doc.Name)
    doc = FreeCAD.openDocument("old.FCStd")
    job = doc.BeltGrindingJob
    assert job.getTypeIdOfProperty("LawCoefficient") == "App::PropertyPrecision"
    assert job.LawCoefficient == 4.5e-6 and job.SpeedExponent == -0.25
    assert job.ExpressionEngine == [("SpeedExponent", "-0.125 * 2")], job.ExpressionEngine
    assert "Touched" not in job.State, job.State


def test_settings_that_grind_nothing_are_told():
    doc, job = prepared()
    job.LawCoefficient = 0.0
    menu("Simulate")
    wait(lambda: doc.getObject("Simulation") is not None)
    texts = [label.text() for label in visible(QtGui.QLabel)]
    assert any("“Belt-grinding job: K” is 0" in text for text in texts), texts


def test_an_entry_shows_the_units_of_the_trade_and_takes_any():
    doc, _ = prepared()
    machine = doc.BeltMachine
    machine.BeltSpeed = "20 m/s"
    menu("Belt machine")
    assert field("BeltSpeed").text() == "20 m/s", field("BeltSpeed").text()
    for typed, value, text in (
        ("25", 25000, "25 m/s"),
        ("18 m/s", 18000, "18 m/s"),
        ("15000 mm/s", 15000, "15 m/s"),
        ("1,5", 1500, "1.5 m/s"),
        ("2 * 11", 22000, "22 m/s"),
        ("1200 m/min", 20000, "20 m/s"),
    ):
        type_in("BeltSpeed", typed)
        assert abs(machine.BeltSpeed.Value - value) < 1e-6, (typed, machine.BeltSpeed)
        assert field("BeltSpeed").text() == text, (typed, field("BeltSpeed").text())
    for bad in ("3 mm", "-4", "fast", ""):
        line = field("BeltSpeed")
        line.selectAll()
        line.insert(bad) if bad else line.clear()
        assert line.styleSheet() and abs(machine.BeltSpeed.Value - 20000) < 1e-6, bad
        type_in("BeltSpeed", "20 m/s")
        assert not field("BeltSpeed").styleSheet()

    # Up and down, an expression, and a number in its place.
    for key, text in ((QtCore.Qt.Key_Up, "21 m/s"), (QtCore.Qt.Key_Down, "20 m/s")):
        event = QtGui.QKeyEvent(QtCore.QEvent.KeyPress, key, QtCore.Qt.NoModifier)
        QtGui.QApplication.sendEvent(field("BeltSpeed"), event)
        assert field("BeltSpeed").text() == text
    type_in("BeltSpeed", "=10 m/s + 2 m/s")
    assert (
        abs(machine.BeltSpeed.Value - 12000) < 1e-6 and machine.ExpressionEngine
    ), machine.BeltSpeed
    assert field("BeltSpeed").text() == "12 m/s" and field("BeltSpeed").font().italic()
    type_in("BeltSpeed", "14")
    assert not machine.ExpressionEngine and abs(machine.BeltSpeed.Value - 14000) < 1e-6
    type_in("BeltSpeed", "=10 m/s +")  # no expression: marked, and the value stays
    assert field("BeltSpeed").styleSheet() and not machine.ExpressionEngine
    assert "parse" in field("BeltSpeed").toolTip() and "{" not in field("BeltSpeed").toolTip()
    assert abs(machine.BeltSpeed.Value - 14000) < 1e-6
    press("OK")
    assert Gui.Control.activeDialog()
    type_in("BeltSpeed", "14")
    assert not field("BeltSpeed").styleSheet()
    assert not field("BeltSpeed").font().italic()
    press("Cancel")

    # Deviations in mm or micrometres, as the preferences say; what is typed bare is in that.
    assert (
        written(-0.05, "mm") == "-0.05 mm"
        and written(0.0, "N") == "0 N"
        and written(-50e-3, "µm") == "-50 µm"
    )
    entry = QuantityEntry(0.05, Units.Length, "µm")
    assert entry.text() == "50 µm"
    assert written(0.0254, "mil") == "1 mil"
    assert QuantityEntry(0.0, Units.Length, "mil").parsed("2") == 0.0508
    assert QuantityEntry(0.0, Units.Acceleration, "mm/s²").parsed("500 mm/s²") == 500.0
    assert (
        entry.parsed("70") == 0.07
        and entry.parsed("0.07 mm") == 0.07
        and abs(entry.parsed("30 um") - 0.03) < 1e-12
    )
