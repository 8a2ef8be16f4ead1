"""Events in words, in the language of the window."""

from ...base.messages import body as body_name, event_message, event_title
from .compat import translate
from .report_language import words


def severities():
    """{severity: (its name, the name of several)}, the worst first."""
    return {
        "error": (translate("BeltGrinding", "Error"), translate("BeltGrinding", "Errors")),
        "warning": (translate("BeltGrinding", "Warning"), translate("BeltGrinding", "Warnings")),
        "info": (translate("BeltGrinding", "Note"), translate("BeltGrinding", "Notes")),
    }


def title(event):
    """The title of an event; of a kind that is not known, its code in words."""
    return words()(event_title(event))


def message(event):
    """What happened."""
    return event_message(event, words().code)


def bodies(event):
    """The bodies that are concerned."""
    return ", ".join(body(name) for name in event["bodies"])


def body(name):
    """What a body of the cell is called."""
    return body_name(name, words().code)


def advice(event):
    """What to try, "" if nothing is known."""
    return words()(event["advice"])


COLOURS = {"error": "#c62828", "warning": "#e08a00", "info": "#1f5fa8"}
