"""Hands and eyes of a person at FreeCAD's window; imported inside FreeCAD."""

import re
import time
from pathlib import Path

import FreeCAD
import FreeCADGui as Gui
import Part
from PySide import QtCore, QtGui

import beltgrinding
from support import pictures
from support.restoring import patch

SMALL = (
    1000,
    700,
)  # pixels; one more is one more that software draws in each frame, the view and all else
window = Gui.getMainWindow() if FreeCAD.GuiUp else None
if window is not None:
    window.setAnimated(False)  # a dock that slides in is not where a click goes
    _large = window.geometry()  # as FreeCAD opens it
    window.resize(*SMALL)
_taken = []  # names of pictures
BUSY = 3
TIME_TAKEN = re.compile(r"(computed in )[\d.,]+ s")


def settle():
    """Lets the window do what it has to do."""
    for _ in range(5):
        Gui.updateGui()
        QtGui.QApplication.processEvents()


def wait(condition, seconds=60, why=lambda: ""):
    """Waits until ``condition()``; on a busy machine ``BUSY`` times the seconds that it takes on a quiet one.
    ``why()``: what the window says where it never is.
    """
    end = time.monotonic() + BUSY * seconds
    while not condition():
        assert time.monotonic() < end, f"waited in vain; {why()}"
        QtGui.QApplication.processEvents()
        time.sleep(0.01)
    settle()


def to_view():
    """Brings the 3D view up where another page lies over it, as a sheet, or FreeCAD's start page,
    which 1.1 opens late: that shows task panels beside a 3D view only.
    """
    settle()
    for area in widgets(QtGui.QMdiArea):
        active = area.activeSubWindow()
        views = [page for page in area.subWindowList() if " : " in page.windowTitle()]
        if views and active not in views:
            area.setActiveSubWindow(views[-1])
            settle()


def menu(text):
    """Chooses an entry of the workbench's menu."""
    to_view()
    bar = {a.text().replace("&", ""): a for a in window.menuBar().actions()}
    assert "Belt grinding" in bar, list(bar)
    action = next(a for a in entries(bar["Belt grinding"]) if a.text().replace("&", "") == text)

    def enabled():
        # FreeCAD looks again whether it is when something has happened, as the mouse that goes there.
        QtCore.QMetaObject.invokeMethod(window, "_updateActions")
        return action.isEnabled()

    wait(enabled, 20, action.toolTip)
    assert not action.icon().isNull() and action.toolTip()
    action.trigger()
    settle()


def example(title):
    """Sets up an example by the dock of the examples."""
    menu("Examples...")
    shown = field("examples", QtGui.QTreeWidget)
    (item,) = shown.findItems(title, QtCore.Qt.MatchExactly | QtCore.Qt.MatchRecursive)
    shown.setCurrentItem(item)
    press("Set up")
    bury()


def entries(action):
    """The entries of an action's menu, those of its submenus too."""
    for one in action.menu().actions():
        if one.menu() is None:
            yield one
        else:
            yield from entries(one)


def widgets(kind, name=None):
    """FreeCAD's widgets of a kind, and of an object name if one is given.

    Not by the window's findChildren: PySide then keeps what it found as long as ``window``, also
    widgets of FreeCAD's own classes of which nobody tells it that they are gone; it takes a new one
    at the same address for the old one.
    """
    found = [widget for widget in QtGui.QApplication.allWidgets() if isinstance(widget, kind)]
    return [widget for widget in found if name is None or widget.objectName() == name]


if window is not None:  # the docks with which FreeCAD opens
    _docks = {dock.objectName() for dock in widgets(QtGui.QDockWidget) if dock.isVisible()}


def visible(kind, name=None):
    """The visible ones of ``widgets``, as one reads them."""

    def place(widget):
        corner = widget.mapToGlobal(QtCore.QPoint(0, 0))
        return corner.y(), corner.x()

    return sorted((widget for widget in widgets(kind, name) if widget.isVisible()), key=place)


def eventually(find, seconds=20):
    """What ``find`` finds, as soon as it is something: FreeCAD 1.1 slides its docks in."""
    end = time.monotonic() + seconds
    while not (found := find()) and time.monotonic() < end:
        QtGui.QApplication.processEvents()
        time.sleep(0.01)
    return found


def field(name, kind=QtGui.QWidget):
    """The visible widget of this object name."""
    found = eventually(lambda: visible(kind, name))
    assert len(found) == 1, (name, found)
    return found[0]


def type_in(name, text):
    """Types a value into a field, as a person does."""
    line = field(name)
    if not isinstance(line, QtGui.QLineEdit):
        line = line.findChild(QtGui.QLineEdit)
    line.setFocus()
    line.selectAll()
    line.insert(text)
    line.editingFinished.emit()
    settle()


def press(text):
    """Presses the visible button with this text."""

    def named():
        return [b for b in visible(QtGui.QPushButton) if b.text().replace("&", "") == text]

    found = eventually(named)
    assert found, text
    found[0].click()
    settle()


