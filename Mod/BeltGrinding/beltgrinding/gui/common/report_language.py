"""The texts that reports and window share, in the window's language."""

from __future__ import annotations

import FreeCAD

from ...reporting.language import Language

GENERAL = "User parameter:BaseApp/Preferences/General"


def language() -> str:
    """German where FreeCAD's is, else English."""
    chosen = FreeCAD.ParamGet(GENERAL).GetString("Language", "English")
    return "de" if chosen in ("German", "Deutsch") else "en"


def words() -> Language:
    """The ``Language``."""
    return Language(language())
