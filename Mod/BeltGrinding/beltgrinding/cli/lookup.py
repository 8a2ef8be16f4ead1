"""What a shell and its user ask before they grind anything: help, and the completion of a line."""

from __future__ import annotations

from typing import Any

from .parser import CommandLine, meant

SHELLS = ("bash", "zsh", "fish")


def add(commands: CommandLine) -> None:
    """Adds the commands to the parser's ``commands``."""
    told = commands.add_parser("help", help="the options of a command, and examples")
    told.add_argument("about", metavar="COMMAND", nargs="?", help="default: the list of all")
    told.set_defaults(at_once=_help)
    completing = commands.add_parser(
        "completion",
        help="print what completes commands and options in a shell",
        description="Prints a script for the shell. It completes commands, options, their choices, and files.",
    )
    completing.add_argument("shell", choices=SHELLS)
    completing.set_defaults(at_once=_completion)


def _help(commands: CommandLine, arguments: Any) -> None:
    name = arguments.about
    if name is None:
        commands.print_help()
    elif name in commands.commands:
        commands.commands[name].print_help()
    else:
        commands.error(f"there is no command {name!r}{meant(name, commands.commands)}")


def _completion(commands: CommandLine, arguments: Any) -> None:
    from . import completion

    print(completion.script(arguments.shell, commands), end="")
