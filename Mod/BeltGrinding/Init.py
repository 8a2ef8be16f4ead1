"""FreeCAD runs this at start, with and without a window."""

import FreeCAD

FreeCAD.addImportType("Robot program (*.src *.csv)", "beltgrinding.objects.importer")
