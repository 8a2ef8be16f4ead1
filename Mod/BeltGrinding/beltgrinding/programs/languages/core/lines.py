"""Statements that go on over several lines."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

MOST = 10_000  # lines of a statement
STRING = re.compile(r'"[^"]*(?:"|$)')


def joined(
    rows: Sequence[tuple[int, str]], begins: Callable[[str], object]
) -> list[tuple[int, str]]:
    """[(line, text)] of statements: one whose brackets are open takes the lines up to where they are closed.

    A line for which ``begins(text)`` is true is never one that goes on: a bracket that is not closed before it
    is a fault of its own line only.
    """
    depths = [_depth(text) for _, text in rows]
    found: list[tuple[int, str]] = []
    at = 0
    while at < len(rows):
        line, text = rows[at]
        depth, last = depths[at], at
        while depth > 0 and last + 1 < len(rows) and last - at < MOST:
            if begins(rows[last + 1][1]):
                break
            last += 1
            depth += depths[last]
        if depth <= 0 < last - at:
            text = " ".join(text for _, text in rows[at : last + 1])
            at = last
        elif last > at:  # of the lines up to there none closes it
            found += rows[at : last + 1]
            at = last + 1
            continue
        found.append((line, text))
        at += 1
    return found


def _depth(text: str) -> int:
    """Brackets that are opened less those that are closed, outside of strings."""
    if '"' in text:
        text = STRING.sub("", text)
    return sum(map(text.count, "([{")) - sum(map(text.count, ")]}"))
