"""A keyboard: keys as the X server sends them, so that shortcuts and Tab do what they do for a person."""

import ctypes
import time

from PySide import QtCore, QtGui

from support.hands import settle, window

SHIFT, DELAY = "Shift_L", 0.03  # s between two keys
_libraries = []


def _x():
    """(libX11, libXtst, the display)."""
    if not _libraries:
        x11, xtst = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXtst.so.6")
        x11.XOpenDisplay.restype = ctypes.c_void_p
        x11.XStringToKeysym.restype = ctypes.c_ulong
        x11.XKeysymToKeycode.argtypes = ctypes.c_void_p, ctypes.c_ulong
        x11.XSync.argtypes = ctypes.c_void_p, ctypes.c_int
        xtst.XTestFakeKeyEvent.argtypes = (
            ctypes.c_void_p,
            ctypes.c_uint,
            ctypes.c_int,
            ctypes.c_ulong,
        )
        _libraries[:] = x11, xtst, x11.XOpenDisplay(None)
    return _libraries


def press_keys(*names):
    """Strikes keys one after the other, by their X names ("g", "Tab", "Shift+r")."""
    x11, xtst, display = _x()
    for name in names:
        if QtGui.QApplication.activeWindow() is None:
            window.activateWindow()  # without a window manager nobody else does
            settle()
        held = [SHIFT] if name.startswith("Shift+") else []
        struck = [*held, name.rpartition("+")[2]]
        codes = [x11.XKeysymToKeycode(display, x11.XStringToKeysym(one.encode())) for one in struck]
        assert all(codes), name
        for code in codes:
            xtst.XTestFakeKeyEvent(display, code, 1, 0)
        for code in reversed(codes):
            xtst.XTestFakeKeyEvent(display, code, 0, 0)
        x11.XSync(display, 0)
        time.sleep(DELAY)
        settle()


def chain(form):
    """The visible, enabled widgets of a form that Tab reaches, in its order."""
    found, widget, first = [], form.nextInFocusChain(), form
    while widget is not None and widget != first:
        reached = int(widget.focusPolicy()) & int(QtCore.Qt.TabFocus)
        if reached and form.isAncestorOf(widget) and widget.isVisible() and widget.isEnabled():
            if widget.focusProxy() is None:
                found.append(widget)
        widget = widget.nextInFocusChain()
    return found


CONTROLS = (
    QtGui.QAbstractButton,
    QtGui.QLineEdit,
    QtGui.QComboBox,
    QtGui.QAbstractSpinBox,
    QtGui.QAbstractSlider,
    QtGui.QAbstractItemView,
    QtGui.QPlainTextEdit,
)


def unreachable(form):
    """[(kind, object name)] of the controls that can be used with the mouse alone."""
    reached = chain(form)
    found = []
    for widget in form.findChildren(QtGui.QWidget):
        usable = isinstance(widget, CONTROLS) and widget.isVisible() and widget.isEnabled()
        if not usable or isinstance(widget, QtGui.QScrollBar) or widget in reached:
            continue
        # What is a part of a control: a spin box' line, a table's corner, a tab bar's arrows.
        part, whole = widget.parentWidget(), False
        while part is not None and part != form:
            whole = whole or isinstance(part, (*CONTROLS, QtGui.QTabBar)) or part in reached
            part = part.parentWidget()
        if not whole:
            found.append((widget.metaObject().className(), widget.objectName()))
    return found


def out_of_order(form):
    """[(object name, that of the next)] where Tab goes up, or to the left in a row."""

    def box(widget):
        corner = widget.mapTo(form, QtCore.QPoint(0, 0))
        return QtCore.QRect(corner, widget.size())

    found, reached = [], chain(form)
    for one, other in zip(reached, reached[1:]):
        first, then = box(one), box(other)
        above = then.bottom() <= first.top()
        level = then.top() < first.bottom() and then.bottom() > first.top()
        if above or (level and then.right() <= first.left()):
            found.append((_name(one), _name(other)))
    return found


def _name(widget):
    return (
        widget.objectName() or f"{widget.metaObject().className()} {getattr(widget, 'text', str)()}"
    )
