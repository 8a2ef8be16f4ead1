"""Telling others of a result: the report; and how sure its settings make it."""

from pathlib import Path

from . import background, figures, outputs


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    told = commands.add_parser(
        "report",
        help="write a result's report as one HTML file or PDF",
        description="Part, program, machine and law, pictures, tolerances, events, how sure the "
        "result is and how to repeat it, in one file that needs nothing else (docs/report.md).",
    )
    told.add_argument("result", help="folder that run wrote")
    told.add_argument(
        "-o",
        "--output",
        help="HTML file, or PDF by its suffix (default: report.html in the folder)",
    )
    told.add_argument("--pdf", help="file for the same as PDF; needs WeasyPrint")
    told.add_argument("--language", choices=("en", "de"), default="en", help="default en")
    told.add_argument("--title", help="what the part is called (default: its file's name)")
    outputs.add(told)
    figures.add(told)
    told.set_defaults(do=_report)

    finer = commands.add_parser(
        "converge",
        help="run a job coarser, as given and finer: are its settings fine enough?",
        description="Estimates the error of every figure of the verdict from three runs at twice, once "
        "and half the spacing, steps and contact cells (docs/convergence.md). Takes about ten times as "
        "long as the job.",
    )
    finer.add_argument("job", help="job.json")
    finer.add_argument("-o", "--output", required=True, help="folder for the results")
    finer.add_argument("-q", "--quiet", action="store_true", help="no progress, no answer")
    outputs.add(finer)
    figures.add(finer)
    finer.set_defaults(do=_converge)


def _converge(arguments):
    from ..job import inputs, load as job
    from ..reporting import convergence_section, language
    from ..simulation import convergence, result_folder

    given = job.load(arguments.job)
    used = [arguments.job, *inputs.files(given)]
    result_folder.check(arguments.output, None, used, arguments.force)
    result = background.run(lambda context: convergence.converge(given, context), arguments.quiet)
    result.write(arguments.output, arguments.force, used)
    if not arguments.quiet:
        arguments.messages.print_warnings(result.convergence["notes"])
    if arguments.json or not arguments.quiet:
        text = " ".join(convergence_section.sentences(result.convergence, language.Language()))
        figures.tell(arguments, result.convergence, text)


def _report(arguments):
    from ..reporting import report as reporting
    from ..simulation import result_folder

    output = arguments.output or Path(arguments.result, result_folder.REPORT)
    outputs.check(arguments, [output, arguments.pdf], result=arguments.result)

    def work(context):
        return reporting.report(
            arguments.result,
            arguments.output,
            arguments.pdf,
            arguments.language,
            arguments.title,
            context,
        )

    file = str(background.run(work, quiet=True))
    figures.tell(arguments, {"file": file}, file)
