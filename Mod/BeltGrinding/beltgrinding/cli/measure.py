"""``beltgrind mesh``: a result for other measuring programs."""

import json
import sys


def add(commands):
    mesh = commands.add_parser("mesh", help="write the whole ground part as a closed mesh")
    mesh.add_argument("result", help="folder that run wrote")
    mesh.add_argument("-o", "--output", required=True, help="file: .stl, .ply or .3mf")
    which = mesh.add_mutually_exclusive_group()
    which.add_argument("--ground", action="store_true", help="as ground (the default)")
    which.add_argument("--design", action="store_true", help="as designed, by the same triangles")
    mesh.add_argument(
        "--deflection-mm", type=float, default=0.05, help="chord error of other faces (0.05)"
    )
    mesh.set_defaults(do=_mesh)


def _mesh(arguments):
    from .. import closed_mesh

    found = closed_mesh.export(
        arguments.result, arguments.output, not arguments.design, arguments.deflection_mm
    )
    for warning in found.pop("warnings"):
        print(f"warning: {warning}", file=sys.stderr)
    print(json.dumps(found))
