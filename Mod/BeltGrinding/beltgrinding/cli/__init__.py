"""The command line: ``python3 -m beltgrinding run job.json -o out/``.

Exit status: 0 success, 1 a part or a program that fails where that is asked for, 2 wrong input (one line on standard
error), 130 interrupted. How scripts read the
errors: docs/job-file.md.
"""

import argparse
import contextlib
import json
import os
import signal
import sys

from . import (
    belt_plan,
    calibrate,
    learn,
    faces,
    faults,
    from_faces,
    grind,
    interrupts,
    inspect,
    lists,
    measure,
    plan,
    press,
    program,
    report,
    sort,
    study,
    verify,
    view,
)
from .messages import LANGUAGES, Messages

# Each has ``add(commands)``, which gives every command of its topic a function ``do(arguments)``. In
# these functions stand the imports that need the compiled core.
TOPICS = (
    grind,
    from_faces,
    plan,
    belt_plan,
    verify,
    press,
    program,
    faces,
    calibrate,
    learn,
    inspect,
    measure,
    study,
    sort,
    report,
    view,
    lists,
)


JSON_ERRORS = "--json-errors"
ALL = "--all"


LARGEST, SMALLEST = 1e15, 1e-15  # numbers of the command line


def _number(kind):
    """A number that something can be: argparse tells of ValueErrors."""

    def read(text):
        value = kind(text)
        if value != 0 and not SMALLEST <= abs(value) <= LARGEST:  # NaN is neither
            raise ValueError(text)
        return value

    return read


class _Parser(argparse.ArgumentParser):
    """Takes ``--json-errors`` and ``--all`` before and after the command; its own errors are JSON then, too."""

    def __init__(self, *arguments, **options):
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
            help="each warning in a line of its own; many of a kind are told in one",
        )
        self.as_json = False
        self.register("type", float, _number(float))
        self.register("type", int, _number(int))

    def parse_known_args(self, args=None, namespace=None):
        self.as_json = JSON_ERRORS in (sys.argv[1:] if args is None else args)
        return super().parse_known_args(args, namespace)

    def error(self, message):
        if not self.as_json:
            super().error(message)
        data = {"code": "cli.usage", "message": f"{self.prog}: {message}", "culprit": {}}
        data.update(arguments={"reason": message}, context=[], remarks=[])
        self.exit(2, json.dumps({"error": data}, allow_nan=False) + "\n")


def _parser():
    parser = _Parser(
        prog="beltgrind", description="Simulates robotic belt grinding without FreeCAD."
    )
    parser.add_argument("--version", action="store_true", help="print versions and exit")
    parser.add_argument(
        "--language",
        choices=LANGUAGES,
        dest="message_language",
        help="of errors and warnings (default: that of the locale, else en)",
    )
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")
    for topic in TOPICS:
        topic.add(commands)
    return parser


def main(argv=None):
    """Runs the command line; returns the exit status."""
    messages, status = Messages(), 0
    try:
        with faults.standard_streams():
            status = _main(argv, messages)
    except KeyboardInterrupt as error:  # before a command has begun, or while an error is told
        return _interrupted(messages, error)
    except Exception as error:  # of output, or memory
        status = _other_error(error, messages)
    return status


def process(handler=None):
    """``main`` as a process of its own, which it ends: Ctrl-C may come at any moment, and a thread that
    computes may still do so. ``handler``: of Ctrl-C, if it was another one before."""
    interrupts.install(handler)
    try:
        status = main()
    except SystemExit as error:  # argparse
        status = error.code if isinstance(error.code, int) else 2
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    os._exit(status)


def _main(argv, messages):
    arguments = _parser().parse_args(argv)
    messages.set(arguments.message_language, getattr(arguments, "json_errors", False))
    messages.everything = getattr(arguments, "everything", False)
    arguments.messages = messages
    try:
        from ..engine import Cancelled, InputError, core
    except ImportError as error:
        if faults.of_memory(error):
            return faults.out_of_memory(messages)
        print(f"beltgrind: {error}", file=sys.stderr)
        return 2
    try:
        if arguments.version:
            print(json.dumps(core.versions(), allow_nan=False))
        elif arguments.command is None:
            _parser().print_usage(sys.stderr)
            return 2
        else:
            arguments.status = 0  # a command may set it
            arguments.do(arguments)
    except InputError as error:
        messages.print_error(error)
        return 2
    except (KeyboardInterrupt, Cancelled) as error:
        return _interrupted(messages, error)
    except BrokenPipeError:
        raise
    except Exception as error:
        return _other_error(error, messages)
    return getattr(arguments, "status", 0)


def _other_error(error, messages):
    if faults.of_memory(error):
        return faults.out_of_memory(messages)
    if not faults.of_output(error):
        return faults.ours(error, messages)
    messages.print_error(faults.output_error(error))
    return 2


def _interrupted(messages, interruption):
    try:
        if isinstance(interruption, interrupts.Interrupted):
            messages.print_error(interruption.error)
            return 130
        from ..base.files import last_written
        from ..engine import InputError

        path = last_written()
        if path is None:
            error = InputError("cli.interrupted", "interrupted; nothing was written")
        else:
            error = InputError(
                "cli.interrupted_late", "interrupted; {file} was written whole before", file=path
            )
        messages.print_error(error)
    except (KeyboardInterrupt, ImportError):
        pass
    return 130
