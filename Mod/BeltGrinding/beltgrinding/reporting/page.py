"""A report's page, put together from its sections."""

from .. import resources
from . import charts, facts, findings, repeat
from .layout import facts as rows, section
from .markup import Markup, e


def document(content, words, scale, spots, drawn):
    """The whole HTML text."""
    title = words("Belt grinding: {part}", part=content.title)
    style = (resources() / "report" / "report.css").read_text(encoding="utf-8")
    body = [
        findings.head(content, words, scale),
        _pictures(content, words, scale, spots, drawn),
        findings.tolerance(content, words, scale),
        findings.events(content, words),
        _process(content, words),
        findings.trust(content, words),
        _what(content, words),
        repeat.repeat(content, words),
        findings.all_events(content, words),
    ]
    html = e(
        "html",
        e(
            "head",
            e("meta", charset="utf-8"),
            e("meta", name="viewport", content="width=device-width, initial-scale=1"),
            e("title", title),
            e("style", Markup(style)),
        ),
        e("body", e("main", body)),
        lang=words.code,
    )
    return "<!DOCTYPE html>\n" + html + "\n"


def _pictures(content, words, scale, spots, drawn):
    shots = []
    names = {"front": words("Front"), "back": words("Back")}
    for key, name in names.items():
        shot = drawn[key]
        shots.append(
            e(
                "figure",
                charts.marked(shot.view, shot.uri, shot.marks, name),
                e("figcaption", e("b", name)),
                class_="whole",
            )
        )
    close = []
    for spot, shot in zip(spots, drawn["close"]):
        name = words("Spot {number}", number=spot["number"])
        picture = charts.ringed(shot.view, shot.uri, *shot.marks[0][1:], name)
        text = e("figcaption", e("b", name), ": ", findings.spot(spot, content.verdict, words))
        close.append(e("figure", picture, text))
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
        e("p", intro, " " + own if content.result.job["inspection"].get("zones") else None),
        charts.legend(scale, words),
        e("div", shots, class_="views"),
        e("h3", words("The worst spots, from near")) if close else None,
        e("div", close, class_="spots") if close else None,
    )


def _process(content, words):
    chart = charts.series(content.bins, words)
    if chart is None:
        chart = e("p", words("The result holds no time series."), class_="unknown")
    return section(words("Process over time"), chart, class_="process")


def _what(content, words):
    job, summary = content.result.job, content.result.summary
    formula, law = facts.law(job, words)
    return section(
        words("What was simulated"),
        e(
            "div",
            e(
                "div",
                e("h3", words("Part and stock")),
                rows(facts.part(content, words)),
            ),
            e("div", e("h3", words("Process")), rows(facts.process(job, summary, words))),
            e(
                "div",
                e("h3", words("Law of removal")),
                e("p", e("code", formula), class_="formula"),
                rows(law),
                e("p", words(
                    "h: height, K: coefficient, k_t: cut left in the belt, V_b: belt speed, "
                    "p: pressure of the wheel on the part, V_w: feed."
                ), class_="small"),
            ),
            class_="columns",
        ),
    )  # fmt: skip
