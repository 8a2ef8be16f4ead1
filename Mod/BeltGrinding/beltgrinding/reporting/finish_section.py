"""The part of a report that tells what finish the passes left."""

from __future__ import annotations
from collections.abc import Sequence

from pathlib import Path
from typing import Any, TYPE_CHECKING

from ..base.kinds import Json
from . import verdict_section
from .layout import facts, section
from .markup import element

if TYPE_CHECKING:
    from .language import Language
    from .markup import Markup


def finish(verdict: Json | None, words: Language) -> Markup | None:
    """The section; None where no finish was computed. ``verdict`` may be None."""
    found = (verdict or {}).get("finish")
    if verdict is None or found is None:
        return None
    note = words(
        "Ra by the last passes over each place, as measured on test pieces; strokes of the 3D view in FreeCAD show the "
        "direction of the scratches."
    )
    return section(
        words("Finish"),
        facts([*_roughness(found, verdict["programs"], words), *_scratches(found, words)]),
        verdict_section.finishes(verdict, words),
        element("p", note, class_="small"),
    )


def _roughness(found: Json, programs: Sequence[Json], words: Language) -> list[Any]:
    unknown = words("not known")
    before = found["initial_Ra_um"]
    rows = [
        (
            words("Ra before grinding"),
            unknown if before is None else _micrometres(before, words),
        )
    ]
    if found["source"] is None:
        return [
            *rows,
            (words("Roughness Ra"), words("not computed: nothing was measured")),
        ]
    rows.append((words("Measurements"), found["source"]))
    rows.append((words("Ra known on"), words.percent(found["known_share"], 1)))
    spread, worst = found["Ra_um"], found["worst"]
    if spread is None:
        return [*rows, (words("Roughness Ra"), unknown)]
    told = words(
        "{least} … {most}, mean {mean}, 95 % of the area below {high}",
        least=words.number(spread["min"], 2),
        most=_micrometres(spread["max"], words),
        mean=_micrometres(spread["mean"], words),
        high=_micrometres(spread["p95"], words),
    )
    rows.append((words("Roughness Ra"), told))
    place = f"Face{worst['face']}, ({verdict_section.place(worst['point_mm'], words)}) mm"
    if worst["line"] is not None:
        name = Path(programs[worst["program"]]["name"]).name
        place += f"; {name}, " + words("line {line}", line=worst["line"])
    if found["ln_deviation"]:
        place += "; " + words(
            "95 %: {least} … {most}",
            least=words.number(worst["least_um"], 2),
            most=_micrometres(worst["greatest_um"], words),
        )
    return [*rows, (words("Roughest"), place)]


def _scratches(found: Json, words: Language) -> list[Any]:
    share = found["crossed_share"]
    told = words("not known") if share is None else words.percent(share, 1)
    return [(words("Crossed scratches on"), told)]


def _micrometres(value: float | None, words: Language) -> str:
    return f"{words.number(value, 2)} µm"
