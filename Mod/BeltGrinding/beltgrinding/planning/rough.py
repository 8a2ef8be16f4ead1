"""Rough plans of passes that are tried: few rounds, coarsely where samples are many."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..base.kinds import Floats, Json, known
from ..base.records import made
from ..engine import core
from ..inspection import verdict as verdicts
from ..job import poses, resolution
from ..job.settings import BeltMachine
from ..job.typed import typed
from ..job.workpiece import read_design
from ..programs.program import Program
from ..raster import raster_path, reach_map
from ..raster.proposal import FORCE_LEAST
from ..simulation import run as runs
from . import reasons, rounds
from .step import force_exponent

MATTERS = 0.01  # of the area: a reason for less is let be
GAIN = 0.003  # of the area, for other passes to be better
LEAST_FORCE, FORCES = 0.02, 40  # of the force that is set by hand; so many are looked at
WAY = ("along", "direction", "belt_angle_deg")
GENTLED = 2  # times that such a force is lowered, before passes are compared with others
FAR_OFF = 0.05  # of the area: gain from which on it is
ELSEWHERE = (
    reasons.NOT_REACHED,
    reasons.FRINGE,
)  # why too much is left that other passes may get to
LEFT = 1_000  # samples that tell where
MOST_OF = 0.9  # of the area that is not done at the least feed: the repeats are for it

# mm (poses,) of the zones of a program as its file will have them; -1: the job's default.
Zones: TypeAlias = Callable[[Program], Floats]


class Roughly(NamedTuple):
    """How passes that are tried are planned."""

    samples: int  # at most, about
    rounds: int


ROUGHLY = Roughly(16_000, 3)  # one round says too little where the force is far off
FEWEST_SAMPLES = 3_000
GLANCE = Roughly(FEWEST_SAMPLES, 1)  # tells which of many are worth a rough plan
MUCH_COARSER = 1.3  # times a rough plan's spacing; a glance that has less takes as long


class Tried(NamedTuple):
    """Passes that were tried, without what is large: it can be sent to another process."""

    change: str  # what of the passes before was changed, or "first"
    machine: Json  # the job's belt machine
    wanted: Json  # settings of the raster, its way found
    in_tolerance: float  # of the area, surely where that is asked for
    start: tuple[Floats, Floats]  # feeds and factors on forces, a value a command
    shares: Json  # of the area out of tolerance, by reason
    below: float  # of the area, cut too deep
    width_mm: float | None  # of the contact
    length_mm: float
    step_over_mm: float
    levels: int  # passes beside each other
    poses: int
    process_time_s: float
    undone: float  # of the area, not done even at the least feed and the greatest force
    repeats: int  # that it wants
    gentler: tuple[float, float]  # of the area, that less force set by hand may mend; of the force
    looks: Floats  # (3,) unit: the faces' mean normal, 0 of closed ones
    left: Floats  # (n, 3) mm: samples with too much left, to which the wheel may get with its belt another way
    left_mm: float  # between them, about
    left_share: float  # of the area

    def region(self) -> dict[str, Any]:
        """Settings of a raster that keep to where too much is left, to half the contact's width or to the next sample."""
        near = self.left_mm <= 0.5 * (self.width_mm or 0.0)
        return {
            "region_points": np.round(self.left, 4).tolist(),
            "region_mm": 0.0 if near else round(self.left_mm, 4),
        }

    def row(self, better: bool) -> dict[str, Any]:
        """Figures of these passes for tables and JSON."""
        wheel = self.machine["wheel"]
        return {
            "change": self.change,
            "wheel": {k: wheel[k] for k in ("radius_mm", "width_mm", "crown_radius_mm")},
            "force_N": self.wanted["force_N"] or self.machine["force_N"],
            "along": self.wanted["along"],
            "direction": list(self.wanted["direction"]),
            "belt_angle_deg": self.wanted["belt_angle_deg"],
            "max_tilt_deg": self.wanted["max_tilt_deg"],
            "step_over_mm": self.step_over_mm,
            "repeats": self.wanted["repeats"],
            "run_out_mm": self.wanted["run_out_mm"],
            "smoothing_mm": self.wanted["smoothing_mm"],
            "border_force_share": self.wanted["border_force_share"],
            "further_passes": [
                {name: {**self.wanted, **group}[name] for name in WAY}
                for group in self.wanted["further_passes"]
            ],
            "poses": self.poses,
            "process_time_s": self.process_time_s,
            "in_tolerance": self.in_tolerance,
            "better": better,
        }


