"""The command line: ``python3 -m beltgrinding run job.json -o out/``.

Exit status: 0 success, 2 wrong input (one line on standard error), 130 interrupted.
"""

import argparse
import json
import sys
import threading
from pathlib import Path

CANCEL_TIME = 5.0  # s


def _parser():
    parser = argparse.ArgumentParser(
        prog="beltgrind", description="Simulates robotic belt grinding without FreeCAD."
    )
    parser.add_argument("--version", action="store_true", help="print versions and exit")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")
    run = commands.add_parser("run", help="grind a job")
    run.add_argument("job", help="job.json")
    run.add_argument("-o", "--output", required=True, help="folder for the results")
    run.add_argument("--belt", help="JSON file that carries the belt's use from job to job")
    run.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    contact = commands.add_parser("contact", help="press the wheel on a workpiece, at one place")
    contact.add_argument("contact", help="contact.json; or a job.json, with --pose")
    contact.add_argument("--pose", type=int, help="pose of the job's program, from 1")
    contact.add_argument("--program", type=int, default=1, help="program of the job, from 1")
    contact.add_argument("-o", "--output", help="CSV for the pressure of every cell")
    contact.add_argument("--reference", choices=("ccx",), help="solve it by CalculiX as well")
    contact.add_argument("--keep", help="folder for CalculiX's deck and results")
    reach = commands.add_parser("reach", help="follow a job's programs with its robot's joints")
    reach.add_argument("job", help="job.json")
    reach.add_argument("-o", "--output", help="CSV for the joints at every pose")
    learn = commands.add_parser(
        "surrogate", help="train a surrogate of the contact on a database of solved contacts"
    )
    learn.add_argument("contact", nargs="?", help="contact.json: the wheel, the force, the cells")
    learn.add_argument("-o", "--output", required=True, help="file for the surrogate (.npz)")
    learn.add_argument("--contacts", type=int, default=2000, help="to solve (default 2000)")
    learn.add_argument("--source", choices=("wheel_rim", "ccx"), default="wheel_rim")
    learn.add_argument("--seed", type=int, default=1, help="of the random contacts (default 1)")
    learn.add_argument("--database", help="file that keeps the database (.npz)")
    learn.add_argument("--train-on", help="a database of your own in place of a contact.json")
    fit = commands.add_parser("calibrate", help="fit the removal law to measured grinds")
    fit.add_argument("table", help="CSV of the grinds (docs/calibration.md)")
    fit.add_argument("-o", "--output", required=True, help="file for the law (.json)")
    fit.add_argument("--report", help="file for the report (.json)")
    fit.add_argument("--plot", help="file for a plot (.png, .svg, .pdf)")
    fit.add_argument(
        "--wheel-diameter", type=float, help="of the drive wheel whose rpm are given, mm"
    )
    fit.add_argument("--wear-unit", type=float, default=1.0, help="work in J of one unit of wear")
    scan = commands.add_parser(
        "calibrate-scan", help="fit the law's coefficient to a scan of the ground part"
    )
    scan.add_argument("result", help="folder that run wrote for the same grind")
    scan.add_argument("scan", help="mesh of the ground part, where the job's design lies")
    scan.add_argument("-o", "--output", required=True, help="file for the law (.json)")
    scan.add_argument("--unit-mm", type=float, default=1.0, help="of the mesh, mm (default 1)")
    scan.add_argument("--offset", action="store_true", help="the scan may lie too high everywhere")
    told = commands.add_parser("predict", help="predict further grinds by a calibrated law")
    told.add_argument("law", help="what calibrate wrote")
    told.add_argument("table", help="CSV of the grinds; measured removals are compared")
    told.add_argument("-o", "--output", help="CSV of the predictions")
    told.add_argument("--wheel-diameter", type=float, help="as for calibrate, mm")
    program = commands.add_parser(
        "program",
        help="read a robot program, write changes back into it, or convert it",
        usage="beltgrind program FILE [-o POSES.csv]\n"
        "       beltgrind program write ORIGINAL CHANGES.csv -o NEW\n"
        "       beltgrind program convert FILE -o NEW.src|.mod|.script|.csv",
        description="Says what is in a robot program. write: changed speeds, forces and offsets "
        "go back into the original, nothing else changes. convert: writes it in another language.",
    )
    program.add_argument("program", nargs="+", metavar="FILE", help="the program's file")
    program.add_argument("-o", "--output", help="CSV of every programmed pose; the new program")
    raster = commands.add_parser("raster", help="lay passes on the job's faces (docs/raster.md)")
    raster.add_argument("job", help="job.json; it need not have a program yet")
    raster.add_argument(
        "-o", "--output", required=True, help="program: .csv, .src, .mod or .script"
    )
    raster.add_argument("--settings", help="JSON file of the settings")
    raster.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="one setting; as JSON"
    )
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
    preset = commands.add_parser("presets", help="list the presets, with their sources")
    preset.add_argument("kind", nargs="?", choices=("wheels", "belts", "materials", "robots"))
    preset.add_argument("--json", action="store_true", help="as JSON")
    printed = commands.add_parser("schema", help="print the JSON Schema of job.json")
    printed.add_argument(
        "name", nargs="?", choices=("job", "contact", "presets", "raster"), default="job"
    )
    return parser


