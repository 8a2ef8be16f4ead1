"""Run by freecadcmd: prints the folder in which it looks for the user's workbenches."""

import os
import sys

import FreeCAD

print("Mod folder: " + os.path.join(FreeCAD.getUserAppDataDir(), "Mod"))
sys.stdout.flush()
os._exit(0)