def view_widget():
    """The widget in which the 3D view is drawn."""
    drawn = [w for w in visible(QtGui.QWidget) if w.metaObject().className() == "QOpenGLWidget"]
    return max(drawn, key=lambda w: w.width() * w.height())  # 1.1 has a small one besides


def bring_up(widget):
    """Chooses the tabs, or the docks, behind which a widget lies."""
    for dock in widgets(QtGui.QDockWidget):
        if dock is widget or dock.isAncestorOf(widget):
            dock.show()
            dock.raise_()
    # Not by parentWidget: once PySide lets go of the parent it takes the child for deleted.
    for kind in (QtGui.QTabWidget, QtGui.QStackedWidget):
        for pages in widgets(kind):
            for page in range(pages.count() if pages.isAncestorOf(widget) else 0):
                if widget.isVisibleTo(pages):
                    break
                pages.setCurrentIndex(page)
    settle()
    assert widget.isVisible()


def strike(widget, key):
    """Strikes a key ("1", "V", " ") over a widget."""
    window.activateWindow()  # without a window manager nobody else does after a dialog
    widget.setFocus()
    settle()
    for kind in (QtCore.QEvent.KeyPress, QtCore.QEvent.KeyRelease):
        event = QtGui.QKeyEvent(kind, ord(key.upper()), QtCore.Qt.NoModifier, key)
        QtGui.QApplication.sendEvent(widget, event)
    settle()


def key(code, modifiers=QtCore.Qt.NoModifier, text=""):
    """Strikes a key, of Qt, where the keyboard's focus is."""
    window.activateWindow()
    settle()
    for kind in (QtCore.QEvent.KeyPress, QtCore.QEvent.KeyRelease):
        widget = QtGui.QApplication.focusWidget()
        if widget is not None:
            QtGui.QApplication.sendEvent(widget, QtGui.QKeyEvent(kind, code, modifiers, text))
    settle()


def click_at(x, y):
    """A click into the 3D view, at device pixels from its lower left."""
    widget = view_widget()
    ratio = widget.devicePixelRatioF()
    at = QtCore.QPointF(round(x / ratio), widget.height() - 1 - round(y / ratio))
    place = QtCore.QPointF(widget.mapToGlobal(at.toPoint()))
    for kind in (QtCore.QEvent.MouseButtonPress, QtCore.QEvent.MouseButtonRelease):
        button, none = QtCore.Qt.LeftButton, QtCore.Qt.NoModifier
        QtGui.QApplication.sendEvent(
            widget, QtGui.QMouseEvent(kind, at, place, button, button, none)
        )
    settle()


def choose(path):
    """Makes the next file dialog answer with ``path``."""
    patch(QtGui.QFileDialog, "getOpenFileName", staticmethod(lambda *a, **k: (str(path), "")))


def name_file(path, kind=""):
    """Makes the next dialog for a file to be written answer with ``path`` and the filter ``kind``."""
    patch(QtGui.QFileDialog, "getSaveFileName", staticmethod(lambda *a, **k: (str(path), kind)))


def bury():
    """Deletes what is to be deleted later, as boxes and views: FreeCAD's event loop does it, under which the
    tests do not run.
    """
    QtCore.QCoreApplication.sendPostedEvents(None, int(QtCore.QEvent.DeferredDelete))


def put_away():
    """Closes panels, docks and messages; chooses nothing."""
    Gui.Control.closeDialog()
    main = Gui.getMainWindow()  # a walk along the focus chain may have spoilt the other wrapper
    settle()
    for dock in widgets(QtGui.QDockWidget):
        if dock.objectName() not in _docks:  # an error opens FreeCAD's report view
            dock.close()
    for box in widgets(QtGui.QMessageBox):
        box.close()
        box.deleteLater()
    for other in widgets(QtGui.QWidget):  # the manual, the report
        if other.isWindow() and other.isVisible() and not other.findChildren(QtGui.QMdiArea):
            other.close()  # not the main window, whichever wrapper Python has for it
    for tabs in widgets(QtGui.QTabWidget, "combiTab"):
        tabs.setCurrentIndex(0)  # the model: what a deleted panel leaves there may not be it
    Gui.Selection.clearSelection()
    main.statusBar().clearMessage()
    _taken.clear()
    main.showNormal()
    main.resize(*SMALL)


def screenshot(path):
    """The whole screen as a PNG."""
    settle()
    # The X server's root window: a grab of FreeCAD's own shows the 3D view empty.
    assert QtGui.QGuiApplication.primaryScreen().grabWindow(0).save(str(path)), path


def picture(name):
    """A picture of the manual: the whole screen, to build/pictures. One that is not as the manual's is
    taken once more, twice at most, later: what FreeCAD still had to do may have begun after the screen was at rest.
    """
    assert window.size() == _large.size(), "whole_screen() first"
    pictures.MADE.mkdir(parents=True, exist_ok=True)
    replaced = _as_everywhere()
    for quiet in (0.7, 3, 6):
        _come_to_rest(quiet)
        screenshot(pictures.MADE / f"{name}.png")
        if not pictures.stale([name]):
            break
    for widget, text in replaced:
        _set_silently(widget, text)
    _taken.append(name)


