"""What a written program does: read as a stranger reads it, from its file and those beside it alone, and simulated
under the robot's time at half the spacing, step and contact cells.

A force that the file does not set is the job's. Where the file falls short of its plan, the places are told with their
reasons, and the plan goes on from there, once: with the forces that the file has, at half the spacing, or both.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base.kinds import Array, Context, Facts, Floats, Json, known
from ..cell.tool_path import tool_path
from ..engine import Fact, core
from ..job import load as jobs, poses, resolution
from ..job.poses import program_name
from ..job.robot_time import timed
from ..job.typed import typed
from ..presets import robot as robots
from ..programs.force_device import of_job
from ..simulation import convergence, run as runs
from . import reasons, rounds
from .commands import Commands
from .step import figures

if TYPE_CHECKING:
    from ..simulation.result import Result
    from .rounds import Plan

SHORT = 0.005  # of the area, less than planned: told, and planned on
SAMPLING = 0.01  # of the area, by which half the spacing may change the share
PLACES = 3  # that are told where a file falls short
# What a file may round: mm, of a rotation's matrix, mm/s, N, mm.
PLACE_MM, TURN, FEED_MM_S, FORCE_N, ZONE_MM = 2e-3, 1e-4, 0.1, 0.1, 2e-3
REACHED = 0.95  # of its feed, on a motion: less is not reached
ROUNDS = 3  # of the planning that goes on

Write = Callable[["Plan"], "Sequence[Json]"]


class Checked(NamedTuple):
    """A plan by what its files do."""

    plan: Plan  # its results, and why something stays out of tolerance, are the files'
    planned: Plan  # the same plan by its own last round
    figures: dict[str, Any]  # of what the files do
    entry: dict[str, Any]  # of plan.json
    short: Facts  # where the files fall short of what was planned, and why
    notes: Facts


class _Read(NamedTuple):
    """A plan's files, read and simulated."""

    plan: Plan
    data: Json  # the job of the files, at the level of the plan
    result: Result
    figures: dict[str, Any]
    sampling: float  # of the area: by how much half the spacing changes the share
    half: bool  # the plan is at half the spacing already
    forces: bool  # the files have the planned forces
    short: Facts


def with_programs(
    job: Json, programs: Sequence[Json], folder: Path | str, own_time: bool = False
) -> dict[str, Any]:
    """A validated job with other programs, whose files are relative to ``folder``, under its robot's time; ``own_time``:
    under the job's own. Validated. Raises InputError."""
    found = jobs.validate({**job, "programs": [dict(one) for one in programs]}, folder)
    return found if own_time else timed(found)


def at_half(job: Json, context: core.RunContext) -> dict[str, Any]:
    """A validated job at full resolution, at half its spacing, step and contact cells."""
    whole = resolution.with_mode(rounds.settled(job, context), resolution.FULL)
    return convergence.scaled(whole, "fine")


def is_at_half(job_file: Path | str) -> bool:
    """Whether a plan that went on at half the spacing has written a job's file: its plan.json says so."""
    try:
        told = json.loads(Path(job_file).with_name("plan.json").read_bytes())
    except (OSError, ValueError, RecursionError):
        return False
    entry = told.get("from_file") if isinstance(told, dict) else None
    if Path(job_file).name != "job.json" or not isinstance(entry, dict):
        return False
    return entry.get("half") is True