def _show_progress(context, done):
    while not done.wait(0.2):
        print(f"\r{100 * context.progress:3.0f} %", end="", file=sys.stderr, flush=True)
    print("\r     \r", end="", file=sys.stderr, flush=True)


def _run(arguments):
    from . import core, job, law

    given = job.load(arguments.job)
    if arguments.belt and Path(arguments.belt).exists():
        given["belt_machine"]["belt"] = law.read_belt(arguments.belt)
    context = core.RunContext()
    outcome = {}
    done = threading.Event()

    def work():
        try:
            outcome["result"] = job.run(given, context)
        except BaseException as error:  # handed on to the main thread
            outcome["error"] = error

    # In a thread of its own, so that Ctrl-C reaches the main thread while C++ computes.
    worker = threading.Thread(target=work, daemon=True)
    worker.start()
    if sys.stderr.isatty() and not arguments.quiet:
        threading.Thread(target=_show_progress, args=(context, done), daemon=True).start()
    try:
        while worker.is_alive():
            worker.join(0.1)
    except KeyboardInterrupt:
        context.cancel()
        worker.join(CANCEL_TIME)  # a library that reads a damaged file may never come back
        raise
    finally:
        done.set()
    if "error" in outcome:
        raise outcome["error"]
    outcome["result"].write(arguments.output)
    if arguments.belt:
        law.write_belt(arguments.belt, outcome["result"].summary["belt"])
    if not arguments.quiet:
        _report(outcome["result"].summary, arguments.output)


def _contact(arguments):
    from . import contact, job

    if arguments.pose is None:
        given = contact.load(arguments.contact)
        result = contact.run(given)
    else:
        given = job.load(arguments.contact)
        result = contact.at_pose(given, arguments.pose, arguments.program)
    figures, truth = contact.summary(result), None
    if arguments.reference:
        from . import reference

        truth = reference.solve(result, contact.rim(given), arguments.keep)
        figures.update(reference.compare(result, truth))
    if arguments.output:
        contact.write_csv(result, arguments.output, truth)
    print(json.dumps(figures))


