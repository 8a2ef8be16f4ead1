"""What the tests of playback begin with; imported inside FreeCAD."""

import FreeCADGui as Gui

from support.hands import field, menu, prepare, press, settle, wait
from support.picture import coloured


def prepared():
    """A job that can be simulated, seen from above, nothing chosen; returns the job, its document, its view."""
    job = prepare()
    Gui.Selection.clearSelection()
    view = Gui.ActiveDocument.ActiveView
    view.setAnimationEnabled(False)
    view.viewTop()
    view.fitAll()
    settle()
    return job, job.Document, view


def record():
    """Simulates with a recording, by the dock of the playback; returns the dock."""
    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    press("Simulate with recording")
    wait(lambda: dock.scene is not None)
    return dock


def brown(name):
    """How many pixels of the view, which becomes the picture ``name``, are brown."""
    settle()
    Gui.ActiveDocument.ActiveView.saveImage(name, 500, 400, "White")
    return coloured(name)[0]
