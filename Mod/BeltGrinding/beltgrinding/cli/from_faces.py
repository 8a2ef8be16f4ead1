"""From faces to a program that grinds them into tolerance."""

import functools
from pathlib import Path

from . import (
    background,
    ground_files,
    outcome,
    outputs,
    plan,
    robot_program,
    rounds_table,
    searching,
    settings,
    stages,
)
from .messages import print_text
from .program import add_form

PROGRAM = "raster.src"


def add(commands):
    """Adds the command to the parser's ``commands``."""
    grind = commands.add_parser(
        "grind",
        help="lay passes on faces and plan feeds and forces that bring them into tolerance (docs/grind.md)",
        description="Lays passes on the faces, plans their feeds and forces, and tries other passes where that is not "
        "enough. A part's file alone gets a wheel and a force that suit its faces; a job.json has its own.",
    )
    grind.add_argument("part", help="job.json, or the file of a part")
    grind.add_argument("-o", "--output", required=True, help="folder for program, job and result")
    grind.add_argument("--faces", metavar="N,...", help="faces from 1, as `beltgrind faces` lists")
    grind.add_argument(
        "--stock",
        type=float,
        metavar="MM",
        help="of a part's file: stock on the faces, 0.3 if not given",
    )
    grind.add_argument(
        "--tolerance", nargs=2, type=float, metavar="MM", help="lower and upper limit, mm"
    )
    grind.add_argument("--raster", metavar="FILE", help="JSON file of the first passes' settings")
    grind.add_argument("--settings", help="JSON file of the plan's settings")
    for option, what in (("--set-raster", "the first passes"), ("--set", "the plan")):
        text = f"one setting of {what}; as JSON"
        grind.add_argument(option, action="append", default=[], metavar="KEY=VALUE", help=text)
    grind.add_argument(
        "--program",
        default=PROGRAM,
        metavar="NAME",
        help=f"the program's file in the folder; its suffix says the language ({PROGRAM})",
    )
    add_form(grind)
    searching.add(grind)
    stages.add(grind)
    robot_program.add_unsafe(grind)
    grind.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outcome.add(grind)
    outputs.add(grind)
    grind.set_defaults(do=_grind)


def _grind(arguments):
    from ..engine import InputError
    from ..job import robot_time
    from ..planning import apply, grinding, rounds as plans
    from ..programs.writers.writer import zones_written
    from ..raster import raster_path

    if Path(arguments.program).name != arguments.program:
        raise InputError(
            "cli.program_name",
            "--program {name}: give a name, not a path; it is written into the output folder",
            name=arguments.program,
        )
    ground_files.check_name(arguments.program, arguments.form)
    outcome.check(arguments)
    searching.budget(arguments)
    searching.wheels(arguments)
    in_turn = stages.given(arguments)
    wanted = plans.validate(settings.given(arguments.settings, arguments.set))
    passes = settings.given(arguments.raster, arguments.set_raster, "--set-raster")
    raster_path.validate(passes)
    if in_turn is not None:
        stages.grind(arguments, in_turn, wanted, passes)
        return

    watched = searching.Watched(None if arguments.quiet else rounds_table.Table().told)
    told = watched.told
    out = arguments.output
    files = ground_files.Files(arguments, out)

    def work(context):
        job, first = ground_files.job_of(arguments, context)
        form = robot_time.form(job, arguments.form)
        zones = functools.partial(zones_written, name=arguments.program, form=form)
        ground_files.check_name(arguments.program, arguments.form, job)
        apply.check({**job, "programs": []}, out, [arguments.part], arguments.force)
        begun = context.part(0.0, plan.PLANNING if wanted["check"] else 1.0)
        unchecked = {**wanted, "check": False}
        search = searching.search(arguments, job, passes, of_a_job=not first)
        found = grinding.grind(
            job, {**first, **passes}, unchecked, begun, told, zones, search, lambda: watched.enough
        )
        return found, files.checked(found, wanted, context.part(plan.PLANNING, 1.0), told)

    ground, checked = background.run(work, arguments.quiet, watched.interrupted)
    found = files.end(ground, checked)
    arguments.messages.print_warnings(ground.laid["warnings"])
    arguments.messages.print_written(files.notes)
    plan.tell_checked(arguments, checked)
    searching.tell(arguments, ground)
    if not arguments.quiet:
        print_text(plan.text(plans.summary(found), checked is not None, before=False))
        _tell_force(found)
        print_text(f"program, job and result in {out}")
    outcome.tell(arguments, found.after, wanted["wanted_share"])


def _tell_force(found):
    """Which one force is to be set by hand."""
    commands = found.commands
    forces = set(commands.force(found.factors).tolist())
    by_force = found.job["belt_machine"]["control"] == "force"
    if by_force and commands.device is None and len(forces) == 1:
        print_text(
            f"set {forces.pop():.4g} N by hand on the belt machine: the program sets no force"
        )
