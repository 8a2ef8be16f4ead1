"""What couples neighbouring commands: how fast feed and force may change along the path; and pressure and heat.

The profile that misses a wanted one least, by least squares weighted with how much each command removes, is found by
coordinate ascent on the multipliers of the limits (Hildreth, Naval Research Logistics Quarterly 4, 1957). What is
left over is exact: no value is more than its neighbours allow, by sweeps along the path as time-optimal motion
profiles are found (Bobrow, Dubowsky and Gibson, Int. J. Robotics Research 4, 1985).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ..base.kinds import Array, Floats, Json, known
from ..engine import InputError
from ..job.robot_time import rounded_feeds
from ..job.settings import Job
from ..job.typed import typed
from ..programs.force_device import of_job

if TYPE_CHECKING:
    from ..simulation.result import Result
    from .commands import Commands

LIGHT = 1e-4  # of the greatest weight: of motions that remove next to nothing
ITERATIONS, LINEARISED = 2000, 50
SETTLED = 1e-4  # mm/s, N
SWEEPS = 100  # a path that comes back to a line needs a few
AT, EXACT = 1e-3, 1e-6  # relative, of a limit
GENTLER = 0.05  # of the force, in the robot's time, which is slow at ends and turns
BELOW = 1.0 - 1e-3  # of the limit of pressure, to which what is above it is brought
YIELDING = 0.5  # least exponent with which pressure follows a lowered force: that of a line contact

# Two commands each (pairs,), and a number of both (pairs,).
Edges: TypeAlias = "tuple[Array, Array, Floats]"
Allowed: TypeAlias = Callable[[float, float], float]  # of a value and mm: the neighbour's


def within_device(job: Job, settings: dict[str, Any]) -> dict[str, Any]:
    """The settings of a plan within what the job's force device sets: its range, and its ramp, which is also the
    default; in the robot's time forces may be lowered then to ``GENTLER`` of the job's, unless the settings say what they
    may. Raises InputError where nothing is left."""
    device = of_job(job)
    if device is None:
        return settings
    least, greatest = settings["force_min_N"], settings["force_max_N"]
    machine = job.belt_machine
    if not least and not greatest and settings["timing"] == "robot" and machine.control == "force":
        least = min(GENTLER * machine.force_N, device.greatest_N or math.inf)
    most = device.greatest_N or math.inf
    if (least and least > most) or 0.0 < greatest < device.least_N:
        raise InputError(
            "planning.device_range",
            "plan: forces of {least:g} to {greatest:g} N are beyond the force device's, {low:g} to {high:g} N: change "
            "force_min_N and force_max_N, or belt_machine.force_device",
            least=least,
            greatest=greatest or most,
            low=device.least_N,
            high=most,
        )
    ramp = device.ramp_N_s or math.inf
    changed = {
        "force_min_N": max(least, device.least_N) if least else least,
        "force_max_N": min(greatest, most) if greatest else greatest,
        "force_change_N_s": min(settings["force_change_N_s"] or ramp, ramp),
    }
    if math.isinf(changed["force_change_N_s"]):
        changed["force_change_N_s"] = 0.0
    return {**settings, **changed}


def refuse(settings: Json) -> None:
    """Raises InputError for limits that contradict each other."""
    if settings["levels"] and (settings["feed_change_mm_s_mm"] or settings["acceleration_mm_s2"]):
        raise InputError(
            "planning.levels_and_change",
            "plan: {key}: few feeds jump from one to the next; either ask for few, or limit {other}",
            key="levels",
            other="feed_change_mm_s_mm"
            if settings["feed_change_mm_s_mm"]
            else "acceleration_mm_s2",
        )


def feeds(commands: Commands, wanted: Floats, weight: Floats, settings: Json) -> Floats:
    """(commands,) mm/s: the wanted feeds, changed where they would change too fast from motion to motion. Between
    motions that must not be changed nothing is. ``weight`` (commands,): what a relative error of each costs.
    """
    per_mm, acceleration = settings["feed_change_mm_s_mm"], settings["acceleration_mm_s2"]
    if not per_mm and not acceleration:
        return (
            wanted
            if commands.limits is None
            else np.where(commands.kept, wanted, rounded_feeds(wanted))
        )
    first, second, way = commands.neighbours()

    def step(values: Floats) -> Floats | float:
        by_way = per_mm * way if per_mm else np.inf
        if acceleration:
            by_way = np.minimum(by_way, 2.0 * acceleration * way / (values[first] + values[second]))
        return by_way

    def up(value: float, d: float) -> float:
        by_way = value + per_mm * d if per_mm else np.inf
        return (
            min(by_way, (value * value + 2.0 * acceleration * d) ** 0.5) if acceleration else by_way
        )

    def down(value: float, d: float) -> float:
        by_way = value - per_mm * d if per_mm else 0.0
        return (
            max(by_way, max(value * value - 2.0 * acceleration * d, 0.0) ** 0.5)
            if acceleration
            else by_way
        )

    near = _nearest(wanted, weight, commands.kept, first, second, step)
    # What nothing is planned for, as positioning, may be outside of the limits as it is.
    least, greatest = commands.feed_range
    near = np.clip(near, np.minimum(least, wanted), np.maximum(greatest, wanted))
    if commands.limits is not None:
        return _exact(
            commands,
            np.where(commands.kept, wanted, rounded_feeds(near)),
            (first, second, way),
            lambda value, d: float(rounded_feeds(np.array([up(value, d)]))[0]),
            down,
        )
    return _exact(commands, np.where(commands.kept, wanted, near), (first, second, way), up, down)


def factors(
    commands: Commands, wanted: Floats, weight: Floats, feeds: Floats, settings: Json
) -> Floats:
    """(commands,) the wanted factors on forces, changed where forces would change too fast. A step that the program has
    itself stays as great as it is at most. ``weight``: as for ``feeds``."""
    own = commands.force(np.ones(len(commands)))
    if not settings["force_change_N_s"] or not own.any():
        return wanted
    first, second, step = _force_steps(commands, own, feeds, settings)
    near = _nearest(own * wanted, weight, commands.kept, first, second, lambda _: step)
    near = np.clip(near, *(factor * own for factor in commands.force_range))
    return _forces_within(commands, own, near, wanted, (first, second, step))


def _force_steps(commands: Commands, own: Floats, feeds: Floats, settings: Json) -> Edges:
    """(first, second (pairs,) commands, N (pairs,) by which their forces may differ)."""
    first, second, _ = commands.neighbours()
    seconds = commands.motion_seconds(feeds)
    step = 0.5 * settings["force_change_N_s"] * (seconds[first] + seconds[second])
    return first, second, np.maximum(step, abs(own[first] - own[second]))


def _forces_within(
    commands: Commands, own: Floats, near: Floats, wanted: Floats, edges: Edges
) -> Floats:
    """(commands,) factors: the forces ``near``, the greater of two that are too far apart lowered."""
    given = _exact(commands, near, edges, lambda v, d: v + d, lambda v, d: v - d)
    least = commands.force_range[0] * own
    return np.where(own > 0.0, np.maximum(given, least) / np.maximum(own, 1e-300), wanted)


def bound(commands: Commands, feeds: Floats, factors: Floats, settings: Json) -> Array:
    """(commands,) bool: the feed or the force could not differ more from a neighbour's."""
    first, second, used = _used(commands, feeds, factors, settings)
    at, found = used >= 1.0 - AT, np.zeros(len(commands), dtype=bool)
    found[first[at]] = found[second[at]] = True
    return found & ~commands.kept


