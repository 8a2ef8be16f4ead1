"""Finds and loads the compiled core, and says what is to be done where none fits.

A release carries several cores side by side, told apart by the tag of their Python
(``beltgrinding_core.cpython-311-x86_64-linux-gnu.so``); beside each a ``.json`` says for what it was
built (cmake/BeltGrindingInstall.cmake).
"""

from __future__ import annotations

import importlib
import importlib.machinery
import json
import os
import sys
from pathlib import Path
from types import ModuleType

NAME = "beltgrinding_core"


def places() -> list[Path]:
    """Folders in which a core may lie: beside this package, within it (a wheel), or a checkout's build."""
    package = Path(__file__).resolve().parents[1]
    found = [package.parent, package, package.parents[2] / "build" / "release" / "python"]
    if "BELTGRINDING_BUILD" in os.environ:
        found.insert(0, Path(os.environ["BELTGRINDING_BUILD"]) / "python")
    return found


def built_for(core: Path) -> dict[str, str]:
    """What a core was built for: {"system", "python", "opencascade"}, the last not where it brings its own; {} where nobody says."""
    try:
        told = core.with_name(core.name + ".json").read_text(encoding="utf-8")
        built: dict[str, str] = json.loads(told)
    except (OSError, ValueError):
        return {}
    return built


def load() -> ModuleType:
    """Imports the core. ImportError says what this FreeCAD needs, what is there, what to do."""
    looked = places()
    suffixes = tuple(importlib.machinery.EXTENSION_SUFFIXES)
    fitting = []
    for place in looked:
        found = [core for core in _cores(place) if core.name[len(NAME) :] in suffixes]
        fitting += found
        if found and str(place) not in sys.path:
            sys.path.append(str(place))
    if fitting:
        _check_opencascade(built_for(fitting[0]), fitting[0])
    try:
        return importlib.import_module(NAME)
    except ImportError as error:
        if fitting:
            reason = f"{fitting[0]} cannot be loaded: {error}."
        else:
            reason = (
                f"There is none for Python {sys.version_info[0]}.{sys.version_info[1]}, which runs "
                f"here; it would be named {NAME}{suffixes[0]}. "
                f"Looked in: {', '.join(str(place) for place in looked)}."
            )
        raise ImportError(message(reason), name=NAME) from error


def extension(name: str) -> ModuleType:
    """Imports a module that is built and installed beside the core. Raises ImportError."""
    core = sys.modules.get(NAME) or load()
    place = str(Path(core.__file__ or "").parent)
    if place not in sys.path:
        sys.path.append(place)
    return importlib.import_module(name)


def message(reason: object) -> str:
    """The whole message: the reason, the cores that are there, and the ways out."""
    lines = [f"The compiled core of the belt-grinding workbench does not fit. {reason}"]
    known = [built_for(core) for place in places() for core in _cores(place)]
    told = sorted({f"- {_words(one)}" for one in known if one})
    if told:
        lines += ["", "The cores that are installed are for", *told]
    lines += [
        "",
        "What to do: with a FreeCAD whose Python is 3.11 or 3.13, on Linux and an x86-64 processor, "
        "install the portable package (BeltGrinding-*-linux-x86_64.zip), or on Debian the package of "
        "your release (apt install ./beltgrinding_*.deb). Anywhere else build the core for your FreeCAD from the sources: "
        "tools/install. See docs/install.md.",
    ]
    return "\n".join(lines)


def _cores(place: Path) -> list[Path]:
    return sorted(place.glob(f"{NAME}*.so"))


def _words(one: dict[str, str]) -> str:
    words = f"{one.get('system', '?')}: Python {one.get('python', '?')}"
    return words + (f", OpenCASCADE {one['opencascade']}" if "opencascade" in one else "")


def _check_opencascade(built: dict[str, str], core: Path) -> None:
    """Two generations of OpenCASCADE in one process share names and crash: refuses before that."""
    if "FreeCAD" not in sys.modules or "opencascade" not in built:
        return
    try:
        import Part

        here = Part.OCC_VERSION
    except (ImportError, AttributeError):
        return  # a FreeCAD that does not tell: the loader has the word
    if here.split(".")[:2] != built["opencascade"].split(".")[:2]:
        raise ImportError(
            message(
                f"{core} needs OpenCASCADE {built['opencascade']}; this FreeCAD runs with {here}."
            ),
            name=NAME,
        )
