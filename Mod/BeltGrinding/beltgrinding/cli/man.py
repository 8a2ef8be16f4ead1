"""Man pages, made from the parser of the command line: ``python3 -m beltgrinding.cli.man FOLDER``."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from . import command_line
from .examples import EXAMPLES
from .parser import DESCRIPTION, PROGRAM, TASKS, CommandLine, Parser

STATUS = (
    "0 success, 1 a part or a program that fails where that is asked for, "
    "2 wrong input (one line on standard error), 130 interrupted."
)


def write(folder: Path | str) -> None:
    """Writes beltgrind.1 and a page for each command into a folder, which is made."""
    place = Path(folder)
    place.mkdir(parents=True, exist_ok=True)
    commands = command_line()
    (place / f"{PROGRAM}.1").write_text(_whole(commands), encoding="utf-8")
    for name, parser in commands.commands.items():
        page = _page(name, parser, commands.helps[name])
        (place / f"{PROGRAM}-{name}.1").write_text(page, encoding="utf-8")


def _text(text: str) -> str:
    """A text for roff: no line begins a request."""
    plain = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join("\\&" + line if line[:1] in ".'" else line for line in plain.split("\n"))


def _head(name: str, about: str) -> list[str]:
    title = f'.TH "{name.upper()}" 1 "" "Belt Grinding" "User Commands"'
    return [title, ".SH NAME", f"{_text(name)} \\- {_text(about)}", ".SH SYNOPSIS"]


def _whole(commands: CommandLine) -> str:
    lines = _head(PROGRAM, "simulate robotic belt grinding without FreeCAD")
    lines += [f".B {PROGRAM}", "COMMAND [OPTION ...]", ".SH DESCRIPTION", _text(DESCRIPTION)]
    for task, names in TASKS:
        lines.append(f".SS {task}")
        for name in names:
            lines += [".TP", f".BR {PROGRAM}\\-{_text(name)} (1)", _text(commands.helps[name])]
    lines += [".SH OPTIONS", *_arguments(commands), ".SH EXIT STATUS", _text(STATUS)]
    return "\n".join(lines) + "\n"


def _page(name: str, parser: Parser, about: str) -> str:
    usage = parser.format_usage().removeprefix("usage: ")
    lines = _head(f"{PROGRAM}-{name}", about)
    lines += [
        ".nf",
        _text(usage.rstrip()),
        ".fi",
        ".SH DESCRIPTION",
        _text(parser.description or ""),
    ]
    lines += [".SH OPTIONS", *_arguments(parser), ".SH EXAMPLES", ".nf"]
    lines += [_text(f"{PROGRAM} {line}") for line in EXAMPLES.get(name, ())]
    lines += [".fi", ".SH EXIT STATUS", _text(STATUS), ".SH SEE ALSO", f".BR {PROGRAM} (1)"]
    return "\n".join(lines) + "\n"


def _arguments(parser: argparse.ArgumentParser) -> list[str]:
    lines: list[str] = []
    for one in parser._actions:
        if one.help == argparse.SUPPRESS:
            continue
        value = "" if one.nargs == 0 else _value(one)
        names = ", ".join(one.option_strings)
        word = _text(f"{names} {value}".strip())
        lines += [".TP", f'.B "{word}"', _text(one.help or "").replace("%%", "%")]
    return lines


def _value(one: argparse.Action) -> str:
    if one.choices and not one.metavar:
        return "{" + ",".join(map(str, one.choices)) + "}"
    if isinstance(one.metavar, tuple):
        return " ".join(one.metavar)
    return str(one.metavar or (one.dest.upper() if one.option_strings else one.dest))


if __name__ == "__main__":
    write(sys.argv[1])
