"""A result's 3D view as a page of its own."""

from __future__ import annotations
from typing import Any, TYPE_CHECKING
from collections.abc import Mapping

from pathlib import Path

from ..base.kinds import Context
from ..base.resources import resources
from ..engine import InputError, core
from ..job.tolerances import colour_scale
from ..simulation import result_folder
from ..simulation.result import Result
from . import (
    charts,
    findings,
    pictures,
    report,
    view as views,
    view_library,
    worst_spots,
)
from .language import Language
from .layout import whole_page
from .markup import element

if TYPE_CHECKING:
    from .content import Content
    from .markup import Markup


def view(
    result: Result | Path | str,
    output: Path | str | None = None,
    language: str = "en",
    title: str | None = None,
    context: Context = None,
) -> Path:
    """Writes the 3D view of a result as one self-contained HTML file.

    ``result``: the folder that a run wrote, or a ``Result``; ``output``: the file, by default view.html in
    that folder; ``language``: "en" or "de"; ``title``: what the part is called. Returns ``output``. Raises
    InputError, also without three.js (Debian's libjs-three), and Cancelled.
    """
    folder = None if isinstance(result, Result) else Path(result)
    if output is None and folder is None:
        raise InputError("reporting.no_view_output", "view: say by output what file to write")
    output = Path(output) if output is not None else folder / result_folder.VIEW
    words, context = Language(language), context or core.RunContext()
    content = report.load(result, title, (), context)
    scale = colour_scale(content.result.job)
    spots = worst_spots.worst(content.result.field, scale[:2], content.verdict)
    view_library.library()  # without it nothing need be drawn

    def turned(sides: Any) -> Any:
        return views.view(content, scale, spots, sides, words, context, alone=True)

    field, shape = content.result.field, content.shape
    drawn = pictures.draw(field, scale, shape, spots, context, near=False, beside=turned)
    html = _document(content, words, scale, drawn["beside"], drawn)
    context.throw_if_cancelled()
    report.write(content.result, {output: html.encode()})
    return output


def _document(
    content: Content,
    words: Language,
    scale: tuple[float, float, float],
    shown: Any,
    drawn: Mapping[str, Any],
) -> Markup:
    title = words("Belt grinding: {part}", part=content.title)
    state, text = findings.state(content, words)
    head = element(
        "header",
        element("h1", content.title),
        element("strong", text, class_=f"state {state}"),
        element("span", findings.in_tolerance(content, words, scale)),
    )
    names = (("front", words("Front")), ("back", words("Back")))
    figures = [
        element(
            "figure",
            charts.marked(drawn[key].view, drawn[key].uri, drawn[key].marks, name),
            element("figcaption", name),
        )
        for key, name in names
    ]
    instead = element(
        "div",
        element(
            "p",
            words("In place of the 3D view, which needs WebGL and JavaScript:"),
            class_="why",
        ),
        charts.legend(scale, words),
        element("div", figures, class_="views"),
        id="view-instead",
    )
    style = (resources() / "report" / "view_page.css").read_text(encoding="utf-8")
    body = [head, shown.markup, instead, shown.scripts]
    return whole_page(title, shown.style + style, body, words.code, views.policy(shown.scripts))