def beyond(commands: Commands, feeds: Floats, factors: Floats, settings: Json) -> int:
    """Number of places where feed or force change faster than they may: those of a program that breaks the limits
    itself, or of motions that must not be changed."""
    return int((_used(commands, feeds, factors, settings)[2] > 1.0 + EXACT).sum())


def _used(commands: Commands, feeds: Floats, factors: Floats, settings: Json) -> Edges:
    """(first, second (pairs,) commands, share (pairs,) of the limits that the change between them uses)."""
    first, second, length = commands.neighbours()
    one, other, length = feeds[first], feeds[second], np.maximum(length, 1e-12)
    used = np.zeros(len(length))
    if settings["feed_change_mm_s_mm"]:
        used = np.maximum(used, abs(one - other) / (settings["feed_change_mm_s_mm"] * length))
    if settings["acceleration_mm_s2"]:
        used = np.maximum(
            used, abs(one**2 - other**2) / (2.0 * settings["acceleration_mm_s2"] * length)
        )
    if settings["force_change_N_s"]:
        force, seconds = commands.force(factors), commands.motion_seconds(feeds)
        step = 0.5 * settings["force_change_N_s"] * (seconds[first] + seconds[second])
        used = np.maximum(used, abs(force[first] - force[second]) / np.maximum(step, 1e-12))
    return first, second, used


def _nearest(
    wanted: Floats,
    weight: Floats,
    kept: Array,
    first: Array,
    second: Array,
    step: Callable[[Floats], Floats | float],
) -> Floats:
    """The profile nearest to a wanted one, nearly within the limits: of each pair's values, no further apart than
    ``step(values)`` (pairs,)."""
    free = ~(kept[first] & kept[second])
    first, second = first[free], second[free]
    weight = np.maximum(weight, LIGHT * max(weight.max(), 1e-300)) / np.maximum(wanted, 1e-9) ** 2
    give = np.where(kept, 0.0, 1.0 / weight)
    together = np.maximum(give[first] + give[second], 1e-300)
    values, pull = wanted.astype(float), np.zeros(len(first))
    colours = _colours(first, second)
    for k in range(ITERATIONS):
        if k % LINEARISED == 0:
            allowed = np.broadcast_to(step(np.maximum(values, 1e-6)), len(free))[free]
        worst = 0.0
        for mine in colours:
            a, b, room = first[mine], second[mine], together[mine]
            apart = values[a] - values[b] + pull[mine] * room
            new = np.sign(apart) * np.maximum(abs(apart) - allowed[mine], 0.0) / room
            change = new - pull[mine]
            pull[mine] = new
            values[a] -= change * give[a]
            values[b] += change * give[b]
            worst = max(worst, float(np.max(abs(change) * room, initial=0.0)))
        if worst < SETTLED and k % LINEARISED:
            break
    return np.maximum(values, 1e-6)


