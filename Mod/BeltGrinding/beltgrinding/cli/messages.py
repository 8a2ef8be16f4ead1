"""Errors and warnings on standard error, in the language of the locale or of ``--language``; errors as
JSON for scripts."""

import contextlib
import json
import math
import os
import sys
import unicodedata

CONTROLS = ("Cc", "Cf", "Cs")
LANGUAGES = ("en", "de")
HANDFUL = 8  # lines about a program; what matters most to its path comes first


def of_locale():
    """German where the locale's messages are, else English."""
    names = (os.environ.get(name) for name in ("LC_ALL", "LC_MESSAGES", "LANG"))
    return "de" if next(filter(None, names), "").startswith("de") else "en"


class Messages:
    """``language``: "en", "de" or None for the locale's. ``as_json``: errors as one line of JSON.
    ``everything``: each warning in a line of its own."""

    def __init__(self, language=None, as_json=False):
        self.set(language, as_json)
        self.everything = False

    def set(self, language, as_json):
        self.language, self.as_json = language or of_locale(), as_json

    def print_error(self, error):
        """An InputError, one line on standard error."""
        if self.as_json:
            text = json.dumps({"error": error_data(error)}, allow_nan=False)
        else:
            text = "beltgrind: " + " ".join(self._sentence(error).split())
        _to_stderr(text)

    def print_warnings(self, warnings):
        """Sentences or facts, a line each; many of a kind in one line and no more than ``HANDFUL`` of what programs
        have, unless ``everything`` is set."""
        from ..base.grouping import grouped

        told = list(warnings)
        shown = told if self.everything else grouped(told)
        rest = [] if self.everything else [one for one in shown if _of_program(one)][HANDFUL:]
        self._print("cli.warning", "warning", [one for one in shown if not _within(one, rest)])
        if rest:
            from ..engine import Fact

            self.print_notes(
                [
                    Fact(
                        "cli.more_problems",
                        "{count} more lines about the program; {option} prints all",
                        count=len(rest),
                        option="--all",
                    )
                ]
            )
        if len(shown) < len(told):
            from ..engine import Fact

            note = Fact(
                "cli.warnings_grouped",
                "{count} warnings in {lines} lines; {option} prints each",
                count=len(told),
                lines=len(shown),
                option="--all",
            )
            self.print_notes([note])

    def print_events(self, events, job):
        """What went wrong on a run's way, a line for each kind of event, errors first."""
        from ..cell.event_lines import lines

        for severity, one in lines(events, job):
            if severity == "error":
                self._print("cli.error", "error", [one])
            else:
                self._print("cli.warning", "warning", [one])

    def print_written(self, facts):
        """What ``write_program`` tells: forces that the program does not set as they are planned, and a form that the
        controller does not follow, are warnings."""
        warned = ("programs.writers.force_", "job.form_")
        warnings = [one for one in facts if one.code.startswith(warned)]
        self.print_warnings(warnings)
        self.print_notes([one for one in facts if one not in warnings])

    def print_notes(self, notes):
        """Facts that are no warnings, a line each."""
        self._print("cli.note", "note", notes)

    def _print(self, code, form, told):
        from ..base.messages import word

        name = word(code, form, self.language)
        for one in told:
            _to_stderr(f"{name}: {' '.join(self._sentence(one).split())}")

    def _sentence(self, told):
        from ..base.messages import sentence

        return sentence(told, self.language)


def _within(one, others):
    return any(one is other for other in others)


def _of_program(told):
    """Whether a fact, or the first of several as one, is of a program that is read."""
    code = getattr(told, "code", "")
    if code.startswith("base.more_alike"):
        return _of_program(told.arguments["first"])
    return code.startswith("programs.")


def print_text(text):
    """On standard output, as a terminal can show it."""
    print(without_controls(text))


def _to_stderr(text):
    with contextlib.suppress(OSError):  # nowhere to say it; the exit status does
        print(without_controls(text), file=sys.stderr, flush=True)


def without_controls(text):
    """Names of files and zones may hold what a terminal obeys, or what turns the writing round."""
    return "".join(
        c if c == "\n" or unicodedata.category(c) not in CONTROLS else f"\\x{ord(c):02x}"
        for c in text
    )


def error_data(error):
    """An InputError as JSON has it: ``code``, ``message`` (English), ``culprit``, ``arguments`` and
    ``context``, the parts of the message before its own, the outermost first, each with code and
    arguments; ``remarks`` likewise, after it. A number that is not finite becomes its text."""
    return {
        "code": error.code,
        "message": str(error),
        "culprit": _plain(error.culprit),
        "arguments": _plain(error.arguments),
        "context": _parts(error.context),
        "remarks": _parts(error.remarks),
    }


def _parts(parts):
    return [{"code": code, "arguments": _plain(arguments)} for code, _, arguments in parts]


def _plain(arguments):
    return {
        name: str(value) if isinstance(value, float) and not math.isfinite(value) else value
        for name, value in arguments.items()
    }
