"""What is tried next, from the reasons for what rough plans leave out of tolerance.

It is a search by hand's rules, no proof that nothing is better.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..base.kinds import Json, known
from ..base.records import made
from ..engine import InputError, core
from ..job.settings import BeltMachine
from .queue import Queue
from .rough import GAIN, MATTERS, Move, Tried, Zones, attempt, less_force

TRIES = 7  # passes, at most
CLOSER = 0.7  # step-over against the one before
CLOSEST = 0.2  # of the contact's width
FEW = 4  # passes beside each other, of which one less may be enough
FEWER = 1.001  # of the step-over that they need then
MOST_POSES = 20_000
SMOOTHER = 2.0  # times the length over which the wheel turns, where the robot is slow to turn it and cuts too deep
MOST_SMOOTHING = 4.0  # of the contact's length
MOST_REPEATS = 20
BORDER_FORCE = 0.15  # of the force, at borders


def climb(
    data: Json,
    first: Move,
    settings: Json,
    zones: Zones | None = None,
    told: Callable[[dict[str, Any]], object] | None = None,
    context: core.RunContext | None = None,
) -> tuple[Tried, list[dict[str, Any]]]:
    """Climb from passes to better ones. Returns (the best; a row of figures for each that was tried).

    At most ``TRIES`` are tried: ``first``, and from the best on what may mend it, the likeliest first. Raises InputError where
    ``first`` cannot be laid, Cancelled.
    """
    context = context or core.RunContext()
    best: Tried | None = None
    rows: list[dict[str, Any]] = []
    seen = set[str]()
    queue, moves = Queue([others], seen), [first]
    while moves and len(rows) < TRIES:
        part = context.part(len(rows) / TRIES, (len(rows) + 1) / TRIES)
        try:
            one = attempt(data, moves[0], settings, zones, part)
        except InputError:
            if best is None:
                raise
            moves = queue.take(1)  # no such passes on these faces
            continue
        better = best is None or one.in_tolerance > best.in_tolerance + GAIN
        rows.append(one.row(better))
        if told is not None:
            told(rows[-1])
        if better:
            best, queue = one, Queue([others], seen)
            queue.add(one)
        moves = queue.take(1)
    return known(best), rows


def others(one: Tried) -> list[tuple[float, Move]]:
    """[(of the area, that it may mend, Move)]: passes that may mend what is out of tolerance."""
    wanted, shares = one.wanted, one.shares
    found: list[tuple[float, Move]] = []

    def add(share: float, name: str, **changed: Any) -> None:
        found.append((share, (name, one.machine, {**wanted, **changed})))

    if one.undone > MATTERS:
        repeats = min(one.repeats, MOST_REPEATS)
        most = MOST_POSES * max(wanted["repeats"], 1)
        if repeats > wanted["repeats"] and one.poses * repeats <= most:
            add(one.undone, "repeats", repeats=repeats)
    between = shares["shared"] + shares["fringe"] + shares["border"]
    closer = CLOSER * one.step_over_mm
    if between > MATTERS and one.poses / CLOSER <= MOST_POSES:
        if one.width_mm is None or closer >= CLOSEST * one.width_mm:
            add(shares["shared"] + shares["fringe"], "step_over", step_over_mm=closer)
    if between > MATTERS and 1 < one.levels <= FEW:
        # A wide wheel leaves marks beside its sides: one pass less has fewer.
        wider = FEWER * one.step_over_mm * one.levels / (one.levels - 1)
        add(between, "step_over", step_over_mm=wider)
    if shares["border"] > MATTERS:
        for run_out in (0.25 * one.length_mm, -0.25 * one.length_mm):
            farther = round(wanted["run_out_mm"] + run_out, 3)
            add(0.9 * shares["border"], "run_out", run_out_mm=farther)
        if _spares_borders(one) and one.poses / CLOSER <= MOST_POSES:
            # The contact is narrower there, too.
            gentle = {"border_force_share": BORDER_FORCE, "step_over_mm": closer}
            add(shares["border"] + shares["shared"] + shares["fringe"], "border_force", **gentle)
    gentler = less_force(one)
    if gentler is not None:
        # As likely as all that is cut too deep: it is the one thing that helps where the robot is slow everywhere.
        found.append((max(gentler[0], one.below), gentler[1]))
    if one.below > MATTERS and wanted["smoothing_mm"] < MOST_SMOOTHING * one.length_mm:
        smoother = max(SMOOTHER * wanted["smoothing_mm"], one.length_mm)
        add(one.below, "smoothing", smoothing_mm=round(smoother, 3))
    return found


def _spares_borders(one: Tried) -> bool:
    """Whether less force at borders is still to be tried: the program sets forces, and they grow along the passes."""
    if one.wanted["border_force_share"] or one.wanted["entry"] == "direct":
        return False
    machine = made(BeltMachine, one.machine)
    return machine.control == "force" and machine.force_device.kind != "none"
