"""A report's words and numbers in the reader's language."""

from __future__ import annotations

import math

from ..base import messages
from ..engine import InputError

LANGUAGES = ("en", "de")
DASH = "\N{EN DASH}"  # where a number is not known


class Language:
    """``words("English text {name}", name=value)`` is the text in the language."""

    def __init__(self, code: str = "en") -> None:
        if code not in LANGUAGES:
            raise InputError(
                "reporting.no_language",
                "report: no language '{language}'; choose {choices}",
                language=code,
                choices=" or ".join(LANGUAGES),
            )
        self.code = code
        self.texts = messages.of_report(code)

    def __call__(self, text: str, **values: object) -> str:
        return self.texts.get(text, text).format(**values) if values else self.texts.get(text, text)

    def number(self, value: float | None, decimals: int = 3, sign: bool = False) -> str:
        """A number with fixed decimals; a dash for None and what is not finite."""
        if value is None or not math.isfinite(value):
            return DASH
        text = f"{round(value, decimals) + 0.0:{'+' if sign else ''}.{decimals}f}"
        return self.decimal(text)

    def decimal(self, text: str) -> str:
        """A number that is written already, with the language's own signs."""
        return messages.decimal(text, self.code)

    def figures(self, value: float | None, count: int = 4) -> str:
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

    def whole(self, value: int | None) -> str:
        """A count, in groups of three digits."""
        return DASH if value is None else f"{value:,}".replace(",", "\N{NARROW NO-BREAK SPACE}")

    def ordinal(self, value: int) -> str:
        """A place in a row: 3rd, 3."""
        if self.code == "de":
            return f"{value}."
        ending = (
            "th" if value // 10 % 10 == 1 else {1: "st", 2: "nd", 3: "rd"}.get(value % 10, "th")
        )
        return f"{value}{ending}"

    def percent(self, share: float | None, decimals: int = 1) -> str:
        """A share as percent. What is not quite all, or not quite nothing, does not look so."""
        if share is None:
            return DASH
        value, step = 100.0 * share, 10.0**-decimals
        if 0.0 < value < step:
            return f"< {self.number(step, decimals)} %"
        if 100.0 - step < value < 100.0:
            return f"> {self.number(100.0 - step, decimals)} %"
        return f"{self.number(value, decimals)} %"

    def short(self, name: str, most: int = 36) -> str:
        """A name that leaves room for others beside it: its middle gives way."""
        if len(name) <= most:
            return name
        return f"{name[: most // 2]}…{name[1 - (most - most // 2) :]}"

    def band(self, lower: float, upper: float) -> str:
        """A tolerance band, mm."""
        return f"{self.number(lower, 3, True)} … {self.number(upper, 3, True)} mm"

    def seconds(self, value: float | None) -> str:
        """A duration: seconds, or minutes and seconds."""
        if value is None or value < 60.0:
            return f"{self.number(value, 1)} s"
        return f"{int(value // 60)} min {self.number(value % 60, 0)} s"