def check(
    found: Plan,
    folder: Path | str,
    write: Write,
    context: Context = None,
    told: Callable[[dict[str, Any]], object] | None = None,
    before: bool = True,
    refine: bool = True,
) -> Checked:
    """Reads and simulates the programs of a ``Plan`` that ``write(plan)`` writes, which gives their entries in a job in
    ``folder``; where they fall short the plan goes on, and is written again if that is better. ``before``: the job as it was
    is simulated likewise; ``told``: as ``rounds.plan`` takes it, and with the figures of each reading, whose key ``from_file`` is true.
    ``refine``: the plan may go on at half the spacing. Raises InputError, Cancelled.
    """
    context = context or core.RunContext()
    best = _read(found, write(found), folder, False, context.part(0.0, 0.3))
    _tell(told, best)
    notes: Facts = []
    # Forces that a program's own file has no place for keep its poses in the job (``apply``).
    missing = not best.forces and bool(best.short) and not any(found.commands.sources)
    coarse = refine and (abs(best.sampling) > SAMPLING or (bool(best.short) and not missing))
    if missing or coarse:
        job, settings, start = _goes_on(best, missing, coarse, context)
        planned = rounds.plan(job, settings, context.part(0.3, 0.7), told, start=start)
        second = _read(planned, write(planned), folder, coarse, context.part(0.7, 0.9))
        _tell(told, second)
        better = second.figures["in_tolerance"] > best.figures["in_tolerance"]
        notes.append(_planned_on(best, second, missing, coarse, better))
        if better:
            best = second
        else:
            write(best.plan)  # the first files again
    plan = best.plan._replace(after=best.result, why=_why(best, context.part(0.9, 0.9)))
    if before:
        part = context.part(0.9, 1.0)
        given = found.commands.job if _own_time(found) else timed(found.commands.job)
        first = runs.run(at_half(given, part), part, shifts=True)
        checked = {"before": figures(first, plan.settings), "after": best.figures}
        plan = plan._replace(before=first, checked=checked)
    if abs(best.sampling) > SAMPLING:
        notes.append(
            Fact(
                "planning.sampling",
                "+-{points:.1f} points in tolerance from the sampling: spacing, step and contact cells",
                points=100.0 * abs(best.sampling),
            )
        )
    context.report(1.0)
    entry = {
        **best.figures,
        "planned_in_tolerance": figures(best.plan.after, best.plan.settings)["in_tolerance"],
        "sampling": best.sampling,
        "half": best.half,
        "short": [str(one) for one in best.short],
        "notes": [str(one) for one in notes],
    }
    return Checked(plan, best.plan, best.figures, entry, best.short, notes)


def _own_time(plan: Plan) -> bool:
    """Whether a plan is for the job's own time law, as for study."""
    return bool(plan.settings["timing"] == "job")


def _tell(told: Callable[[dict[str, Any]], object] | None, read: _Read) -> None:
    if told is not None:
        told({**read.figures, "from_file": True})


def _read(
    plan: Plan, entries: Sequence[Json], folder: Path | str, half: bool, context: core.RunContext
) -> _Read:
    """``half``: the plan is at half the spacing already, and its files are simulated as they are."""
    data = with_programs(plan.commands.pressed(plan.factors), entries, folder, _own_time(plan))
    part = context.part(0.0, 0.6)
    fine = data if half else at_half(data, context)
    result = runs.run(fine, part, influence=True, shifts=True)
    mine, its = (_arrays(job) for job in (plan.job, data))
    told = figures(result, plan.settings)
    planned = figures(plan.after, plan.settings)
    there = [len(one["feeds"]) for one in mine] == [len(one["feeds"]) for one in its]
    forces = there and _same(mine, its, "forces", FORCE_N)
    other = context.part(0.6, 1.0)
    if half:  # the cheap one of the two levels
        coarse = runs.run(convergence.scaled(data, "coarse"), other, shifts=True)
        sampling = told["in_tolerance"] - figures(coarse, plan.settings)["in_tolerance"]
    elif (
        forces
        and typed(plan.after.job).simulation.timing == typed(data).simulation.timing
        and _same(mine, its, "feeds", FEED_MM_S)
        and _same(mine, its, "zones", ZONE_MM)
        and _in_place(mine, its)
    ):
        sampling = told["in_tolerance"] - planned["in_tolerance"]
    else:
        same = runs.run(at_half(plan.job, context), other, shifts=True)
        sampling = figures(same, plan.settings)["in_tolerance"] - planned["in_tolerance"]
    short: Facts = []
    points = planned["in_tolerance"] - told["in_tolerance"]
    if points > SHORT:
        short.append(
            Fact(
                "planning.file_short",
                "read again, the written program keeps {share:.1f} % in tolerance, {points:.1f} points less than planned",
                share=100.0 * told["in_tolerance"],
                points=100.0 * points,
            )
        )
        short += _places(result, mine, its, fine)
    return _Read(plan, data, result, told, sampling, half, forces, short)


