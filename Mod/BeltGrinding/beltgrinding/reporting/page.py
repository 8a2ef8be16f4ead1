"""A report's page, put together from its sections."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TYPE_CHECKING

from ..base.kinds import Json
from ..base.resources import resources
from . import charts, facts, findings, finish_section, heat_section, reproduction, view
from .layout import facts as rows, section, whole_page
from .markup import element

if TYPE_CHECKING:
    from .markup import Markup
    from .content import Content
    from .language import Language


def document(
    content: Content,
    words: Language,
    scale: tuple[float, float, float],
    spots: Sequence[Json],
    drawn: Mapping[str, Any],
    shown: Any = None,
    lacking: str | None = None,
) -> str:
    """The whole HTML text; with the 3D view ``shown`` (a ``view.View``), or a note on what it ``lacks``."""
    title = words("Belt grinding: {part}", part=content.title)
    style = (resources() / "report" / "report.css").read_text(encoding="utf-8")
    scripts = [] if shown is None else shown.scripts
    if shown is not None:
        style += shown.style
    body = [
        findings.head(content, words, scale),
        _pictures(content, words, scale, spots, drawn, shown, lacking),
        findings.tolerance(content, words, scale),
        heat_section.heat(content.verdict, words),
        finish_section.finish(content.verdict, words),
        findings.events(content, words),
        _process(content, words),
        findings.trust(content, words),
        _what(content, words),
        reproduction.repeat(content, words),
        findings.all_events(content, words),
    ]
    return whole_page(
        title, style, [element("main", body), scripts], words.code, view.policy(scripts)
    )


def _pictures(
    content: Content,
    words: Language,
    scale: tuple[float, float, float],
    spots: Sequence[Json],
    drawn: Mapping[str, Any],
    shown: Any,
    lacking: Any,
) -> Markup:
    shots = []
    names = {"front": words("Front"), "back": words("Back")}
    for key, name in names.items():
        shot = drawn[key]
        shots.append(
            element(
                "figure",
                charts.marked(shot.view, shot.uri, shot.marks, name),
                element("figcaption", element("b", name)),
                class_="whole",
            )
        )
    close = []
    for spot, shot in zip(spots, drawn["close"]):
        name = words("Spot {number}", number=spot["number"])
        picture = charts.ringed(shot.view, shot.uri, *shot.marks[0][1:], name)
        text = element(
            "figcaption",
            element("b", name),
            ": ",
            findings.spot(spot, content.verdict, words),
        )
        close.append(element("figure", picture, text))
    intro = words(
        "Grey is the part as it is. On the ground faces the colour says how far the surface will lie "
        "from the design after grinding."
    )
    own = words(
        "The colours' limits are {band}; zones have limits of their own.",
        band=words.band(*scale[:2]),
    )
    return section(
        words("Pictures"),
        element(
            "p",
            intro,
            " " + own if content.result.job["inspection"].get("zones") else None,
        ),
        None if lacking is None else element("p", lacking, class_="note"),
        None if shown is None else shown.markup,
        charts.legend(scale, words),
        element("div", shots, class_="views"),
        element("h3", words("The worst spots, from near")) if close else None,
        element("div", close, class_="spots") if close else None,
    )


def _process(content: Content, words: Language) -> Markup:
    chart = charts.series(content.bins, words)
    if chart is None:
        chart = element("p", words("The result holds no time series."), class_="unknown")
    return section(words("Process over time"), chart, class_="process")


def _what(content: Content, words: Language) -> Markup:
    job, summary = content.result.job, content.result.summary
    formula, law = facts.law(job, words)
    return section(
        words("What was simulated"),
        element(
            "div",
            element(
                "div",
                element("h3", words("Part and stock")),
                rows(facts.part(content, words)),
            ),
            element("div", element("h3", words("Process")), rows(facts.process(job, summary, words))),
            element(
                "div",
                element("h3", words("Law of removal")),
                element("p", element("code", formula), class_="formula"),
                rows(law),
                element("p", words(
                    "h: height, K: coefficient, k_t: cut left in the belt, V_b: belt speed, "
                    "p: pressure of the wheel on the part, V_w: feed."
                ), class_="small"),
            ),
            class_="columns",
        ),
    )  # fmt: skip
