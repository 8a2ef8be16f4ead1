"""Puts FreeCAD back after a test. Its functions run inside of FreeCAD, with its window or without."""

import gc
import sys

_patched = []  # (holder, name, what it was)


def patch(holder, name, value):
    """Replaces an attribute until the test's end."""
    _patched.append((holder, name, vars(holder).get(name, getattr(holder, name))))
    setattr(holder, name, value)


def restore():
    """No document, patch or preference of the test is left, nor anything of its in the window."""
    import FreeCAD

    if FreeCAD.GuiUp:
        from support import hands

        hands.put_away()
    for name in list(FreeCAD.listDocuments()):
        FreeCAD.closeDocument(name)
    FreeCAD.closeActiveTransaction(False)  # one that has changed nothing outlives its document
    if FreeCAD.GuiUp:
        hands.bury()  # or the dialogs would hold their panels
    gc.collect()
    while _patched:
        setattr(*_patched.pop())
    preferences = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/BeltGrinding")
    preferences.Clear()
    if "beltgrinding.objects.preferences" in sys.modules:
        sys.modules["beltgrinding.objects.preferences"].apply_threads()
    if FreeCAD.GuiUp:
        hands.settle()
        hands.bury()


def speak(language):
    """Keeps a language ("German") for the next FreeCAD that starts in this home."""
    import FreeCAD

    general = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/General")
    general.SetString("Language", language)
    FreeCAD.saveParameter("User parameter")