def _goes_on(
    best: _Read, missing: bool, coarse: bool, context: core.RunContext
) -> tuple[Json, Json, tuple[Floats, Floats] | None]:
    """(job, settings, start) of the planning that goes on from a plan whose files are read. ``missing``: with the
    forces that the files have, and no others; ``coarse``: at half the spacing."""
    plan = best.plan
    job = plan.commands.job
    settings: dict[str, Any] = {**plan.settings, "check": False, "rounds": ROUNDS}
    factors = plan.factors
    if missing:
        mine, its = _given(job), _given(best.data)
        if [len(one["feeds"]) for one in mine] == [len(one["feeds"]) for one in its]:
            # The job's own feeds: a file has none for rapid motions.
            its = [{**own, "forces": one["forces"]} for own, one in zip(mine, its)]
        listed = [{"poses": poses.list_poses(one)} for one in its]
        kept = [{"name": one.name} if one.name else {} for one in typed(job).programs]
        rests = [poses.rests(one) for one in job["programs"]]
        job = {**job, "programs": [{**a, **b, **c} for a, b, c in zip(kept, listed, rests)]}
        settings.update(force_min_N=0.0, force_max_N=0.0)
        factors = np.ones(len(factors))
    if coarse:
        job = at_half(job, context)
    same = len(Commands(job, settings)) == len(plan.new)  # not where poses are left out
    return job, settings, (plan.new, factors) if same else None


def _planned_on(first: _Read, second: _Read, missing: bool, coarse: bool, better: bool) -> Fact:
    why = Fact("planning.on_half", "at half the spacing, step and contact cells")
    if missing:
        why = Fact("planning.on_force", "with the force that the file has")
    if missing and coarse:
        why = Fact("planning.on_both", "with the force that the file has, at half the spacing")
    told = {
        "why": why,
        "before": 100.0 * first.figures["in_tolerance"],
        "after": 100.0 * second.figures["in_tolerance"],
    }
    if better:
        return Fact(
            "planning.planned_on",
            "planned on from the written program, {why}: {after:.1f} % in tolerance in place of {before:.1f} %",
            **told,
        )
    return Fact(
        "planning.planned_on_in_vain",
        "planned on from the written program, {why}, which brings no more: {after:.1f} % in place of {before:.1f} %",
        **told,
    )


def _why(read: _Read, context: core.RunContext) -> dict[str, Any]:
    """As ``reasons.find``, of the files."""
    plan = read.plan
    commands, feeds, factors = plan.commands, plan.new, plan.factors
    if len(commands.group) != len(known(read.result.influence)):  # poses are left out
        commands = Commands(read.data, {**plan.settings, "keep": []})
        feeds, factors = commands.feed(), np.ones(len(commands))
    return reasons.find(read.result, commands, feeds, factors, plan.settings, context)


def _arrays(data: Json) -> list[dict[str, Array]]:
    """As ``_given``, forces of the job where a program sets none."""
    force = float(typed(data).belt_machine.force_N)
    return [
        {**one, "forces": np.where(one["forces"] < 0.0, force, one["forces"])}
        for one in _given(data)
    ]


def _given(data: Json) -> list[dict[str, Array]]:
    """Of each program of a job, as ``poses.program_arrays``."""
    job = typed(data)
    pose_of = robots.pose_function(data["robot"])
    return [
        poses.program_arrays(
            program, program_name(job, k), [], pose_of, job.cell.holding, of_job(job)
        )
        for k, program in enumerate(job.programs)
    ]


def _same(mine: list[dict[str, Array]], its: list[dict[str, Array]], name: str, by: float) -> bool:
    """Whether a file has what is planned, but for ``by``, on all motions that grind."""
    for a, b in zip(mine, its):
        grinds = ~a["rapid"]
        one, other = a[name][grinds], b[name][grinds]
        if (abs(one - other) > by).any():
            return False
    return True


