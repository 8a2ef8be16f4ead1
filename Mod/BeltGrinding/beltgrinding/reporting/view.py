"""The 3D view of a page: its markup, its data and the scripts that draw it. Drawn by three.js (WebGL)."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ..base.kinds import Context, Json
from ..base.messages import sentence
from ..base.resources import resources
from ..engine import InputError
from . import view_data, view_library
from .markup import Markup, element

if TYPE_CHECKING:
    from .content import Content
    from .language import Language

SCRIPTS = (  # Resources/report, in one scope
    "view_data.js",
    "view_pick.js",
    "view_camera.js",
    "view_lines.js",
    "view_scene.js",
    "view_legend.js",
    "view_panel.js",
    "view.js",
)


class View(NamedTuple):
    """``markup`` goes where the view stands, ``scripts`` to the page's end, ``style`` into its head."""

    markup: Markup
    scripts: list[Markup]
    style: str


def view(
    content: Content,
    scale: tuple[float, float, float],
    spots: Sequence[Json],
    sides: Mapping[str, Any],
    words: Language,
    context: Context = None,
    alone: bool = False,
) -> View:
    """The ``View`` of a report's ``Content``, from the directions of ``sides``, the ``picture.View`` of front
    and back; ``alone``: it fills the page. Raises InputError without three.js, and Cancelled.
    """
    library = view_library.library()
    sides = [sides[key].direction for key in ("front", "back")]
    data = view_data.data(content, scale, spots, sides, words, context)
    about = {**data.about, "texts": _texts(words), "alone": alone}
    folder = resources() / "report"
    own = "\n".join((folder / name).read_text(encoding="utf-8") for name in SCRIPTS)
    own = f'(() => {{\n"use strict";\n{own}\n}})();'
    # "<" cannot stand in it: no text of a user can end the element.
    told = json.dumps(about, ensure_ascii=True, separators=(",", ":"), allow_nan=False).replace(
        "<", "\\u003c"
    )
    licence = "".join(f" * {line}".rstrip() + "\n" for line in library.licence.splitlines())
    scripts = [
        element("script", Markup(told), type="application/json", id="view-about"),
        element(
            "script",
            Markup(data.arrays),
            type="application/octet-stream",
            id="view-arrays",
        ),
        element("script", Markup(_safe(f"/*\n{licence} */\n{library.script}"))),
        element("script", Markup(_safe(own))),
    ]
    style = (folder / "view.css").read_text(encoding="utf-8")
    # A report has them on its top.
    notes = [sentence(note, words.code) for note in content.notes] if alone else []
    return View(_markup(data.about, library, words, alone, notes), scripts, style)


def missing(words: Language) -> str | None:
    """A sentence that says what a view would need; None where all is there."""
    try:
        view_library.library()
    except InputError as error:
        return sentence(error.fact, words.code)
    return None


def policy(scripts: Iterable[str] = ()) -> Markup:
    """The page's Content-Security-Policy as an element: nothing is loaded, and only these scripts run."""
    hashes = []
    for script in scripts:
        opening, _, rest = script.partition(">")
        if "type=" in opening:
            continue
        digest = hashlib.sha256(rest.rpartition("</script>")[0].encode()).digest()
        hashes.append(f"'sha256-{base64.b64encode(digest).decode()}'")
    rules = (
        "default-src 'none'",
        "img-src data:",
        "style-src 'unsafe-inline'",
        f"script-src {' '.join(hashes) or chr(39) + 'none' + chr(39)}",
        "base-uri 'none'",
        "form-action 'none'",
    )
    return element("meta", http_equiv="Content-Security-Policy", content="; ".join(rules))


def _safe(script: str) -> str:
    """A script that nothing in it can end: in strings ``<\\/`` is ``</``."""
    return re.sub(r"<(?=/script|!--)", r"\\x3c", script, flags=re.IGNORECASE)


def _texts(words: Language) -> dict[str, str]:
    """What the script says."""
    return {
        "in": words("in tolerance"),
        "above": words("too much left"),
        "below": words("cut too deep"),
        "missed": words("no stock"),
        "untouched": words("never touched by the wheel"),
        "made": words("{motion} removed most"),
        "line": words("line {line}"),
        "motion": words("motion {number}"),
        "zone": words("zone {name}"),
        "limits": words("limits {lower} … {upper} mm"),
        "rest": words("not ground"),
        "play": words("Play"),
        "pause": words("Pause"),
        "seconds": words("{time} of {whole} s"),
        "design": words("design"),
        "ground": words("ground, deviation × {times}"),
        "slow": words("The view cannot be shown: {reason}"),
    }


