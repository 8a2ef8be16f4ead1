"""Grinding a job."""

from pathlib import Path

from . import background, outcome, outputs
from .messages import print_text


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    run = commands.add_parser("run", help="grind a job")
    run.add_argument("job", help="job.json")
    run.add_argument("-o", "--output", required=True, help="folder for the results")
    run.add_argument("--belt", help="JSON file that carries the belt's use from job to job")
    run.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outcome.add(run)
    outputs.add(run)
    run.set_defaults(do=_run)


def _run(arguments):
    from ..job import inputs, law, load as jobs
    from ..simulation import result_folder, run as runs

    outcome.check(arguments)
    given = jobs.load(arguments.job)
    used = [path for path in (arguments.job, arguments.belt) if path]
    files = inputs.files(given)
    result_folder.check(arguments.output, None, [*used, *files], arguments.force)
    outputs.check(arguments, [arguments.belt], [arguments.job, *files])
    if arguments.belt and Path(arguments.belt).exists():
        given["belt_machine"]["belt"] = law.read_belt(arguments.belt)
    said = []

    def early(warnings):
        if not arguments.quiet:
            arguments.messages.print_warnings(warnings)
            said.extend(warnings)

    result = background.run(
        lambda context: runs.run(given, context, early=early, resume=False), arguments.quiet
    )
    result.write(arguments.output, arguments.force, used)
    if arguments.belt:
        law.write_belt(arguments.belt, result.summary["belt"])
    if not arguments.quiet:
        report(result, arguments, len(said))
    outcome.tell(arguments, result)


def report(result, arguments, said):
    """Prints what came out and, where there is a folder, where it is; ``said``: how many of its warnings have been printed."""
    from ..inspection import verdict

    summary = result.summary
    arguments.messages.print_warnings(summary["warnings"][said:])
    deviation = summary["deviation_mm"]
    chosen = ", chosen" if summary["spacing_chosen"] else ""
    coarse = "coarse: " if summary["resolution"] == "coarse" else ""
    where = f"; results in {arguments.output}" if arguments.output else ""
    print_text(
        f"{coarse}{summary['samples']} samples ({summary['spacing_mm']:.3g} mm apart{chosen}), "
        f"{summary['steps']} steps, "
        f"{summary['removed_volume_mm3']:.1f} mm3 removed; deviation "
        f"{deviation['min']:+.3f} to {deviation['max']:+.3f} mm, "
        f"{100 * summary['in_tolerance_area_share']:.1f} % of the area in tolerance{where}"
    )
    print_text(verdict.text(result.verdict))
