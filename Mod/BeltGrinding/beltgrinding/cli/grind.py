"""Grinding a job."""

import sys
import threading
from pathlib import Path

CANCEL_TIME = 5.0  # s


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    run = commands.add_parser("run", help="grind a job")
    run.add_argument("job", help="job.json")
    run.add_argument("-o", "--output", required=True, help="folder for the results")
    run.add_argument("--belt", help="JSON file that carries the belt's use from job to job")
    run.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    run.set_defaults(do=_run)


def _show_progress(context, done):
    while not done.wait(0.2):
        print(f"\r{100 * context.progress:3.0f} %", end="", file=sys.stderr, flush=True)
    print("\r     \r", end="", file=sys.stderr, flush=True)


def _run(arguments):
    from .. import core, job, law

    given = job.load(arguments.job)
    if arguments.belt and Path(arguments.belt).exists():
        given["belt_machine"]["belt"] = law.read_belt(arguments.belt)
    context = core.RunContext()
    outcome = {}
    done = threading.Event()

    def work():
        try:
            outcome["result"] = job.run(given, context)
        except BaseException as error:  # handed on to the main thread
            outcome["error"] = error

    # In a thread of its own, so that Ctrl-C reaches the main thread while C++ computes.
    worker = threading.Thread(target=work, daemon=True)
    worker.start()
    if sys.stderr.isatty() and not arguments.quiet:
        threading.Thread(target=_show_progress, args=(context, done), daemon=True).start()
    try:
        while worker.is_alive():
            worker.join(0.1)
    except KeyboardInterrupt:
        context.cancel()
        worker.join(CANCEL_TIME)  # a library that reads a damaged file may never come back
        raise
    finally:
        done.set()
    if "error" in outcome:
        raise outcome["error"]
    outcome["result"].write(arguments.output)
    if arguments.belt:
        law.write_belt(arguments.belt, outcome["result"].summary["belt"])
    if not arguments.quiet:
        _report(outcome["result"].summary, arguments.output)


def _report(summary, output):
    for warning in summary["warnings"]:
        print(f"warning: {warning}", file=sys.stderr)
    deviation = summary["deviation_mm"]
    print(
        f"{summary['samples']} samples, {summary['steps']} steps, "
        f"{summary['removed_volume_mm3']:.1f} mm3 removed; deviation "
        f"{deviation['min']:+.3f} to {deviation['max']:+.3f} mm, "
        f"{100 * summary['in_tolerance_area_share']:.1f} % of the area in tolerance; "
        f"results in {output}"
    )
