"""FreeCAD's File > Open and Import for robot programs."""

from __future__ import annotations

from pathlib import Path

import FreeCAD

from ..engine import Cancelled
from . import api
from .kinds import Document

# Suffixes that FreeCAD's spreadsheets and CAM read too: with the workbench open it asks who shall.
SHARED_TYPE = (
    "Robot program, milling program or table (*.csv *.nc *.ngc *.gcode *.tap)",
    "beltgrinding.objects.importer",
)


def open(path: Path | str) -> Document | None:
    """Opens a robot program as a new document; None where a person cancels it."""
    document = FreeCAD.newDocument(Path(path).stem)
    try:
        api.import_program(document, path)
    except Cancelled:
        FreeCAD.closeDocument(document.Name)
        return None
    except Exception:
        FreeCAD.closeDocument(document.Name)
        raise
    document.recompute()
    return document


def insert(path: Path | str, name: str) -> None:
    """Imports a robot program into the document ``name``: into its job, if it has just one."""
    document = FreeCAD.getDocument(name)
    jobs = [obj for obj in document.Objects if api.is_job(obj)]
    document.openTransaction(FreeCAD.Qt.translate("BeltGrinding", "Import robot program"))
    try:
        api.import_program(jobs[0] if len(jobs) == 1 else document, path)
    except Cancelled:
        document.abortTransaction()
        return
    except Exception:
        document.abortTransaction()
        raise
    document.recompute()
    document.commitTransaction()