def _markup(
    about: Json, library: Any, words: Language, alone: bool, notes: Sequence[Any]
) -> Markup:
    spots = [
        element(
            "button",
            element("b", str(spot["number"])),
            element("span", spot["text"]),
            type="button",
            data_spot=k,
            class_="above" if spot["above"] else "below",
        )
        for k, spot in enumerate(about["spots"])
    ]
    parts = [
        _part(
            words("Colours"),
            element("select", id="view-mode", aria_label=words("What the colours show")),
            element("div", id="view-legend"),
        ),
        _part(words("Worst spots"), element("div", spots, class_="spots3d")) if spots else None,
        _part(words("Section"), _section(words)),
        _part(words("Wheel on its way"), _wheel(about, words)),
        [element("p", note, class_="notes told") for note in notes],
        element("p", _notes(about, library, words), class_="notes"),
    ]
    hint = words("Left button turns, right or Shift shifts, wheel zooms, double click centres")
    stage = element(
        "div",
        element(
            "canvas",
            tabindex="0",
            aria_label=words("The ground part, in three dimensions"),
        ),
        element("div", id="view-marks"),
        element("div", id="view-axes"),
        element(
            "div",
            _button("view-home", words("Front")),
            _button("view-back", words("Back")),
            _button("view-whole", words("Full screen")),
            class_="tools",
        ),
        element("p", hint, class_="hint", id="view-hint"),
        element("div", id="view-tip", hidden=True),
        class_="stage",
    )
    panel = element("div", parts, class_="panel")
    return element("div", stage, panel, id="view", class_="alone" if alone else None, hidden=True)


def _part(title: str, *children: object) -> Markup:
    return element("section", element("h3", title), *children)


def _button(name: str, text: str) -> Markup:
    return element("button", text, type="button", id=name)


def _section(words: Language) -> list[Markup]:
    choices = (
        ("", words("none")),
        ("x", words("across {axis}", axis="x")),
        ("y", words("across {axis}", axis="y")),
        ("z", words("across {axis}", axis="z")),
        ("view", words("as one looks now")),
    )
    options = [element("option", text, value=value) for value, text in choices]
    times = [element("option", f"× {n}", value=n, selected=n == 20) for n in (1, 5, 20, 100)]
    return [
        element(
            "div",
            element("select", options, id="view-cut", aria_label=words("Plane of the section")),
            element("button", words("Other side"), type="button", id="view-flip", hidden=True),
            class_="row",
        ),
        element(
            "div",
            element("div",
                element("input", type="range", id="view-place", min=0, max=1000, value=500,
                    aria_label=words("Place of the section")),
                element("output", id="view-where"), class_="row"),
            element("label", words("Deviation drawn"), " ",
                element("select", times, id="view-times"), class_="row"),
            element("p", id="view-lines", class_="keys"),
            id="view-cutting", hidden=True,
        ),
    ]  # fmt: skip


def _wheel(about: Json, words: Language) -> Any:
    if about["wheel"] is None:
        return element(
            "p",
            words(
                "No wheel is shown: the programs cannot be read any more, or the machine has none."
            ),
            class_="notes",
        )
    final = words("Heights and colours are those at the end.")
    if about["traced"]:
        final = words(
            "Grey is what the wheel still has to finish there; heights and colours are those at the end."
        )
    return [
        element(
            "div",
            _button("view-play", words("Play")),
            element("input", type="range", id="view-time", min=0, max=1000, value=0,
                aria_label=words("Time on the way")),
            class_="row",
        ),
        element("p", id="view-moment", class_="keys"),
        element("p", final, class_="notes", id="view-final", hidden=True),
    ]  # fmt: skip


def _notes(about: Json, library: Any, words: Language) -> str:
    told = []
    if about["samples"] < about["of"]:
        told.append(
            words(
                "The view shows {shown} of {all} samples, every {nth} on average; each has its own value.",
                shown=words.whole(about["samples"]),
                all=words.whole(about["of"]),
                nth=words.ordinal(round(about["of"] / about["samples"])),
            )
        )
    told.append(words("Drawn by three.js r{release} (MIT licence).", release=library.release))
    return " ".join(told)
