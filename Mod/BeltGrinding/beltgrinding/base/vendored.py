"""Pure Python packages that the portable package carries along, for a Python that has none of them."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1] / "vendored"


def offer() -> None:
    """Lets Python look there last, so that an installed package goes before."""
    if FOLDER.is_dir() and importlib.util.find_spec("jsonschema") is None:
        sys.path.append(str(FOLDER))
