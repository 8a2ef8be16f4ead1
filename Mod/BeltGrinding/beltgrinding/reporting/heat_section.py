"""The part of a report that tells how hot the part became."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..base.kinds import Json
from . import verdict_section
from .layout import facts, section
from .markup import element

if TYPE_CHECKING:
    from .language import Language
    from .markup import Markup


def heat(verdict: Json | None, words: Language) -> Markup | None:
    """The section; None where no temperatures were computed. ``verdict`` may be None."""
    found = (verdict or {}).get("heat")
    if verdict is None or found is None:
        return None
    worst = found["worst"]

    def degrees(value: float | None) -> str:
        return f"{words.number(value, 0)} °C"

    likely = words(
        "{likely} ({least} … {greatest}, friction and partition being uncertain)",
        likely=degrees(worst["temperature_C"]),
        least=words.number(worst["least_C"], 0),
        greatest=degrees(worst["greatest_C"]),
    )
    place = f"Face{worst['face']}, ({verdict_section.place(worst['point_mm'], words)}) mm"
    if worst["line"] is not None:
        name = Path(verdict["programs"][worst["program"]]["name"]).name
        place += f"; {name}, " + words("line {line}", line=worst["line"])
    rows = [
        (words("Material"), found["material"] or "–"),
        (words("Greatest temperature"), likely),
        (words("Where"), place),
    ]
    if found["burn_C"] is None:
        rows.append((words("Limit"), words("not known")))
    else:
        source = f" ({found['burn_source']})" if found["burn_source"] else ""
        rows.append((words("Limit"), degrees(found["burn_C"]) + source))
        share = words(
            "{likely} of the area, {most} if the heat is the most that it may be",
            likely=words.percent(found["burnt_share"], 2),
            most=words.percent(found["perhaps_burnt_share"], 2),
        )
        rows.append((words("Above the limit"), share))
    note = words(
        "Means over contact cells: flashes at single grains are hotter. No coolant, no heat lost to the air; "
        "properties do not depend on the temperature."
    )
    return section(words("Temperature"), facts(rows), element("p", note, class_="small"))
