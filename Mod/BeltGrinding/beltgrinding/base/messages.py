"""Facts as sentences, in the reader's language: here and nowhere else.

A fact (``beltgrinding_core.Fact``, an event's ``facts``, an ``InputError``) has a code, an English form
and arguments. The forms in other languages stand in Resources/messages, by code; what has none there,
as of another version, is told in English.
"""

from __future__ import annotations

import json
import math
import re
import string
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

from .grouping import grouped
from .resources import resources

POINTS = {"en": ".", "de": ","}
MINUS = "\N{MINUS SIGN}"
FORMAT = re.compile(r"[+-]?(\.?\d{1,2})?[a-z%]?")  # all that our forms use
BODIES = ("body", "other")  # arguments that are bodies of the cell
PARTS = ("context", "remarks")  # of what is told, before and after it
OF_A_BELT = "event.belt_"  # codes of facts on a belt that is pressed without a wheel
# (code, English words, what follows them) of a body's name, None of one that the user gave.
NamedBody = Callable[[str], tuple[str, str, str] | None]
_told: NamedBody = lambda name: None
_words: Callable[[str], str] = lambda text: text
# Facts that name a table's columns, or keys as they are typed.
AS_WRITTEN = {
    "calibration.no_wear_by_job",
    "calibration.wear_by_job",
    "studies.unknown_key",
}
BELT_TITLES = {"wheel_too_large": "Belt spans a hollow"}  # where the kind's code names the wheel


@lru_cache(maxsize=None)
def _catalogue(language: str) -> dict[str, Any]:
    if language == "en":
        return {}
    path = resources() / "messages" / f"{language}.json"
    catalogue: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return catalogue


def _forms(language: str) -> dict[str, str]:
    """{code: form}, and the texts of ``of_report``"""
    return _catalogue(language)


def of_report(language: str) -> dict[str, str]:
    """{English text: text} of the words that only reports have, which have no code."""
    texts: dict[str, str] = _catalogue(language).get("report", {})
    return texts


def decimal(text: str, language: str) -> str:
    """A number that is written already, with the language's own signs."""
    return text.replace("-", MINUS).replace(".", POINTS[language])


class _Formatter(string.Formatter):
    """str.format, with numbers as the language writes them."""

    def __init__(self, language: str) -> None:
        self.language = language

    def get_field(
        self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]
    ) -> tuple[Any, str]:
        # A form may come out of a document: nothing but the arguments themselves is told.
        return kwargs[field_name], field_name

    def convert_field(self, value: Any, conversion: Any) -> Any:
        if conversion is not None:
            raise ValueError(conversion)
        return value

    def format_field(self, value: Any, format_spec: str) -> str:
        if isinstance(value, str):  # also a number that JSON does not have
            return value
        if not FORMAT.fullmatch(format_spec):
            raise ValueError(format_spec)
        text = format(value, format_spec)
        return text if self.language == "en" else decimal(text, self.language)


def word(code: str, text: str, language: str) -> str:
    """A word or a sentence without arguments; ``text`` is the English one."""
    return _forms(language).get(code, text)


def name_bodies(told: NamedBody) -> None:
    """Takes what says how a body is called: the package hands it down from the room that knows them."""
    global _told
    _told = told


def show_keys_as(words: Callable[[str], str]) -> None:
    """Takes what says a sentence in the words of those who read it: the window has labels, no keys."""
    global _words
    _words = words


def body(name: str, language: str) -> str:
    """The name of a body of the cell: those of machine, part, stock and arm are ours, the others the user's."""
    known = _told(name)
    if known is None:
        return name
    code, text, rest = known
    return word(code, text, language) + rest


def _argument(name: str, value: Any, language: str) -> Any:
    """A value as it is told: a reason may be a fact itself."""
    if hasattr(value, "code") or isinstance(value, dict):
        return _sentence(value, language)
    return body(value, language) if name in BODIES else value


