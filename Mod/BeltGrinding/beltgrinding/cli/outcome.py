"""The last line of a command that grinds: PASS or FAIL, and the exit status by it."""

from .messages import print_text

PERCENT = 100.0


def add(parser):
    """Gives a command the options ``--check`` and ``--wanted``."""
    parser.add_argument("--check", action="store_true", help="exit status 1 where the part fails")
    parser.add_argument(
        "--wanted",
        type=float,
        metavar="PERCENT",
        help="of the area, in tolerance, for the part to pass (default: all of it)",
    )


def check(arguments):
    """Refuses a ``--wanted`` that no part can have. Raises InputError."""
    from ..engine import InputError

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
    from ..inspection.outcome import outcome

    wanted = arguments.wanted / PERCENT if arguments.wanted is not None else share or 1.0
    passed, told = outcome(result.verdict, result.events, wanted)
    if not arguments.quiet:
        arguments.messages.print_events(result.events, result.job)
        print_text(sentence(told, arguments.messages.language))
    if arguments.check and not passed:
        arguments.status = 1
