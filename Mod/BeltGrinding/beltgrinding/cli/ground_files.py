"""The job that `beltgrind grind` begins with, and the files that it writes."""

from pathlib import Path

from . import robot_program


class Files:
    """The files of passes and their plan in a folder."""

    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder
        self.program, self.notes = Path(folder, arguments.program), []
        self._searched = []

    def checked(self, ground, wanted, context, told):
        """What the written files do, as ``from_file.check``; None where the settings of the plan, ``wanted``, want none."""
        from ..planning import from_file

        self._searched = [ground.search]
        if not wanted["check"]:
            return None
        return from_file.check(ground.plan, self.folder, self.write, context, told, before=False)

    def write(self, found, entry=None):
        """Entries of the program's file in a job."""
        from ..job.poses import rests
        from ..planning import apply

        arguments = self.arguments
        read = [arguments.part]
        apply.write(found, self.folder, read, arguments.force, entry, *self._searched)
        self.notes = _write_program(found, self.program, arguments.force, arguments.form)
        return [{**rests(found.job["programs"][0]), "file": self.program.name}]

    def end(self, ground, checked):
        """Writes what is best, and the whole robot's program if one is wanted. Returns the plan."""
        found = ground.plan if checked is None else checked.plan
        self.write(found, None if checked is None else checked.entry)
        if robot_program.wanted(found.job):
            self.notes = robot_program.in_place_of(self.program, found.job, self.arguments)
        return found


def job_of(arguments, context):
    """(validated job, first settings of its raster)."""
    from ..base import standard
    from ..engine import InputError
    from ..job import load as jobs
    from ..raster import proposal, raster_path

    faces = _faces(arguments.faces)
    if standard.named(arguments.part) or Path(arguments.part).suffix.lower() == ".json":
        if arguments.stock is not None:
            raise InputError(
                "cli.stock_of_job", "--stock is for a part's file; the job has its own"
            )
        job, first = raster_path.load_job(arguments.part), {}
        if faces:
            job["design"]["faces"] = faces
        return _with_tolerance(job, arguments), first
    given = {
        "design": {"file": arguments.part, **({"faces": faces} if faces else {})},
        "stock": {"allowance_mm": 0.3 if arguments.stock is None else arguments.stock},
        "programs": [{"poses": []}],
    }
    job = jobs.validate(given, Path.cwd())
    seen = proposal.propose(job, context.part(0.0, 0.0))
    given["sampling"] = {"spacing_mm": seen["spacing_mm"]}
    given["belt_machine"] = {
        "wheel": {"radius_mm": seen["wheel_radius_mm"], "width_mm": seen["wheel_width_mm"]},
        "compliance": {"rim_thickness_mm": seen["rim_thickness_mm"]},
        "force_N": seen["force_N"],
    }
    first = {"along": "direction", **{name: seen[name] for name in proposal.OF_PASSES}}
    arguments.messages.print_warnings(seen["notes"])
    return _with_tolerance(jobs.validate(given, Path.cwd()), arguments), first


def _with_tolerance(job, arguments):
    if arguments.tolerance:
        job["inspection"]["tolerance_mm"] = list(arguments.tolerance)
    return job


def _faces(text):
    from ..engine import InputError

    try:
        return [int(part) for part in text.split(",")] if text else []
    except ValueError:
        raise InputError(
            "cli.faces", "--faces {given}: write numbers from 1, as 3,4,9", given=text
        ) from None


def check_name(name, form, job=None):
    """Refuses the name of a program that cannot be written, before anything is planned, and a job's force device, external
    axes or base that cannot be set there. Raises InputError."""
    import tempfile

    import numpy as np

    from ..programs.force_device import of_job
    from ..programs.writers.writer import check_suffix, write_program

    check_suffix(name)
    poses = np.stack([np.eye(4)] * 3)
    poses[:, 0, 3] = range(3)
    passes = [{"poses": poses, "feed_mm_s": 1.0}]
    device = None
    if job is not None:
        device, passes[0]["force_N"] = of_job(job), job["belt_machine"]["force_N"]
        robot_program.check(name, job)
    with tempfile.TemporaryDirectory() as folder:
        write_program(Path(folder, name), None, passes, form=form, force_device=device)


def _write_program(found, file, force, form):
    import os

    from ..engine import InputError
    from ..planning.written import write_made

    if os.path.lexists(file) and not force and not (file.parent / "plan.json").exists():
        raise InputError(
            "planning.not_of_a_plan",
            "{file}: is there already, and no plan has written it; choose another folder, or replace it by --force",
            file=file,
        )
    return write_made(found, 0, file, form)