def _in_place(mine: list[dict[str, Array]], its: list[dict[str, Array]]) -> bool:
    off = [abs(a["frames"] - b["frames"]) for a, b in zip(mine, its)]
    return all(one[:, :3, 3].max() <= PLACE_MM and one[:, :3, :3].max() <= TURN for one in off)


def _places(
    result: Result, mine: list[dict[str, Array]], its: list[dict[str, Array]], job: Json
) -> Facts:
    """The largest places out of tolerance, each with the motion that did most there and what is otherwise on it than
    planned."""
    verdict = known(result.verdict)
    reached = [_reached(job, k) for k in range(len(its))]
    found: Facts = []
    for cluster in verdict["clusters"][:PLACES]:
        motion = next(iter(cluster["motions"]), None)
        side = Fact("planning.too_much_left", "too much left")
        if cluster["side"] == "below":
            side = Fact("planning.cut_too_deep", "cut too deep")
        told = {
            "area": cluster["area_mm2"],
            "side": side,
            "worst": cluster["worst"]["value_mm"],
            **dict(zip("xyz", cluster["worst"]["point_mm"])),
        }
        if motion is None or motion["program"] is None:
            found.append(
                Fact(
                    "planning.file_short_where",
                    "{area:.1f} mm2 {side} at {x:.1f} {y:.1f} {z:.1f}, worst {worst:+.3f} mm: no motion removes anything there",
                    **told,
                )
            )
            continue
        k, pose = motion["program"], motion["pose"]
        program = Path(verdict["programs"][k]["name"]).name
        place = Fact("cell.at_pose", "{program}, pose {number}", program=program, number=pose + 1)
        if motion["line"]:
            place = Fact(
                "cell.at_line", "{program}, line {number}", program=program, number=motion["line"]
            )
        found.append(
            Fact(
                "planning.file_short_at",
                "{place}: {area:.1f} mm2 {side} at {x:.1f} {y:.1f} {z:.1f}, worst {worst:+.3f} mm: {why}",
                place=place,
                why=_reason(mine[k], its[k], reached[k], pose),
                **told,
            )
        )
    return found


def _reason(mine: dict[str, Array], its: dict[str, Array], reached: Floats, pose: int) -> Fact:
    """What is otherwise on the motion to a pose of the file than planned."""
    left = len(mine["feeds"]) - len(its["feeds"])
    if left:
        return Fact(
            "planning.poses_left_out", "{count} poses of the plan are not in the file", count=left
        )
    force, has = float(mine["forces"][pose]), float(its["forces"][pose])
    if abs(force - has) > FORCE_N:
        return Fact(
            "planning.force_not_in_file",
            "planned with {force:.1f} N, and the file sets none: {has:.1f} N",
            force=force,
            has=has,
        )
    feed = float(mine["feeds"][pose])
    if abs(feed - its["feeds"][pose]) > FEED_MM_S:
        return Fact(
            "planning.feed_not_in_file",
            "planned with {feed:.1f} mm/s, and the file has {has:.1f}",
            feed=feed,
            has=float(its["feeds"][pose]),
        )
    if reached[pose] < REACHED * feed:
        return Fact(
            "planning.feed_not_reached",
            "the robot reaches {reached:.1f} of {feed:.1f} mm/s there",
            reached=float(reached[pose]),
            feed=feed,
        )
    return Fact("planning.seen_at_half", "half the spacing, step and contact cells show it")


def _reached(job: Json, number: int) -> Floats:
    """(poses,) mm/s: the mean speed of the tool centre point on the way to each; the feed where there is no way."""
    path = tool_path(job, number, [])
    given = _arrays(job)[number]
    way = np.linalg.norm(np.diff(given["frames"][:, :3, 3], axis=0), axis=1)
    seconds = np.diff(path.times())
    feeds = np.asarray(given["feeds"], dtype=float)
    moved = np.concatenate([[False], (way > 0.0) & (seconds > 0.0)])
    speed = feeds.copy()
    speed[moved] = (way / np.maximum(seconds, 1e-12))[moved[1:]]
    return speed
