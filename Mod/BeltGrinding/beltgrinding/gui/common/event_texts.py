"""Events in words, in the language of the window."""

from __future__ import annotations

from ...base.messages import (
    body as body_name,
    event_message,
    event_title,
    fact_data,
    kind_text,
    sentence,
)
from ...objects.kinds import DocumentObject, Event
from ...objects.simulation import errors as found_errors
from .compat import translate
from .report_language import words


def severities() -> dict[str, tuple[str, str]]:
    """{severity: (its name, the name of several)}, the worst first."""
    return {
        "error": (translate("BeltGrinding", "Error"), translate("BeltGrinding", "Errors")),
        "warning": (translate("BeltGrinding", "Warning"), translate("BeltGrinding", "Warnings")),
        "info": (translate("BeltGrinding", "Note"), translate("BeltGrinding", "Notes")),
    }


def title(event: Event) -> str:
    """The title of an event; of a kind that is not known, its code in words."""
    return words()(event_title(event))


def message(event: Event) -> str:
    """What happened."""
    return event_message(event, words().code)


def bodies(event: Event) -> str:
    """The bodies that are concerned."""
    return ", ".join(body(name) for name in event["bodies"])


def body(name: str) -> str:
    """What a body of the cell is called."""
    return body_name(name, words().code)


def advice(event: Event) -> str:
    """What to try, "" if nothing is known."""
    return words()(event["advice"])


def errors(simulation: DocumentObject) -> str:
    """What went wrong on a Simulation's way, a line for each kind of event; "" where nothing did."""
    told = [fact_data(one) for one in found_errors(simulation)]
    for one in told:
        one["arguments"]["kind"] = words()(kind_text(one["arguments"]["kind"]))
    return "\n".join(sentence(one, words().code) for one in told)


COLOURS = {"error": "#c62828", "warning": "#e08a00", "info": "#1f5fa8"}