def _filled(code: str, text: str, arguments: Mapping[str, Any], language: str) -> str:
    form = _forms(language).get(code)
    if not code:
        return text
    if form is None:
        form, language = text, "en"
    named = {name: _argument(name, value, language) for name, value in arguments.items()}
    try:
        return _Formatter(language).vformat(form, (), named)
    except (KeyError, ValueError, TypeError):  # a document's own words, or damaged ones
        return form


def sentence(told: Any, language: str) -> str:
    """What a fact, an error or a fact of an event (a dict) says. ``language``: "en" or "de". Of an
    error of another kind, what it says itself."""
    said = _sentence(told, language)
    return said if getattr(told, "code", "") in AS_WRITTEN else _words(said)


def _sentence(told: Any, language: str) -> str:
    if isinstance(told, dict):
        parts = [*told.get("context", ()), told, *told.get("remarks", ())]
        return "".join(_filled(p["code"], p["text"], p["arguments"], language) for p in parts)
    if language == "en" or not hasattr(told, "code"):
        return str(told)
    told_parts: list[tuple[str, str, Mapping[str, Any]]] = [
        *getattr(told, "context", ()),
        (told.code, told.text, told.arguments),
        *getattr(told, "remarks", ()),
    ]
    return "".join(_filled(code, text, given, language) for code, text, given in told_parts)


def reason(error: BaseException) -> str:
    """The sentence of an exception that is not ours, or the name of its class.

    An exception of FreeCAD's own has a dict in place of a text: {"sErrMsg": text, ...}.
    """
    said = error.args[0] if error.args else None
    text = str(said.get("sErrMsg", "")) if isinstance(said, dict) else str(error)
    return text or type(error).__name__


def fact_data(told: Any) -> dict[str, Any]:
    """A fact, or a sentence that is none, as JSON keeps it for ``sentence``: code, text, arguments, and
    where there are any context and remarks."""
    if not hasattr(told, "code"):
        return {"code": "", "text": told, "arguments": {}}
    return {
        **_part(told.code, told.text, told.arguments),
        **{k: [_part(*one) for one in getattr(told, k)] for k in PARTS if getattr(told, k)},
    }


def _part(code: str, text: str, arguments: Mapping[str, Any]) -> dict[str, Any]:
    kept = {k: _plain(v) for k, v in arguments.items()}
    return {"code": code, "text": text, "arguments": kept}


def _plain(value: Any) -> Any:
    """As JSON has it, which knows no number that is not finite."""
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return fact_data(value) if hasattr(value, "code") else value


def warnings(summary: Mapping[str, Any], language: str) -> list[str]:
    """The sentences of a run's warnings, from its summary; many of a kind as one."""
    told = summary.get("warning_facts") or summary.get("warnings", ())
    return [sentence(one, language) for one in grouped(told or ())]


def notes(found: Mapping[str, Any], language: str) -> list[str]:
    """The sentences of the notes of a verdict or a check of the settings. Of a version before 0.2, in
    English."""
    return [sentence(one, language) for one in found.get("note_facts") or found["notes"]]


def kind_text(kind: str) -> str:
    """A kind of events in English words: "force_not_reached" is "Force not reached"."""
    return kind.replace("_", " ").capitalize()


def event_title(event: Mapping[str, Any]) -> str:
    """The title of an event in English words: that of its kind, or where a belt is pressed without a wheel, and the kind is
    named by the wheel, one of its own."""
    of_belt = any(fact["code"].startswith(OF_A_BELT) for fact in event.get("facts", ()))
    return of_belt and BELT_TITLES.get(event["kind"]) or kind_text(event["kind"])


def event_message(event: Mapping[str, Any], language: str) -> str:
    """What happened, one line. Of a result without facts, of a version before 0.2, in English."""
    if language == "en" or not event.get("facts"):
        return _words(str(event["message"]))
    return "; ".join(sentence(fact, language) for fact in event["facts"])
