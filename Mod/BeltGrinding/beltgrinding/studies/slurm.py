"""A study, or a batch of castings, as an array of Slurm jobs: the script for sbatch, and its submission.

Each job of the array makes every Nth run and keeps it in the study's folder, which all nodes must see, as they must the files
that the study reads. The next ``beltgrind study`` in that folder collects what is there, makes what is missing, and writes
the table; ``beltgrind sort`` the same.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from ..base import processes
from ..base.files import cannot_be_written, write_whole
from ..engine import InputError, core

FOLDER = "slurm"
MOST = 100_000  # jobs of an array
SUBMIT_S = 60.0  # for sbatch to answer


def write(
    folder: Path | str, jobs: int, command: Sequence[object], options: Sequence[str] = ()
) -> Path:
    """Writes the script of an array of so many ``jobs`` into ``folder``, with further ``options`` of sbatch, such as
    --time=02:00:00. ``command``: the words after ``beltgrind``, which take --chunk; the first, study or sort, names the
    script. Returns its path. Raises InputError."""
    if not 1 <= jobs <= MOST:
        raise InputError(
            "studies.slurm_jobs",
            "an array has 1 to {most} jobs, not {count}",
            most=MOST,
            count=jobs,
        )
    for option in options:
        if not option.startswith("-") or any(ord(c) < 32 for c in option):
            raise InputError(
                "studies.slurm_option",
                "'{option}' is no option of sbatch; write it as --time=02:00:00",
                option=option,
            )
    place = Path(os.path.realpath(folder)) / FOLDER
    path = place / f"{command[0]}.sbatch"
    try:
        place.mkdir(parents=True, exist_ok=True)
        write_whole(path, _text(place, jobs, command, options).encode("utf-8", "surrogateescape"))
        os.chmod(path, 0o755)
    except OSError as error:
        raise cannot_be_written(path, error) from None
    return path


def _text(place: Path, jobs: int, command: Sequence[object], options: Sequence[str]) -> str:
    package = Path(__file__).resolve().parents[2]
    places = [str(package), str(Path(core.__file__).resolve().parent)]
    words = [processes.python(), "-m", "beltgrinding", *map(str, command)]
    words += ["--workers", "0", "--quiet", "--chunk"]
    lines = [
        "#!/bin/bash",
        f"#SBATCH --job-name=beltgrind-{command[0]}",
        f"#SBATCH --array=1-{jobs}",
        "#SBATCH --ntasks=1",
        "#SBATCH --cpus-per-task=1",
        f"#SBATCH --output={shlex.quote(str(place))}/%A_%a.log",
        *(f"#SBATCH {option}" for option in options),
        f"export PYTHONPATH={shlex.quote(os.pathsep.join(places))}${{PYTHONPATH:+:$PYTHONPATH}}",
        # The folder that the script is submitted from may be anybody's: Python imports nothing from it.
        "export PYTHONSAFEPATH=1",
        *(f"export {name}=1" for name in processes.ONE_THREAD),
        f'exec {shlex.join(words)} "$SLURM_ARRAY_TASK_ID/{jobs}"',
    ]
    return "\n".join(lines) + "\n"


def submit(path: Path) -> str:
    """Hands the script to sbatch; what it says. Raises InputError."""
    program = shutil.which("sbatch")
    if program is None:
        raise InputError(
            "studies.no_sbatch",
            "{file}: is written, but there is no sbatch here to submit it; do so on a machine of the cluster",
            file=path,
        )
    try:
        done = subprocess.run(
            [program, str(path)], capture_output=True, text=True, timeout=SUBMIT_S
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise _refused(path, str(error)) from None
    if done.returncode != 0:
        raise _refused(path, done.stderr or done.stdout)
    return " ".join(done.stdout.split())


def _refused(path: Path, said: str) -> InputError:
    return InputError(
        "studies.sbatch_refused",
        "{file}: sbatch does not take it: {reason}",
        file=path,
        reason=" ".join(said.split())[:300],
    )
