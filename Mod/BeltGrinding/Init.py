"""FreeCAD runs this at start, with and without a window."""

import FreeCAD

# What nobody but us reads. Suffixes that FreeCAD knows as something else (tables, milling programs)
# follow when the workbench is opened: before, FreeCAD would ask everyone who opens such a file.
FreeCAD.addImportType(
    "Robot program (*.src *.mod *.modx *.prg *.sys *.script *.ls *.jbi *.apt *.aptsource *.ncl *.cls "
    "*.cl *.h *.pgx *.dtx *.urp *.mpf *.spf *.as *.pg)",
    "beltgrinding.objects.importer",
)
