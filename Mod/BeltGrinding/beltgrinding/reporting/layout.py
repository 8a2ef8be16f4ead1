"""The pieces that a report's sections are made of."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from .markup import Markup, element

if TYPE_CHECKING:
    from .markup import Child


def whole_page(
    title: str, style: str, body: Child, language: str, policy: Child | None = None
) -> str:
    """A whole HTML text. ``style``: its CSS; ``body``: its elements; ``policy``: an element of its head."""
    html = element(
        "html",
        element(
            "head",
            element("meta", charset="utf-8"),
            policy,
            element("meta", name="viewport", content="width=device-width, initial-scale=1"),
            element("title", title),
            element("style", Markup(style)),
        ),
        element("body", body),
        lang=language,
    )
    return "<!DOCTYPE html>\n" + html + "\n"


def section(title: str, *children: Child, **attributes: object) -> Markup | None:
    """A section with its heading; nothing without any child."""
    if all(child is None for child in children):
        return None
    return element("section", element("h2", title), *children, **attributes)


def facts(pairs: Iterable[tuple[Child, Child]], class_: str = "facts") -> Markup:
    """A table of labels and values."""
    body = [
        element("tr", element("th", label, scope="row"), element("td", value))
        for label, value in pairs
    ]
    return element("table", element("tbody", body), class_=class_)


def table(
    heads: Sequence[tuple[str, str]],
    rows: Iterable[Sequence[Child]],
    class_: str = "list",
) -> Markup:
    """A table; ``heads``: (text, class of its column's cells or '')."""
    body = [
        element(
            "tr",
            [element("td", cell, class_=kind or None) for cell, (_, kind) in zip(row, heads)],
        )
        for row in rows
    ]
    head = element("tr", [element("th", text, class_=kind or None) for text, kind in heads])
    return element("table", element("thead", head), element("tbody", body), class_=class_)
