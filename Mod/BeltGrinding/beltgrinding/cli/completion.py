"""Scripts by which bash, zsh and fish complete the command line, made from its parser."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from .parser import PROGRAM, CommandLine, Parser


def script(shell: str, commands: CommandLine) -> str:
    """The script for a shell, ``bash``, ``zsh`` or ``fish``."""
    makers: dict[str, Callable[[CommandLine], str]] = {"bash": _bash, "zsh": _zsh, "fish": _fish}
    return makers[shell](commands)


def _actions(parser: Parser) -> list[argparse.Action]:
    return [one for one in parser._actions if one.option_strings]


def _choices(parser: Parser) -> list[str]:
    """What may stand in the place of an argument."""
    found: list[str] = []
    for one in parser._actions:
        if not one.option_strings and one.choices:
            found += map(str, one.choices)
    return found


def _bash(commands: CommandLine) -> str:
    cases, values = [], {}
    for name, parser in commands.commands.items():
        words = [option for one in _actions(parser) for option in one.option_strings]
        more = list(commands.commands) if name == "help" else _choices(parser)
        cases.append(f"        {name}) words='{' '.join(more + words)}' ;;")
        for one in _actions(parser):
            if one.choices:
                values.update({option: one.choices for option in one.option_strings})
    chosen = [
        f"        {option}) COMPREPLY=($(compgen -W '{' '.join(map(str, known))}' -- \"$word\")); return ;;"
        for option, known in sorted(values.items())
    ]
    top = " ".join(
        [*commands.commands, *(o for one in _actions(commands) for o in one.option_strings)]
    )
    return "\n".join(
        [
            f"# bash completion for {PROGRAM}",
            f"_{PROGRAM}() {{",
            '    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} words command="" i',
            "    for ((i = 1; i < COMP_CWORD; i++)); do",
            "        [[ ${COMP_WORDS[i]} == -* ]] || { command=${COMP_WORDS[i]}; break; }",
            "    done",
            '    case "$before" in',
            *chosen,
            "    esac",
            '    case "$command" in',
            *cases,
            f"        *) words='{top}' ;;",
            "    esac",
            '    COMPREPLY=($(compgen -W "$words" -- "$word"))',
            '    [[ -z $command || $word == -* ]] || COMPREPLY+=($(compgen -f -- "$word"))',
            "}",
            f"complete -o filenames -F _{PROGRAM} {PROGRAM}",
            "",
        ]
    )


def _zsh(commands: CommandLine) -> str:
    listed = [f"        '{name}:{_plain(text)}'" for name, text in commands.helps.items()]
    cases = []
    for name, parser in commands.commands.items():
        lines = [
            f"                '{option}[{_plain(one.help or '')}]{_zsh_value(one)}'"
            for one in _actions(parser)
            for option in one.option_strings
        ]
        more = list(commands.commands) if name == "help" else _choices(parser)
        places = (
            f"                '*:argument:({' '.join(more)})'"
            if more
            else "                '*:file:_files'"
        )
        cases += [f"        {name})", "            _arguments \\"]
        cases += [f"{line} \\" for line in lines] + [places, "            ;;"]
    return "\n".join(
        [
            f"#compdef {PROGRAM}",
            f"_{PROGRAM}() {{",
            "    local -a commands=(",
            *listed,
            "    )",
            "    if ((CURRENT == 2)); then",
            "        _describe command commands",
            "        return",
            "    fi",
            "    local command=$words[2]",
            "    shift words",
            "    ((CURRENT--))",
            "    case $command in",
            *cases,
            "    esac",
            "}",
            # read by `source` it has to be named; as a file of $fpath it is called at once
            f'if [[ $funcstack[1] == _{PROGRAM} ]]; then _{PROGRAM} "$@"; else compdef _{PROGRAM} {PROGRAM}; fi',
            "",
        ]
    )


def _zsh_value(one: argparse.Action) -> str:
    if one.nargs == 0:
        return ""
    return f":value:({' '.join(map(str, one.choices))})" if one.choices else ":value:_files"


def _plain(text: str) -> str:
    """A text for zsh and fish: without what ends a word or a description there."""
    return "".join(c for c in text if c not in "'[]:`\\%")


def _fish(commands: CommandLine) -> str:
    lines = [f"# fish completion for {PROGRAM}"]
    known = " ".join(commands.commands)
    for name, text in commands.helps.items():
        lines.append(
            f"complete -c {PROGRAM} -f -n 'not __fish_seen_subcommand_from {known}' -a {name} -d '{_plain(text)}'"
        )
    for name, parser in commands.commands.items():
        here = f"complete -c {PROGRAM} -n '__fish_seen_subcommand_from {name}'"
        more = list(commands.commands) if name == "help" else _choices(parser)
        if more:
            lines.append(f"{here} -f -a '{' '.join(more)}'")
        for one in _actions(parser):
            names = " ".join(
                f"-l {o[2:]}" if o.startswith("--") else f"-s {o[1:]}" for o in one.option_strings
            )
            value = (
                f" -x -a '{' '.join(map(str, one.choices))}'"
                if one.choices
                else ""
                if one.nargs == 0
                else " -r"
            )
            lines.append(f"{here} {names}{value} -d '{_plain(one.help or '')}'")
    return "\n".join(lines) + "\n"
