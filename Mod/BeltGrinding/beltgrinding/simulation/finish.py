"""The finish of a part while a job grinds it, where the job asks for it."""

from ..engine import InputError, core
from ..inspection import finish as figures


def check_grit(given):
    """Raises InputError where the grit of a job's ``finish`` is none that its model's measurements cover."""
    span = given["model"]["ranges"]["grit"]
    low, high = figures.widened(span)
    if not low <= given["grit"] <= high:
        raise InputError(
            "job.grit_not_measured",
            "{key}: a grit of {grit:g} was not measured (from {low:g} to {high:g}): its roughness is not known",
            key="finish.grit",
            grit=given["grit"],
            low=span[0],
            high=span[1],
        )


def options(job, warnings):
    """The dict that core.simulate takes as ``finish``; {} for a job without ``finish``, or one whose rigid tool has no
    pressure, which is told. Raises InputError for a grit that was not measured.
    """
    given = job.get("finish")
    if given is None:
        return {}
    if job["law"]["model"] == "geometric":
        warnings.append(
            core.Fact(
                "simulation.no_finish_of_rigid",
                "a geometric (rigid) tool has no pressure: no finish is computed",
            )
        )
        return {}
    found = {}
    if "initial_Ra_um" in given:
        found["before"] = float(given["initial_Ra_um"])
    rest = figures.rest_per_pass(given)
    if rest is not None:
        found["rest"] = float(rest)
    model = given.get("model")
    if model is None:
        warnings.append(
            core.Fact(
                "simulation.no_finish_model",
                "{key} is not given: the direction of the scratches is computed, but no roughness, which only "
                "measurements tell (beltgrind calibrate-finish)",
                key="finish.model",
            )
        )
        return found | {"roughness": 0.0}
    ranges = {key: figures.widened(span) for key, span in model["ranges"].items()}
    check_grit(given)
    if rest is None:
        warnings.append(
            core.Fact(
                "simulation.no_rest_per_pass",
                "{key} is not known: each pass is taken to leave its own roughness, and whether crossed scratches stay "
                "is not told",
                key="finish.rest_per_pass",
            )
        )
    factor = (given["grit"] / model["reference_grit"]) ** model["grit_exponent"]
    speeds = tuple(1000.0 * speed for speed in ranges["belt_speed_m_s"])
    return found | {
        "roughness": model["coefficient_um"] * factor,
        "pressure_exponent": float(model["pressure_exponent"]),
        "speed_exponent": float(model["belt_speed_exponent"]),
        "feed_exponent": float(model["feed_exponent"]),
        "cut_exponent": float(model["wear_exponent"]),
        "reference_pressure": float(model["reference_pressure_MPa"]),
        "reference_speed": 1000.0 * model["reference_belt_speed_m_s"],
        "reference_feed": float(model["reference_feed_mm_s"]),
        "pressure": ranges["pressure_MPa"],
        "speed": speeds,
        "feed": ranges["feed_mm_s"],
        "cut": ranges["remaining_cut"],
    }
