"""From faces to a program that grinds them into tolerance."""

import functools
from pathlib import Path

from . import background, outcome, outputs, plan, robot_program, rounds_table, searching, settings
from .messages import print_text
from .program import add_form

PROGRAM = "raster.src"


def add(commands):
    """Adds the command to the parser's ``commands``."""
    grind = commands.add_parser(
        "grind",
        help="lay passes on faces and plan feeds and forces that bring them into tolerance (docs/planning.md)",
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
    robot_program.add_unsafe(grind)
    grind.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outcome.add(grind)
    outputs.add(grind)
    grind.set_defaults(do=_grind)


def _grind(arguments):
    from ..engine import InputError
    from ..job import robot_time
    from ..planning import apply, from_file, grinding, rounds as plans
    from ..programs.writers.writer import zones_written
    from ..raster import raster_path

    if Path(arguments.program).name != arguments.program:
        raise InputError(
            "cli.program_name",
            "--program {name}: give a name, not a path; it is written into the output folder",
            name=arguments.program,
        )
    _check_name(arguments.program, arguments.form)
    outcome.check(arguments)
    searching.budget(arguments)
    searching.wheels(arguments)
    wanted = plans.validate(settings.given(arguments.settings, arguments.set))
    passes = settings.given(arguments.raster, arguments.set_raster, "--set-raster")
    raster_path.validate(passes)

    watched = searching.Watched(None if arguments.quiet else rounds_table.Table().told)
    told = watched.told
    out, program = arguments.output, Path(arguments.output, arguments.program)
    notes, searched = [], []

    def write(found, entry=None):
        """Entries of the program's file in a job."""
        apply.write(found, out, [arguments.part], arguments.force, entry, *searched)
        notes[:] = _write_program(found, program, arguments.force, arguments.form)
        return [{"file": program.name}]

    def work(context):
        job, first = _job(arguments, context)
        form = robot_time.form(job, arguments.form)
        zones = functools.partial(zones_written, name=arguments.program, form=form)
        _check_name(arguments.program, arguments.form, job)
        apply.check({**job, "programs": []}, out, [arguments.part], arguments.force)
        begun = context.part(0.0, plan.PLANNING if wanted["check"] else 1.0)
        unchecked = {**wanted, "check": False}
        search = searching.search(arguments, job, passes, of_a_job=not first)
        found = grinding.grind(
            job, {**first, **passes}, unchecked, begun, told, zones, search, lambda: watched.enough
        )
        searched[:] = [found.search]
        if not wanted["check"]:
            return found, None
        rest = context.part(plan.PLANNING, 1.0)
        return found, from_file.check(found.plan, out, write, rest, told, before=False)

    ground, checked = background.run(work, arguments.quiet, watched.interrupted)
    found = ground.plan if checked is None else checked.plan
    write(found, None if checked is None else checked.entry)
    arguments.messages.print_warnings(ground.laid["warnings"])
    if robot_program.wanted(found.job):
        notes[:] = robot_program.in_place_of(program, found.job, arguments)
    arguments.messages.print_written(notes)
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


def _job(arguments, context):
    """(validated job, first settings of its raster)."""
    from ..engine import InputError
    from ..job import load as jobs
    from ..raster import proposal, raster_path

    faces = _faces(arguments.faces)
    if Path(arguments.part).suffix.lower() == ".json":
        if arguments.stock is not None:
            raise InputError(
                "cli.stock_of_job", "--stock is for a part's file; the job has its own"
            )
        job, first = raster_path.load_job(arguments.part), {}
        if faces:
            job["design"]["faces"] = faces
        return _with_tolerance(job, arguments), first
    given = {
        "design": {"file": arguments.part, **({"faces": faces} if faces else {})},
        "stock": {"allowance_mm": 0.3 if arguments.stock is None else arguments.stock},
        "programs": [{"poses": []}],
    }
    job = jobs.validate(given, Path.cwd())
    seen = proposal.propose(job, context.part(0.0, 0.0))
    given["sampling"] = {"spacing_mm": seen["spacing_mm"]}
    given["belt_machine"] = {
        "wheel": {"radius_mm": seen["wheel_radius_mm"], "width_mm": seen["wheel_width_mm"]},
        "compliance": {"rim_thickness_mm": seen["rim_thickness_mm"]},
        "force_N": seen["force_N"],
    }
    first = {
        "along": "direction",
        "direction": seen["direction"],
        "step_over_share": seen["step_over_share"],
        "feed_mm_s": seen["feed_mm_s"],
        "approach_feed_mm_s": seen["approach_feed_mm_s"],
    }
    arguments.messages.print_warnings(seen["notes"])
    return _with_tolerance(jobs.validate(given, Path.cwd()), arguments), first


def _with_tolerance(job, arguments):
    if arguments.tolerance:
        job["inspection"]["tolerance_mm"] = list(arguments.tolerance)
    return job


def _faces(text):
    from ..engine import InputError

    try:
        return [int(part) for part in text.split(",")] if text else []
    except ValueError:
        raise InputError(
            "cli.faces", "--faces {given}: write numbers from 1, as 3,4,9", given=text
        ) from None


def _check_name(name, form, job=None):
    """Refuses the name of a program that cannot be written, before anything is planned, and a job's force device that
    cannot set its force there. Raises InputError."""
    import tempfile

    import numpy as np

    from ..programs.force_device import of_job
    from ..programs.writers.writer import check_suffix, write_program

    check_suffix(name)
    poses = np.stack([np.eye(4)] * 3)
    poses[:, 0, 3] = range(3)
    passes = [{"poses": poses, "feed_mm_s": 1.0}]
    device = None
    if job is not None:
        device, passes[0]["force_N"] = of_job(job), job["belt_machine"]["force_N"]
    with tempfile.TemporaryDirectory() as folder:
        write_program(Path(folder, name), None, passes, form=form, force_device=device)


def _write_program(found, file, force, form):
    import os

    from ..engine import InputError
    from ..planning.written import write_made

    if os.path.lexists(file) and not force and not (file.parent / "plan.json").exists():
        raise InputError(
            "planning.not_of_a_plan",
            "{file}: is there already, and no plan has written it; choose another folder, or replace it by --force",
            file=file,
        )
    return write_made(found, 0, file, form)
