"""The options ``--base`` and ``--tool`` of a new program."""

import math


def add(command):
    """The options ``--base`` and ``--tool`` of a new program."""
    for what, name, example in (("base", "BASE", "BASE_DATA"), ("tool", "TOOL", "TOOL_DATA")):
        command.add_argument(
            f"--{what}",
            metavar=name,
            help=f"what a new program sets as its {what}: the controller's own (KRL: n of {example}[n]; "
            "RAPID: a name), numbers X,Y,Z,A,B,C in mm and degrees, or as-known: the numbers that are "
            "known of it (default: nothing; the program's head says what to set)",
        )


def given(arguments):
    """The options as ``write_program`` takes them."""
    return {"bases": _frame("base", arguments.base), "tools": _frame("tool", arguments.tool)}


def _frame(what, given):
    from ..base.frames import from_abc
    from ..engine import InputError

    if given is None or "," not in given:
        return given
    try:
        values = [float(value) for value in given.split(",")]
        if len(values) != 6 or not all(map(math.isfinite, values)):
            raise ValueError
    except ValueError:
        raise InputError(
            "cli.frame_numbers",
            "--{what} {given}: write X,Y,Z,A,B,C, mm and degrees, as in --{what}=0,0,120.5,0,90,0",
            what=what,
            given=given,
        ) from None
    return from_abc(values[:3], values[3:])
