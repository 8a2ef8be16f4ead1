"""Motions that a plan leaves as they are, as a person writes them: 12-40, 2:7."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ...engine import InputError
from ..common.kinds import Json, Widget

ONE = re.compile(r"\s*(?:(\d{1,6})\s*:)?\s*(\d{1,9})\s*(?:[-–]\s*(\d{1,9}))?\s*$")


def parsed(text: str, sources: Sequence[str | None]) -> list[dict[str, Any]]:
    """``keep`` of a plan's settings. ``sources``: the file of each program, or None: its poses are meant, not lines.
    Raises InputError."""
    found = []
    for part in filter(None, (part.strip() for part in re.split(r"[,;]", text))):
        match = ONE.match(part)
        program = int(match[1] or 1) if match else 0
        if not match or not 1 <= program <= len(sources):
            raise InputError(
                "planning.keep_text",
                "motions that stay: {text} is not understood; write lines as 12-40, those of the second program as "
                "2:7-9",
                text=part,
            )
        what = "line" if sources[program - 1] else "pose"
        one = {"program": program, f"first_{what}": int(match[2])}
        if match[3]:
            one[f"last_{what}"] = int(match[3])
        found.append(one)
    return found


def stored(keep: Sequence[Json]) -> str:
    """As the property Keep has it."""
    return json.dumps(keep, allow_nan=False) if keep else ""


def text(keep: Iterable[Json]) -> str:
    """What ``parsed`` makes ``keep`` of."""
    return ", ".join(_text(one) for one in keep)


def _text(one: Json) -> str:
    first = one.get("first_line") or one.get("first_pose") or 0
    last = one.get("last_line") or one.get("last_pose") or 0
    program = f"{one['program']}:" if one.get("program", 1) != 1 else ""
    return f"{program}{first}" + (f"-{last}" if last > first else "")


def of_chart(chart: Widget, sources: Sequence[str | None]) -> str:
    """What of a FeedChart is chosen, written so."""
    first, last = chart.chosen
    written = []
    for program in np.unique(chart.of[first : last + 1]).tolist():
        begin = int(np.argmax(chart.of == program))
        mine = np.arange(first, last + 1)
        own = mine[chart.of[mine] == program] - begin
        what = own + 1
        if sources[program]:
            lines = np.array(chart.lines[program])[own]
            what = lines[lines > 0]
        if len(what):
            word = "pose" if not sources[program] else "line"
            one = {"program": program + 1, f"first_{word}": int(what.min())}
            written.append(_text({**one, f"last_{word}": int(what.max())}))
    return ", ".join(written)
