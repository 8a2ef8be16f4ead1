"""One job many times, with what varies."""

import json
import os
import sys
import time
from pathlib import Path

from . import background, figures, interrupts, where
from .messages import print_text

LOG_S = 60.0  # between two lines of progress where standard error is no terminal
WIDTH = 78  # of a line of progress


def add(commands):
    """Adds the command to the parser's ``commands``."""
    study = commands.add_parser(
        "study",
        help="run a job many times with other values (docs/study.md)",
        description="Makes the runs of a study that are not in its folder yet, and writes the table. What is finished stays, "
        "whatever happens; the same command goes on.",
    )
    study.add_argument("study", help="study.json")
    study.add_argument("-o", "--output", required=True, help="folder for the table and the runs")
    where.add(study, "runs", "run")
    study.add_argument(
        "--count",
        action="store_true",
        help="tell how many runs there are and how long they take, run nothing",
    )
    study.add_argument(
        "--language", choices=("en", "de"), default="en", help="of the report (default en)"
    )
    study.add_argument(
        "--no-report", action="store_true", help="the table alone, no answers, report and pictures"
    )
    study.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    figures.add(study)
    study.set_defaults(do=_study)


def _study(arguments):
    from ..engine import InputError
    from ..studies import making, store

    if arguments.workers is not None and arguments.workers < 0:
        raise InputError(
            "cli.study_workers", "--workers {count}: give 0 or more", count=arguments.workers
        )
    arguments.quiet = arguments.quiet or arguments.json
    chunk = where.chunk(arguments)
    prepared = background.run(
        lambda context: making.prepare(making.load(arguments.study), context), quiet=True
    )
    if not arguments.quiet:
        arguments.messages.print_warnings(prepared.warnings)
    if arguments.count:
        print_text(_count(making.survey(prepared, arguments.output), arguments))
        return
    if arguments.slurm is not None:
        making.lay_out(prepared, arguments.output, [arguments.study])
        place = Path(os.path.realpath(arguments.output))
        command = ["study", place / store.STUDY, "-o", place]
        again = ["study", arguments.study, "-o", arguments.output]
        where.array(arguments, command, again)
        return
    shown = _Shown(arguments.quiet)

    def work(context):
        return making.run(
            prepared,
            arguments.output,
            context,
            shown.told,
            arguments.workers,
            arguments.scheduler,
            arguments.again,
            chunk,
            [arguments.study],
            arguments.tls,
        )

    try:
        found = background.run(work, quiet=True)
    except KeyboardInterrupt as error:
        raise shown.kept(arguments.output) or error from None
    finally:
        shown.end()
    told = _tell(found, arguments, chunk)
    if chunk is None and not arguments.no_report and found.table.done.any():
        told["answers"] = _answer(found, arguments)
    if arguments.json:
        figures.tell(arguments, told)


def _answer(found, arguments):
    """Writes answers, report and pictures; what they warn of is a warning. Returns what the answers' file holds."""
    from ..studies import report

    said = background.run(
        lambda context: report.write_answers(arguments.output, arguments.language, context, found),
        quiet=True,
    )
    if not arguments.quiet:
        arguments.messages.print_notes(said["note_facts"])
        print_text(f"{report.REPORT}, {report.ANSWERS} and {report.PICTURES} in {arguments.output}")
    return json.loads(Path(arguments.output, report.ANSWERS).read_bytes())


def _count(survey, arguments):
    """What --count says."""
    text = f"{survey.runs} runs, {survey.jobs} different jobs, {survey.there} of them are there already"
    if survey.left_s(1) is None:
        return f"{text}; how long a run takes is not known before the first ones"
    workers = 1 if arguments.workers == 0 else arguments.workers or survey.cores
    left = _duration(survey.left_s(workers))
    return f"{text}; the others take about {left} on {workers} cores, by those that are there"


def _tell(found, arguments, chunk):
    """Prints what came out, and returns its counts; failed runs are warnings, or errors where nothing came out or another
    try may mend them."""
    from ..engine import Fact, InputError
    from ..studies import table

    made = found.table
    status, done = made[table.STATUS], int(made.done.sum())
    failed = [k for k in range(len(made)) if status[k] == table.FAILED]
    if chunk is None and not arguments.quiet:
        print_text(
            f"{done} of {len(made)} runs have figures, {found.reused} were there already; "
            f"{table.FILE} in {arguments.output}"
        )
    told = {"runs": len(made), "done": done, "there_already": found.reused, "failed": len(failed)}
    if not failed:
        return told
    run, error = int(made[table.RUN][failed[0]]), made[table.ERROR][failed[0]]
    if found.broken_off:
        raise InputError(
            "studies.broken_off",
            "{count} runs did not come to an end, such as {run}: {error}; the same command tries them again",
            count=found.broken_off,
            run=run,
            error=error,
        )
    if chunk is None and not done:
        raise InputError(
            "studies.all_failed",
            "all of the {count} runs failed, such as {run}: {error}",
            count=len(failed),
            run=run,
            error=error,
        )
    arguments.messages.print_warnings(
        [
            Fact(
                "studies.some_failed",
                "{count} runs failed, such as {run}: {error}",
                count=len(failed),
                run=run,
                error=error,
            )
        ]
    )
    return told


class _Shown:
    """Progress on standard error: a line that is written anew on a terminal, else one now and then."""

    def __init__(self, quiet):
        self.quiet, self.terminal = quiet, sys.stderr.isatty()
        self.last, self.logged, self.shown = None, time.monotonic(), False

    def told(self, progress):
        self.last = progress
        if self.quiet:
            return
        if self.terminal:
            print(f"\r{line(progress):<{WIDTH}.{WIDTH}}", end="", file=sys.stderr, flush=True)
            self.shown = True
        elif time.monotonic() - self.logged > LOG_S:
            self.logged = time.monotonic()
            print(line(progress), file=sys.stderr, flush=True)

    def end(self):
        """Clears the terminal's line."""
        if self.shown:
            print("\r" + " " * WIDTH + "\r", end="", file=sys.stderr, flush=True)
            self.shown = False

    def kept(self, folder):
        """The Interrupted that tells what is finished; None where nothing was begun."""
        from ..engine import InputError

        if self.last is None:
            return None
        return interrupts.Interrupted(
            InputError(
                "studies.kept",
                "interrupted; {done} of {runs} runs are finished and kept in {folder}; the same command goes on from there",
                done=self.last.done,
                runs=self.last.runs,
                folder=folder,
            )
        )


def line(progress):
    """How far a study is, in words."""
    text = f"{progress.done} of {progress.runs} runs"
    if progress.failed:
        text += f", {progress.failed} failed"
    if progress.workers > 1:
        text += f", {progress.workers} at a time"
    if progress.done == progress.runs:
        return text
    if progress.left_s is None:
        return f"{text}, starting"
    return f"{text}, {_duration(progress.left_s)} left"


def _duration(seconds):
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
