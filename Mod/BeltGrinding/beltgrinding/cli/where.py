"""Where many tasks run: processes of this machine, a Dask cluster, an array of Slurm jobs."""

import shlex

from .messages import print_text


def add(parser, tasks, task):
    """Gives a command its options. ``tasks``, ``task``: what is run, in words."""
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=int,
        metavar="N",
        help=f"processes of this machine (default: one a core); 0: none, one {task} after the other",
    )
    where.add_argument(
        "--scheduler", metavar="ADDRESS", help="of a Dask cluster that is there, as tls://host:8786"
    )
    where.add_argument(
        "--slurm",
        type=int,
        metavar="N",
        help="write the script of a Slurm array of N jobs, run nothing",
    )
    tls = parser.add_mutually_exclusive_group()
    tls.add_argument(
        "--tls",
        metavar="FILE",
        help="with --scheduler: a PEM file with the key and its certificate, which nobody else may read (default: as Dask is "
        "configured)",
    )
    tls.add_argument(
        "--without-tls",
        action="store_const",
        const=False,
        dest="tls",
        help="with --scheduler: ask it without TLS; whoever reaches its port can run programs as you",
    )
    parser.add_argument("--submit", action="store_true", help="with --slurm: hand it to sbatch")
    parser.add_argument(
        "--sbatch",
        action="append",
        default=[],
        metavar="OPTION",
        help="with --slurm: a further option, as --sbatch=--time=02:00:00; several times",
    )
    parser.add_argument(
        "--chunk",
        metavar="I/N",
        help=f"only every Nth {task} from the Ith on, and no table: a job of an array",
    )
    parser.add_argument(
        "--again", action="store_true", help=f"make all {tasks}, also those that are there already"
    )


def chunk(arguments):
    """(I, N) of --chunk, None without one. Raises InputError for options that do not go together."""
    from ..engine import InputError

    if (arguments.submit or arguments.sbatch) and arguments.slurm is None:
        raise InputError("cli.study_slurm", "--submit and --sbatch go with --slurm")
    text = arguments.chunk
    if text is None:
        return None
    number, _, count = text.partition("/")
    if not (number.isdecimal() and count.isdecimal() and 1 <= int(number) <= int(count)):
        raise InputError(
            "cli.study_chunk", "--chunk {text}: write I/N, as 3/20, with I from 1 to N", text=text
        )
    return int(number), int(count)


def array(arguments, command, after):
    """Writes the script of --slurm, and submits it if that is wanted. ``command``: of each job, as ``slurm.write`` takes it;
    ``after``: words after ``beltgrind`` of the command that collects what they made. Raises InputError.
    """
    from ..studies import slurm

    path = slurm.write(arguments.output, arguments.slurm, command, arguments.sbatch)
    said = (
        slurm.submit(path)
        if arguments.submit
        else f"submit it by: {shlex.join(['sbatch', str(path)])}"
    )
    if not arguments.quiet:
        print_text(f"{path}\n{said}\nthen: {shlex.join(['beltgrind', *map(str, after)])}")
