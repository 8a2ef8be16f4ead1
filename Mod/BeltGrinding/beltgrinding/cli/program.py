"""Robot programs: read, changed, converted, laid out, reached."""

import json
import math
from pathlib import Path

from . import background, figures, frames_options, outputs, robot_program, settings


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    program = commands.add_parser(
        "program",
        help="read a robot program, write changes back into it, or convert it",
        usage="beltgrind program FILE [-o POSES.csv] [--strict]\n"
        "       beltgrind program write ORIGINAL CHANGES.csv -o NEW\n"
        "       beltgrind program convert FILE -o NEW.src|.mod|.script|.ls|.jbi|.csv\n"
        "       beltgrind program robot JOB.json -o NEW.src|.mod|.script|.ls|.jbi|.csv [--unsafe]",
        description="Says what is in a robot program. write: changed speeds, forces and offsets "
        "go back into the original, nothing else changes. convert: writes it in another language. robot: a program for "
        "the whole robot, from home by links through a job's passes and back (docs/robot.md).",
    )
    program.add_argument("program", nargs="+", metavar="FILE", help="the program's file")
    program.add_argument("-o", "--output", help="CSV of every programmed pose; the new program")
    frames_options.add(program)
    program.add_argument(
        "--force-device",
        metavar="JSON",
        help="what sets the pressing force in the program that is read, and in the one that is written: a file with "
        "the job's belt_machine.force_device, a job, or that JSON itself (docs/force-device.md)",
    )
    add_form(program, "as --controller follows them, without it as the source's motions say")
    program.add_argument(
        "--controller",
        metavar="ID",
        help="convert: write the passes as this controller follows them (beltgrind presets controllers)",
    )
    program.add_argument(
        "--roll",
        metavar="hold|along|X,Y,Z",
        help="how poses that are tool axes only (APT, G-code) are turned about them: held along a pass "
        "(default), along the pass, or the belt along a direction in the program's base",
    )
    program.add_argument(
        "--values",
        metavar="JSON",
        help="what only the controller knows (default: NAME.values.json beside the program)",
    )
    program.add_argument(
        "--units",
        choices=("mm", "inch"),
        help="of lengths in a file that does not say them (APT without UNITS, G-code without G20 or G21)",
    )
    program.add_argument(
        "--strict",
        action="store_true",
        help="exit status 1 where a motion is left out; convert writes nothing then",
    )
    program.add_argument(
        "--write-values",
        action="store_true",
        help="write what the program asks for into NAME.values.json beside it, to be filled in",
    )
    robot_program.add_unsafe(program)
    outputs.add(program)
    figures.add(program)
    program.set_defaults(do=_program)
    raster = commands.add_parser("raster", help="lay passes on the job's faces (docs/raster.md)")
    raster.add_argument("job", help="job.json; it need not have a program yet")
    raster.add_argument(
        "-o", "--output", required=True, help="program: .csv, .src, .mod, .script, .ls or .jbi"
    )
    raster.add_argument("--settings", help="JSON file of the settings")
    raster.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="one setting; as JSON"
    )
    raster.add_argument(
        "--region", metavar="RESULT", help="passes only where this result has too much left"
    )
    raster.add_argument(
        "--above", type=float, metavar="MM", help="more is too much; without: above its tolerance"
    )
    raster.add_argument(
        "--cluster",
        type=int,
        action="append",
        default=[],
        metavar="N",
        help="in place of --above: a cluster of the result's verdict, by its number",
    )
    raster.add_argument(
        "--then",
        nargs=2,
        action="append",
        default=[],
        metavar=("JOB", "OUTPUT"),
        help="a job with another wheel, and the program for where the wheels before do not get to",
    )
    raster.add_argument(
        "--picture",
        metavar="FILE",
        help="PNG of the passes on the part from two sides, and of what is left out and why",
    )
    frames_options.add(raster)
    add_form(raster)
    outputs.add(raster)
    figures.add(raster)
    raster.set_defaults(do=_raster)
    reach = commands.add_parser("reach", help="follow a job's programs with its robot's joints")
    reach.add_argument("job", help="job.json")
    reach.add_argument(
        "-o", "--output", help="CSV for the joints at every pose; of --place, the map"
    )
    reach.add_argument(
        "--place",
        action="store_true",
        help="search where the robot, or its external axes, reach the whole program farthest from limits and singularities",
    )
    outputs.add(reach)
    figures.add(reach)
    reach.set_defaults(do=_reach)


def add_form(command, default="as the job's robot.controller follows them"):
    """The option ``--form`` of a new program."""
    command.add_argument(
        "--form",
        choices=("spline", "zones"),
        default="",
        help="how the controller follows the passes: KRL's as spline blocks, which a KRC2 does not know, or by zones "
        f"of at most half a block; other languages by such zones (default: {default})",
    )


