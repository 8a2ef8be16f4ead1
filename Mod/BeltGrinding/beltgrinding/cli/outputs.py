"""What a command may write over: nothing that it reads, and another's file only by ``--force``."""

import json
import os
import zipfile
from pathlib import Path

HEAD = 4096  # bytes
# How files begin that this program writes. What people keep under such names looks otherwise.
BEGINNINGS = (
    b"index,motion,x_mm,y_mm,z_mm,qw,",  # program
    b"program,pose,line,j1_deg,",  # reach
    b"distance_mm,azimuth_deg,",  # reach --place
    b"E1,",  # the same of external axes
    b"piece,face,s_mm,",  # section
    b"x_mm,y_mm,p_MPa",  # contact
    b"line,predicted,standard_deviation,",  # predict
    b"part,belt,part_of_belt,cut,",  # belt-plan
    b"part,scan,sorted,in_share,",  # sort
    b"belt-ground part",  # mesh, STL
)
MARKS = (
    b"written by BeltGrinding",  # raster, program convert (programs/writers)
    b"\ncomment belt-ground part",  # mesh, PLY
    b"<title>Belt grinding:",  # report, view
    b"<title>Bandschleifen:",
    b'font-size="14">Section at',  # section, SVG
)
PICTURES = (b"\x89PNG", b"<?xml", b"%PDF")  # of calibrate
KEYS = (  # of JSON files
    {"format", "overall", "faces"},  # verdict
    {"model", "coefficient_mm2_per_N"},  # a law
    {"work_J", "removed_mm3", "hours"},  # a belt
    {"grinds", "parameters"},  # a calibration's report
    {"coefficient_um", "reference_grit", "ranges"},  # a job's finish.model
    {"measurements", "rest_per_pass", "left_out"},  # its report
    {"new_belts", "parts_per_belt"},  # a belt plan
)
ARCHIVES = ({"about.npy", "vectors.npy"}, {"about.npy", "gap.npy"})  # a surrogate, its database


def add(parser):
    """Gives a command the option ``--force``."""
    parser.add_argument(
        "--force", action="store_true", help="write over a file that this program has not written"
    )


def check(arguments, outputs, inputs=(), result=None):
    """Raises InputError where one of ``outputs`` (paths, or None) is one of ``inputs`` or a file of the
    ``result``'s folder, or, without ``--force``, a file that this program has not written. Where one is ``-``, standard
    output is left to it.
    """
    from ..base import standard
    from ..engine import InputError
    from ..simulation import result_folder

    read = [Path(path) for path in inputs if path]
    if result is not None:
        read += [Path(result, name) for name in (*result_folder.FILES, result_folder.SCAN)]
    read = {os.path.realpath(path): path for path in read if not standard.named(path)}
    written = {}
    for path in filter(None, outputs):
        real = os.path.realpath(path)
        if real in read:
            raise InputError(
                "cli.own_input",
                "{file}: the command reads it and would write over it; give another file by -o",
                file=path,
            )
        if real in written:
            raise InputError(
                "cli.output_twice", "{file}: two results would be written there", file=path
            )
        written[real] = path
        if standard.named(path):
            standard.keep_for_file()
            continue
        if not arguments.force and os.path.isfile(real) and not _ours(Path(real), result):
            raise InputError(
                "cli.not_ours",
                "{file}: is there already, and this program has not written it; give another file, "
                "or write over it by --force",
                file=path,
            )


def _ours(path, result):
    from ..engine import InputError
    from ..simulation import result_folder

    if result is not None and path.parent == Path(os.path.realpath(result)):
        try:
            if path.name in result_folder.read_summary(result).get("files", ()):
                return True
        except InputError:
            pass
    try:
        with open(path, "rb") as file:
            head = file.read(HEAD)
            file.seek(-min(HEAD, path.stat().st_size), os.SEEK_END)
            tail = file.read()
    except OSError:
        return False
    if not head or head.startswith(BEGINNINGS) or any(mark in head for mark in MARKS):
        return True
    if head.startswith(PICTURES):
        return b"BeltGrinding" in head + tail  # as its creator, in a PDF at the end
    if head.startswith(b"PK"):
        return any(names <= _names(path) for names in ARCHIVES)
    return head.lstrip().startswith(b"{") and any(keys <= _keys(path) for keys in KEYS)


def _names(path):
    try:
        with zipfile.ZipFile(path) as archive:
            return set(archive.namelist())
    except (OSError, zipfile.BadZipFile, ValueError):
        return set()


def _keys(path):
    try:
        found = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return set()
    return set(found) if isinstance(found, dict) else set()
