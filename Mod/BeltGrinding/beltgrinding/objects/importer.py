"""FreeCAD's File > Open and Import for robot programs."""

from pathlib import Path

import FreeCAD

from . import api

# Suffixes that FreeCAD's spreadsheets and CAM read too: with the workbench open it asks who shall.
SHARED_TYPE = (
    "Robot program, milling program or table (*.csv *.nc *.ngc *.gcode *.tap)",
    "beltgrinding.objects.importer",
)


def open(path):
    """Opens a robot program as a new document."""
    document = FreeCAD.newDocument(Path(path).stem)
    api.import_program(document, path)
    document.recompute()
    return document


def insert(path, name):
    """Imports a robot program into the document ``name``: into its job, if it has just one."""
    document = FreeCAD.getDocument(name)
    jobs = [obj for obj in document.Objects if api.is_job(obj)]
    api.import_program(jobs[0] if len(jobs) == 1 else document, path)
    document.recompute()
