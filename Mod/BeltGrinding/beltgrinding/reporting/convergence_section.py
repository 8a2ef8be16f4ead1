"""The section of a report that tells whether the job's settings are fine enough."""

from __future__ import annotations

import math
from typing import Any, TYPE_CHECKING

from ..base import messages
from ..base.kinds import Json
from ..simulation.convergence_record import LEVELS, worst
from .layout import table
from .markup import element

if TYPE_CHECKING:
    from .markup import Markup
    from .language import Language

MOST_FACES = 8  # of the whole table, the worst ones
NAMES = {
    "removed_volume": "Removed volume",
    "min": "Lowest deviation",
    "max": "Highest deviation",
    "mean": "Mean deviation",
    "rms": "Deviation, root mean square",
    "p05": "5 % of the area lie below",
    "p50": "Half of the area lies below",
    "p95": "95 % of the area lie below",
    "in_tolerance": "Share of the area in tolerance",
    "face_min": "Face{face}, lowest",
    "face_max": "Face{face}, highest",
}
SETTINGS = {
    "spacing": "the sampling spacing",
    "step": "the step of the simulation",
    "contact_grid": "the contact grid",
}
UNITS = {"mm": "mm", "mm3": "mm³", "share": "%"}
LEVEL_NAMES = {
    "coarse": "twice as coarse",
    "given": "as given",
    "fine": "twice as fine",
}


def sentences(convergence: Json, words: Language) -> list[str]:
    """Whether the settings are fine enough, in a few plain sentences."""
    band = 100 * convergence["band_share"]
    depths = [one for one in convergence["quantities"] if one["unit"] == "mm"]
    allowed = f"{words.number(depths[0]['limit'], 4)} mm"
    rule = words(
        "A depth may be off by {percent} % of the narrowest tolerance band, {allowed}; a share of the "
        "area or a volume by 1 %.",
        percent=words.figures(band),
        allowed=allowed,
    )
    if convergence["fine_enough"]:
        most = max(one["error"] for one in depths)
        said = words(
            "Yes: because of them no depth is off by more than about {error} mm.",
            error=words.number(most, 4),
        )
        return [said, rule, *_of_samples(convergence, words)]
    bad = [one for one in convergence["quantities"] if not one["ok"]]
    first = worst(convergence)
    said = words(
        "No: {bad} of {count} figures may be off by more than is allowed. The worst is “{name}”: {error}.",
        bad=len(bad),
        count=len(convergence["quantities"]),
        name=name_of(first, words),
        error=words("off by up to {error}", error=value_of(first, first["error"], words, True))
        if first["error"] is not None
        else words("not known"),
    )
    settings = {k: v for k, v in (convergence["settings"] or {}).items() if v is not None}
    advice = None
    if settings:
        most = max(settings, key=settings.get)
        advice = words(
            "What matters most is {setting}: made twice as coarse alone, it moves a depth by up to "
            "{change} mm. Refine it first.",
            setting=words(SETTINGS[most]),
            change=words.number(settings[most], 4),
        )
    return [text for text in (said, rule, advice, *_of_samples(convergence, words)) if text]


def _of_samples(convergence: Json, words: Language) -> list[str]:
    found = convergence.get("samples")
    if not found:
        return []
    said = words(
        "At 95 % of the area the deviation is off by at most {most} mm, at 99 % by {nearly_all} mm.",
        most=words.number(found["p95_mm"], 4),
        nearly_all=words.number(found["p99_mm"], 4),
    )
    if found["undecided_share"] is None:
        return [said]
    open_ = words(
        "At {share} % of the area this leaves open whether it is in tolerance.",
        share=words.number(100.0 * found["undecided_share"], 2),
    )
    return [said, open_]


def name_of(one: Json, words: Language) -> str:
    """What a quantity is called."""
    return words(NAMES[one["name"]], face=one["face"])


def value_of(one: Json, value: float | None, words: Language, unit: bool = False) -> str:
    """A value of a quantity, and its unit if asked for."""
    if value is None:
        return words.number(None)
    if one["unit"] == "share":
        text = words.number(100.0 * value, 2)
    else:
        text = words.number(value, 4 if one["unit"] == "mm" else 1)
    return f"{text} {UNITS[one['unit']]}" if unit else text


def convergence_part(convergence: Json, words: Language) -> list[Any]:
    """The sentences, the levels, and the table of all figures."""
    return [
        element("p", " ".join(sentences(convergence, words))),
        _levels(convergence, words),
        _figures(convergence, words),
        element("p", words(
            "The error is Richardson's estimate from the three runs with a margin; where the figures do "
            "not settle evenly, it is their range."
        ), class_="small"),
        [element("p", note, class_="note") for note in messages.notes(convergence, words.code)],
    ]  # fmt: skip


def _levels(convergence: Json, words: Language) -> Markup:
    rows = []
    for level in LEVELS:
        found = convergence["levels"][level]
        if found is None:
            rows.append((words(LEVEL_NAMES[level]), *["–"] * 6))
            continue
        rows.append(
            (
                words(LEVEL_NAMES[level]),
                words.figures(found["spacing_mm"]),
                words.figures(found["max_travel_mm"]),
                words.figures(found["contact_spacing_mm"]),
                words.whole(found["samples"]),
                words.whole(found["steps"]),
                words.number(found["wall_time_s"], 1),
            )
        )
    heads = [
        (words("Run"), ""),
        (words("Spacing, mm"), "number"),
        (words("Step, mm"), "number"),
        (words("Contact cell, mm"), "number"),
        (words("Samples"), "number"),
        (words("Steps"), "number"),
        (words("Computed in, s"), "number"),
    ]
    return table(heads, rows, "list levels")


def _figures(convergence: Json, words: Language) -> list[Markup]:
    whole = [one for one in convergence["quantities"] if one["face"] is None]
    faces = [one for one in convergence["quantities"] if one["face"] is not None]
    faces.sort(key=lambda one: -(math.inf if one["error"] is None else one["error"]))
    shown = whole + faces[:MOST_FACES]
    rows = [
        (
            f"{name_of(one, words)}, {UNITS[one['unit']]}",
            *(value_of(one, value, words) for value in one["values"]),
            words.number(one["order"], 1),
            value_of(one, one["error"], words),
            value_of(one, one["limit"], words),
            element(
                "span",
                words("fine") if one["ok"] else words("too coarse"),
                class_=f"mark {'pass' if one['ok'] else 'fail'}",
            ),
        )
        for one in shown
    ]
    heads = [
        (words("Figure"), ""),
        *((words(LEVEL_NAMES[level]), "number") for level in LEVELS),
        (words("Order"), "number"),
        (words("Error"), "number"),
        (words("Allowed"), "number"),
        ("", ""),
    ]
    left = len(faces) - MOST_FACES
    note = words(
        "{count} more figures of faces, with smaller errors, stand in convergence.json.",
        count=left,
    )
    return [
        table(heads, rows, "list convergence"),
        element("p", note, class_="small") if left > 0 else None,
    ]
