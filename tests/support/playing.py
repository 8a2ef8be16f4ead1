"""What the tests of playback begin with, run inside FreeCAD."""

PREPARE = """
import numpy as np
from pathlib import Path
from support.hands import *
from support.picture import coloured
job = prepare()
doc = job.Document
Gui.Selection.clearSelection()
view = Gui.ActiveDocument.ActiveView
view.setAnimationEnabled(False)
view.viewTop()
view.fitAll()
settle()

def record():
    menu("Playback")
    dock = field("BeltGrinding_PlaybackDock")
    press("Simulate with recording")
    wait(lambda: dock.scene is not None)
    return dock

def brown(name):
    settle()
    view.saveImage(name, 500, 400, "White")
    return coloured(name)[0]
"""
