"""What a search has done in other processes, by one thread each, until a share of its budget ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..base.crew import End
from ..base.kinds import Json
from ..engine import core
from ..job import resolution
from . import rough, rounds
from .rough import ROUGHLY, Move, Roughly, Tried, Zones


def alone(function: Callable[..., Any], *arguments: Any) -> Any:
    """The function's answer, by one thread; called in a process of its own."""
    core.set_threads(1)
    return function(*arguments)


def begun(
    data: Json,
    until: End,
    move: Move,
    settings: Json,
    zones: Zones | None = None,
    how: Roughly = ROUGHLY,
) -> Tried:
    """As ``rough.gentled``; nothing further is tried after ``until``."""
    return rough.gentled(data, move, settings, zones, until.passed, how)


def soon(data: Json, until: End, *arguments: Any) -> Tried | None:
    """As ``begun``; None where ``until`` has passed before it begins."""
    return None if until.passed() else begun(data, until, *arguments)


def once(data: Json, until: End, *arguments: Any) -> Tried | None:
    """As ``rough.attempt``; None where ``until`` has passed before it begins."""
    return None if until.passed() else rough.attempt(data, *arguments)


def full(data: Json, until: End, tried: Tried, settings: Json, zones: Zones | None) -> Tried:
    """Passes that were tried with the feeds and forces of a full plan in the coarse resolution. No round begins after ``until``."""
    data = rough.with_machine(data, tried.machine, tried.wanted, settings)
    laid = rough.lay(data, tried.wanted, settings, core.RunContext(), zones, looked_at=False)
    settings = {**settings, "goal": "tolerance", "levels": 0, "check": False}
    job = resolution.applied(
        resolution.with_mode(rough.evenly(rough.with_path(data, laid)), resolution.COARSE), []
    )
    plan = rounds.plan(job, settings, start=tried.start, over=until.passed)
    share = max(rough.share(one) for one in plan.rounds)
    planned = tried._replace(change="full", in_tolerance=share, start=(plan.new, plan.factors))
    return planned._replace(shares=plan.why["shares"])
