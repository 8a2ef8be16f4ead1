"""HTML and SVG from elements, in which no text of a user can become markup."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterable
from html import escape
from typing import Any, TypeAlias

FORBIDDEN = re.compile("[^\t\n\x20-\x7e\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
VOID = {"meta", "link", "br", "img", "col", "input"}  # HTML: elements without an end


# Text, which is escaped; markup; None, which is left out; or lists of them.
Child: TypeAlias = Any


class Markup(str):
    """Text that is markup already."""


def element(tag: str, *children: Child, **attributes: object) -> Markup:
    """An element. Children: text (escaped), ``Markup``, None (left out), or lists of them.

    An underscore at an attribute's end is dropped (``class_``), others become hyphens; one that is
    None or False is left out, one that is True has no value.
    """
    names = []
    for name, value in attributes.items():
        if value is None or value is False:
            continue
        name = name.rstrip("_").replace("_", "-")
        names.append(f" {name}" if value is True else f' {name}="{escape(_text(value))}"')
    start = f"<{tag}{''.join(names)}>"
    return Markup(start if tag in VOID else f"{start}{join(children)}</{tag}>")


def join(children: Iterable[Child]) -> Markup:
    """The markup of children one after the other."""
    parts: list[str] = []
    for child in children:
        if isinstance(child, Markup):
            parts.append(child)
        elif isinstance(child, (list, tuple)):
            parts.append(join(child))
        elif child is not None:
            parts.append(escape(_text(child), quote=False))
    return Markup("".join(parts))


def _text(value: object) -> str:
    """Without what no document may hold: control characters, halves of surrogate pairs."""
    text = f"{value:.2f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)
    return FORBIDDEN.sub("\ufffd", text)


def data_uri(data: bytes, kind: str) -> str:
    """``data`` (bytes) as an address that holds it; ``kind``: its media type."""
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"
