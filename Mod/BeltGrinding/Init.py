"""FreeCAD runs this at start, with and without a window."""

import FreeCAD

FreeCAD.addImportType(
    "Robot program (*.src *.csv *.mod *.modx *.prg *.script *.ls *.jbi "
    "*.apt *.cls *.cl *.pgx *.dtx *.urp *.nc *.ngc *.mpf)",
    "beltgrinding.objects.importer",
)
