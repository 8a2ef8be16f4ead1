"""A result's picture that others can turn: the 3D view."""

from pathlib import Path

from . import background, figures, outputs


def add(commands):
    """Adds the command to the parser's ``commands``."""
    turned = commands.add_parser(
        "view",
        help="write a result's 3D view as one HTML file",
        description="The ground part in a browser, to turn, zoom and probe, with its colours, sections and "
        "the wheel on its way, in one file that needs nothing else (docs/report.md). Needs Debian's "
        "libjs-three where it is written.",
    )
    turned.add_argument("result", help="folder that run wrote")
    turned.add_argument("-o", "--output", help="HTML file (default: view.html in the folder)")
    turned.add_argument("--language", choices=("en", "de"), default="en", help="default en")
    turned.add_argument("--title", help="what the part is called (default: its file's name)")
    outputs.add(turned)
    figures.add(turned)
    turned.set_defaults(do=_view)


def _view(arguments):
    from ..reporting import view_page
    from ..simulation import result_folder

    output = arguments.output or Path(arguments.result, result_folder.VIEW)
    outputs.check(arguments, [output], result=arguments.result)

    def work(context):
        return view_page.view(
            arguments.result, arguments.output, arguments.language, arguments.title, context
        )

    file = str(background.run(work, quiet=True))
    figures.tell(arguments, {"file": file}, file)
