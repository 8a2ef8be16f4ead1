"""The fields that a message names are links to where they can be set."""

import FreeCADGui as Gui
import pytest
from PySide import QtGui

import beltgrinding
from beltgrinding.engine import InputError
from beltgrinding.gui.common import field_links
from beltgrinding.gui.common.messages import report
from support.hands import field, menu, prepare, press, settle, start, wait, window

pytestmark = pytest.mark.freecad(window=True)


def label_of_the_message():
    (box,) = [one for one in window.findChildren(QtGui.QMessageBox) if one.isVisible()]
    return box.findChild(QtGui.QLabel, "qt_msgbox_label")


def links(label):
    """{text: address} of the links in a label."""
    found = {}
    for part in label.text().split('<a href="')[1:]:
        address, _, rest = part.partition('"')
        found[rest.partition(">")[2].partition("</a>")[0]] = address
    return found


def follow(label, text):
    label.linkActivated.emit(links(label)[text])
    settle()


def has_the_focus(name):
    wait(lambda: window.focusWidget() is not None and is_within(window.focusWidget(), name), 5)


def is_within(widget, name):
    while widget is not None:
        if widget.objectName() == name:
            return True
        widget = widget.parentWidget()
    return False


def test_a_panel_that_runs_leads_to_the_panel_of_the_field():
    job = prepare()
    job.WearModel = "none"
    job.Document.recompute()
    menu("Belt plan...")
    press("Plan")
    wait(lambda: "Model" in field("state").text(), 60)
    follow(field("state"), "Belt-grinding job: Model")
    has_the_focus("WearModel")
    press("Cancel")


def test_a_message_leads_there_and_goes():
    job = prepare()
    Gui.Selection.clearSelection()
    words = "{key} is 0 < 1; or see sampling.spacing_mm and hdf5.chunks."
    report(InputError("job.wrong", words, key="belt_machine.force_N"))
    label = label_of_the_message()
    found = links(label)
    assert list(found) == ["Belt machine: Force", "Belt-grinding job: Sample spacing"], label.text()
    assert "is 0 &lt; 1" in label.text()
    report(InputError("job.wrong", "Another."))
    assert len(links(label_of_the_message())) == 2 and "Another." in label.text()
    follow(label, "Belt machine: Force")
    has_the_focus("Force")
    assert not [one for one in window.findChildren(QtGui.QMessageBox) if one.isVisible()]
    press("Cancel")
    assert job.Document.UndoCount == 0


def test_of_several_paths_the_one_that_is_named():
    job = prepare()
    one, other = (beltgrinding.make_raster(job) for _ in range(2))
    text = f"{other.Label}: “Raster path: Step-over” is 0"
    label = QtGui.QLabel()
    field_links.show(label, text, field_links.objects_of(job))
    assert links(label) == {"Raster path: Step-over": f"{other.Name}.StepOver"}
    field_links.show(label, text.replace(other.Label, one.Label + ", "), [one, other])
    assert links(label) == {"Raster path: Step-over": f"{one.Name}.StepOver"}


def test_what_no_panel_shows_is_chosen_in_the_tree():
    job = prepare()
    machine = next(obj for obj in job.Group if hasattr(obj, "WheelRadius"))
    field_links.go_to(job.Document.Name, f"{machine.Name}.ContactTolerance")
    settle()
    assert Gui.Selection.getSelection() == [machine]
    press("Cancel")


def test_without_a_job_there_is_no_link():
    start()
    report(InputError("job.wrong", "{key} is 0", key="belt_machine.force_N"))
    label = label_of_the_message()
    assert label.text() == "“Belt machine: Force” is 0"
    label.window().close()