def _reach(arguments):
    from . import InputError, job, robot
    from .result import write_whole

    given = job.load(arguments.job)
    if not robot.given(given["robot"]):
        raise InputError(f"{arguments.job}: the job names no robot; give it the key 'robot'")
    warnings = []
    paths = [job.tool_path(given, i, warnings) for i in range(len(given["programs"]))]
    found = robot.job_reach(given, paths)
    if arguments.output:
        text = robot.joints_csv(found, [path.lines() for path in paths])
        try:
            write_whole(Path(arguments.output), text.encode())
        except OSError as error:
            raise InputError(f"{arguments.output}: cannot be written: {error.strerror}") from None
    for warning in warnings:
        print(f"warning: {warning}", file=sys.stderr)
    events = [{"program": i, **event} for i, one in enumerate(found) for event in one["events"]]
    print(json.dumps({**robot.summary(given["robot"], found), "events": events}, indent=2))


def _surrogate(arguments):
    from . import InputError, contact, surrogate

    if (arguments.contact is None) == (arguments.train_on is None):
        raise InputError("give either a contact.json or --train-on with a database")

    def tell(done, count):
        print(f"\r{done} of {count} contacts", end="", file=sys.stderr, flush=True)

    if arguments.train_on:
        database = surrogate.load_database(arguments.train_on)
    else:
        database = surrogate.make_database(
            contact.load(arguments.contact),
            arguments.contacts,
            arguments.source,
            arguments.seed,
            tell if sys.stderr.isatty() else None,
        )
        if arguments.database:
            surrogate.save_database(database, arguments.database)
    trained, report = surrogate.train(database, arguments.seed)
    surrogate.save(trained, arguments.output)
    print(json.dumps(report))


def _calibrate(arguments):
    from . import calibration, calibration_plot, calibration_report

    result = calibration.fit(arguments.table, arguments.wheel_diameter, arguments.wear_unit)
    report = result["report"]
    if arguments.plot:
        calibration_plot.draw(report, arguments.plot)
    if arguments.report:
        calibration.write(report, arguments.report)
    calibration.write(result["law"], arguments.output)
    for warning in report["warnings"]:
        print(f"warning: {warning}", file=sys.stderr)
    print(calibration_report.text(report))


def _calibrate_scan(arguments):
    from . import calibration, calibration_scan

    law, figures = calibration_scan.from_files(
        arguments.result, arguments.scan, arguments.unit_mm, offset=arguments.offset
    )
    calibration.write(law, arguments.output)
    print(json.dumps(figures))


def _program(arguments):
    from . import InputError
    from .programs import ProgramError, patch_program, read_program, table, write_program
    from .result import write_whole

    action, *files = arguments.program
    counts = {"write": 2, "convert": 1}
    if action not in counts:
        action, files = "read", arguments.program
    if len(files) != counts.get(action, 1):
        raise InputError(f"program {action}: {len(files)} files; see beltgrind program --help")
    if action != "read" and not arguments.output:
        raise InputError(f"program {action}: say by -o what file to write")
    try:
        if action == "write":
            changed = patch_program(*files, arguments.output)
            print(json.dumps({"changed": len(changed), "motions": changed}, indent=2))
            return
        program = read_program(files[0])
        if action == "convert":
            write_program(arguments.output, None, program)
        elif arguments.output:
            write_whole(Path(arguments.output), table.poses_csv(program).encode())
    except ProgramError as error:
        raise InputError(str(error)) from None
    except OSError as error:
        raise InputError(f"{arguments.output}: cannot be written: {error.strerror}") from None
    print(json.dumps(table.summary(program), indent=2))


def _raster(arguments):
    from . import InputError, raster, schemas
    from .programs import ProgramError, write_program

    settings = schemas.read_json(Path(arguments.settings)) if arguments.settings else {}
    if not isinstance(settings, dict):
        raise InputError(f"{arguments.settings}: the settings are no object of keys")
    for one in arguments.set:
        key, equals, value = one.partition("=")
        if not equals:
            raise InputError(f"--set {one}: write KEY=VALUE")
        try:
            settings[key] = json.loads(value)
        except ValueError:
            settings[key] = value
    found = raster.raster(raster.load_job(arguments.job), settings)
    try:
        write_program(arguments.output, None, raster.program(found))
    except ProgramError as error:
        raise InputError(str(error)) from None
    except OSError as error:
        raise InputError(f"{arguments.output}: cannot be written: {error.strerror}") from None
    for warning in found["warnings"]:
        print(f"warning: {warning}", file=sys.stderr)
    print(json.dumps(raster.summary(found)))


