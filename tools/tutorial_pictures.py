"""Run inside FreeCAD with a window: takes the pictures of docs/tutorial.md anew.

    source tools/setup.sh && in_freecad freecad "$root/tools/tutorial_pictures.py"
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from support import hands, tutorial  # noqa: E402

for name, text in tutorial.walk(
    lambda name: hands.screenshot(ROOT / "docs" / "images" / f"{name}.png")
).items():
    print(f"{name}: {text}", file=sys.stderr)
