"""The last line of a command that grinds: PASS or FAIL, and the exit status by it."""

import json

from .messages import print_text

PERCENT = 100.0


def add(parser):
    """Gives a command the options ``--check``, ``--wanted`` and ``--json``."""
    parser.add_argument("--check", action="store_true", help="exit status 1 where the part fails")
    parser.add_argument(
        "--wanted",
        type=float,
        metavar="PERCENT",
        help="of the area, in tolerance, for the part to pass (default: all of it)",
    )

    parser.add_argument(
        "--json",
        action="store_true",
        help="the outcome as one line of JSON in place of all that is for people",
    )


def check(arguments):
    """Refuses a ``--wanted`` that no part can have. Raises InputError."""
    from ..engine import InputError

    arguments.quiet = arguments.quiet or arguments.json
    if arguments.wanted is not None and not 0.0 < arguments.wanted <= PERCENT:
        raise InputError(
            "cli.wanted",
            "--wanted {given:g}: give a share of the area from above 0 to 100 percent",
            given=arguments.wanted,
        )


def tell(arguments, result, share=0.0):
    """Prints what happened on the way and the last line, and sets the exit status. ``share``: of the area, that the
    settings want in tolerance, 0: none; ``--wanted`` is before it."""
    from ..base.messages import sentence
    from ..inspection.outcome import as_json, outcome

    wanted = arguments.wanted / PERCENT if arguments.wanted is not None else share or 1.0
    found = outcome(result.verdict, result.events, wanted)
    if not arguments.quiet:
        arguments.messages.print_events(result.events, result.job)
        print_text(sentence(found.told, arguments.messages.language))
    if arguments.json:
        time = {"process_time_s": result.summary["process_time_s"]}
        print(json.dumps({**as_json(result.verdict, found), **time}, allow_nan=False))
    if arguments.check and not found.passed:
        arguments.status = 1
