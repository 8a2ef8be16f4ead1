"""Run by freecadcmd: writes the example blade to the folder BELTGRINDING_OUT."""

import os
import sys
import traceback
from pathlib import Path

status = 1
try:
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from beltgrinding.examples import blade

    blade.make(os.environ["BELTGRINDING_OUT"])
    status = 0
except BaseException:
    traceback.print_exc()
finally:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # freecadcmd would wait at a prompt and end with 0 whatever happened
