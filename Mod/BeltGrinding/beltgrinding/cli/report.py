"""Telling others of a result: the report."""

from . import background


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    told = commands.add_parser(
        "report",
        help="write a result's report as one HTML file",
        description="Part, program, machine and law, pictures, tolerances, events, how sure the "
        "result is and how to repeat it, in one file that needs nothing else (docs/report.md).",
    )
    told.add_argument("result", help="folder that run wrote")
    told.add_argument("-o", "--output", help="HTML file (default: report.html in the folder)")
    told.add_argument("--pdf", help="file for the same as PDF; needs WeasyPrint")
    told.add_argument("--language", choices=("en", "de"), default="en", help="default en")
    told.add_argument("--title", help="what the part is called (default: its file's name)")
    told.set_defaults(do=_report)


def _report(arguments):
    from .. import reporting

    def work(context):
        return reporting.report(
            arguments.result,
            arguments.output,
            arguments.pdf,
            arguments.language,
            arguments.title,
            context,
        )

    print(background.run(work, quiet=True))
