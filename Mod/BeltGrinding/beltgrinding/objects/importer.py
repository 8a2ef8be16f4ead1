"""FreeCAD's File > Open and Import for robot programs."""

from pathlib import Path

import FreeCAD

from . import api


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
