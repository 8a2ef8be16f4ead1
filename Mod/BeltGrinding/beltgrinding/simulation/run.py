"""Runs a job: grinds its field along its programs, and says what came out. No FreeCAD in here."""

import time

import numpy as np

from ..base import kept
from ..base.messages import fact_data
from ..cell import collision, events as event_lists, gaps, motions, reach
from ..cell.tool_path import tool_path
from ..engine import Cancelled, InputError, core
from ..inspection import verdict as verdicts
from ..job import inputs, law as laws, resolution, spacing
from ..job.engine_input import engine_arguments
from ..job.law import remaining_cut
from ..job.poses import program_name
from ..job.workpiece import check_faces, make_stocked_field, read_design, shape_warnings
from . import finish, heat, idle
from .checkpoints import RunCheckpoints
from .result import Result

NOTES = 3  # warnings shown behind an error


class _Phases:
    """Wall time by phase, s."""

    def __init__(self):
        self.seconds = {}
        self.restart()

    def restart(self):
        self._last = time.perf_counter()

    def end(self, name):
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - self._last
        self.restart()


def run(
    job,
    context=None,
    recording=None,
    early=None,
    influence=False,
    shifts=False,
    forces=False,
    resume=True,
):
    """Runs a validated job. Raises InputError for what the user must mend, Cancelled on cancel.
    ``recording``: an empty core.Recording that is to follow it, program after program; ``early(warnings)``: is called
    with a list of the first of its warnings before anything is ground; ``influence``: the result has a
    core.Influence, what every motion of all programs removed where; ``forces``: and ``force_influence``, mm that each would
    remove more per relative change of its force; ``shifts``: it has what laws would have removed
    more that are a standard deviation off (``law.shifted_laws``); ``resume``: it goes on from a state of an earlier run
    of this process, and keeps its own for later ones, which takes memory and a little time.
    """
    warnings = []
    phases = _Phases()
    try:
        context = context or core.RunContext()
        result, by_law = _run(
            job, context, warnings, recording, phases, early, influence, forces, resume
        )
        result.shifts = by_law if shifts else None
        return result
    except MemoryError:
        kept.forget()
        raise _out_of_memory(phases.seconds) from None
    except InputError as error:
        if not warnings:
            raise
        notes = warnings[0]  # they may well be the reason
        for warning in warnings[1:NOTES]:
            notes = core.Fact("simulation.and_note", "{one}; {other}", one=notes, other=warning)
        raise error.followed_by("simulation.notes", ". Note: {notes}", notes=notes) from None


def _out_of_memory(ended):
    """The InputError that says what would need less; ``ended``: phases by name."""
    advice = {
        "programs": core.Fact("simulation.less_program", "split the programs"),
        "reach": core.Fact("simulation.less_program", "split the programs"),
        "read": core.Fact("simulation.less_design", "export the design with fewer faces or bodies"),
        "sample": core.Fact("simulation.less_samples", "enlarge sampling.spacing_mm"),
        "stock": core.Fact(
            "simulation.less_stock", "enlarge sampling.spacing_mm, or thin the stock's mesh"
        ),
        "collisions": core.Fact("simulation.less_cell", "take simpler bodies in the cell"),
        "build": core.Fact(
            "simulation.less_contact",
            "enlarge sampling.spacing_mm, or simulation.max_travel_mm",
        ),
    }
    phase = next((name for name in advice if name not in ended), None)
    return InputError(
        "simulation.run_out_of_memory",
        "out of memory; {advice}, or close other programs",
        advice=advice.get(phase, advice["sample"]),
    )


