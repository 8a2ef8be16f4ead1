"""Runs a job: grinds its field along its programs, and says what came out. No FreeCAD in here."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..base import kept, records
from ..base.kinds import Array, Context, Facts, Floats, Json
from ..base.messages import fact_data
from ..cell import collision, events as event_lists, gaps, motions, reach
from ..cell.tool_path import motions as arrays_of, tool_path
from ..engine import Cancelled, InputError, core
from ..inspection import verdict as verdicts
from ..job import engine_input, inputs, law as laws, resolution, spacing, usual
from ..job.law import remaining_cut
from ..job.poses import program_name
from ..job.settings import Job
from ..job.typed import typed
from ..job.workpiece import check_faces, make_stocked_field, read_design, shape_warnings
from . import cell_errors, finish, heat, idle, last_door
from .checkpoints import RunCheckpoints
from .result import Result

NEVER_TOUCHES = "simulation.never_touches"  # the core's code of it
NOTES = 3  # warnings shown behind an error


class _Phases:
    """Wall time by phase, s."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.restart()

    def restart(self) -> None:
        self._last = time.perf_counter()

    def end(self, name: str) -> None:
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - self._last
        self.restart()


def run(
    job: Job | Json,
    context: Context = None,
    recording: core.Recording | None = None,
    early: Callable[[Facts], object] | None = None,
    influence: bool = False,
    shifts: bool = False,
    forces: bool = False,
    resume: bool = True,
) -> Result:
    """Runs a validated job. Raises InputError for what the user must mend, Cancelled on cancel.
    ``recording``: an empty core.Recording that is to follow it, program after program; ``early(warnings)``: is called
    with a list of the first of its warnings before anything is ground; ``influence``: the result has a
    core.Influence, what every motion of all programs removed where, and no errors by the contact's cells; ``forces``: and ``force_influence``, mm that each would
    remove more per relative change of its force; ``shifts``: it has what laws would have removed
    more that are a standard deviation off (``law.shifted_laws``); ``resume``: it goes on from a state of an earlier run
    of this process, and keeps its own for later ones, which takes memory and a little time. A result that cannot be is
    a fault of the program, a RuntimeError (``last_door``).
    """
    warnings: Facts = []
    phases = _Phases()
    try:
        context = context or core.RunContext()
        result, by_law = _run(
            records.plain(job),
            context,
            warnings,
            recording,
            phases,
            early,
            influence,
            forces,
            resume,
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


def _out_of_memory(ended: Collection[str]) -> InputError:
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
    phase = next((name for name in advice if name not in ended), "sample")
    return InputError(
        "simulation.run_out_of_memory",
        "out of memory; {advice}, or close other programs",
        advice=advice[phase],
    )


def _run(
    data: Json,
    context: core.RunContext,
    warnings: Facts,
    recording: core.Recording | None,
    phases: _Phases,
    early: Callable[[Facts], object] | None,
    influence: bool,
    forces: bool,
    resume: bool,
) -> tuple[Result, Floats]:
    phases.restart()
    digests = inputs.digests(data)
    phases.end("hash")
    job = typed(data)
    core.check_wheel(engine_input.of(job).machine.wheel)
    left_out: list[Array] = []
    paths = [tool_path(job, i, warnings, gaps=left_out) for i in range(len(job.programs))]
    unresolved = len(warnings) + sum(program.unresolved or 0 for program in job.programs)
    warnings += idle.warnings(job, paths)
    warnings += usual.warnings(data, [arrays_of(path) for path in paths])
    ways = motions.of_paths(paths)
    phases.end("programs")
    reached = reach.job_reach(job, paths, context.part(0.0, 0.0))
    warnings += reach.warnings(job)
    phases.end("reach")
    shape = read_design(job.design, context)
    warnings += shape_warnings(shape)
    phases.end("read")
    check_faces(job, shape)
    settled, chosen = spacing.settled(data, shape, warnings, context.part(0.0, 0.0))
    data = resolution.applied(settled, warnings)
    job = typed(data)
    given = engine_input.of(job)
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
    speed_effects = _speed_effects(given)
    given = replace(
        given,
        cell_errors=not influence,  # a plan's runs, of which only the heights matter
        influence=influence,
        force_influence=forces,
        lower_limits=verdicts.lower_limits(job, field),
        heat=heated,
        finish=finished,
    )
    shifts = np.zeros((field.size, len(given.shifted_laws)))
    left: list[Floats] = []  # open by the contact's cells, by program
    checkpoints = RunCheckpoints(
        field,
        replace(given, heat=heat.plain(heated)),
        recording is not None,
        len(paths),
        resume,
        [(program.pause_s, program.dress) for program in job.programs],
    )
    phases.end("hash")
    found, process_time, lost, models = [], 0.0, 0.0, {}
    steps: dict[str, Array] = {}
    touched: list[bool] = []
    for i, path in enumerate(paths):
        # Programs that miss the part are told; where all do, there is nothing to show.
        last = len(touched) == len(paths) - 1 and not any(touched)
        given = replace(engine_input.at_program(given, job, i), must_touch=last)
        share = 0.7 / len(paths)
        part = context.part(0.3 + i * share, 0.3 + (i + 1) * share)
        try:
            result = core.simulate(field, path, given, part, recording, checkpoints.next())
        except Cancelled:
            checkpoints.keep()
            raise
        except InputError as error:
            if error.code == NEVER_TOUCHES:
                error = spacing.unseen(job, shape, context.part(0.0, 0.0)) or error
            raise error.within(
                "job.in_program", "{program}: ", program=program_name(job, i)
            ) from None
        checkpoints.ended(result)
        touched.append(result["touched"])
        lists = [one[i]["events"] for one in (reached, met) if one]
        lists.append(gaps.events(path, left_out[i]))
        found.append((i, process_time, sum(lists, result["events"])))
        if removed is not None:
            removed.append(result["influence"])
        if pressed is not None:
            pressed.append(result["force_influence"])
        rows = result["steps"]
        rows["program"] = np.full(len(rows["time"]), i, dtype=np.uint32)
        rows["time"] = rows["time"] + process_time
        steps = rows if not steps else {k: np.concatenate([steps[k], rows[k]]) for k in rows}
        process_time += result["process_time"]
        lost += result["lost_volume"]
        given = replace(given, belt=result["belt"], first_motion=given.first_motion + len(path))
        shifts += result["shifts"]
        left.append(result["unresolved"])
        models = {key: result[key] for key in ("compliance", "law")}
        for name, seconds in result["wall"].items():
            phases.seconds[name] = phases.seconds.get(name, 0.0) + seconds
    checkpoints.keep()
    warnings += _missing(job, touched)
    belt = given.belt
    assert belt is not None  # a job has a program
    phases.restart()
    if shifts.shape[1]:
        field.set_height_sd(np.sqrt((shifts**2).sum(axis=1)), laws.freedom(job.law))
    cell_errors.estimate(job, field, left)
    events = event_lists.merge(found)
    summary = summarise(job, field, events)
    summary.update(cell_errors.figures(job, field))
    cell_errors.warn(summary, warnings)
    phases.end("inspect")
    summary.update(
        spacing_mm=job.sampling.spacing_mm,
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
        belt={**laws.job_belt(belt), "remaining_cut": remaining_cut(job, belt)},
        robot=reach.summary(data["robot"], reached),
        clearances=collision.summary(met, paths),
        unresolved_motions=unresolved,
    )
    done = Result(dict(data), field, summary, events, steps, recording)
    done.motions = ways
    done.influence, done.force_influence = removed, pressed
    phases.restart()
    done.verdict = verdicts.of_result(done, shape, context=context.part(1.0, 1.0))
    done.tell_finish(data["inspection"])
    last_door.check(done)
    phases.end("verdict")
    return done, shifts


def _missing(job: Job, touched: Sequence[bool]) -> Facts:
    """Facts of the programs whose wheel has not met the stock."""
    return [
        core.Fact(
            "job.program_misses",
            "{program}: the wheel never touches the stock, and the program grinds nothing; check its frame and work "
            "object, and its place on the part",
            program=program_name(job, i),
        )
        for i, one in enumerate(touched)
        if not one
    ]


def _speed_effects(given: engine_input.EngineInput) -> dict[str, float]:
    """What the summary says of how the rubber behaves at speed, where it is not left out."""
    factor = given.machine.compliance.dynamic_modulus_factor
    growth = given.wheel_growth
    return {
        **({"dynamic_modulus_factor": factor} if factor != 1.0 else {}),
        **({"wheel_growth_mm": growth} if growth > 0.0 else {}),
    }


def summarise(job: Job, field: core.HeightField, events: Sequence[Json]) -> dict[str, Any]:
    """The figures of a ground field, as summary.json has them."""
    lower, upper = job.inspection.tolerance_mm
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
