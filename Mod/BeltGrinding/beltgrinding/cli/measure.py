"""A result for other measuring programs, and what these measured: ``beltgrind mesh`` and ``scan``."""


from . import background, figures, outputs


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
    outputs.add(mesh)
    figures.add(mesh)
    mesh.set_defaults(do=_mesh)
    scan = commands.add_parser(
        "scan",
        help="align a scan of the ground part and compare it with the prediction (docs/scan.md)",
        description="Keeps the measured heights with the result. Where the scan starts: as it lies, "
        "by --matrix, by --pairs, or by --principal.",
    )
    scan.add_argument("result", help="folder that run wrote for the same grind")
    scan.add_argument("scan", help="mesh or cloud: .stl, .ply, .obj, .xyz, .asc, .csv")
    scan.add_argument("--unit-mm", type=float, default=1.0, help="of the scan, mm (default 1)")
    scan.add_argument("--datum-faces", help="numbers from 1, as 1,2,5; default: all not ground")
    start = scan.add_mutually_exclusive_group()
    start.add_argument("--matrix", help="text file of 4 rows (or 3) of 4: work from scan, mm")
    start.add_argument(
        "--pairs", help="CSV: x,y,z on the scan (its unit), x,y,z on the design (mm)"
    )
    start.add_argument("--principal", action="store_true", help="lay principal axes on each other")
    start.add_argument("--aligned", action="store_true", help="it lies right: only measure it")
    scan.add_argument("--fixed", default="", help="of tx,ty,tz,rx,ry,rz: stay as they start")
    scan.add_argument("--max-distance-mm", type=float, help="farther points are not of the part")
    scan.add_argument("--share", type=float, default=0.9, help="of the pairs, not trimmed (0.9)")
    scan.add_argument("--search-mm", type=float, help="for the surface, along the normals")
    figures.add(scan)
    scan.set_defaults(do=_scan)


def _mesh(arguments):
    from ..inspection import closed_mesh
    from ..simulation.result import Result

    outputs.check(arguments, [arguments.output], result=arguments.result)
    result = Result.read(arguments.result)
    found = background.run(
        lambda context: closed_mesh.export(
            result, arguments.output, not arguments.design, arguments.deflection_mm, context
        ),
        quiet=True,
    )
    arguments.messages.print_warnings(found.pop("warnings"))
    figures.tell(arguments, found)


def _scan(arguments):
    from ..scan import comparison as scan, start as scan_start
    from ..simulation.result import Result

    result = Result.read(arguments.result)
    faces = None
    if arguments.datum_faces is not None:
        faces = scan_start.face_numbers(arguments.datum_faces)
    options = {
        "start": "principal" if arguments.principal else scan_start.read_matrix(arguments.matrix),
        "pairs": scan_start.read_pairs(arguments.pairs),
        "datum_faces": faces,
        "fixed": [name for name in arguments.fixed.split(",") if name],
        "max_distance_mm": arguments.max_distance_mm,
        "share": arguments.share,
        "search_mm": arguments.search_mm,
        "aligned": arguments.aligned,
    }
    found = background.run(
        lambda context: scan.compare(
            result, arguments.scan, arguments.unit_mm, context=context, **options
        ),
        quiet=True,
    )
    scan.write(result, found)
    arguments.messages.print_warnings(found["warnings"])
    figures.tell(arguments, found)
