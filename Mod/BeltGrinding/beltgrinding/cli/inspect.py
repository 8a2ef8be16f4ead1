"""Looking into a result."""

import json
from pathlib import Path

from . import background, figures, outputs


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    cut = commands.add_parser(
        "section",
        help="cut a result by a plane: design, stock and ground profile",
        description="A plane by --point and --normal, or the line on the surface --from one point "
        "--to another; mm, in the part's frame. Write --normal=-1,0,0 where the first is negative.",
    )
    cut.add_argument("result", help="folder that run wrote")
    cut.add_argument("--point", metavar="X,Y,Z", help="of the plane")
    cut.add_argument("--normal", metavar="X,Y,Z", help="of the plane")
    cut.add_argument("--from", dest="start", metavar="X,Y,Z", help="where the line begins")
    cut.add_argument("--to", dest="end", metavar="X,Y,Z", help="where the line ends")
    cut.add_argument(
        "-o", "--output", action="append", default=[], help="file: .csv or .svg; may be repeated"
    )
    cut.add_argument("--mode", choices=("unrolled", "shape"), default="unrolled", help="of the SVG")
    cut.add_argument("--exaggeration", type=float, help="of the heights in the shape's SVG")
    outputs.add(cut)
    figures.add(cut)
    cut.set_defaults(do=_section)
    judge = commands.add_parser(
        "verdict",
        help="judge a result, also by other tolerances (docs/verification.md)",
        description="Judges the result in a folder again, writes its verdict.json, and in events.json how "
        "zones keep their finish, and says it in a few lines.",
    )
    judge.add_argument("result", help="folder that run wrote")
    judge.add_argument("--job", help="job.json whose key inspection is taken in place of its own")
    judge.add_argument("-o", "--output", help="file for the verdict in place of verdict.json there")
    outputs.add(judge)
    figures.add(judge)
    judge.set_defaults(do=_verdict)


def _verdict(arguments):
    from ..base.files import cannot_be_written, write_whole
    from ..inspection import verdict
    from ..job import load as job
    from ..simulation.result import Result

    outputs.check(arguments, [arguments.output], [arguments.job], arguments.result)
    result = Result.read(arguments.result)
    given = job.load(arguments.job) if arguments.job else job.validate(result.job)
    result.verdict = background.run(
        lambda context: verdict.of_result(result, inspection=given["inspection"], context=context),
        quiet=True,
    )
    if arguments.output:
        try:
            write_whole(arguments.output, result.verdict_bytes())
        except OSError as error:
            raise cannot_be_written(arguments.output, error) from None
    else:
        result.tell_finish(given["inspection"])
        result.update(verdict=True)
    figures.tell(arguments, json.loads(result.verdict_bytes()), verdict.text(result.verdict))


def _section(arguments):
    from ..base import standard
    from ..engine import InputError
    from ..inspection import section
    from ..simulation.result import Result

    by_plane = (arguments.point, arguments.normal)
    by_line = (arguments.start, arguments.end)
    for path in arguments.output:
        if not standard.named(path) and Path(path).suffix.lower() not in (".csv", ".svg"):
            raise InputError(
                "cli.section_suffix", "{file}: a section is written as .csv or .svg", file=path
            )
    outputs.check(arguments, arguments.output, result=arguments.result)
    if all(by_plane) and not any(by_line):
        found = section.section(Result.read(arguments.result), *by_plane)
    elif all(by_line) and not any(by_plane):
        found = section.between(Result.read(arguments.result), *by_line)
    else:
        raise InputError(
            "cli.section_of_what", "section: give --point and --normal, or --from and --to"
        )
    for path in arguments.output:
        if Path(path).suffix.lower() == ".svg":
            section.write_svg(found, path, arguments.mode, arguments.exaggeration)
        else:
            section.write_csv(found, path)
    figures.tell(arguments, section.summary(found))
