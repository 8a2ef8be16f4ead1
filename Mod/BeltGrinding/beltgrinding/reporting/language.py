"""A report's words and numbers in the reader's language."""

import json
import math
from functools import lru_cache

from ..base import messages
from ..base.resources import resources
from ..engine import InputError

LANGUAGES = ("en", "de")
DASH = "\N{EN DASH}"  # where a number is not known


@lru_cache(maxsize=None)
def _texts(language):
    """English text: text in another language."""
    path = resources() / "report" / f"{language}.json"
    return json.loads(path.read_text(encoding="utf-8"))


class Language:
    """``words("English text {name}", name=value)`` is the text in the language."""

    def __init__(self, code="en"):
        if code not in LANGUAGES:
            raise InputError(
                "reporting.no_language",
                "report: no language '{language}'; choose {choices}",
                language=code,
                choices=" or ".join(LANGUAGES),
            )
        self.code = code
        self.texts = {} if code == "en" else _texts(code)

    def __call__(self, text, **values):
        return self.texts.get(text, text).format(**values) if values else self.texts.get(text, text)

    def number(self, value, decimals=3, sign=False):
        """A number with fixed decimals; a dash for None and what is not finite."""
        if value is None or not math.isfinite(value):
            return DASH
        text = f"{round(value, decimals) + 0.0:{'+' if sign else ''}.{decimals}f}"
        return self.decimal(text)

    def decimal(self, text):
        """A number that is written already, with the language's own signs."""
        return messages.decimal(text, self.code)

    def figures(self, value, count=4):
        """A number with so many figures, as large or small as it may be."""
        if value is None or not math.isfinite(value):
            return DASH
        text = f"{value:.{count}g}"
        mantissa, e, power = text.partition("e")
        mantissa = self.decimal(mantissa)
        if not e:
            return mantissa
        raised = str(int(power)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{mantissa} · 10{raised}"

    def whole(self, value):
        """A count, in groups of three digits."""
        return DASH if value is None else f"{value:,}".replace(",", "\N{NARROW NO-BREAK SPACE}")

    def ordinal(self, value):
        """A place in a row: 3rd, 3."""
        if self.code == "de":
            return f"{value}."
        ending = (
            "th" if value // 10 % 10 == 1 else {1: "st", 2: "nd", 3: "rd"}.get(value % 10, "th")
        )
        return f"{value}{ending}"

    def percent(self, share, decimals=1):
        """A share as percent. What is not quite all, or not quite nothing, does not look so."""
        if share is None:
            return DASH
        value, step = 100.0 * share, 10.0**-decimals
        if 0.0 < value < step:
            return f"< {self.number(step, decimals)} %"
        if 100.0 - step < value < 100.0:
            return f"> {self.number(100.0 - step, decimals)} %"
        return f"{self.number(value, decimals)} %"

    def short(self, name, most=36):
        """A name that leaves room for others beside it: its middle gives way."""
        if len(name) <= most:
            return name
        return f"{name[: most // 2]}…{name[1 - (most - most // 2) :]}"

    def band(self, lower, upper):
        """A tolerance band, mm."""
        return f"{self.number(lower, 3, True)} … {self.number(upper, 3, True)} mm"

    def seconds(self, value):
        """A duration: seconds, or minutes and seconds."""
        if value is None or value < 60.0:
            return f"{self.number(value, 1)} s"
        return f"{int(value // 60)} min {self.number(value % 60, 0)} s"