Move: TypeAlias = "tuple[str, Json, Json]"  # what changes, belt machine, settings of the raster
Moves: TypeAlias = Callable[[Tried], Iterable["tuple[float, Move]"]]  # with what each may bring


def with_path(data: Json, laid: Json) -> dict[str, Any]:
    """The job with the passes as its only program, before which the belt rests as before its first one."""
    first = data["programs"][0]
    laid_program = {
        "name": "raster",
        **poses.rests(first),
        "poses": poses.list_poses(laid),
        "unresolved": 0,
    }
    return {**data, "programs": [laid_program]}


def one_force(settings: Json) -> bool:
    """Whether the force is set once, by hand: the settings of a plan let none change."""
    return not settings["force_min_N"] and not settings["force_max_N"]


def with_machine(data: Json, machine: Json, wanted: Json, settings: Json) -> dict[str, Any]:
    """The job with another belt machine; a force of the passes that no program sets is the machine's."""
    force = wanted["force_N"] or machine["force_N"]
    return {
        **data,
        "belt_machine": {**machine, "force_N": force} if one_force(settings) else machine,
    }


def lay(
    data: Json,
    wanted: Json,
    settings: Json,
    context: core.RunContext,
    zones: Zones | None = None,
    looked_at: bool = True,
) -> dict[str, Any]:
    """As ``raster_path.raster``; with the zones that the program's file will have, and one force where the plan's settings let
    none change."""
    if one_force(settings):  # the feed alone would fall at borders
        wanted = {**wanted, "border_force_share": 0.0}
    laid = raster_path.raster(data, wanted, context, looked_at)
    if one_force(settings):
        laid["forces"] = np.full(
            len(laid["forces"]), -1.0
        )  # the job's, from touching down to lifting off
    if zones is not None:
        laid["zones"] = zones(raster_path.program(laid))
    return laid


def attempt(
    data: Json,
    move: Move,
    settings: Json,
    zones: Zones | None = None,
    context: core.RunContext | None = None,
    how: Roughly = ROUGHLY,
) -> Tried:
    """Lays passes on a job (validated, in its time) and plans them roughly. Raises InputError, Cancelled."""
    return attempted(data, move, settings, zones, context, how)[0]


def attempted(
    data: Json,
    move: Move,
    settings: Json,
    zones: Zones | None = None,
    context: core.RunContext | None = None,
    how: Roughly = ROUGHLY,
) -> tuple[Tried, rounds.Plan]:
    """As ``attempt``, with the rough plan itself."""
    context = context or core.RunContext()
    change, machine, wanted = move
    data = with_machine(data, machine, wanted, settings)
    laid = lay(data, wanted, settings, context.part(0.0, 0.2), zones, looked_at=False)
    # The way is found once: other passes go the same.
    wanted = {**wanted, "along": laid["along"], "direction": list(laid["direction"])}
    job = rounds.settled(with_path(data, laid), context)
    job = _coarser(job, laid["area_mm2"], how.samples)
    rough = {"rounds": how.rounds, "check": False, "levels": 0}
    plan = rounds.plan(job, {**settings, **rough}, context.part(0.2, 1.0))
    return _seen(move[0], machine, wanted, laid, plan, settings), plan


def gentled(
    data: Json,
    move: Move,
    settings: Json,
    zones: Zones | None = None,
    over: Callable[[], bool] | None = None,
    how: Roughly = ROUGHLY,
) -> Tried:
    """As ``attempt``; where a force that is set by hand is far too great, with less of it: else ways that remove more would all
    seem worse. ``over()``: whether the best so far is enough. Raises InputError."""
    best = attempt(data, move, settings, zones, how=how)
    for _ in range(GENTLED):
        if over is not None and over():
            break
        less = less_force(best)
        if less is None or max(less[0], best.below) <= FAR_OFF:
            break
        one = attempt(data, less[1], settings, zones, how=how)
        if one.in_tolerance <= best.in_tolerance:
            break
        best = one
    return best._replace(change=move[0])