def _section(arguments):
    from . import InputError, section

    by_plane = (arguments.point, arguments.normal)
    by_line = (arguments.start, arguments.end)
    for path in arguments.output:
        if Path(path).suffix.lower() not in (".csv", ".svg"):
            raise InputError(f"{path}: a section is written as .csv or .svg")
    if all(by_plane) and not any(by_line):
        found = section.section(arguments.result, *by_plane)
    elif all(by_line) and not any(by_plane):
        found = section.between(arguments.result, *by_line)
    else:
        raise InputError("section: give --point and --normal, or --from and --to")
    for path in arguments.output:
        if Path(path).suffix.lower() == ".svg":
            section.write_svg(found, path, arguments.mode, arguments.exaggeration)
        else:
            section.write_csv(found, path)
    print(json.dumps(section.summary(found)))


def _predict(arguments):
    from . import calibration_law, schemas

    law = schemas.checked(
        schemas.read_json(Path(arguments.law)), schemas.schema("job")["properties"]["law"], "law"
    )
    found = calibration_law.compare(law, arguments.table, arguments.wheel_diameter)
    if arguments.output:
        calibration_law.write_predictions(found, arguments.output)
    for note in found["notes"]:
        print(f"warning: {note}", file=sys.stderr)
    print(json.dumps(found["figures"]))


def _report(summary, output):
    for warning in summary["warnings"]:
        print(f"warning: {warning}", file=sys.stderr)
    deviation = summary["deviation_mm"]
    print(
        f"{summary['samples']} samples, {summary['steps']} steps, "
        f"{summary['removed_volume_mm3']:.1f} mm3 removed; deviation "
        f"{deviation['min']:+.3f} to {deviation['max']:+.3f} mm, "
        f"{100 * summary['in_tolerance_area_share']:.1f} % of the area in tolerance; "
        f"results in {output}"
    )


def main(argv=None):
    """Runs the command line; returns the exit status."""
    parser = _parser()
    arguments = parser.parse_args(argv)
    try:
        from . import Cancelled, InputError, core, presets, schemas
    except ImportError as error:
        print(f"beltgrind: {error}", file=sys.stderr)
        return 1
    try:
        if arguments.version:
            print(json.dumps(core.versions()))
        elif arguments.command == "schema":
            print(json.dumps(schemas.schema(arguments.name), indent=2))
        elif arguments.command == "presets":
            presets.print_list(arguments.kind, arguments.json)
        elif arguments.command == "contact":
            _contact(arguments)
        elif arguments.command == "reach":
            _reach(arguments)
        elif arguments.command == "surrogate":
            _surrogate(arguments)
        elif arguments.command == "calibrate":
            _calibrate(arguments)
        elif arguments.command == "calibrate-scan":
            _calibrate_scan(arguments)
        elif arguments.command == "program":
            _program(arguments)
        elif arguments.command == "raster":
            _raster(arguments)
        elif arguments.command == "section":
            _section(arguments)
        elif arguments.command == "predict":
            _predict(arguments)
        elif arguments.command == "run":
            _run(arguments)
        else:
            parser.print_usage(sys.stderr)
            return 2
    except InputError as error:
        print("beltgrind: " + " ".join(str(error).split()), file=sys.stderr)
        return 2
    except (KeyboardInterrupt, Cancelled):
        print("beltgrind: interrupted; nothing was written", file=sys.stderr)
        return 130
    except MemoryError:
        print("beltgrind: out of memory; enlarge sampling.spacing_mm", file=sys.stderr)
        return 2
    return 0