def _run(job, context, warnings, recording, phases, early, influence, forces, resume):
    phases.restart()
    digests = inputs.digests(job)
    phases.end("hash")
    core.check_wheel(engine_arguments(job)[0])
    left_out = []
    paths = [tool_path(job, i, warnings, gaps=left_out) for i in range(len(job["programs"]))]
    unresolved = len(warnings) + sum(program["unresolved"] for program in job["programs"])
    warnings += idle.warnings(job, paths)
    ways = motions.of_paths(paths)
    phases.end("programs")
    reached = reach.job_reach(job, paths, context.part(0.0, 0.0))
    phases.end("reach")
    shape = read_design(job["design"], context)
    warnings += shape_warnings(shape)
    phases.end("read")
    check_faces(job, shape)
    job, chosen = spacing.settled(job, shape, warnings, context.part(0.0, 0.0))
    job = resolution.applied(job, warnings)
    wheel, compliance, law, options = engine_arguments(job)
    sampled = lambda: phases.end("sample")
    field = make_stocked_field(job, shape, warnings, context.part(0.0, 0.27), sampled)
    phases.end("stock")
    met = collision.check(job, shape, paths, warnings, context.part(0.27, 0.3), reached)
    phases.end("collisions")
    heated = heat.options(job, field, shape, warnings, context.part(0.3, 0.3))
    if heated:
        phases.end("heat")
    finished = finish.options(job, warnings)
    if early is not None:
        early(list(warnings))

    removed = core.Influence() if influence else None
    pressed = core.Influence() if forces else None
    speed_effects = _speed_effects(job, options)
    options.update(
        first_motion=0,
        influence=influence,
        force_influence=forces,
        lower_limits=verdicts.lower_limits(job, field),
        heat=heated,
        finish=finished,
    )
    shifts = np.zeros((field.size, len(options["shifted_laws"])))
    checkpoints = RunCheckpoints(
        field,
        (wheel, compliance, law, options | {"heat": heat.plain(heated)}),
        recording is not None,
        len(paths),
        resume,
    )
    phases.end("hash")
    found, steps, process_time, lost, models = [], None, 0.0, 0.0, {}
    for i, path in enumerate(paths):
        share = 0.7 / len(paths)
        part = context.part(0.3 + i * share, 0.3 + (i + 1) * share)
        try:
            result = core.simulate(
                field, path, wheel, compliance, law, options, part, recording, checkpoints.next()
            )
        except Cancelled:
            checkpoints.keep()
            raise
        except InputError as error:
            raise error.within(
                "job.in_program", "{program}: ", program=program_name(job, i)
            ) from None
        checkpoints.ended(result)
        lists = [one[i]["events"] for one in (reached, met) if one]
        lists.append(gaps.events(path, left_out[i]))
        found.append((i, process_time, sum(lists, result["events"])))
        if influence:
            removed.append(result["influence"])
        if forces:
            pressed.append(result["force_influence"])
        rows = result["steps"]
        rows["program"] = np.full(len(rows["time"]), i, dtype=np.uint32)
        rows["time"] = rows["time"] + process_time
        steps = rows if steps is None else {k: np.concatenate([steps[k], rows[k]]) for k in rows}
        process_time += result["process_time"]
        lost += result["lost_volume"]
        options["belt"] = result["belt"]
        options["first_motion"] += len(path)
        shifts += result["shifts"]
        models = {key: result[key] for key in ("compliance", "law")}
        for name, seconds in result["wall"].items():
            phases.seconds[name] = phases.seconds.get(name, 0.0) + seconds
    checkpoints.keep()
    phases.restart()
    if shifts.shape[1]:
        field.set_height_sd(np.sqrt((shifts**2).sum(axis=1)))
    events = event_lists.merge(found)
    summary = summarise(job, field, events)
    phases.end("inspect")
    summary.update(
        spacing_mm=job["sampling"]["spacing_mm"],
        spacing_chosen=chosen,
        resolution=resolution.mode(job),
        steps=len(steps["time"]),
        process_time_s=process_time,
        lost_volume_mm3=lost,
        **speed_effects,
        wall_time_s=phases.seconds,
        warnings=warnings,
        warning_facts=[fact_data(warning) for warning in warnings],
        inputs=digests,
        models=models,
        belt={
            **laws.job_belt(options["belt"]),
            "remaining_cut": remaining_cut(job, options["belt"]),
        },
        robot=reach.summary(job["robot"], reached),
        clearances=collision.summary(met, paths),
        unresolved_motions=unresolved,
    )
    result = Result(job, field, summary, events, steps, recording)
    result.motions = ways
    result.influence, result.force_influence = removed, pressed
    phases.restart()
    result.verdict = verdicts.of_result(result, shape, context=context.part(1.0, 1.0))
    result.tell_finish(job["inspection"])
    phases.end("verdict")
    return result, shifts


def _speed_effects(job, options):
    """What the summary says of how the rubber behaves at speed, where it is not left out."""
    factor = job["belt_machine"]["compliance"]["dynamic_modulus_factor"]
    growth = options["wheel_growth"]
    return {
        **({"dynamic_modulus_factor": factor} if factor != 1.0 else {}),
        **({"wheel_growth_mm": growth} if growth > 0.0 else {}),
    }


def summarise(job, field, events):
    """The figures of a ground field, as summary.json has them."""
    lower, upper = job["inspection"]["tolerance_mm"]
    s = core.deviation_statistics(field, lower, upper)
    uncertainty = {}
    if "sd_mean" in s:
        uncertainty = {
            "deviation_sd_mm": {"mean": s["sd_mean"], "p95": s["sd_p95"]},
            "expected_in_tolerance_area_share": s["expected_in_tolerance_share"],
        }
    return {
        "samples": s["samples"],
        "design_area_mm2": s["design_area"],
        "stock_volume_mm3": s["stock_volume"],
        "removed_volume_mm3": s["removed_volume"],
        "deviation_mm": {k: s[k] for k in ("min", "max", "mean", "rms", "p05", "p50", "p95")},
        "in_tolerance_area_share": s["in_tolerance_share"],
        "above_tolerance_area_share": s["above_share"],
        "below_tolerance_area_share": s["below_share"],
        **uncertainty,
        "missed_rays": s["missed"],
        "defective_samples": s["defective"],
        "events": event_lists.count(events),
        "versions": core.versions(),
    }
