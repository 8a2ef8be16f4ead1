"""Routines in files of their names beside a program's."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from ...program import MAX_FILE

MOST = 200  # files that are looked at beside one
WORDS = re.compile(r"[\w-]+")


def near(path: Path | str, suffixes: Sequence[str]) -> dict[str, Path]:
    """{name in capitals: path} of the files in the folder of a program's that have one of the suffixes; of two the
    one with the earlier suffix."""
    path = Path(path)
    found: list[tuple[int, str, str]] = []
    try:
        with os.scandir(path.parent) as entries:
            for entry in entries:
                stem, suffix = os.path.splitext(entry.name)
                if suffix.lower() in suffixes and entry.name != path.name and entry.is_file():
                    found.append((suffixes.index(suffix.lower()), entry.name, stem.upper()))
    except (OSError, ValueError):
        return {}
    return {stem: path.parent / name for _, name, stem in sorted(found, reverse=True)}


def called(path: Path | str, suffixes: Sequence[str]) -> list[Path]:
    """The files beside a program that it names, and those that these name in turn."""
    others, waiting = near(path, suffixes), [Path(path)]
    found: list[Path] = []
    while waiting and others and len(found) < MOST:
        one = waiting.pop()
        try:
            if one.stat().st_size > MAX_FILE:
                continue
            text = one.read_bytes().decode("latin-1").upper()
        except (OSError, ValueError):
            continue
        words = set(WORDS.findall(text))
        words.update(*(word.split("-") for word in words if "-" in word))
        for name in sorted(words & others.keys()):
            found.append(others.pop(name))
            waiting.append(found[-1])
    return found


def first(called: Mapping[str, set[str]], names: Sequence[str]) -> str:
    """The routine with which a file begins: one of ``names``, or the first that no other calls. ``called``: {name:
    names that it calls}."""
    for name in names:
        if name in called:
            return name
    all_called = {one for by, ones in called.items() for one in ones if one != by}
    return next((name for name in called if name not in all_called), next(iter(called)))
