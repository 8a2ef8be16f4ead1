"""The faces of a part, for who chooses them without FreeCAD."""

import json

from . import background, outputs
from .messages import print_text


def add(commands):
    """Adds the command to the parser's ``commands``."""
    listed = commands.add_parser(
        "faces",
        help="list a part's faces: number, type, area, place, radii, neighbours",
        description="The faces of a STEP, IGES, BREP or mesh file, numbered as in a job's design.faces. Radii: "
        "the smallest on which the face bulges out or is hollow, but for a twentieth of its area.",
    )
    listed.add_argument("part", help="file of the part, or a job.json")
    listed.add_argument("--unit", type=float, default=1.0, metavar="MM", help="as design.unit_mm")
    listed.add_argument("--json", action="store_true", help="as JSON")
    listed.add_argument(
        "--picture", metavar="FILE", help="PNG of the part from two sides, with the faces' numbers"
    )
    outputs.add(listed)
    listed.set_defaults(do=_faces)


def _faces(arguments):
    from pathlib import Path

    from ..base import standard
    from ..base.files import cannot_be_written, write_whole
    from ..engine import InputError
    from ..inspection import faces
    from ..job import workpiece
    from ..raster.raster_path import load_job

    if not 0.0 < arguments.unit < float("inf"):
        raise InputError("cli.unit", "--unit must be above 0, not {unit:g}", unit=arguments.unit)
    design = {"file": arguments.part, "unit_mm": arguments.unit}
    if standard.named(arguments.part) or Path(arguments.part).suffix.lower() == ".json":
        design = load_job(arguments.part)["design"]
    outputs.check(arguments, [arguments.picture], [arguments.part, design.get("file")])

    def work(context):
        shape = workpiece.read_design(design, context)
        drawn = faces.draw(shape, context) if arguments.picture else None
        return shape.warnings(), faces.faces_of(shape, context), drawn

    warnings, found, drawn = background.run(work, quiet=True)
    arguments.messages.print_warnings(warnings)
    if drawn is not None:
        try:
            write_whole(arguments.picture, drawn[0])
        except OSError as error:
            raise cannot_be_written(arguments.picture, error) from None
    if arguments.json:
        print_text(json.dumps([one.data() for one in found], indent=1, allow_nan=False))
    else:
        print_text(faces.text(found))
    if drawn is not None and drawn[1] and not arguments.json:
        print_text(f"not named in the picture, hidden or too small: {_list(drawn[1])}")


def _list(numbers):
    runs = []
    for number in numbers:
        if runs and runs[-1][1] == number - 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in runs)
