"""From faces to a path and its feeds: passes are laid, their feeds planned, and where that is not enough others are tried:
by rules, from the reasons for what stays out of tolerance, or by a search for wheel, direction and belt angle, too."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

from ..base.kinds import Context, Json
from ..base.records import made
from ..engine import core
from ..job.settings import BeltMachine, Job
from ..job.typed import typed
from ..programs.force_device import of_job
from ..raster import raster_path
from . import by_rules, rough, rounds, search as searches
from .limits import GENTLER
from .rough import Tried, Zones

GENTLE = 0.2  # of the force: the least where none is given, so that borders and ends of passes can be spared
FINAL = 0.5  # of the time: the last plan
SEARCHED = 0.9  # of the time: the search
POLISHED = 2  # rounds, at least, of the plan that begins with the feeds of a search


class Ground(NamedTuple):
    """Passes and their plan."""

    settings: Json  # of the raster
    laid: dict[str, Any]  # as ``raster_path.raster`` gives it
    plan: rounds.Plan
    tried: list[dict[str, Any]]  # as ``Tried.row``
    search: dict[str, Any] | None = None  # as ``search.Found.report``, if there was one


def grind(
    job: Job | Json,
    raster_settings: Json | None = None,
    settings: Json | None = None,
    context: Context = None,
    told: Callable[[dict[str, Any]], object] | None = None,
    zones: Zones | None = None,
    search: searches.Search | None = None,
    stop: Callable[[], bool] | None = None,
) -> Ground:
    """Lays passes on the faces of a validated job, whose own programs do not matter, and plans their feeds, and forces
    if the machine has a force device: down to ``GENTLER`` of the job's where ``force_min_N`` is not given, never up unless
    ``force_max_N`` is. Without a device the force stays, unless one of the two is given. ``raster_settings``: where it begins; ``settings``: of the plan; ``told(dict)``: as
    ``tried``, then as rounds of the plan; ``zones(program)``: (poses,) mm, -1: the job's default, as the program's file will
    have them; without it those of the raster. ``search``: what is tried besides what the rules say, None: nothing; the plan's job
    has the wheel that was found; ``stop()``: whether the best that was found so far is enough.

    Returns a ``Ground``. Raises InputError, Cancelled.
    """
    context, begun = context or core.RunContext(), time.monotonic()
    planned = with_forces(typed(job), rounds.validate(settings or {}))
    data, settings = rounds.in_time(job, planned)
    first = raster_path.validate(raster_settings or {})
    if search is None:
        part = context.part(0.0, 1.0 - FINAL)
        move = ("first", data["belt_machine"], first)
        best, tried = by_rules.climb(data, move, settings, zones=zones, told=told, context=part)
        return _planned(data, best, settings, context.part(1.0 - FINAL, 1.0), told, zones, tried)
    data = rounds.settled(data, context)
    part = context.part(0.0, SEARCHED)
    found = searches.find(data, first, settings, search, zones, told, stop, part)
    rest, budget = context.part(SEARCHED, 1.0), search.budget_s
    in_time = settings["goal"] == "time"
    rounds_told = 0

    def heard(row: dict[str, Any]) -> None:
        nonlocal rounds_told
        rounds_told += 1
        if told is not None:
            told(row)

    def over() -> bool:
        """Whether it is polished: the budget is spent, or who asked wants no more."""
        late = time.monotonic() - begun > budget or (stop is not None and stop())
        return late and rounds_told >= POLISHED and not in_time

    ground = _planned(data, found.best, settings, rest, heard, zones, found.rows, over)
    return ground._replace(search=found.report())


def _planned(
    data: Json,
    best: Tried,
    settings: Json,
    context: core.RunContext,
    told: Callable[[dict[str, Any]], object] | None,
    zones: Zones | None,
    tried: list[dict[str, Any]],
    over: Callable[[], bool] | None = None,
) -> Ground:
    """The plan of passes that were tried, from their feeds on."""
    wanted, force = best.wanted, made(BeltMachine, best.machine).force_N
    if force != typed(data).belt_machine.force_N and not wanted["force_N"]:
        wanted = {**wanted, "force_N": force}  # so that its passes can be laid once more
    data = rough.with_machine(data, best.machine, wanted, settings)
    laid = rough.lay(data, wanted, settings, context.part(0.0, 0.1), zones)
    path = rough.with_path(data, laid)
    plan = rounds.plan(path, settings, context.part(0.1, 1.0), told, start=best.start, over=over)
    return Ground(wanted, laid, plan, tried)


def with_forces(job: Job, settings: Json) -> dict[str, Any]:
    """A plan's settings, validated, with the least force that they take where they give none."""
    settings = dict(settings)
    machine = job.belt_machine
    asked = (
        settings["force_max_N"] > 0.0 or of_job(job) is not None
    )  # without a device it is set once, by hand
    if machine.control == "force" and asked and settings["force_min_N"] == 0.0:
        least = GENTLER if settings["timing"] == "robot" else GENTLE
        settings = {**settings, "force_min_N": least * machine.force_N}
    return settings
