"""FreeCAD runs this at start, with and without a window."""

import FreeCAD

FreeCAD.addImportType(
    "Robot program (*.src *.csv *.mod *.modx *.prg *.script *.apt *.cls *.nc *.ngc *.mpf)",
    "beltgrinding.objects.importer",
)
