"""The report of a sorted batch, one HTML file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base import plotting
from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Json
from ..base.plotting import GREEN, GREY, ORANGE, RED
from ..base.resources import resources
from ..reporting.facts import part_name
from ..reporting.language import DASH, Language
from ..reporting.layout import section, table as html_table, whole_page
from ..reporting.markup import data_uri, element
from . import casting

if TYPE_CHECKING:
    from .sorting import Batch

REPORT = "parts.html"
COLOURS = {
    casting.PASSES: GREEN,
    casting.PLANNED: ORANGE,
    casting.SCRAP: RED,
    casting.UNKNOWN: GREY,
}
TEXTS = {
    casting.PASSES: "passes",
    casting.PLANNED: "passes with this plan",
    casting.SCRAP: "scrap",
    casting.UNKNOWN: "not known",
}


def write(
    folder: Path | str, batch: Batch, job: Json, share: float = 1.0, language: str = "en"
) -> Path:
    """Writes the report of a ``sorting.Batch`` of a job into the folder; returns its path. Raises InputError."""
    words = Language(language)
    path = Path(folder, REPORT)
    try:
        write_whole(path, document(batch, job, share, words).encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None
    return path


def counts(batch: Batch) -> dict[str, int]:
    """{sort: parts}"""
    return {sort: sum(row["sorted"] == sort for row in batch.parts) for sort in casting.SORTS}


def document(batch: Batch, job: Json, share: float, words: Language) -> str:
    """The whole HTML text."""
    title = words("Belt grinding: castings of {part}", part=part_name(job))
    style = (resources() / "report" / "report.css").read_text(encoding="utf-8")
    style += (resources() / "report" / "study.css").read_text(encoding="utf-8")
    found = counts(batch)
    tiles = [
        element(
            "div", element("b", words.whole(n)), element("span", words(TEXTS[k])), class_="tile"
        )
        for k, n in found.items()
        if n or k != casting.UNKNOWN
    ]
    limit = words("A part passes if its verdict is pass.")
    if share < 1.0:
        limit = words(
            "A part passes with {share} of its area in tolerance.", share=words.percent(share)
        )
    body = [
        element("p", words("A batch of castings, sorted by their scans"), class_="kind"),
        element("h1", title),
        element("div", tiles, class_="tiles"),
        element("p", limit),
        element("img", src=data_uri(picture(batch, words), "image/png"), alt=words("Parts")),
        section(words("Parts"), _table(batch, words)),
    ]
    return whole_page(title, style, element("main", element("section", body)), words.code)


def _table(batch: Batch, words: Language) -> Any:
    heads = [
        (words("part"), "name"),
        (words("sorted"), ""),
        (words("in tolerance"), "number"),
        (words("with its plan"), "number"),
        (words("grinding, s"), "number"),
        (words("why"), "name"),
    ]
    rows = []
    for row in batch.parts:
        seconds = (
            row["planned_time_s"] if row["sorted"] == casting.PLANNED else row["process_time_s"]
        )
        why = casting.reason(row, words)
        if not row["trusted"]:
            why = "; ".join(filter(None, [why, words("the scan is poorly laid on the design")]))
        rows.append(
            [
                row["part"],
                words(TEXTS[row["sorted"]]),
                words.percent(row["in_share"]),
                DASH if row["planned_in_share"] is None else words.percent(row["planned_in_share"]),
                words.number(seconds, 1),
                why,
            ]
        )
    return html_table(heads, rows)


def picture(batch: Batch, words: Language) -> bytes:
    """Bytes of a PNG: the area in tolerance of each part, as the program grinds it and with its plan."""
    parts = batch.parts
    drawn = plotting.figure(7.2, 0.9 + 0.3 * max(len(parts), 2))
    axes = drawn.add_subplot()
    for place, row in enumerate(reversed(parts)):
        share = 100.0 * (row["in_share"] or 0.0)
        axes.barh(place, share, color=COLOURS[row["sorted"]], height=0.6)
        if row["planned_in_share"] is not None:
            planned = 100.0 * row["planned_in_share"]
            axes.plot([planned], [place], "D", color="#23272e", ms=5)
    axes.set_yticks(range(len(parts)), [words.short(row["part"], 24) for row in reversed(parts)])
    axes.tick_params(labelsize=9)
    axes.set_xlim(0.0, 101.0)
    axes.set_xlabel(words("area in tolerance, %; diamond: with a plan"), fontsize=9)
    plotting.grid(axes, "x")
    return plotting.saved(drawn, dpi=130)
