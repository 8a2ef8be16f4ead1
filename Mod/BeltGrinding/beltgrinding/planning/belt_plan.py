"""When to change the belt over a batch of equal parts, and how feed or force follow its wear until then.

A worn belt cuts k times as much as a fresh one (the job's law of wear). So that every part loses the same, it is ground
slower, or pressed harder, part by part; a second of that costs what the cell costs. A fresh belt costs its price and the time
of changing it. The cheapest sequence of belts for a number of parts is found by dynamic programming over the parts that
are left (Bellman, Dynamic Programming, 1957), which is exact: each belt begins as new.
"""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from ..base import records
from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Context, Json
from ..engine import InputError, core
from ..job import law as laws
from ..job import settings
from ..job.typed import typed
from ..simulation import run as runs
from . import belt_loading, rounds, step
from .belt_loading import Between, Stretch
from .commands import Commands

if TYPE_CHECKING:
    from ..job.settings import Wear
    from ..simulation.result import Result

FILES = ("belt_plan.json", "parts.csv", "belt_plan.png")
MOST_PARTS = 100_000
NEAR = 1e-6  # of the removal, that a part may lack at a limit
NEW = settings.Belt(work_J=0.0, removed_mm3=0.0, hours=0.0, loading=0.0)
LEAST_DRAWN, MOST_DRAWN = 20, 200  # wears, for the interval of a belt's life
DRAWN_PARTS = 40_000  # over all of them
MOST_OF_LIFE = 4  # lives that are counted
INNER = 8  # how often a part's own wear is looked at, for its mean cut
COLUMNS = (
    "part",
    "belt",
    "part_of_belt",
    "cut",
    "feed_factor",
    "force_factor",
    "seconds",
    "cost",
    "new_belt",
)

Belt: TypeAlias = dict[str, float]  # the engine's: work, volume, time, loading


class Part(NamedTuple):
    """What grinding one part with a fresh belt takes."""

    ground_s: float  # in motions whose feed may follow
    other_s: float  # all the rest
    work_J: float  # of the pressing force at belt speed
    removed_mm3: float
    power: float  # removal goes with the time to this power
    alpha: float  # and with the force to this one
    slowest: float  # least factor on the feeds
    hardest: float  # greatest factor on the forces
    stretches: tuple[Stretch, ...] = ()  # of contact; (): the belt does not load


class Costs(NamedTuple):
    """What a batch costs."""

    belt: float  # of one
    change_s: float  # cell's time for changing it
    minute: float  # of the cell


class BeltPlan(NamedTuple):
    """The cheapest batch."""

    rows: list[dict[str, Any]]  # dicts of COLUMNS
    cost: float
    seconds: float
    belts: int  # that are put on
    until_worn_out: float  # the same batch's cost with each belt used as long as it can
    life: int  # parts that a fresh belt can grind within the limits
    life_95: tuple[int, int] | None  # between which that lies with 95 %; None: the law does not say


def part_of(
    job: settings.Job | Json,
    feed_min: float,
    force_max: float,
    follow: str,
    context: Context = None,
) -> tuple[Part, Result]:
    """(``Part`` of a validated job, its Result with a fresh belt). ``feed_min`` mm/s; ``force_max`` N. Raises InputError
    (no wear to follow, limits that the job itself breaks), Cancelled."""
    job = typed(job)
    machine = job.belt_machine
    wear = laws.engine_wear(job.law)
    worn = wear.model != "none" or wear.loading_share > 0.0
    if not worn or job.law.model in ("geometric", "hammann"):
        raise InputError(
            "planning.no_wear",
            "belt plan: {key} is {value}; give the law a wear, from measured grinds (beltgrind calibrate) or by hand",
            key="law.wear.model",
            value=job.law.wear.model,
        )
    if follow != "feed" and machine.control != "force":
        raise InputError(
            "planning.no_force",
            "plan: {key}: forces are planned for machines under force control only",
            key="follow",
        )
    if step.feed_exponent(job) > rounds.STEEPEST and follow != "force":
        raise InputError(
            "planning.feed_decides_nothing",
            "plan: by the law, {key} {value:g}, a faster feed removes no less; nothing can be planned by feeds",
            key="law.feed_exponent",
            value=step.feed_exponent(job),
        )
    fresh = replace(machine, belt=NEW)
    job = replace(job, belt_machine=fresh)
    result = runs.run(job, context)
    commands = Commands(job, rounds.validate({"timing": "job"}))
    feeds = commands.feed()
    seconds = commands.seconds(feeds)
    moving = seconds > 0.0
    ground = float(seconds.sum())
    whole = result.summary["process_time_s"]
    least, greatest = float(feeds[moving].min()), float(commands.force(np.ones(len(feeds))).max())
    if feed_min > least or 0.0 < force_max < greatest:
        raise InputError(
            "planning.belt_limits",
            "belt plan: a fresh belt's own feed of {feed:.4g} mm/s or force of {force:.4g} N is beyond the limits",
            feed=least,
            force=greatest,
        )
    belt = result.summary["belt"]
    return (
        Part(
            min(ground, whole),
            max(whole - ground, 0.0),
            belt["work_J"],
            belt["removed_mm3"],
            1.0 - step.feed_exponent(job),
            step.force_exponent(job),
            feed_min / least if follow != "force" else 1.0,
            force_max / greatest if follow != "feed" and force_max > 0.0 else 1.0,
            belt_loading.stretches(job, result) if wear.loading_share > 0.0 else (),
        ),
        result,
    )


