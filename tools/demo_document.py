"""Run inside FreeCAD with a window: grinds the example blade as a macro would, and writes the
document, a picture of it and the numbers to the folder BELTGRINDING_OUT.
"""

import os
from pathlib import Path

import FreeCAD
import FreeCADGui
from beltgrinding.gui.scene.camera import look_at
from beltgrinding.objects import api

out = Path(os.environ["BELTGRINDING_OUT"])
job = api.open_example(out)
simulation = api.simulate(job, write_to=out)
api.make_deviation(job)
for part, _ in job.DesignFaces:
    part.ViewObject.Visibility = False  # it would hide what is cut below it
normals = simulation.Proxy.field(simulation).normals
look_at(FreeCAD.Vector(*normals.mean(axis=0).tolist()))
FreeCADGui.ActiveDocument.ActiveView.saveImage(str(out / "deviation.png"), 1400, 1000, "White")
job.Document.saveAs(str(out / "deviation.FCStd"))
