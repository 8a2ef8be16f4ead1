"""Planning a job's feeds."""

from pathlib import Path

from . import background, outcome, outputs, plan_batch, robot_program, rounds_table, settings
from .messages import print_text

PLANNING = 0.6  # of the time; the rest reads and simulates what was written


def add(commands):
    """Adds the command to the parser's ``commands``."""
    plan = commands.add_parser(
        "plan", help="find feeds with which a job's programs keep the tolerance (docs/planning.md)"
    )
    plan.add_argument("job", help="job.json")
    plan.add_argument(
        "-o", "--output", required=True, help="folder for the planned programs, job and result"
    )
    plan.add_argument("--settings", help="JSON file of the settings")
    plan.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="one setting; as JSON"
    )
    plan_batch.add(plan)
    robot_program.add_unsafe(plan)
    plan.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outcome.add(plan)
    outputs.add(plan)
    plan.set_defaults(do=_plan)


def _plan(arguments):
    from ..job import inputs, load as jobs
    from ..planning import apply, from_file, rounds as plans
    from ..scan import stock as scan_stock

    outcome.check(arguments)
    wanted = plans.validate(settings.given(arguments.settings, arguments.set))
    job = jobs.load(arguments.job)
    read = [arguments.job, *arguments.stock, *inputs.files(job)]

    def one_part(scan, folder, options):
        """(Plan, alignment or None) of a part with its own stock; written into the folder."""
        told = None if arguments.quiet else rounds_table.Table().told
        apply.check(job, folder, read, arguments.force)

        def write(found, entry=None):
            """(names of the written programs, warnings)"""
            return apply.write(found, folder, read, arguments.force, entry)

        def programs(found):
            write(found)
            return jobs.load(Path(folder, apply.JOB))["programs"]

        def work(context):
            mine, laid = job, None
            if scan is not None:
                mine, laid = scan_stock.as_stock(
                    job, scan, **options, context=context.part(0.0, 0.0)
                )
                if laid is not None:
                    arguments.messages.print_warnings(laid["warnings"])
            if not wanted["check"]:
                return plans.plan(mine, wanted, context, told), None, laid
            searched = {**wanted, "check": False}
            found = plans.plan(mine, searched, context.part(0.0, PLANNING), told)
            part = context.part(PLANNING, 1.0)
            return found, from_file.check(found, folder, programs, part, told), laid

        found, checked, laid = background.run(work, arguments.quiet)
        found = found if checked is None else checked.plan
        written, warnings = write(found, None if checked is None else checked.entry)
        arguments.messages.print_warnings(warnings)
        whole = robot_program.beside(folder, written, found.job, arguments)
        tell_checked(arguments, checked)
        if not arguments.quiet:
            print_text(text(plans.summary(found), checked is not None))
            names = ", ".join(written) if written else "poses in job.json"
            print_text(f"programs: {names}; results in {folder}")
            if whole is not None:
                print_text(f"program for the whole robot: {whole}")
        outcome.tell(arguments, found.after, wanted["wanted_share"])
        return found, laid

    plan_batch.each(arguments, one_part)


def tell_checked(arguments, checked):
    """Prints where the written programs fall short of the plan (``from_file.Checked``, or None)."""
    if checked is not None and not arguments.quiet:
        arguments.messages.print_warnings(checked.short)
        arguments.messages.print_notes(checked.notes)


def line(one):
    return (
        f"{100 * one['in_tolerance']:.1f} % of the area in tolerance, "
        f"{100 * one['above']:.1f} % too much left, {100 * one['below']:.1f} % cut too deep, "
        f"rms {one['rms_mm']:.3f} mm, {one['process_time_s']:.1f} s of grinding"
    )


def text(summary, from_file=False, before=True):
    """A plan's summary in words. ``from_file``: its figures are those of the written programs; ``before``: those of the job
    as it was are told, too."""
    from ..planning.pictures import WORDS

    if not summary["better"]:
        lines = ["nothing better was found: the feeds stay as they are"]
    else:
        first, after = summary["before"], summary["after"]
        lines = [f"before: {line(first)}"] if before else []
        lines.append(f"planned: {line(after)}")
        if from_file:
            lines[-1] += " (the written program read again, at half the spacing and step)"
        if "sure_share" in after:
            lines += [f"before, {_sure(first)}"] if before else []
            lines.append(f"planned, {_sure(after)}")
        if after.get("over_limit", 0.0) > 1e-6:
            lines.append(
                f"the greatest pressure, {after['peak_pressure_MPa']:.3g} MPa, is {100 * after['over_limit']:.1f} % "
                "above its limit"
            )
    out = {k: v for k, v in summary["out_of_tolerance"].items() if v > 0.0005}
    for word, share in sorted(out.items(), key=lambda pair: -pair[1]):
        lines.append(f"  out of tolerance, {100 * share:.1f} %: {WORDS[word]}")
    if summary["beyond_limits"]["after"]:
        lines.append(
            f"at {summary['beyond_limits']['after']} places feed or force change faster than they may: the program's own "
            "steps, or motions that stay"
        )
    lines += _about_forces(summary)
    if summary["timing"] == "job":
        lines.append(
            f"planned by the job's own time law ({summary['time_law']}), not for the time that the robot takes"
        )
    feeds = summary["feed_mm_s"]
    lines.append(
        f"feeds {feeds['least']:.3g} to {feeds['greatest']:.3g} mm/s; {summary['changed']} of "
        f"{summary['commands']} commands changed"
    )
    return "\n".join(lines)


def _about_forces(summary):
    hand, lines = summary["force_by_hand"], []
    if hand and hand["after_N"] != hand["before_N"]:
        lines.append(
            f"set {hand['after_N']:.4g} N by hand on the belt machine in place of {hand['before_N']:.4g} N: the programs set "
            "no force; job.json has it"
        )
    if summary["less_force_would_help"]:
        lines.append(
            "the robot goes no faster there, and the force is fixed: less of it would help. Allow it by --set "
            "force_min_N=5 (one force, set by hand), or say by belt_machine.force_device how programs set it"
        )
    if summary["short_blocks"]:
        lines.append(
            f"{summary['short_blocks']} commands keep feeds at which their blocks last less than the controller needs: the "
            "robot may be slower there, and cut deeper"
        )
    return lines


def _sure(one):
    low, middle, high = (100 * share for share in one["drawn"])
    return (
        f"laws drawn at random: {low:.1f}, {middle:.1f}, {high:.1f} % in tolerance (5th, 50th, 95th percentile); "
        f"surely {100 * one['sure_share']:.1f} %; {100 * one['passing']:.1f} % of the laws have the wanted share"
    )