def _form_of_controller(arguments):
    """(form of a converted program, what is to be told of it): of ``--controller``, if one is named."""
    from ..job import robot_time

    if not arguments.controller:
        return arguments.form, []
    job = {"robot": {"controller": arguments.controller}}
    options, told = robot_time.written(job, arguments.output, arguments.form)
    return options["form"], told


def _roll(arguments):
    """``--roll`` as ``read_program`` takes it."""
    from ..engine import InputError

    given = arguments.roll
    if given is None or given in ("hold", "along"):
        return {"roll": given}
    try:
        values = [float(value) for value in given.split(",")]
        if len(values) != 3 or not all(map(math.isfinite, values)):
            raise ValueError
    except ValueError:
        raise InputError(
            "cli.roll",
            "--roll {given}: write hold, along, or a direction X,Y,Z, as in --roll=0,1,0",
            given=given,
        ) from None
    return {"roll": "fixed", "roll_direction": values}


def _program(arguments):
    from ..base.files import cannot_be_written, write_whole
    from ..engine import Fact, InputError
    from ..programs import force_device, given, table
    from ..programs.patch.patch import patch
    from ..programs.registry import read_program
    from ..programs.writers.writer import write_program

    action, *files = arguments.program
    if action == "robot":
        robot_program.write(arguments, files)
        return
    counts = {"write": 2, "convert": 1}
    if action not in counts:
        action, files = "read", arguments.program
    if len(files) != counts.get(action, 1):
        raise InputError(
            "cli.program_files",
            "program {action}: {count} files; see beltgrind program --help",
            action=action,
            count=len(files),
        )
    if action != "read" and not arguments.output:
        raise InputError(
            "cli.program_output", "program {action}: say by -o what file to write", action=action
        )
    robot_program.refuse_unsafe(arguments, action)
    if action != "convert" and (arguments.base or arguments.tool):
        raise InputError(
            "cli.frames_of_new_programs",
            "program {action}: --base and --tool are convert's",
            action=action,
        )
    if action != "convert" and (arguments.form or arguments.controller):
        raise InputError(
            "cli.form_of_new_programs",
            "program {action}: {option} is convert's",
            action=action,
            option="--form" if arguments.form else "--controller",
        )
    if action == "write" and arguments.roll:
        raise InputError(
            "cli.roll_of_written", "program write: --roll changes nothing in the original"
        )
    if action != "read" and arguments.write_values:
        raise InputError(
            "cli.write_values", "program {action}: --write-values is for reading", action=action
        )
    if (arguments.values or arguments.units) and (action == "write" or arguments.write_values):
        raise InputError(
            "cli.values_beside",
            "{option}: program write and --write-values take the file beside the program only",
            option="--values" if arguments.values else "--units",
        )
    outputs.check(arguments, [arguments.output], files)
    device = force_device.device_of(arguments.force_device)
    notes = []
    try:
        if action == "write":
            changed = patch(*files, arguments.output, device)
            figures.tell(arguments, {"changed": len(changed), "motions": changed}, indent=2)
            return
        program = read_program(
            files[0],
            **_roll(arguments),
            values=arguments.values,
            units=arguments.units,
            force_device=device,
        )
        read, said = program.counted()
        arguments.status = int(arguments.strict and read < said)
        if action == "convert" and arguments.status == 0 and read:
            form, told = _form_of_controller(arguments)
            options = {"form": form, "force_device": device}
            notes = write_program(
                arguments.output, None, program, **frames_options.given(arguments), **options
            )
            notes += told
        elif arguments.write_values:
            data, varies = given.explored(
                program, files[0], lambda values: read_program(files[0], values=values)
            )
            file, count = given.write_template(program, files[0], data)
            figures.tell(arguments, {"values": str(file), "to_be_given": count})
            arguments.status = 0
            if varies:
                note = Fact(
                    "cli.more_values",
                    "which values are asked for depends on those to be given; run --write-values again when they are "
                    "filled in",
                )
                arguments.messages.print_notes([note])
            return
        elif action == "read" and arguments.output and read:
            Path(arguments.output).parent.mkdir(parents=True, exist_ok=True)
            write_whole(Path(arguments.output), table.poses_csv(program).encode())
    except OSError as error:
        raise cannot_be_written(arguments.output, error) from None
    arguments.messages.print_written(notes)
    found = table.summary(program, arguments.messages.everything)
    figures.tell(arguments, found, indent=2)
    _tell_read(arguments, program, read, said)


def _tell_read(arguments, program, read, said):
    """How much of a program is read, and what it still asks for. Raises InputError where nothing is."""
    from ..engine import Fact, InputError
    from ..programs import given
    from ..programs.problems import ordered

    missing = given.missing(program)
    notes = []
    if missing:
        names = ", ".join(name or '""' for name in missing[:8]) + (
            ", ..." if len(missing) > 8 else ""
        )
        notes.append(
            Fact(
                "cli.program_asks",
                "the program asks for what only the controller knows ({names}); --write-values writes a file to be "
                "filled in",
                names=names,
            )
        )
    if read == 0:
        arguments.messages.print_notes(notes)
        raise InputError(
            "cli.no_motion_read",
            "{file}: no motion is read: {problem}",
            file=program.file,
            problem=ordered(program.problems)[0].message,
        )
    notes.append(Fact("cli.motions_read", "read {read} of {said} motions", read=read, said=said))
    arguments.messages.print_notes(notes)


