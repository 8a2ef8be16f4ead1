"""What the tests of plans begin with; imported inside FreeCAD."""

import FreeCAD
import Part

import beltgrinding
from support.hands import fit_view, start


def prepared():
    """A block with a raster path, to be planned; returns its document, job and path."""
    start()
    doc = FreeCAD.newDocument("work")
    doc.UndoMode = 1
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(60, 40, 20)
    doc.recompute()
    job = beltgrinding.make_job(part, ["Face6"], Spacing="1 mm")
    beltgrinding.make_stock(job, Allowance="0.2 mm")
    beltgrinding.make_belt_machine(
        job, WheelRadius=30, WheelWidth="15 mm", CrownRadius="80 mm", Force="30 N"
    )
    path = beltgrinding.make_raster(
        job, Along="direction", Direction=FreeCAD.Vector(1, 0, 0), Feed="90 mm/s"
    )
    doc.recompute()
    fit_view()
    return doc, job, path