def less_force(one: Tried) -> tuple[float, Move] | None:
    """(of the area, that it may mend; the same passes with less of a force that is set by hand); None: it mends nothing."""
    gain, of_force = one.gentler
    machine = made(BeltMachine, one.machine)
    force = max(round(of_force * machine.force_N, 1), FORCE_LEAST)
    by_hand = machine.control == "force" and not one.wanted["force_N"]
    if gain <= MATTERS or not by_hand or force >= machine.force_N:
        return None
    return gain, ("force", {**one.machine, "force_N": force}, one.wanted)


def expected(job: Json, context: core.RunContext | None = None) -> float:
    """Of the area, that a validated job brings into tolerance as it is, by a coarse run. Raises InputError, Cancelled."""
    context = context or core.RunContext()
    job = rounds.settled(job, context.part(0.0, 0.0))
    design = typed(job).design
    shape = read_design(design, context.part(0.0, 0.0))
    faces = design.faces or range(1, shape.face_count + 1)
    area = sum(shape.face_area(face - 1) for face in faces)
    result = runs.run(_coarser(job, area, ROUGHLY.samples), context, resume=False)
    return float(result.summary["in_tolerance_area_share"])


def evenly(job: Json) -> Json:
    """A job, its spacing chosen, without the finer samples at noses that come by themselves: contacts there have so many
    cells that they take most of the time, on little of the area."""
    sampling = typed(job).sampling
    if sampling.edge_spacing_mm or sampling.precision_mm:
        return job
    return _sampled(job, edge_spacing_mm=sampling.spacing_mm)


def _sampled(job: Json, **values: float) -> Json:
    return {**job, "sampling": {**job["sampling"], **values}}


def _coarser(job: Json, area: float, samples: int) -> Json:
    """The job in the coarse mode, with at most ``samples``, about; small faces keep enough of them."""
    job = evenly(job)
    sampling = typed(job).sampling
    own = sampling.spacing_mm
    factor = spacing(job, area, samples) / own
    coarse = _sampled(
        job,
        spacing_mm=factor * own,
        edge_spacing_mm=factor * sampling.edge_spacing_mm,
        precision_mm=factor**2 * sampling.precision_mm,
    )
    return resolution.sooner(coarse)


def spacing(job: Json, area: float, samples: int) -> float:
    """mm between samples of rough plans of a job with a spacing, on faces of ``area`` mm2."""
    read = typed(job)
    least, most = math.sqrt(area / samples), math.sqrt(area / FEWEST_SAMPLES)
    by_contact = min(resolution.SAMPLES * read.belt_machine.contact_spacing_mm, most)
    return max(by_contact, least, read.sampling.spacing_mm)


def glances(data: Json, wanted: Json) -> bool:
    """Whether a glance at passes of a validated job takes much less time than a rough plan: it has fewer samples."""
    area = reach_map.area_of(data, wanted)
    glance, roughly = (spacing(data, area, how.samples) for how in (GLANCE, ROUGHLY))
    return glance > MUCH_COARSER * roughly


