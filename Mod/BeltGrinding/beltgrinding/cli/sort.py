"""Sorting a batch of castings by their scans."""

import os
import sys
from pathlib import Path

from . import background, figures, interrupts, outputs, plan_batch, settings, where


def add(commands):
    """Adds the command to the parser's ``commands``."""
    sort = commands.add_parser(
        "sort",
        help="sort castings by their scans: passes, passes with a plan of its own, scrap (docs/castings.md)",
        description="Grinds each raw part as its scan shows it, by the job's program; plans feeds for those that do not "
        "pass; tells why the others cannot be saved.",
    )
    sort.add_argument("job", help="job.json")
    sort.add_argument("scans", nargs="+", help="meshes of the raw parts, or folders of them")
    sort.add_argument(
        "-o", "--output", required=True, help="folder for the table, report and plans"
    )
    sort.add_argument("--settings", help="JSON file of the plans' settings")
    sort.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="one of them; as JSON"
    )
    sort.add_argument(
        "--share",
        type=float,
        default=1.0,
        help="of the area that must be in tolerance (default 1: the verdict must be pass)",
    )
    where.add(sort, "parts", "part")
    plan_batch.add_alignment(sort)
    sort.add_argument(
        "--language", choices=("en", "de"), default="en", help="of the report (default en)"
    )
    sort.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outputs.add(sort)
    figures.add(sort)
    sort.set_defaults(do=_sort)


def _sort(arguments):
    from ..engine import InputError
    from ..job import load as jobs
    from ..studies import sorting, sorting_report

    if arguments.workers is not None and arguments.workers < 0:
        raise InputError(
            "cli.sort_workers", "--workers {count}: give 0 or more", count=arguments.workers
        )
    chunk = where.chunk(arguments)
    job = jobs.load(arguments.job)
    wanted = settings.given(arguments.settings, arguments.set)
    files = [Path(arguments.output, name) for name in (sorting.TABLE, sorting_report.REPORT)]
    outputs.check(arguments, files, [arguments.job, *arguments.scans])
    if arguments.slurm is not None:
        sorting.Tasks(job, arguments.scans, arguments.output, wanted, arguments.share, {})
        where.array(arguments, _command(arguments), _command(arguments))
        return
    last = []

    def told(progress):
        last[:] = [progress]
        if not arguments.quiet:
            print(f"{progress.done} of {progress.parts} parts", file=sys.stderr, flush=True)

    try:
        batch = background.run(
            lambda context: sorting.sort(
                job,
                arguments.scans,
                arguments.output,
                wanted,
                arguments.share,
                plan_batch.options(arguments),
                arguments.workers,
                context,
                told,
                arguments.scheduler,
                arguments.again,
                chunk,
                arguments.tls,
            ),
            quiet=True,
        )
    except KeyboardInterrupt as error:
        raise _kept(last, arguments.output) or error from None
    if chunk is not None:
        return
    sorting_report.write(arguments.output, batch, job, arguments.share, arguments.language)
    if arguments.quiet and not arguments.json:
        return
    lines = [f"{row['part']}: {row['sorted']}{_why(row)}" for row in batch.parts]
    found = sorting_report.counts(batch)
    text = ", ".join(f"{count} {sort}" for sort, count in found.items() if count)
    lines.append(f"{text}; {batch.reused} were there already" if batch.reused else text)
    parts = {row["part"]: row["sorted"] for row in batch.parts}
    told = {"sorts": found, "there_already": batch.reused, "parts": parts}
    figures.tell(arguments, told, "\n".join(lines))


def _command(arguments):
    """What a job of an array is told: the same, with paths that hold everywhere."""
    command = ["sort", os.path.abspath(arguments.job)]
    command += [os.path.abspath(scan) for scan in arguments.scans]
    command += ["-o", os.path.abspath(arguments.output), "--share", repr(arguments.share)]
    command += ["--unit-mm", repr(arguments.unit_mm)]
    for name in ("settings", "matrix", "pairs"):
        if getattr(arguments, name) is not None:
            command += [f"--{name}", os.path.abspath(getattr(arguments, name))]
    if arguments.datum_faces is not None:
        command += ["--datum-faces", arguments.datum_faces]
    command += [f"--{name}" for name in ("principal", "aligned") if getattr(arguments, name)]
    for one in arguments.set:
        command += ["--set", one]
    return command


def _kept(last, folder):
    """The Interrupted that tells what is finished; None where nothing was begun."""
    from ..engine import InputError

    if not last:
        return None
    return interrupts.Interrupted(
        InputError(
            "studies.parts_kept",
            "interrupted; {done} of {parts} parts are sorted and kept in {folder}; the same command goes on from there",
            done=last[0].done,
            parts=last[0].parts,
            folder=folder,
        )
    )


def _why(row):
    return f" ({row['reason']})" if row["reason"] else ""