def _come_to_rest(quiet, patience=3, most=30):
    """Waits until the screen has shown the same for ``quiet`` seconds: FreeCAD greys out its buttons and
    brings its tree and status bar up to date by timers of its own, late on a busy machine. Its bar of
    loading may come when the loading is over, and then stay: after ``patience`` seconds it is put away.
    """
    screen, begun = QtGui.QGuiApplication.primaryScreen(), time.monotonic()
    seen, since = None, begun
    while time.monotonic() - begun < most:
        settle()
        time.sleep(0.1)
        status = window.statusBar()
        left_over = [bar for bar in visible(QtGui.QProgressBar) if status.isAncestorOf(bar)]
        if left_over and time.monotonic() - begun > patience:
            for bar in left_over:
                bar.hide()
            for label in visible(QtGui.QLabel):
                if status.isAncestorOf(label) and label.text().endswith("..."):
                    label.clear()
        shown = screen.grabWindow(0).toImage()
        if shown != seen or left_over:
            seen, since = shown, time.monotonic()
        elif time.monotonic() - since > quiet:
            return


def _as_everywhere():
    """Shows what every computer or test run writes otherwise as one text: the time that a simulation
    took, the folder of a file; and an empty clipboard, by which *Paste* is grey. The tree is without the keyboard's
    focus, which frames a line of it and comes there, or not, by chance. Returns [(widget, its text)].
    """
    focused = QtGui.QApplication.focusWidget()
    if focused is not None and focused.metaObject().className() == "Gui::TreeWidget":
        focused.clearFocus()
    QtGui.QApplication.clipboard().clear()
    QtGui.QApplication.setCursorFlashTime(0)
    replaced = []
    for kind in (QtGui.QLabel, QtGui.QLineEdit):
        for widget in visible(kind):
            text = TIME_TAKEN.sub(r"\g<1>2.0 s", widget.text())
            if kind is QtGui.QLineEdit and Path(text).is_absolute():
                text = Path(text).name
            if text != widget.text():
                replaced.append((widget, widget.text()))
                _set_silently(widget, text)
    return replaced


def _set_silently(widget, text):
    """Sets a text of which only the screen hears."""
    before = widget.blockSignals(True)
    widget.setText(text)
    widget.blockSignals(before)


def walked():
    """([FreeCAD's major and minor release], names of the pictures taken since it was asked last)."""
    names, _taken[:] = list(_taken), []
    return [int(part) for part in FreeCAD.Version()[:2]], names


def start():
    """Opens the workbench and writes pass.csv, one pass over the block."""
    rows = [f"{x},20,20.2,0,1,0,0,30" for x in range(10, 51, 5)]
    header = "x_mm,y_mm,z_mm,qw,qx,qy,qz,feed_mm_s"
    Path("pass.csv").write_text("\n".join([header, *rows]) + "\n")
    Gui.activateWorkbench("BeltGrindingWorkbench")
    settle()


def whole_screen():
    """Makes the window as large as FreeCAD opens it and pictures show it, until the test's end."""
    window.setGeometry(_large)
    window.showMaximized()  # without a window manager that takes the grip of its corner alone
    settle()


def fit_view():
    """Shows the whole document, from an oblique direction."""
    Gui.activeDocument().activeView().viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    settle()


def prepare():
    """A job that can be simulated: a block with stock, belt machine and one pass; returns the job. Made
    as a macro does it, which takes a tenth of the time, and the same as ``prepare_by_hand`` leaves it.
    """
    part = _block()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="0.6 mm")
    beltgrinding.make_stock(job, Allowance="0.2 mm")
    wheel = {"WheelRadius": "60 mm", "RimThickness": "7.5 mm", "WheelWidth": "15 mm"}
    beltgrinding.make_belt_machine(job, **wheel, Force="30 N")
    beltgrinding.import_program(job, "pass.csv")
    job.Document.recompute()
    settle()
    job.Document.commitTransaction()  # FreeCAD may have begun one, and counts it as a step
    job.Document.clearUndos()
    return job


def _block():
    """A block in a new document, its upper face selected."""
    start()
    doc = FreeCAD.newDocument("work")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(doc.Name, "Block", "Face6")
    return part


def prepare_by_hand():
    """From a block to a job that can be simulated, through menus and panels; returns the job."""
    part = _block()
    doc = part.Document
    menu("New job")
    type_in("Spacing", "0.6 mm")
    press("OK")
    job = doc.BeltGrindingJob
    assert job.Spacing.Value == 0.6 and job.DesignFaces == [(part, ("Face6",))]
    menu("Stock")
    type_in("Allowance", "0.2 mm")
    press("OK")
    menu("Belt machine")
    type_in("WheelRadius", "60 mm")
    type_in("WheelWidth", "15 mm")
    type_in("Force", "30 N")
    press("OK")
    machine = doc.BeltMachine
    assert machine.WheelRadius.Value == 60 and machine.Force.getValueAs("N") == 30
    choose("pass.csv")
    menu("Import robot program...")
    press("OK")
    assert doc.RobotPath.PoseCount == 9
    return job
