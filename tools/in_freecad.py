"""Run by freecad or freecadcmd: runs the Python file BELTGRINDING_RUN, and ends FreeCAD with its
status. FreeCAD alone would wait at a prompt, or end with 0 whatever happened.
"""

import os
import runpy
import sys
import traceback
from pathlib import Path

status = 1
try:
    # The checkout's workbench before an installed one, which FreeCAD has put in front; it clears PYTHONPATH.
    root = Path(__file__).resolve().parents[1]
    sys.path[:0] = [str(root / "Mod" / "BeltGrinding"), str(root / "tests")]
    # Not as __main__: FreeCAD keeps names of its own there, and looks for them.
    runpy.run_path(os.environ["BELTGRINDING_RUN"], run_name="script")
    status = 0
except BaseException:
    traceback.print_exc()
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