def plan(
    job: settings.Job | Json,
    part: Part,
    costs: Costs,
    parts: int,
    context: Context = None,
    between: Between = Between(),
) -> BeltPlan:
    """The ``BeltPlan`` of a batch of ``parts`` of a validated job, whose belt's use is that of the first belt. Raises
    InputError where not even a fresh belt does one part, Cancelled."""
    job = typed(job)
    context = context or core.RunContext()
    if not 1 <= parts <= MOST_PARTS:
        raise InputError(
            "planning.parts",
            "belt plan: {count} parts; give 1 to {most}",
            count=parts,
            most=MOST_PARTS,
        )
    if not all(math.isfinite(value) and value >= 0.0 for value in costs):
        raise InputError(
            "planning.costs", "belt plan: costs and times must be numbers, none below 0"
        )
    wear = laws.engine_wear(job.law)
    belt_loading.check(between, wear)
    fresh = _life(wear, part, NEW, costs, parts, between)
    first = _life(wear, part, job.belt_machine.belt, costs, parts, between)
    if not fresh:
        raise InputError(
            "planning.belt_too_short",
            "belt plan: within the limits not even a fresh belt does one part; lower the least feed, raise the "
            "greatest force, or take a belt that lasts longer",
        )
    changing = costs.belt + costs.minute * costs.change_s / 60.0
    lasts, whole = [row["cost"] for row in fresh], [row["cost"] for row in first]
    total = np.concatenate([[0.0], np.cumsum(lasts)])
    best, choice = np.zeros(parts + 1), np.zeros(parts + 1, dtype=int)
    for left in range(1, parts + 1):
        context.throw_if_cancelled()
        most = min(left, len(lasts))
        found = best[left - most : left][::-1] + total[1 : most + 1] + changing
        k = int(np.argmin(found))
        best[left], choice[left] = found[k], k + 1
    # The belt that is on the machine goes on for as long as that is cheapest.
    begun = np.concatenate([[0.0], np.cumsum(whole)])
    ways = begun[: parts + 1] + best[parts - np.arange(min(len(whole), parts) + 1)]
    kept = int(np.argmin(ways))
    rows = _rows([], first[:kept], new_belt=False)
    left = parts - kept
    while left:
        count = int(choice[left])
        rows = _rows(rows, fresh[:count], new_belt=True)
        left -= count
    put_on = sum(row["new_belt"] for row in rows)
    spent = sum(row["seconds"] for row in rows) + put_on * costs.change_s
    return BeltPlan(
        rows,
        float(ways[kept]),
        float(spent),
        put_on,
        _until_worn_out(lasts, whole, changing, parts),
        len(fresh),
        _life_95(job, part, costs, min(parts, MOST_OF_LIFE * len(fresh)), len(fresh), between),
    )


