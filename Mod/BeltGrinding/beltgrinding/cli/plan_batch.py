"""The same plan for many parts, each with its own scan as stock and its own programs."""

import csv
import io
from pathlib import Path

from .messages import print_text

TABLE = "parts.csv"
COLUMNS = (
    "scan",
    "folder",
    "before_in_tolerance",
    "in_tolerance",
    "process_time_s",
    "trusted",
    "error",
)


def add(parser):
    """Gives ``plan`` its options for scans."""
    parser.add_argument(
        "--stock",
        action="append",
        default=[],
        metavar="SCAN",
        help="mesh of a raw part, which is laid on the design and is its stock (.stl, .ply, .obj); for several parts "
        "several times: each has a folder of its own",
    )
    add_alignment(parser)


def add_alignment(parser):
    """Gives a command the options that lay scans on the design."""
    parser.add_argument("--unit-mm", type=float, default=1.0, help="of the scans, mm (default 1)")
    parser.add_argument("--datum-faces", help="numbers from 1, as 1,2,5; default: all not ground")
    start = parser.add_mutually_exclusive_group()
    start.add_argument("--matrix", help="text file of 4 rows (or 3) of 4: work from scan, mm")
    start.add_argument(
        "--pairs", help="CSV: x,y,z on the scan (its unit), x,y,z on the design (mm)"
    )
    start.add_argument("--principal", action="store_true", help="by the principal axes")
    start.add_argument("--aligned", action="store_true", help="it lies where the design does")


def options(arguments):
    """What ``scan.stock.as_stock`` takes."""
    from ..scan import start as scan_start

    faces = arguments.datum_faces
    return {
        "unit_mm": arguments.unit_mm,
        "start": "principal" if arguments.principal else scan_start.read_matrix(arguments.matrix),
        "pairs": scan_start.read_pairs(arguments.pairs),
        "datum_faces": None if faces is None else scan_start.face_numbers(faces),
        "aligned": arguments.aligned,
    }


def folders(arguments):
    """[(scan or None, folder)]: one scan is planned into the folder itself, several into folders of their names."""
    out = Path(arguments.output)
    if len(arguments.stock) < 2:
        return [(next(iter(arguments.stock), None), out)]
    found, taken = [], set()
    for scan in arguments.stock:
        name, number = Path(scan).stem, 1
        while name.lower() in taken:
            number += 1
            name = f"{Path(scan).stem}-{number}"
        taken.add(name.lower())
        found.append((scan, out / name))
    return found


def each(arguments, one_part):
    """Plans all parts by ``one_part(scan, folder, options)``, which gives a plan and its alignment. A part that fails is
    told, and the others go on; in the end that is an InputError."""
    from ..engine import InputError

    parts, given = folders(arguments), options(arguments)
    if len(parts) == 1:
        one_part(*parts[0], given)
        return
    rows = []
    for scan, folder in parts:
        if not arguments.quiet:
            print_text(f"{scan}:")
        try:
            plan, found = one_part(scan, folder, given)
        except InputError as error:
            arguments.messages.print_warnings([error])
            rows.append([scan, folder.name, "", "", "", "", str(error)])
            continue
        before, after = (one.summary for one in (plan.before, plan.after))
        share = "in_tolerance_area_share"
        trusted = "" if found is None else found["trusted"]
        figures = [f"{before[share]:.4f}", f"{after[share]:.4f}", f"{after['process_time_s']:.2f}"]
        rows.append([scan, folder.name, *figures, trusted, ""])
    _write(Path(arguments.output, TABLE), rows)
    failed = sum(bool(row[-1]) for row in rows)
    if failed:
        raise InputError(
            "planning.parts_failed",
            "{failed} of {count} parts could not be planned; {file} says why",
            failed=failed,
            count=len(rows),
            file=Path(arguments.output, TABLE),
        )
    if not arguments.quiet:
        print_text(f"{len(rows)} parts planned; {TABLE} in {arguments.output}")


def _write(path, rows):
    from ..base.files import cannot_be_written, write_whole

    file = io.StringIO()
    table = csv.writer(file, lineterminator="\n")
    table.writerow(COLUMNS)
    table.writerows(rows)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, file.getvalue().encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None