def _colours(first: Array, second: Array) -> list[Array]:
    """Lists of pairs of which no two of a list share a command."""
    taken: dict[int, set[int]] = {}
    lists: list[list[int]] = []
    for k, (a, b) in enumerate(zip(first.tolist(), second.tolist())):
        used = taken.setdefault(a, set()), taken.setdefault(b, set())
        colour = next(c for c in range(len(lists) + 1) if c not in used[0] and c not in used[1])
        if colour == len(lists):
            lists.append([])
        lists[colour].append(k)
        for one in used:
            one.add(colour)
    return [np.array(one) for one in lists]


def _exact(commands: Commands, near: Floats, edges: Edges, up: Allowed, down: Allowed) -> Floats:
    """The largest profile (commands,) below a near one of which no value is above ``up(value, d)`` or below
    ``down(value, d)`` of a neighbour's; those of commands that are kept stay, and what is beside them yields.
    """
    pairs = list(zip(*(one.tolist() for one in edges)))
    kept = commands.kept
    floor = _sweep(np.where(kept, near, -np.inf), pairs, down, max)
    ceiling = _sweep(np.where(kept, near, np.inf), pairs, up, min)
    below = np.clip(near, floor, np.maximum(ceiling, floor))
    found = np.maximum(_sweep(below, pairs, up, min), floor)
    return np.where(kept, near, found)


def _sweep(
    values: Floats,
    edges: list[tuple[int, int, float]],
    allowed: Allowed,
    nearest: Callable[[float, float], float],
) -> Floats:
    found = values.tolist()
    for _ in range(SWEEPS):
        changed = False
        for order in (edges, reversed(edges)):
            for a, b, d in order:
                for one, other in ((a, b), (b, a)):
                    if abs(found[one]) == np.inf:
                        continue
                    value = nearest(found[other], allowed(found[one], d))
                    if value != found[other]:
                        found[other], changed = value, True
        if not changed:
            break
    return np.array(found)


def peaks(result: Result, commands: Commands) -> Floats:
    """(commands,) MPa: the greatest pressure of each command's motions."""
    steps = known(result.steps)
    begin = np.cumsum([0] + [len(one["feeds"]) for one in commands.arrays])
    motions = begin[np.asarray(steps["program"], dtype=int)] + np.asarray(steps["pose"], dtype=int)
    found = np.zeros(len(commands))
    np.maximum.at(found, commands.group[motions], np.asarray(steps["peak_pressure"], dtype=float))
    return found


def greatest_pressure(job: Job | Json, settings: Json) -> float:
    """MPa, by the settings or else the law; inf: no limit of pressure, nor of pressure times belt speed, or no force may
    change."""
    job = typed(job)
    if not settings["force_min_N"] and not settings["force_max_N"]:
        return np.inf
    law, speed = job.law, job.belt_machine.belt_speed_m_s
    most = settings["pressure_max_MPa"] or law.pressure_limit_MPa or np.inf
    heat = settings["heat_max_MPa_m_s"] or law.heat_limit_MPa_m_s
    return min(most, heat / speed) if heat and speed > 0.0 else most


def greatest_factors(result: Result, commands: Commands, factors: Floats, settings: Json) -> Floats:
    """(commands,) up to which the factors on forces keep the limit of pressure: a raised force raises the pressure no more
    than in proportion, a lowered one lowers it with its square root at least."""
    most = greatest_pressure(result.job, settings)
    if most == np.inf:
        return np.full(len(commands), np.inf)
    room = most / np.maximum(peaks(result, commands), 1e-9)
    return factors * np.where(room < 1.0, room ** (1.0 / YIELDING), room)


def below_pressure(
    result: Result, commands: Commands, feeds: Floats, factors: Floats, settings: Json
) -> Floats:
    """(commands,) factors on forces, lowered where a simulation found a pressure above the limit, and beside that as far
    as the limit on their change asks."""
    room = greatest_pressure(result.job, settings) / np.maximum(peaks(result, commands), 1e-9)
    over = (room < 1.0) & ~commands.kept
    force = np.where(over, factors * (BELOW * room) ** (1.0 / YIELDING), factors)
    force = np.maximum(force, np.minimum(commands.force_range[0], factors))
    own = commands.force(np.ones(len(commands)))
    if not settings["force_change_N_s"] or not own.any():
        return force
    edges = _force_steps(commands, own, feeds, settings)
    return _forces_within(commands, own, own * force, force, edges)


def figures(result: Result, settings: Json) -> dict[str, float]:
    """``peak_pressure_MPa``, and by which share it is ``over_limit``; empty where nothing limits it."""
    most = greatest_pressure(result.job, settings)
    if most == np.inf:
        return {}
    peak = float(np.max(known(result.steps)["peak_pressure"], initial=0.0))
    return {"peak_pressure_MPa": peak, "over_limit": max(0.0, peak / most - 1.0)}
