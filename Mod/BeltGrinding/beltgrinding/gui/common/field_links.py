"""Messages whose fields are links: a click opens the panel that has the field, and goes there."""

from __future__ import annotations

import contextlib
import html

import FreeCAD
import FreeCADGui as Gui

from ...objects.kinds import DocumentObject
from ...objects.living import GONE
from ...objects.properties import property_of
from . import field_words
from .chosen import active_job
from .compat import QtCore, QtGui
from .editing import edit
from .field_labels import LABELS
from .kinds import Widget
from .theme import theme

SLIDES_IN = 300  # ms


def show(label: Widget, text: str, among: list[DocumentObject]) -> None:
    """Sets a QLabel's text, with a link on each field that one of the objects has."""
    fields = _fields(text, among)
    if not fields:
        label.setText(text)
        return
    rich = html.escape(text, quote=False).replace("\n", "<br>")
    for words, (obj, names) in fields.items():
        address, colour = ".".join([obj.Name, *names]), theme().warning
        link = f'<a href="{address}" style="color: {colour}">{html.escape(words[1:-1], quote=False)}</a>'
        rich = rich.replace(html.escape(words, quote=False), words[0] + link + words[-1])
    label.setText(f"<span>{rich}</span>")


def link(box: Widget, text: str) -> None:
    """The same for a QMessageBox, on the fields of the job that is chosen."""
    label, job = box.findChild(QtGui.QLabel, "qt_msgbox_label"), active_job()
    if label is None or job is None:
        return
    show(label, text, objects_of(job))
    label.setTextInteractionFlags(QtCore.Qt.TextBrowserInteraction)
    document = job.Document.Name

    def follow(address: str) -> None:
        box.close()
        go_to(document, address)

    with contextlib.suppress(
        RuntimeError
    ):  # of an earlier message in this box, of another document
        label.linkActivated.disconnect()
    label.linkActivated.connect(follow)


def objects_of(job: DocumentObject) -> list[DocumentObject]:
    """A job and all that is in it, the selected first."""
    selected = Gui.Selection.getSelection(job.Document.Name)
    found = [job, *job.OutListRecursive]
    return sorted(found, key=lambda obj: obj not in selected)


def _fields(text: str, among: list[DocumentObject]) -> dict[str, tuple[DocumentObject, list[str]]]:
    """{a field's name in the text, in quotation marks: (the object that has it, its property, or those that a panel
    shows by the same name)}"""
    keys: dict[str, list[str]] = {}
    for key in LABELS:
        if (words := field_words.named(key)) and words in text:
            keys.setdefault(words, []).append(key)
    found: dict[str, tuple[DocumentObject, list[str]]] = {}
    for words, mine in keys.items():
        # Of several raster paths the one that the message names, "Path001" rather than "Path".
        rest = text.replace(words, "")
        named = [(len(obj.Label) if obj.Label in rest else 0) for obj in among]
        for _, obj in sorted(zip(named, among), key=lambda one: -one[0]):
            if names := [name for key in mine if (name := property_of(obj, key))]:
                found[words] = obj, names
                break
    return found


def go_to(document: str, address: str) -> None:
    """Opens the panel of the object of a link, if no other is open, and goes to the field."""
    name, *fields = address.split(".")
    try:
        obj = FreeCAD.getDocument(document).getObject(name)
    except GONE:
        return
    if obj is None or any(map(focus, fields)):
        return
    edit(obj)
    if not any(map(focus, fields)):  # only FreeCAD's property editor has it
        Gui.Selection.clearSelection()
        Gui.Selection.addSelection(obj)


def focus(name: str) -> bool:
    """Unfolds, shows and chooses the field in the panel that is open; whether it has one."""
    for field in Gui.getMainWindow().findChildren(QtGui.QWidget, name):
        panel = field.parentWidget()
        while panel is not None and not panel.windowTitle():
            if hasattr(panel, "fold"):
                panel.fold(False)
            panel = panel.parentWidget()
        if panel is not None and field.isVisibleTo(panel):
            # FreeCAD slides a panel in, and lays it out then.
            QtCore.QTimer.singleShot(SLIDES_IN, lambda: _choose(field))
            return True
    return False


def _choose(field: Widget) -> None:
    try:
        field.setFocus()
    except GONE:
        return  # closed again
    entry = field if isinstance(field, QtGui.QLineEdit) else field.findChild(QtGui.QLineEdit)
    if entry is not None:
        entry.selectAll()
    area = field.parentWidget()
    while area is not None and not isinstance(area, QtGui.QScrollArea):
        area = area.parentWidget()
    if area is not None:
        area.ensureWidgetVisible(field)
