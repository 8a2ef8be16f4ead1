"""Fitting the removal law to what was measured, and predicting by it."""

from pathlib import Path

from . import background, figures, outputs


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    fit = commands.add_parser("calibrate", help="fit the removal law to measured grinds")
    fit.add_argument("table", help="CSV of the grinds (docs/calibration.md)")
    fit.add_argument("-o", "--output", required=True, help="file for the law (.json)")
    fit.add_argument("--report", help="file for the report (.json)")
    fit.add_argument("--plot", help="file for a plot (.png, .svg, .pdf)")
    fit.add_argument(
        "--wheel-diameter", type=float, help="of the drive wheel whose rpm are given, mm"
    )
    fit.add_argument("--wear-unit", type=float, default=1.0, help="work in J of one unit of wear")
    fit.add_argument("--job", help="job (.json) on whose wheel the grinds were done")
    outputs.add(fit)
    figures.add(fit)
    fit.set_defaults(do=_calibrate)
    finish = commands.add_parser(
        "calibrate-finish", help="fit the roughness that passes leave to measured ones"
    )
    finish.add_argument("table", help="CSV of the measurements (docs/finish.md)")
    finish.add_argument(
        "-o", "--output", required=True, help="file for a job's finish.model (.json)"
    )
    finish.add_argument("--report", help="file for the report (.json)")
    finish.add_argument("--job", help="job (.json) whose law tells how belts wear")
    finish.add_argument("--source", default="", help="what was measured, and by whom")
    outputs.add(finish)
    figures.add(finish)
    finish.set_defaults(do=_calibrate_finish)
    scan = commands.add_parser(
        "calibrate-scan", help="fit the law's coefficient to a scan of the ground part"
    )
    scan.add_argument("result", help="folder that run wrote for the same grind")
    scan.add_argument(
        "scan",
        nargs="?",
        help="mesh of the ground part, where the job's design lies; none: what 'scan' measured",
    )
    scan.add_argument("-o", "--output", required=True, help="file for the law (.json)")
    scan.add_argument("--unit-mm", type=float, default=1.0, help="of the mesh, mm (default 1)")
    scan.add_argument("--offset", action="store_true", help="the scan may lie too high everywhere")
    outputs.add(scan)
    figures.add(scan)
    scan.set_defaults(do=_calibrate_scan)
    told = commands.add_parser("predict", help="predict further grinds by a calibrated law")
    told.add_argument("law", help="what calibrate wrote")
    told.add_argument("table", help="CSV of the grinds; measured removals are compared")
    told.add_argument("-o", "--output", help="CSV of the predictions")
    told.add_argument("--wheel-diameter", type=float, help="as for calibrate, mm")
    outputs.add(told)
    figures.add(told)
    told.set_defaults(do=_predict)


def _calibrate(arguments):
    from ..calibration import (
        calibrate as calibration,
        plot as calibration_plot,
        report as calibration_report,
    )
    from ..job import load as jobs

    written = [arguments.output, arguments.report, arguments.plot]
    outputs.check(arguments, written, [arguments.table, arguments.job])
    machine = jobs.load(arguments.job)["belt_machine"] if arguments.job else None
    result = calibration.fit(
        arguments.table, arguments.wheel_diameter, arguments.wear_unit, machine
    )
    report = result["report"]
    if arguments.plot:
        calibration_plot.draw(report, arguments.plot)
    if arguments.report:
        calibration.write(report, arguments.report)
    calibration.write(result["law"], arguments.output)
    arguments.messages.print_warnings(report["warnings"])
    figures.tell(arguments, report, calibration_report.text(report))


def _calibrate_finish(arguments):
    from ..calibration import calibrate as calibration, finish, finish_table
    from ..job import load as jobs

    outputs.check(arguments, [arguments.output, arguments.report], [arguments.table, arguments.job])
    remaining = finish_table.wear_by(jobs.load(arguments.job)) if arguments.job else None
    result = background.run(
        lambda context: finish.fit_finish(arguments.table, remaining, arguments.source, context)
    )
    report = result["report"]
    if arguments.report:
        calibration.write(report, arguments.report)
    calibration.write(result["model"], arguments.output)
    arguments.messages.print_warnings(report["warnings"])
    figures.tell(arguments, report, finish.text(report))


def _calibrate_scan(arguments):
    from ..calibration import calibrate as calibration, part_scan as calibration_scan

    outputs.check(arguments, [arguments.output], [arguments.scan], arguments.result)
    law, found = calibration_scan.from_files(
        arguments.result, arguments.scan, arguments.unit_mm, offset=arguments.offset
    )
    calibration.write(law, arguments.output)
    figures.tell(arguments, found)


def _predict(arguments):
    from ..base import schemas
    from ..calibration import law as calibration_law
    from ..job.law import check_calibration

    outputs.check(arguments, [arguments.output], [arguments.law, arguments.table])
    law = schemas.checked(
        schemas.read_json(Path(arguments.law)), schemas.schema("job")["properties"]["law"], "law"
    )
    check_calibration(law["calibration"])
    found = calibration_law.compare(law, arguments.table, arguments.wheel_diameter)
    if arguments.output:
        calibration_law.write_predictions(found, arguments.output)
    arguments.messages.print_warnings(found["notes"])
    figures.tell(arguments, found["figures"])
