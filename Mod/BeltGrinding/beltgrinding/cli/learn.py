"""Learning the law and the belt's wear from the scan of a ground part."""

from . import background, figures, outputs

NAMES = {"coefficient": "coefficient, mm2/N", "ln_wear_scale": "wear scale"}


def add(commands):
    """Adds the command to the parser's ``commands``."""
    learn = commands.add_parser(
        "learn",
        help="correct the law and the belt's wear by a scan of the ground part, for the next part",
        description="The job of the result is simulated again as it was believed, and its law corrected by what the scan "
        "shows, as far as law, wear and the scatter of a grind were unsure.",
    )
    learn.add_argument("result", help="folder that run or plan wrote for this part")
    learn.add_argument(
        "scan",
        nargs="?",
        help="mesh of the ground part, where the job's design lies; none: what 'scan' measured",
    )
    learn.add_argument("-o", "--output", required=True, help="file for the next part's law (.json)")
    learn.add_argument("--report", help="file for what was learned (.json)")
    learn.add_argument("--unit-mm", type=float, default=1.0, help="of the mesh, mm (default 1)")
    learn.add_argument(
        "--scatter",
        type=float,
        help="standard deviation of ln(measured / predicted) of a grind (default: the calibration's, or 0.05)",
    )
    learn.add_argument(
        "--drift",
        type=float,
        default=0.03,
        help="of coefficient and wear from part to part, as logarithms (default 0.03)",
    )
    learn.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outputs.add(learn)
    figures.add(learn)
    learn.set_defaults(do=_learn)


def _learn(arguments):
    from ..calibration import calibrate as calibration, learning, part_scan
    from ..engine import InputError
    from ..simulation.result import Result

    for name in ("scatter", "drift"):
        value = getattr(arguments, name)
        if value is not None and not 0.0 <= value <= 10.0:
            raise InputError(
                "cli.share", "--{name} {value}: give a number from 0 to 10", name=name, value=value
            )
    written = [arguments.output, arguments.report]
    outputs.check(arguments, written, [arguments.scan], arguments.result)
    result = Result.read(arguments.result)
    measured = part_scan.measured_heights(result, arguments.scan, arguments.unit_mm)

    def work(context):
        return learning.learn(result.job, measured, arguments.scatter, arguments.drift, context)

    found = background.run(work, arguments.quiet)
    report = {
        "learned": found.report,
        "factor": found.factor,
        "rms_mm": {"before": found.rms_mm[0], "after": found.rms_mm[1]},
        "samples": found.samples,
    }
    if arguments.report:
        calibration.write(report, arguments.report)
    calibration.write(found.law, arguments.output)
    if arguments.json or not arguments.quiet:
        figures.tell(arguments, report, _text(found))


def _text(found):
    lines = [
        f"measured removal is {found.factor:.3f} of the predicted; what is predicted misses the scan by "
        f"{found.rms_mm[0]:.3f} mm rms before, {found.rms_mm[1]:.3f} mm after"
    ]
    for one in found.report:
        name = NAMES.get(one["parameter"], one["parameter"].replace("_", " "))
        low, high = one["interval"]
        lines.append(
            f"  {name}: {one['before']:.4g} before, {one['after']:.4g} now ({low:.4g} to {high:.4g} in 95 %)"
        )
    return "\n".join(lines)
