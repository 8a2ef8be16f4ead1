"""The command line: ``python3 -m beltgrinding run job.json -o out/``.

Exit status: 0 success, 1 a part or a program that fails where that is asked for, 2 wrong input (one line on standard
error), 130 interrupted. How scripts read the
errors: docs/job-file.md.
"""

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
    lookup,
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
from .messages import Messages
from .parser import PROGRAM, CommandLine

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
    lookup,
)


def command_line():
    """The parser of all commands."""
    return CommandLine(TOPICS)


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
    parser = command_line()
    arguments = parser.parse_args(argv)
    messages.set(arguments.message_language, getattr(arguments, "json_errors", False))
    messages.everything = getattr(arguments, "everything", False)
    arguments.messages = messages
    if hasattr(arguments, "at_once"):  # what needs no core
        arguments.at_once(parser, arguments)
        return 0
    if arguments.command is None and not (arguments.version or arguments.versions):
        parser.print_help(sys.stderr)
        return 2
    try:
        from ..engine import Cancelled, InputError, core
    except ImportError as error:
        if faults.of_memory(error):
            return faults.out_of_memory(messages)
        print(f"beltgrind: {error}", file=sys.stderr)
        return 2
    try:
        if arguments.version:
            print(f"{PROGRAM} {core.versions()['beltgrinding']}")
        elif arguments.versions:
            print(json.dumps(core.versions(), allow_nan=False))
        else:
            from ..base import standard

            arguments.status = 0  # a command may set it
            with standard.allowed():
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