def _life_95(
    job: settings.Job, part: Part, costs: Costs, parts: int, life: int, between: Between
) -> tuple[int, int] | None:
    """Between how many parts a fresh belt's life, ``life``, lies with 95 %, none counted beyond ``parts``, by the law's
    doubt of its wear."""
    wears = laws.drawn_wears(job.law, min(max(DRAWN_PARTS // life, LEAST_DRAWN), MOST_DRAWN))
    if not wears:
        return None
    lives = [len(_life(wear, part, NEW, costs, parts, between)) for wear in wears]
    low, high = np.quantile(lives, (0.025, 0.975), method="nearest")
    return int(low), int(high)


def _until_worn_out(lasts: list[float], whole: list[float], changing: float, parts: int) -> float:
    cost, left, on = 0.0, parts, whole
    while left:
        count = min(left, len(on))
        cost += sum(on[:count])
        left -= count
        if left:
            cost, on = cost + changing, lasts
    return cost


def _rows(
    rows: list[dict[str, Any]], parts: list[dict[str, Any]], new_belt: bool
) -> list[dict[str, Any]]:
    """``rows`` with those of the parts of the next belt."""
    belt = rows[-1]["belt"] + 1 if rows else 1
    begun = len(rows)
    return rows + [
        {
            "part": begun + k + 1,
            "belt": belt,
            "part_of_belt": k + 1,
            **row,
            "new_belt": new_belt and k == 0,
        }
        for k, row in enumerate(parts)
    ]


def _life(
    wear: Wear,
    part: Part,
    belt: settings.Belt,
    costs: Costs,
    parts: int,
    between: Between = Between(),
) -> list[dict[str, Any]]:
    """Dicts of the parts that a belt grinds one after the other, as long as the limits let it."""
    state, rows = laws.engine_belt(records.plain(belt)), []
    nothing = {key: 0.0 for key in state}
    # What the job was simulated with: a fresh belt that wears over the part itself.
    usual = core.belt_remaining(wear, _used(wear, nothing, part, 1.0, 1.0, 0.5))
    for number in range(parts):
        dressed = False
        if number:
            loading, dressed = belt_loading.rested(wear, between, state["loading"], number)
            state = {**state, "loading": loading}
        found = _one(wear, part, state, usual)
        if found is None:
            break
        feed, force, cut, state = found
        curve = wear.curve if wear.model == "curve" else ()
        used = state["volume" if wear.variable == "volume" else "work"]
        seconds = part.other_s + part.ground_s / feed + (between.dress_s if dressed else 0.0)
        rows.append(
            {
                "cut": cut,
                "feed_factor": feed,
                "force_factor": force,
                "seconds": seconds,
                "cost": costs.minute * seconds / 60.0,
                "beyond_measured": bool(len(curve) and used > curve[-1][0]),
            }
        )
    return rows


def _one(
    wear: Wear, part: Part, state: Belt, usual: float
) -> tuple[float, float, float, Belt] | None:
    """(factor on feeds, factor on forces, mean cut, the belt's state after it) of one part; None beyond the limits.
    ``usual``: the mean cut that the factors are against."""
    cut = core.belt_remaining(wear, _used(wear, state, part, 1.0, 1.0, 0.0))
    for _ in range(INNER):  # the belt wears over the part itself: the cut in its middle counts
        if not min(cut, usual) > 0.0:
            return None
        share = cut / usual
        force = min(share ** (-1.0 / part.alpha), part.hardest) if part.hardest > 1.0 else 1.0
        left = share * force**part.alpha
        feed = left ** (1.0 / part.power) if part.slowest < 1.0 else 1.0
        if feed < part.slowest - NEAR or (feed == 1.0 and left < 1.0 - NEAR):
            return None
        cut = core.belt_remaining(wear, _used(wear, state, part, feed, force, 0.5))
    return feed, force, cut, _used(wear, state, part, feed, force, 1.0)


def _used(wear: Wear, state: Belt, part: Part, feed: float, force: float, share: float) -> Belt:
    """The engine's belt after a share of a part; with its mean loading over the part until all is done."""
    work, loading = part.work_J * force / feed, state["loading"]
    if part.stretches:
        use = work if wear.variable == "work" else part.removed_mm3
        mean, after = belt_loading.over(wear, part.stretches, loading, use, feed)
        loading = mean if share < 1.0 else after
    return {
        "work": state["work"] + share * work,
        "volume": state["volume"] + share * part.removed_mm3,
        "time": state["time"] + share * part.ground_s / feed,
        "loading": loading,
    }


def summary(found: BeltPlan, costs: Costs) -> dict[str, Any]:
    """The figures of a ``BeltPlan``, as JSON has them."""
    counts = np.bincount([row["belt"] for row in found.rows])[1:]
    return {
        "parts": len(found.rows),
        "cost": found.cost,
        "cost_per_part": found.cost / len(found.rows),
        "seconds": found.seconds,
        "new_belts": found.belts,
        "parts_per_belt": counts.tolist(),
        "life_parts": found.life,
        **({"life_parts_95": list(found.life_95)} if found.life_95 else {}),
        "parts_beyond_measured_wear": sum(row["beyond_measured"] for row in found.rows),
        "cost_until_worn_out": found.until_worn_out,
        "costs": costs._asdict(),
    }


def write(
    found: BeltPlan,
    costs: Costs,
    folder: Path | str,
    words: Mapping[str, str] | None = None,
    replace: bool = True,
) -> None:
    """Writes ``FILES`` into a folder: figures, a line a part, chart; ``replace``: files that are there already. Raises
    InputError."""
    from . import belt_chart  # pictures are drawn only for files

    folder = Path(folder)
    there = [name for name in FILES if (folder / name).exists()]
    if there and not replace:
        raise InputError(
            "planning.belts_there",
            "{file}: is there already; choose another folder",
            file=folder / there[0],
        )
    contents = (
        (json.dumps(summary(found, costs), indent=1, allow_nan=False) + "\n").encode(),
        table(found).encode(),
        belt_chart.draw(found, words),
    )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in zip(FILES, contents):
            write_whole(folder / name, content)
    except OSError as error:
        raise cannot_be_written(folder, error) from None


def table(found: BeltPlan) -> str:
    """A CSV of the batch, a line a part."""
    file = io.StringIO()
    rows = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
    rows.writeheader()
    for row in found.rows:
        rows.writerow(
            {
                k: f"{v:.6g}" if isinstance(v, float) else int(v)
                for k, v in row.items()
                if k in COLUMNS
            }
        )
    return file.getvalue()
