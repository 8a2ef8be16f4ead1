"""Sorting a batch of castings by their scans."""

import sys

from . import background, outputs, plan_batch, settings
from .messages import print_text


def add(commands):
    """Adds the command to the parser's ``commands``."""
    sort = commands.add_parser(
        "sort",
        help="castings by their scans: passes, passes with a plan of its own, scrap (docs/study.md)",
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
    sort.add_argument(
        "--workers",
        type=int,
        metavar="N",
        help="processes of this machine (default: one a core); 0: none, one part after the other",
    )
    plan_batch.add_alignment(sort)
    sort.add_argument(
        "--language", choices=("en", "de"), default="en", help="of the report (default en)"
    )
    sort.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outputs.add(sort)
    sort.set_defaults(do=_sort)


def _sort(arguments):
    from pathlib import Path

    from ..engine import InputError
    from ..job import load as jobs
    from ..studies import sorting, sorting_report

    if arguments.workers is not None and arguments.workers < 0:
        raise InputError(
            "cli.sort_workers", "--workers {count}: give 0 or more", count=arguments.workers
        )
    job = jobs.load(arguments.job)
    wanted = settings.given(arguments.settings, arguments.set)
    files = [Path(arguments.output, name) for name in (sorting.TABLE, sorting_report.REPORT)]
    outputs.check(arguments, files, [arguments.job, *arguments.scans])

    def told(progress):
        if not arguments.quiet:
            print(f"{progress.done} of {progress.parts} parts", file=sys.stderr, flush=True)

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
        ),
        quiet=True,
    )
    sorting_report.write(arguments.output, batch, job, arguments.share, arguments.language)
    if arguments.quiet:
        return
    for row in batch.parts:
        print_text(f"{row['part']}: {row['sorted']}{_why(row)}")
    found = sorting_report.counts(batch)
    print_text(", ".join(f"{count} {sort}" for sort, count in found.items() if count))


def _why(row):
    return f" ({row['reason']})" if row["reason"] else ""
