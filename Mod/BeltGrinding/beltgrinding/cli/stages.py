"""Options and words of stages: wheels and belts that grind one after the other (planning/stages.py)."""

import functools
import itertools
import json
from pathlib import Path

from . import background, ground_files, outcome, plan, rounds_table, searching
from .messages import print_text

TABLE = "stages.json"
HEAD = (
    "stage",
    "wheel mm",
    "belt",
    "where",
    "leaves mm",
    "time s",
    "in tol. %",
    "changed",
)
WIDTHS = (5, 13, 8, 10, 9, 8, 9, 0)


def add(parser):
    """Gives a command the options of stages."""
    parser.add_argument(
        "--belts",
        metavar="BELTS",
        help="belts that may follow one another, the roughest first, as P80=law80.json,P240: presets' names, each with what "
        "calibrate wrote for it, if anything did",
    )
    parser.add_argument(
        "--stages",
        type=int,
        metavar="N",
        help="at most so many stages of the wheels and belts one after the other; default: 1, with --belts 4",
    )


def given(arguments):
    """(belts, most stages), or None: no stages are wanted. Raises InputError."""
    from ..engine import InputError
    from ..planning import belts, stages, wheels

    if arguments.stages is not None and arguments.stages < 1:
        raise InputError(
            "cli.stages", "--stages {given}: give a number from 1", given=arguments.stages
        )
    if arguments.belts is None and (arguments.stages or 1) < 2:
        return None
    if arguments.wheels == wheels.ANY:
        raise InputError(
            "cli.stages_wheels",
            "--wheels {given}: stages need the sizes of wheels that you have, as 20x15,10x8",
            given=arguments.wheels,
        )
    found = [] if arguments.belts is None else belts.given(arguments.belts)
    return found, arguments.stages or stages.MOST


def grind(arguments, in_turn, wanted, passes):
    """Plans stages and writes each into a folder of its own. ``in_turn``: as ``given``; ``wanted``: settings of the plan;
    ``passes``: of the raster."""
    from ..planning import belts, stages

    out = Path(arguments.output)
    watched = searching.Watched(None if arguments.quiet else rounds_table.Table().told)
    written = []

    def work(context):
        job, first = ground_files.job_of(arguments, context)
        ground_files.check_name(arguments.program, arguments.form, job)
        _check(out, arguments)
        if in_turn[0]:
            arguments.messages.print_warnings(belts.notes(job, in_turn[0]))
        chooser = _chooser(arguments, in_turn[0], job, first, passes, wanted, watched, context)
        node = chooser.choose(in_turn[1])

        def write(number, ground, part):
            files = ground_files.Files(arguments, out / f"stage_{number}")
            checked = files.checked(ground, wanted, part, watched.told)
            found = files.end(ground, checked)
            written.append((files, ground, checked, found))
            return found.after, Path(files.folder, "result", "heightfield.h5")

        return chooser, stages.grind(chooser, node, write, watched.told, lambda: watched.enough)

    chooser, staged = background.run(work, arguments.quiet, watched.interrupted)
    report = staged.report(chooser)
    _write(out, report)
    for files, ground, checked, found in written:
        arguments.messages.print_warnings(ground.laid["warnings"])
        arguments.messages.print_written(files.notes)
        plan.tell_checked(arguments, checked)
    arguments.messages.print_notes(staged.dropped)
    arguments.messages.print_warnings(_left_over(out, len(written)))
    if not arguments.quiet:
        _tell(report, out)
    outcome.tell(arguments, staged.stages[-1].result, wanted["wanted_share"])


def _chooser(arguments, belts, job, first, passes, wanted, watched, context):
    from ..planning import search as searches, stages, wheels
    from ..programs.writers.writer import zones_written

    from ..job import robot_time

    own = arguments.wheels in (None, wheels.OWN)
    more = [] if own else wheels.mounted(job, wheels.given(arguments.wheels))
    tools = stages.tools(job, [job["belt_machine"], *more], belts)
    form = robot_time.form(job, arguments.form)
    search = searches.Search(
        budget_s=searching.budget(arguments),
        fixed=tuple(sorted(passes)),
        workers=arguments.processes,
    )
    return stages.Chooser(
        tools,
        stages.first_settings({**first, **passes}),
        {**wanted, "check": False},
        search,
        functools.partial(zones_written, name=arguments.program, form=form),
        None if arguments.quiet else _tried,
        lambda: watched.enough,
        context,
    )


def _left_over(out, count):
    """[Fact] of folders behind the last stage, which an earlier plan of more stages has written."""
    from ..engine import core

    numbers = itertools.takewhile(
        lambda number: (out / f"stage_{number}").exists(), itertools.count(count + 1)
    )
    return [
        core.Fact(
            "planning.stage_left_over",
            "{file}: is of an earlier plan; these stages do not need it",
            file=str(out / f"stage_{number}"),
        )
        for number in numbers
    ]


def _check(out, arguments):
    """Refuses to write the table over another's file. Raises InputError."""
    from ..engine import InputError

    file = out / TABLE
    if file.exists() and not arguments.force and not (out / "stage_1" / "plan.json").exists():
        raise InputError(
            "planning.not_of_a_plan",
            "{file}: is there already, and no plan has written it; choose another folder, or replace it by --force",
            file=file,
        )


def _write(out, report):
    from ..base.files import cannot_be_written, json_bytes, write_whole

    try:
        write_whole(out / TABLE, json_bytes(report))
    except OSError as error:
        raise cannot_be_written(out / TABLE, error) from None


def _tried(row):
    told = " > ".join(_short(one) for one in row["stages"])
    share = f"{100 * row['in_tolerance']:.1f} % in tolerance"
    if row["stages"][-1]["leave_mm"]:
        share = f"{100 * row['reached']:.1f} % of what it is to do"
    print_text(f"{told}: {share}, {row['process_time_s']:.0f} s of grinding")


def _short(one):
    words = [rounds_table.wheel(one["wheel"]), one["belt"]]
    words += [] if one["everywhere"] else ["where too much is left"]
    words += [f"leaving {one['leave_mm']:g} mm"] if one["leave_mm"] else []
    return " ".join(word for word in words if word)


def _tell(report, out):
    lines = [HEAD]
    for number, one in enumerate(report["stages"], 1):
        lines.append(
            (
                str(number),
                rounds_table.wheel(one["wheel"]),
                one["belt"] or "-",
                "everywhere" if one["everywhere"] else "what is left",
                f"{one['leave_mm']:g}",
                f"{one['process_time_s']:.1f}",
                f"{100 * one['in_tolerance']:.1f}",
                " and ".join(one["changed"]),
            )
        )
    for line in lines:
        print_text("  ".join(text.rjust(width) for text, width in zip(line, WIDTHS)).rstrip())
    seconds = sum(one["process_time_s"] for one in report["stages"])
    print_text(
        f"{len(report['stages'])} stages, {report['tool_changes']} tool changes, {seconds:.1f} s of grinding; programs, "
        f"jobs and results in {out}"
    )
