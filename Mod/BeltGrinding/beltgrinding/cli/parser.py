"""The parser of the command line: commands by task, help with examples, and what a misspelt word may mean."""

from __future__ import annotations

import argparse
import contextlib
import difflib
import json
import sys
from collections.abc import Callable, Iterable
from types import ModuleType
from typing import Any, NoReturn

from ..base.resources import documentation
from .examples import EXAMPLES
from .messages import LANGUAGES

PROGRAM = "beltgrind"
DESCRIPTION = "Simulates robotic belt grinding without FreeCAD."
JSON_ERRORS = "--json-errors"
ALL = "--all"
LARGEST, SMALLEST = 1e15, 1e-15  # numbers of the command line

# Every command stands under one of these.
TASKS = (
    ("Grind a part", ("grind", "plan", "run", "verify")),
    ("Parts and programs", ("faces", "raster", "program", "reach", "contact")),
    ("Look at a result", ("report", "view", "section", "mesh", "verdict", "converge")),
    (
        "Measure and learn",
        (
            "scan",
            "learn",
            "calibrate",
            "calibrate-finish",
            "calibrate-scan",
            "predict",
            "surrogate",
        ),
    ),
    ("Batches and belts", ("study", "sort", "belt-plan")),
    ("Look up", ("presets", "schema", "help", "completion")),
)


def _number(kind: type) -> Callable[[str], Any]:
    """A number that something can be: argparse tells of ValueErrors."""

    def read(text: str) -> Any:
        value = kind(text)
        if value != 0 and not SMALLEST <= abs(value) <= LARGEST:  # NaN is neither
            raise ValueError(text)
        return value

    read.__name__ = kind.__name__
    return read


class Parser(argparse.ArgumentParser):
    """Takes ``--json-errors`` and ``--all`` before and after the command; its own errors are JSON then, too."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        options.setdefault("formatter_class", argparse.RawDescriptionHelpFormatter)
        super().__init__(*arguments, **options)
        self.add_argument(
            JSON_ERRORS,
            action="store_true",
            default=argparse.SUPPRESS,
            help="an error as one line of JSON: its code, message, culprit and arguments",
        )
        self.add_argument(
            ALL,
            action="store_true",
            dest="everything",
            default=argparse.SUPPRESS,
            help="print each warning on its own line, in place of one line for many of a kind",
        )
        self.as_json = False
        self.register("type", float, _number(float))
        self.register("type", int, _number(int))

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        self.as_json = JSON_ERRORS in (sys.argv[1:] if args is None else args)
        return super().parse_known_args(args, namespace)

    def options(self) -> list[str]:
        """The long options that it takes."""
        return [name for name in self._option_string_actions if name.startswith("--")]

    def error(self, message: str) -> NoReturn:
        if not self.as_json:
            super().error(message)
        data = {"code": "cli.usage", "message": f"{self.prog}: {message}", "culprit": {}}
        data.update(arguments={"reason": message}, context=[], remarks=[])
        self.exit(2, json.dumps({"error": data}, allow_nan=False) + "\n")


class CommandLine(Parser):
    """The whole command line. ``commands``: the parser of each command by its name; ``helps``: what it does, in a line."""

    def __init__(self, topics: Iterable[ModuleType]) -> None:
        super().__init__(prog=PROGRAM, description=DESCRIPTION)
        self.commands: dict[str, Parser] = {}
        self.helps: dict[str, str] = {}
        self.add_argument("--version", action="store_true", help="print the version")
        self.add_argument(
            "--versions", action="store_true", help="print those of all parts as JSON"
        )
        self.add_argument(
            "--language",
            choices=LANGUAGES,
            dest="message_language",
            help="of errors and warnings (default: that of the locale, else en)",
        )
        self._places = super().add_subparsers(
            dest="command", metavar="COMMAND", parser_class=Parser, help=argparse.SUPPRESS
        )
        for topic in topics:
            topic.add(self)

    def add_parser(self, name: str, help: str, **options: Any) -> Parser:
        """A command. Its page of help has its examples."""
        options.setdefault("description", help[0].upper() + help[1:] + ".")
        examples = EXAMPLES.get(name, ())
        if examples:
            options["epilog"] = "examples:\n" + "\n".join(f"  {PROGRAM} {one}" for one in examples)
        made: Parser = self._places.add_parser(name, formatter_class=_Wrapped, **options)
        self.commands[name], self.helps[name] = made, help
        return made

    def format_help(self) -> str:
        lines = [DESCRIPTION, "", f"usage: {PROGRAM} COMMAND [OPTION ...]", ""]
        for task, names in TASKS:
            lines.append(f"{task}:")
            lines += [f"  {name:<18}{self.helps[name]}" for name in names if name in self.helps]
            lines.append("")
        lines.append("Options:")
        lines += [f"  {name:<18}{text}" for name, text in self._own_options()]
        lines += ["", f"'{PROGRAM} help COMMAND' has the options of a command, and examples."]
        lines.append("In a file's place - is standard input or output.")
        with contextlib.suppress(FileNotFoundError):
            lines.append(f"The pages docs/... lie in {documentation()}.")
        return "\n".join(lines) + "\n"

    def _own_options(self) -> list[tuple[str, str]]:
        return [
            (one.option_strings[-1], one.help or "") for one in self._actions if one.option_strings
        ]

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        given = list(sys.argv[1:] if args is None else args)
        self.as_json = JSON_ERRORS in given
        command = next((word for word in given if not word.startswith("-")), None)
        if (
            command is not None
            and self._is_command(given, command)
            and command not in self.commands
        ):
            self.error(f"there is no command {command!r}{meant(command, self.commands)}")
        read, rest = self.parse_known_args(given, namespace)
        if rest:
            parser = self.commands.get(read.command, self)
            parser.as_json = self.as_json
            parser.error(f"unknown: {' '.join(rest)}{meant(rest[0], parser.options())}")
        return read

    def _is_command(self, given: list[str], word: str) -> bool:
        """Not the value of an option before it."""
        at = given.index(word)
        return at == 0 or given[at - 1] != "--language"


class _Wrapped(argparse.RawDescriptionHelpFormatter):
    """The description in lines that fit the terminal, the examples as they stand."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        if text.startswith("examples:"):
            return text
        return argparse.HelpFormatter._fill_text(self, text, width, indent)


def meant(word: str, known: Iterable[str]) -> str:
    """'; did you mean ...?', or nothing where no known word is like it."""
    near = difflib.get_close_matches(word.split("=")[0], list(known), 2, 0.6)
    return f"; did you mean {' or '.join(near)}?" if near else ""