def _raster(arguments):
    from ..engine import InputError
    from ..raster import in_turn, raster_path as raster, region

    if arguments.picture and arguments.then:
        raise InputError(
            "cli.picture_of_one", "--picture shows one wheel's passes; leave out --then"
        )
    written = [arguments.output, arguments.picture, *(file for _, file in arguments.then)]
    read = [arguments.job, arguments.settings, *(job for job, _ in arguments.then)]
    outputs.check(arguments, written, read, arguments.region)
    wanted = settings.given(arguments.settings, arguments.set)
    if arguments.region:
        points, _ = region.of_result(arguments.region, arguments.above, arguments.cluster)
        wanted["region_points"] = points.tolist()
    elif arguments.above is not None or arguments.cluster:
        raise InputError("cli.region_of_what", "--above and --cluster need --region RESULT")
    job = raster.load_job(arguments.job)
    if not arguments.then:
        found, drawn = background.run(
            lambda context: _laid_and_drawn(job, wanted, arguments.picture, context), quiet=True
        )
        _write_raster(arguments, arguments.output, job, found)
        if drawn is not None:
            _write_picture(arguments.picture, drawn)
        figures.tell(arguments, raster.summary(found))
        return
    steps = [(job, wanted)] + [(raster.load_job(one), wanted) for one, _ in arguments.then]
    laid, places = background.run(lambda context: in_turn(steps, context), quiet=True)
    files = [arguments.output, *(file for _, file in arguments.then)]
    for (one, _), file, found in zip(steps, files, laid):
        if found is not None:
            _write_raster(arguments, file, one, found)
    left = float(places["areas"][places["left"]].sum() / places["areas"].sum())
    summaries = [None if found is None else raster.summary(found) for found in laid]
    figures.tell(arguments, {"wheels": summaries, "left_by_all": left})


def _laid_and_drawn(job, settings, picture, context):
    from ..raster import drawing, raster_path as raster

    found = raster.raster(job, settings, context)
    return found, drawing.draw(job, found, context) if picture else None


def _write_picture(file, data):
    from ..base.files import cannot_be_written, write_whole

    try:
        write_whole(file, data)
    except OSError as error:
        raise cannot_be_written(file, error) from None


def _write_raster(arguments, file, job, found):
    from ..planning.written import write_passes

    given = frames_options.given(arguments)
    notes = write_passes(file, found, job, arguments.form, **given)
    arguments.messages.print_warnings(found["warnings"])
    arguments.messages.print_written(notes)


def _place(arguments, job):
    """Where the job's robot stands best, as keys of its robot."""
    from ..base.files import cannot_be_written, write_whole
    from ..cell import placing

    def search(context):
        made = placing.Search(job, context)
        return made, *made.run()

    made, place, events = background.run(search)
    if arguments.output:
        try:
            write_whole(Path(arguments.output), placing.map_csv(made).encode())
        except OSError as error:
            raise cannot_be_written(arguments.output, error) from None
    arguments.messages.print_warnings(placing.doubts(place, events))
    print(json.dumps(placing.told(made, place, events), indent=2, allow_nan=False))


def _reach(arguments):
    from ..base.files import cannot_be_written, write_whole
    from ..cell import events as event_lists, reach, tool_path as tool_paths
    from ..engine import InputError
    from ..job import inputs, load as jobs
    from ..presets import robot as robots

    given = jobs.load(arguments.job)
    files = inputs.files(given)
    outputs.check(arguments, [arguments.output], [arguments.job, *files])
    if not robots.given(given["robot"]):
        raise InputError(
            "cli.no_robot",
            "{file}: the job names no robot; give it the key '{key}'",
            file=arguments.job,
            key="robot",
        )
    reach.refuse_coordinated(given["robot"])
    if arguments.place:
        _place(arguments, given)
        return
    warnings = []
    paths = [tool_paths.tool_path(given, i, warnings) for i in range(len(given["programs"]))]
    found = reach.job_reach(given, paths)
    if arguments.output:
        text = reach.joints_csv(found, [path.lines() for path in paths])
        try:
            write_whole(Path(arguments.output), text.encode())
        except OSError as error:
            raise cannot_be_written(arguments.output, error) from None
    arguments.messages.print_warnings(warnings)
    begins = [sum(path.duration() for path in paths[:i]) for i in range(len(paths))]
    events = event_lists.merge([(i, begins[i], one["events"]) for i, one in enumerate(found)])
    told = {**reach.summary(given["robot"], found), "events": events}
    figures.tell(arguments, told, indent=2)
