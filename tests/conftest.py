"""What all Python tests share."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
for folder in (ROOT / "Mod" / "BeltGrinding", ROOT / "tests"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))

from support.freecad import freecad  # noqa: E402, F401
