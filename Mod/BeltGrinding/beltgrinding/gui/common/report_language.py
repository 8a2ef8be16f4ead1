"""The texts that reports and window share, in the window's language."""

import FreeCAD

from ...reporting.language import Language

GENERAL = "User parameter:BaseApp/Preferences/General"


def language():
    """German where FreeCAD's is, else English."""
    chosen = FreeCAD.ParamGet(GENERAL).GetString("Language", "English")
    return "de" if chosen in ("German", "Deutsch") else "en"


def words():
    """The ``Language``."""
    return Language(language())
