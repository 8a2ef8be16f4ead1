"""A program for the whole robot of a job."""


from . import background, figures, frames_options, outputs

NAME = "whole_robot"  # of a plan's program
LANGUAGES = (".src", ".mod", ".script")  # in which that may be: those that set frames by numbers


def add_unsafe(command):
    """The option ``--unsafe`` of a program for the whole robot."""
    command.add_argument(
        "--unsafe",
        action="store_true",
        help="write a program for the whole robot in spite of a collision, a limit or a pose out of reach",
    )


def refuse_unsafe(arguments, action):
    """Raises InputError for ``--unsafe`` without a program for the whole robot."""
    from ..engine import InputError

    if arguments.unsafe:
        raise InputError(
            "cli.unsafe_of_robot", "program {action}: --unsafe is robot's", action=action
        )


def write(arguments, files):
    """Plans and writes the program of a job for the command line's ``program robot``."""
    from ..base.files import cannot_be_written
    from ..engine import InputError
    from ..job import inputs, load as jobs
    from ..programs.writers.writer import check_suffix
    from ..robot_program import write as writing

    if len(files) != 1 or not arguments.output:
        raise InputError(
            "cli.program_robot", "program robot: give a job, and by -o what file to write"
        )
    check_suffix(arguments.output)
    job = jobs.load(files[0])
    outputs.check(arguments, [arguments.output], [files[0], *inputs.files(job)])
    given = {"form": arguments.form, **frames_options.given(arguments)}
    if wanted(job):
        writing.base_set(arguments.output, job, given["bases"])
    whole, notes = _planned(arguments.output, job, arguments, **given)
    arguments.messages.print_written(notes)
    figures.tell(arguments, writing.summary(whole), indent=2)


def _planned(file, job, arguments, **options):
    """Plans the program of a job and writes it: (``Whole``, what the writer tells). Raises InputError."""
    from ..base.files import cannot_be_written
    from ..robot_program import write as writing

    whole = background.run(lambda context: writing.plan_job(job, context), quiet=True)
    arguments.messages.print_warnings([*whole.notes, *whole.problems])
    try:
        return whole, writing.write(file, job, whole, unsafe=arguments.unsafe, **options)
    except OSError as error:
        raise cannot_be_written(file, error) from None


def wanted(job):
    """Whether a job has a robot and the home of its programs."""
    from ..robot_program import whole

    return whole.wanted(job)


def in_place_of(file, job, arguments):
    """Writes the program for the whole robot over that of the passes alone, and returns what the writer tells. Where it
    is refused the other stays, which the error says. Raises InputError."""
    from ..engine import InputError

    try:
        return _planned(file, job, arguments, form=arguments.form)[1]
    except InputError as error:
        raise error.within(
            "cli.passes_alone",
            "{program} has the passes alone, not the way from home to home: ",
            program=file,
        ) from None


def check(name, job):
    """Refuses, before anything is planned, a program for the whole robot whose external axes or base cannot be written.
    Raises InputError."""
    from ..robot_program import write as writing

    if wanted(job):
        writing.base_set(name, job)


def beside(folder, names, job, arguments):
    """Writes a plan's program for the whole robot into its folder, as NAME in the language of the programs there
    (``names``). Returns its file, None for a job without a home. Raises InputError."""
    from pathlib import Path

    if not wanted(job):
        return None
    suffixes = [Path(name).suffix.lower() for name in names]
    suffix = next((one for one in suffixes if one in LANGUAGES), LANGUAGES[0])
    file = Path(folder, NAME + suffix)
    outputs.check(arguments, [file])
    arguments.messages.print_written(_planned(file, job, arguments)[1])
    return file
