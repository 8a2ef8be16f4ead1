"""three.js, with which a browser draws the 3D view, read when a page is written: Debian's libjs-three, or the copy in the
portable package."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import NamedTuple

from ..base import vendored
from ..base.resources import resources
from ..engine import InputError

PLACES = (
    str(vendored.FOLDER / "three.min.js"),
    "/usr/share/javascript/three/three.min.js",
    "/usr/share/nodejs/three/build/three.min.js",
)
ELSEWHERE = "BELTGRINDING_THREE"  # environment: the file, where it lies elsewhere
OLDEST, NEWEST = 110, 124  # releases that have what the view calls; tried with 111
MOST_BYTES = 4_000_000


class Library(NamedTuple):
    """``script``: its text; ``release``: its number; ``licence``: what must go with it."""

    script: str
    release: int
    licence: str


def library() -> Library:
    """The ``Library``. Raises InputError where it is not installed, or is another release."""
    elsewhere = os.environ.get(ELSEWHERE)
    for path in map(Path, (elsewhere,) if elsewhere else PLACES):
        try:
            if path.stat().st_size > MOST_BYTES:
                continue
            script = path.read_text(encoding="utf-8")
        except (OSError, ValueError):
            continue
        found = re.search(r"REVISION\s*=\s*[\"'](\d+)", script)
        if found and OLDEST <= int(found[1]) <= NEWEST:
            licence = (resources() / "report" / "three-licence.txt").read_text(encoding="utf-8")
            return Library(script, int(found[1]), licence)
    raise InputError(
        "reporting.no_three",
        "the 3D view needs three.js, release {oldest} to {newest}; install Debian's libjs-three, or "
        "name its three.min.js in the environment by {variable}",
        oldest=OLDEST,
        newest=NEWEST,
        variable=ELSEWHERE,
    )
