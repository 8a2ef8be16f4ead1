"""What a job is made of, as rows (label, text) for a report's tables."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base.kinds import Json, known
from ..job import machine as machines
from ..job.poses import program_name
from ..job.settings import (
    BeltMachine,
    Calibration,
    Compliance,
    ForceDynamics,
    Job,
    Law,
    Robot,
    Wear,
)
from ..job.typed import typed

if TYPE_CHECKING:
    from .content import Content
    from .language import Language

MOST_FACES = 12  # named one by one

ELASTICITY = {
    "wheel_rim": "rubber rim of finite width on a rigid core",
    "bonded_layer": "rubber layer, infinitely wide",
    "half_space": "rubber half-space",
    "elastic_foundation": "independent springs",
    "surrogate": "regression trained on solved contacts",
    "geometric": "rigid tool that cuts all it meets",
}
LAWS = {
    "local_linear": ("local, linear", "dh/dt = K · k_t · V_b · p"),
    "local": (
        "local, with exponents",
        "dh/dt = K · k_t · g_b(V_b) · g_w(V_w) · g_p(p)",
    ),
    "hammann": ("Hammann, global", "r = C_A · K_A · k_t · V_b · F_A / (V_w · l_w)"),
    "geometric": ("geometric", "all that the wheel's envelope meets is cut"),
}


def part_name(job: Job | Json) -> str:
    """What the part is called: its file, or the design of the job."""
    return Path(typed(job).design.file or "").stem or "design"


def part(content: Content, words: Language) -> list[Any]:
    """Rows of the part and its stock."""
    job, summary, shape = content.result.job, content.result.summary, content.shape
    design, stock = job["design"], job["stock"]
    held = words("held by the job itself")
    count = shape.face_count if shape is not None else None
    rows = [
        (words("Part"), Path(design["file"]).name if "file" in design else held),
        (words("Ground faces"), faces(design["faces"], count, words)),
        (words("Ground area"), f"{words.number(summary['design_area_mm2'], 1)} mm²"),
    ]
    if shape is not None:
        low, high = shape.extents()
        size = " × ".join(words.number(b - a, 1) for a, b in zip(low, high))
        rows.append((words("Size of the part"), f"{size} mm"))
    if "left_by" in stock:
        text = words("what an earlier run left ({file})", file=stock["left_by"])
    elif stock["kind"] == "allowance":
        text = words("{mm} mm everywhere", mm=words.number(stock["allowance_mm"]))
    else:
        kind = words("another solid") if stock["kind"] == "solid" else words("a mesh (scan)")
        text = f"{kind}: {Path(stock['file']).name if 'file' in stock else held}"
    volume = words.number(summary["stock_volume_mm3"], 1)
    rows += [
        (words("Stock before"), f"{text}; {volume} mm³"),
        (
            words("Removed"),
            words("{mm3} mm³", mm3=words.number(summary["removed_volume_mm3"], 1)),
        ),
        *_left(content.verdict, words),
        (
            words("Samples"),
            words(
                "{count}, {mm} mm apart",
                count=words.whole(summary["samples"]),
                mm=words.figures(job["sampling"]["spacing_mm"]),
            ),
        ),
    ]
    return rows


def _left(verdict: Json | None, words: Language) -> list[Any]:
    """Rows of what is left and missing, by a verdict."""
    if verdict is None:
        return []
    untouched = verdict["untouched_area_mm2"]
    return [
        (
            words("Left above the design"),
            f"{words.number(verdict['excess_volume_mm3'], 1)} mm³",
        ),
        (
            words("Missing below the design"),
            f"{words.number(verdict['gouge_volume_mm3'], 1)} mm³",
        ),
        (words("Never touched by the wheel"), f"{words.number(untouched, 1)} mm²"),
    ]


def faces(numbers: Sequence[int], count: int | None, words: Language) -> str:
    """Face1, Face7 of 12; all."""
    if not numbers:
        return words("all {count}", count=count) if count else words("all")
    named = ", ".join(f"Face{number}" for number in numbers[:MOST_FACES])
    if len(numbers) > MOST_FACES:
        named = words("{faces} and {more} more", faces=named, more=len(numbers) - MOST_FACES)
    return words("{faces} (of {count})", faces=named, count=count) if count else named


def process(job: Job | Json, summary: Json, words: Language) -> list[Any]:
    """Rows of programs, belt machine and control."""
    job = typed(job)
    machine, wheel = job.belt_machine, job.belt_machine.wheel
    rows = []
    for i, program in enumerate(job.programs):
        text = Path(program_name(job, i)).name
        for key, unit in (("force_N", "N"), ("feed_mm_s", "mm/s")):
            value = getattr(program, key)
            if value is not None:
                text += f"; {words('everywhere')} {words.figures(value)} {unit}"
        label = words("Robot program")
        rows.append((f"{label} {i + 1}" if len(job.programs) > 1 else label, text))
    shape = words(
        "diameter {diameter} mm, width {width} mm",
        diameter=words.figures(2 * wheel.radius_mm),
        width=words.figures(wheel.width_mm),
    )
    if wheel.profile_mm:
        shape += ", " + words("turned to a profile")
    elif wheel.crown_radius_mm:
        shape += ", " + words("crown radius {mm} mm", mm=words.figures(wheel.crown_radius_mm))
    if machines.wheel_presses(machine):
        small = machines.kind(machine) == machines.SMALL_WHEEL
        rows.append((words("Small wheel") if small else words("Contact wheel"), shape))
        rows.append((words("Elasticity"), _elasticity(machine.compliance, words)))
    else:
        rows += _belt(machine, words)
    if machine.control == "force":
        control = words(
            "force control, {force} N unless the program says otherwise",
            force=words.figures(machine.force_N),
        )
        control += _dynamics(machine.force_dynamics, words)
    elif machine.robot_stiffness_N_per_mm:
        control = words(
            "position control, robot stiffness {stiffness} N/mm",
            stiffness=words.figures(machine.robot_stiffness_N_per_mm),
        )
    else:
        control = words("position control, rigid robot")
    if grown := summary.get("wheel_growth_mm"):
        control += "; " + words("the rim grown by {mm} mm by its rotation", mm=words.figures(grown))
    cut = words.percent(summary.get("belt", {}).get("remaining_cut"), 0)
    holding = job.cell.holding
    rows += [
        (words("Control"), control),
        (
            words("Belt"),
            words(
                "{speed} m/s; cuts {cut} of a fresh one in the end",
                speed=words.figures(machine.belt_speed_m_s),
                cut=cut,
            ),
        ),
        (
            words("The robot holds"),
            words("the tool") if holding == "tool_in_hand" else words("the part"),
        ),
        (words("Robot"), _robot(job.robot, words)),
        (words("Duration of the grind"), words.seconds(summary.get("process_time_s"))),
    ]
    return rows


def _robot(robot: Robot, words: Language) -> str:
    if robot.preset:
        return robot.preset
    own = robot.model.joints or robot.model.urdf
    return words("a robot of one's own") if own else words("not given; its reach is not checked")


def _dynamics(dynamics: ForceDynamics, words: Language) -> str:
    """Behind the control: how quickly the force is met, if not at every moment."""
    model = dynamics.model
    if model == "ideal":
        return ""
    lag = words.figures(dynamics.lag_s)
    if model == "lag":
        return "; " + words("the force lags by {lag} s", lag=lag)
    return "; " + words(
        "moves {mass} kg with a damping of {damping} N s/mm, lag {lag} s",
        damping=words.figures(dynamics.damping_N_s_per_mm),
        mass=words.figures(dynamics.moving_mass_kg),
        lag=lag,
    )


def _belt(machine: BeltMachine, words: Language) -> list[Any]:
    """Rows of a free belt or a platen."""
    run, kind = known(machine.free_run), machines.kind(machine)
    text = words(
        "{width} mm wide, {thickness} mm thick, E {modulus} MPa",
        width=words.figures(run.width_mm),
        thickness=words.figures(run.thickness_mm),
        modulus=words.figures(run.youngs_modulus_MPa),
    )
    rollers = {
        "fixed": words("fixed rollers"),
        "tensioned": words("rollers that keep the pull"),
    }
    text += "; " + words(
        "{tension} N/mm over {length} mm, {rollers}",
        tension=words.figures(run.tension_N_per_mm),
        length=words.figures(run.length_mm),
        rollers=rollers[run.rollers],
    )
    rows = [(words("Free belt") if kind == machines.FREE_BELT else words("Belt"), text)]
    if kind == machines.PLATEN:
        platen = known(machine.platen)
        text = words("{length} mm long", length=words.figures(platen.length_mm))
        if platen.radius_mm > 0.0:
            text += ", R " + words.figures(platen.radius_mm) + " mm"
        text += ", " + words("{count} layers", count=len(platen.layers))
        rows.append((words("Platen"), text))
    return rows


def _elasticity(compliance: Compliance, words: Language) -> str:
    text = words(ELASTICITY[compliance.model])
    if compliance.model in ("wheel_rim", "bonded_layer") and not compliance.layers:
        text += ", " + words(
            "{mm} mm thick, Young's modulus {modulus} MPa",
            mm=words.figures(compliance.rim_thickness_mm),
            modulus=words.figures(compliance.youngs_modulus_MPa),
        )
    elif compliance.layers:
        text += ", " + words("{count} layers", count=len(compliance.layers))
    factor = compliance.dynamic_modulus_factor
    if factor != 1.0:
        text += "; " + words(
            "{factor} times as stiff under the quick contact",
            factor=words.figures(factor),
        )
    return text


def law(job: Job | Json, words: Language) -> tuple[Any, list[Any]]:
    """(formula, rows) of the law of removal."""
    job = typed(job)
    given = job.law
    model, formula = LAWS[given.model]
    rows = [(words("Model"), words(model))]
    if given.model != "geometric":
        k = words.figures(given.coefficient_mm2_per_N)
        rows.append((words("Coefficient K"), f"{k} mm²/N"))
    if given.model == "local":
        rows += _local(given, words)
    rows.append((words("Belt wear"), words(given.wear.model.replace("_", " "))))
    if given.wear.loading_share > 0.0:
        rows.append((words("Belt loading"), _loading(given.wear, words)))
    limit = given.heat_limit_MPa_m_s
    rows.append(
        (
            words("Heat limit"),
            f"{words.figures(limit)} MPa · m/s" if limit else words("none"),
        )
    )
    found = given.calibration
    if _calibrated(given):
        grinds = (found.fit or {}).get("grinds")
        text = words("yes, from {count} grinds", count=grinds) if grinds else words("yes")
        scatter = words.percent(found.scatter or 0.0)
        text += "; " + words("scatter of one grind {share}", share=scatter)
    else:
        text = words("no: the removal is only as good as the coefficient that was typed in")
    rows.append((words("Calibrated"), text))
    rows.append((words("Valid range"), _range(given, words)))
    return formula, rows


def _loading(given: Wear, words: Language) -> str:
    text = words(
        "takes up to {share} of the cut, within {scale}",
        share=words.percent(given.loading_share, 0),
        scale=f"{words.figures(given.loading_scale)} {'J' if given.variable == 'work' else 'mm³'}",
    )
    if given.loading_recovery_s > 0.0:
        seconds = words.figures(given.loading_recovery_s)
        text += "; " + words("given back within {seconds} s of running free", seconds=seconds)
    return text


def _calibrated(law: Law) -> bool:
    return law.calibration != Calibration()


def _local(given: Law, words: Language) -> list[Any]:
    rows = []
    for letter, key, reference, unit in (
        ("α", "pressure", "reference_pressure_MPa", "MPa"),
        ("β", "speed", "reference_speed_m_s", "m/s"),
        ("γ", "feed", "reference_feed_mm_s", "mm/s"),
    ):
        name = {
            "pressure": words("Pressure"),
            "speed": words("Belt speed"),
            "feed": words("Feed"),
        }
        curve = getattr(given, f"{key}_curve")
        if curve:
            text = words("measured curve of {count} points", count=len(curve))
        else:
            text = words(
                "exponent {letter} = {value}, reference {reference}",
                letter=letter,
                value=words.figures(getattr(given, f"{key}_exponent")),
                reference=f"{words.figures(getattr(given, reference))} {unit}",
            )
        rows.append((name[key], text))
    if given.pressure_threshold_MPa:
        value = words.figures(given.pressure_threshold_MPa)
        rows.append((words("Pressure threshold"), f"{value} MPa"))
    if given.saturation_pressure_MPa:
        value = words.figures(given.saturation_pressure_MPa)
        rows.append((words("Saturation pressure"), f"{value} MPa"))
    return rows


def _range(given: Law, words: Language) -> str:
    """The measured ranges that a law names."""
    parts = []
    if given.model == "local":
        for key, unit in (
            ("pressure_curve", "MPa"),
            ("speed_curve", "m/s"),
            ("feed_curve", "mm/s"),
        ):
            curve = getattr(given, key)
            if curve:
                first, last = (words.figures(curve[k][0]) for k in (0, -1))
                parts.append(f"{first} … {last} {unit}")
    return "; ".join(parts) or words("not known: the law names none")


def doubts(
    job: Job | Json,
    summary: Json,
    events: Sequence[Json],
    verdict: Json | None,
    words: Language,
) -> list[Any]:
    """Rows (what, count or None, what it means) of all that weakens the result; always all of them."""
    counted: dict[str, int] = {}
    for event in events:
        counted[event["kind"]] = counted.get(event["kind"], 0) + 1
    verdict = verdict or {}
    calibrated = _calibrated(typed(job).law)
    return [
        (
            words("Samples over which no stock was found (missed rays)"),
            summary["missed_rays"],
            words("Nothing is known there; they count neither as good nor as bad."),
        ),
        (
            words("Samples where the stock already lies below the design"),
            summary["defective_samples"],
            words("No grinding can make these good: the blank is too small there."),
        ),
        (
            words("Places where the process left the law's range"),
            counted.get("law_out_of_range", 0) + counted.get("belt_out_of_range", 0),
            words("The removal is a guess there: the law was never measured so far out."),
        ),
        (
            words("Contacts whose pressure did not settle"),
            counted.get("not_converged", 0),
            words("The pressure is less exact there than asked for."),
        ),
        (
            words("Motions of the robot program that were not understood"),
            verdict.get("unresolved_motions", summary.get("unresolved_motions")),
            words("The real robot does something there that was not simulated."),
        ),
        (
            words("Law of removal without a calibration"),
            int(not calibrated),
            words("Grind a test piece and calibrate, before depths are trusted."),
        ),
        (
            words("Warnings about the input"),
            len(summary.get("warnings", [])),
            words("They are listed below."),
        ),
    ]
