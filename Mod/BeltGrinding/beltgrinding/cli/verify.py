"""What a robot program does to a job's part: by its file alone, under the robot's time."""

from pathlib import Path

from . import background, grind, outcome, outputs


def add(commands):
    """Adds the command to the parser's ``commands``."""
    verify = commands.add_parser(
        "verify",
        help="simulate a program as its file has it, under the robot's time (docs/verify.md)",
        description="Reads a robot program as its file has it, grinds the job's part with it under the robot's time at "
        "half the spacing, step and contact cells, and says whether the part is good. Exit status 1 where it fails.",
    )
    verify.add_argument("program", nargs="+", help="the programs, in the order in which they run")
    verify.add_argument("--job", required=True, help="job.json; its own programs do not matter")
    verify.add_argument("-o", "--output", help="folder for the result")
    verify.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outcome.add(verify)
    outputs.add(verify)
    verify.set_defaults(do=_verify)


def _verify(arguments):
    from ..job import inputs
    from ..planning import from_file
    from ..raster import raster_path
    from ..simulation import result_folder, run as runs

    outcome.check(arguments)
    arguments.check = True
    job = raster_path.load_job(arguments.job)
    entries = [_entry(job, Path(file).resolve()) for file in arguments.program]
    given = from_file.with_programs(job, entries, Path.cwd())
    used = [arguments.job, *inputs.files(given)]
    if arguments.output:
        result_folder.check(arguments.output, None, used, arguments.force)
    said = []

    def early(warnings):
        if not arguments.quiet:
            arguments.messages.print_warnings(warnings)
            said.extend(warnings)

    def work(context):
        half = from_file.is_at_half(arguments.job)  # a plan has refined it already
        fine = given if half else from_file.at_half(given, context)
        return runs.run(fine, context, early=early, resume=False)

    result = background.run(work, arguments.quiet)
    if arguments.output:
        result.write(arguments.output, arguments.force, used)
    if not arguments.quiet:
        grind.report(result, arguments, len(said))
    outcome.tell(arguments, result)


def _entry(job, file):
    """A program's entry in a job: by the job's, what the file does not have by nature."""
    from ..job.poses import rests

    own = next((one for one in job["programs"] if one.get("file") == str(file)), {})
    kept = {key: own[key] for key in ("values", "roll", "roll_direction") if key in own}
    return {**kept, **rests(own), "file": str(file)}
