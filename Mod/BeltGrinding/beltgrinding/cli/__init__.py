"""The command line: ``python3 -m beltgrinding run job.json -o out/``.

Exit status: 0 success, 2 wrong input (one line on standard error), 130 interrupted.
"""

import argparse
import json
import sys

from . import calibrate, grind, inspect, lists, measure, press, program, report

# Each has ``add(commands)``, which gives every command of its topic a function ``do(arguments)``. In
# these functions stand the imports that need the compiled core.
TOPICS = (grind, press, program, calibrate, inspect, measure, report, lists)


def _parser():
    parser = argparse.ArgumentParser(
        prog="beltgrind", description="Simulates robotic belt grinding without FreeCAD."
    )
    parser.add_argument("--version", action="store_true", help="print versions and exit")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")
    for topic in TOPICS:
        topic.add(commands)
    return parser


def main(argv=None):
    """Runs the command line; returns the exit status."""
    parser = _parser()
    arguments = parser.parse_args(argv)
    try:
        from ..engine import Cancelled, InputError, core
    except ImportError as error:
        print(f"beltgrind: {error}", file=sys.stderr)
        return 1
    try:
        if arguments.version:
            print(json.dumps(core.versions()))
        elif arguments.command is None:
            parser.print_usage(sys.stderr)
            return 2
        else:
            arguments.do(arguments)
    except InputError as error:
        print("beltgrind: " + " ".join(str(error).split()), file=sys.stderr)
        return 2
    except (KeyboardInterrupt, Cancelled):
        print("beltgrind: interrupted; nothing was written", file=sys.stderr)
        return 130
    except MemoryError:
        print("beltgrind: out of memory; enlarge sampling.spacing_mm", file=sys.stderr)
        return 2
    return 0