def _seen(
    change: str, machine: Json, wanted: Json, laid: Json, plan: rounds.Plan, settings: Json
) -> Tried:
    looks = -np.asarray(laid["contacts"])[:, :3, 2].mean(axis=0)
    size = float(np.linalg.norm(looks))
    best = max(plan.rounds, key=share)
    shares = plan.why["shares"]
    removed, most = _removed(plan), _most(plan)
    undone, repeats = _repeats(plan, wanted["repeats"], removed, most)
    left, areas = np.isin(plan.why["state"], ELSEWHERE), np.asarray(plan.after.field.areas)
    some = np.flatnonzero(left)
    some = some[np.unique(np.linspace(0, len(some) - 1, LEFT).astype(int))] if len(some) else some
    return Tried(
        change=change,
        machine=machine,
        wanted=wanted,
        in_tolerance=share(best),
        start=(plan.new, plan.factors),
        shares=shares,
        below=plan.rounds[-1]["below"],
        width_mm=laid["contact_width_mm"],
        length_mm=laid["contact_length_mm"],
        step_over_mm=laid["step_over_mm"],
        levels=len({one["level"] for one in laid["passes"]}),
        poses=len(laid["frames"]),
        process_time_s=best["process_time_s"],
        undone=undone,
        repeats=repeats,
        gentler=_gentler(plan, removed, most) if one_force(settings) else (0.0, 1.0),
        looks=looks / size if size > 0.1 else np.zeros(3),
        left=np.asarray(plan.after.field.points, dtype=float)[some],
        left_mm=float(np.sqrt(areas[left].sum() / max(len(some), 1))),
        left_share=float(areas[left].sum() / areas.sum()),
    )


def share(one: Json) -> float:
    """Of the area, in tolerance by a round's figures; surely, where that was asked for."""
    return float(one.get("expected_share", one["in_tolerance"]))


def _gentler(plan: rounds.Plan, removed: Floats, most: Floats) -> tuple[float, float]:
    """(of the area, that is in tolerance besides; with this share of the force): what is cut too deep is taken to be ground
    as fast as the robot can, the rest to be ground as slowly as it may."""
    field, alpha = plan.after.field, force_exponent(plan.after.job)
    lower, upper = verdicts.limits(plan.after.job, field)
    height, areas = (np.asarray(a, dtype=float) for a in (field.height, field.areas))
    begun = height + removed
    deep = np.where(height < lower, removed, 0.0)

    def within(factor: float) -> float:
        less = factor**alpha
        inside = (deep * less <= begun - lower) & (most * less >= begun - upper)
        return float(areas[inside].sum() / areas.sum())

    tried = np.geomspace(LEAST_FORCE, 1.0, FORCES)
    shares = np.array([within(one) for one in tried])
    best = int(np.flatnonzero(shares >= shares.max() - GAIN)[-1])  # less force takes longer
    return shares[best] - shares[-1], float(tried[best])


def _most(plan: rounds.Plan) -> Floats:
    """(samples,) mm that is removed at the least feed and the greatest force."""
    slowest, _ = plan.commands.feed_range
    _, strongest = plan.commands.force_range
    more = (plan.new / slowest) * (strongest / plan.factors)  # of each command, than it removes now
    more[plan.commands.kept] = 1.0
    return _removed(plan, more[plan.commands.group])


def _removed(plan: rounds.Plan, more: Floats | None = None) -> Floats:
    """(samples,) mm that the programs remove; or ``more`` times as much, (motions,)."""
    influence = known(plan.after.influence)
    depth = np.asarray(influence.depth, dtype=float)
    if more is not None:
        depth = depth * np.repeat(more, np.diff(influence.first).astype(int))
    sample, samples = influence.sample.astype(int), len(plan.after.field.height)
    return np.bincount(sample, depth, samples).astype(float)


def _repeats(plan: rounds.Plan, now: int, removed: Floats, most: Floats) -> tuple[float, int]:
    """(of the area, what is not done even at the least feed and the greatest force; how often the passes must be run through
    so that most of it is)."""
    field = plan.after.field
    lower, upper = verdicts.limits(plan.after.job, field)
    needed = np.asarray(field.height, dtype=float) + removed - upper
    areas = np.asarray(field.areas, dtype=float)
    left = (most > 0.0) & (most < needed) & (np.asarray(field.flags) & core.MISSED == 0)
    if not left.any():
        return 0.0, now
    wanted = (needed + 0.5 * (upper - lower))[left]
    ratios = np.sort(wanted / np.maximum(most[left], 1e-6))
    repeats = math.ceil(now * float(ratios[int(MOST_OF * (len(ratios) - 1))]))
    return float(areas[left].sum() / areas.sum()), max(now + 1, repeats)
