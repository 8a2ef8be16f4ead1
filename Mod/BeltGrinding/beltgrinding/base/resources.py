"""Where the folders of a release lie: beside the package, within it (a wheel), or in a checkout."""

from __future__ import annotations

from pathlib import Path


def resources() -> Path:
    """The folder Resources, installed or of a checkout."""
    return _folder("Resources")


def documentation() -> Path:
    """The folder docs, installed or of a checkout."""
    return _folder("docs")


def _folder(name: str) -> Path:
    package = Path(__file__).resolve().parents[1]
    for folder in (package / name, package.parent / name, package.parents[2] / name):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"The folder {name} is missing; install the workbench again.")
