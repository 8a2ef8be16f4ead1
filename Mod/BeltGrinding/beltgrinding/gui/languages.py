"""The languages of the workbench: compiled translations, which FreeCAD chooses from."""

from __future__ import annotations

import os
from pathlib import Path

import FreeCADGui as Gui

from ..base.resources import resources


def folders() -> list[Path]:
    """Where compiled translations lie: installed in Resources, in a checkout where it is built."""
    places = [resources() / "translations"]
    build = os.environ.get("BELTGRINDING_BUILD")
    places.append(Path(build or resources().parent / "build" / "release") / "translations")
    return [place for place in places if any(place.glob("*.qm"))]


def register() -> None:
    """Tells FreeCAD where the translations are, and lets its present language take them in."""
    found = folders()
    for folder in found:
        Gui.addLanguagePath(str(folder))
    if found:
        Gui.updateLocale()
