"""The search for wheel, direction of the passes and belt angle: first by what the geometry says, then by a glance at what seems to
reach enough, then by rough plans of the best, then by rules from all of those, the most promising first, then with further groups of
passes where the best leave too much, then by full plans of the best three.

Candidates run side by side, on processes of one thread each. What is found depends on how many were tried, never on how many
processes did it, nor on which was ready first.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..base.crew import Answer, Call, Crew, End
from ..base.kinds import Context, Json, known
from ..engine import InputError, core
from ..job.typed import typed
from ..raster import reach_map
from . import by_rules, rough, tasks
from .candidates import Seen, candidates, further_groups, of_further
from .moves import Moves
from .queue import Queue
from .rough import Move, Tried, Zones

BUDGET_S = 120.0
UNTIL_IT_PAYS = float("inf")  # s: as long as a generation of rough plans brings GAIN
OWN_ANGLES, OTHER_ANGLES = (0.0, 90.0, 45.0, 135.0), (0.0, 90.0)  # degrees, of the belt
LEADERS = 4  # of a glance, that are planned in a generation
FINALS = 3  # full plans
FAR_BEHIND = 0.1  # of the area: passes so far behind get no full plan
GAIN = 0.005  # of the area
ENOUGH = 0.995  # of the area: nothing else is tried
# Of the budget.
GLANCES_UNTIL, COARSE_UNTIL, RULES_UNTIL, GROUPS_UNTIL, FULL_UNTIL = 0.2, 0.35, 0.55, 0.7, 0.9
TO_END = 0.1  # of the budget, in which what is being tried then may end
WIDE = 4  # passes that rules try at a time, whatever the number of processes
PATIENCE = 20  # passes that rules try without finding better ones
LAST = 2.0  # times what full plans took: what they and the last rounds take once more
GROUPS, OF_A_GROUP = 3, 4  # further groups of passes; ways and belt angles that are tried for each
FURTHER = 4  # wheels of which is planned what they would bring
PROCESS_BYTES, SAMPLE_BYTES = 4e8, 3_000.0  # of a process, and for each sample

Told = Callable[[dict[str, Any]], object]


class Search(NamedTuple):
    """What may be tried."""

    budget_s: float = BUDGET_S
    wheels: tuple[
        Json, ...
    ] = ()  # belt machines of the job, which may be taken in place of its own
    further: tuple[Json, ...] = ()  # only their gain is reported
    fixed: tuple[str, ...] = ()  # settings of the raster that stay as they are
    workers: int = 0  # processes at most; 0: one a core


class Found(NamedTuple):
    """What a search found."""

    best: Tried  # with the start of its full plan
    rows: list[dict[str, Any]]  # as ``Tried.row``, of all that was tried
    geometry: list[dict[str, Any]]  # wheel, along, direction, belt_angle_deg, reachable, upright
    wheels: list[
        dict[str, Any]
    ]  # what further wheels would bring: wheel, reachable, in_tolerance and gain (None: not planned)
    reachable: float  # of the area, by the job's own wheel with its belt in any direction
    reachable_by_any: float  # by any of the wheels
    seconds: float
    through: bool  # all was tried that was to be

    def report(self) -> dict[str, Any]:
        """As JSON has it."""
        kept = ("geometry", "wheels", "reachable", "reachable_by_any", "seconds", "through")
        return {"tried": self.rows, **{name: getattr(self, name) for name in kept}}


def find(
    data: Json,
    first: Json,
    settings: Json,
    search: Search,
    zones: Zones | None = None,
    told: Told | None = None,
    stop: Callable[[], bool] | None = None,
    context: Context = None,
) -> Found:
    """Searches for a job, validated and in its time. ``first``: validated settings of the raster; the rules begin with them in any
    case, and go on as long as the budget lets them; ``settings``: of the plan, validated; ``told(row)``: as ``Tried.row``;
    ``zones``: must be picklable; ``stop()``: whether the best so far is enough. Raises InputError, Cancelled.
    """
    run = _Run(data, first, settings, search, zones, told, stop, context or core.RunContext())
    with Crew(
        search.workers, _bytes(data, first)
    ) as run.crew, tempfile.TemporaryDirectory() as folder:
        run.going = Path(folder, "going")
        run.going.touch()
        return run.found()


def _bytes(data: Json, first: Json) -> float:
    """What a process needs, about."""
    spacing = typed(data).sampling.spacing_mm
    if not spacing:
        return PROCESS_BYTES
    return PROCESS_BYTES + SAMPLE_BYTES * reach_map.area_of(data, first) / spacing**2


class _Run:
    crew: Crew
    going: Path  # a file that is there until who asked wants no more
    reachable: float  # of the area, by any of the wheels that may be taken

    def __init__(
        self,
        data: Json,
        first: Json,
        settings: Json,
        search: Search,
        zones: Zones | None,
        told: Told | None,
        stop: Callable[[], bool] | None,
        context: core.RunContext,
    ) -> None:
        self.data, self.first, self.settings = data, first, settings
        self.search, self.zones, self.told, self.stop = search, zones, told, stop
        self.context, self.begun = context, time.monotonic()
        self.rows: list[dict[str, Any]] = []  # in the order of the calls
        self.shown = 0.0  # the best share that was told
        self.through = True
        self.lap, self.seen = 0, set[str]()  # of rules; what they have tried
        self.planned: list[Tried] = []  # in full

    def found(self) -> Found:
        own, others, further = self._looked()
        self.reachable = max(one.most for one in (own, *others))
        start: Move = ("first", self.data["belt_machine"], self.first)
        default, coarse = self._coarse(start, candidates(own, others, start, self.search.fixed))
        mine = [one for one in coarse if one.machine["wheel"] == own.machine["wheel"]]
        wheels = self._brought(further, own, mine)
        tried = self._ruled(default, coarse, RULES_UNTIL + TO_END)
        tried = self._grouped(tried)
        begun = self._spent()
        best = self._finals(default, tried)
        # What is left of the budget, but for as much once more, and the last rounds.
        until = 1.0 - LAST * (self._spent() - begun)
        while self.search.budget_s < UNTIL_IT_PAYS and not self._over(until - TO_END):
            before, self.lap = _most(tried), self.lap + 1
            tried = self._ruled(default, tried, until)
            if not _most(tried) > before:
                break
            again = self._finals(default, tried)
            best = max(best, again, key=lambda one: one.in_tolerance)
        fits = [one.map.fits for one in (own, *others, *further)]
        return Found(
            best=best,
            rows=self.rows,
            geometry=[_geometry(one, reach) for one in (own, *others) for reach in one.map.found],
            wheels=wheels,
            reachable=max(float(own.map.fits.mean()), own.most),
            reachable_by_any=max(
                float(np.logical_or.reduce(fits).mean()),
                *(one.most for one in (own, *others, *further)),
            ),
            seconds=time.monotonic() - self.begun,
            through=self.through,
        )

    def _call(self, function: Callable[..., Any], *arguments: Any) -> Call:
        return Call(tasks.alone, (function, self.data, *arguments))

    def _until(self, share: float) -> End:
        """When that share of the budget is spent, or who asked wants no more."""
        return End(self.begun + share * self.search.budget_s, str(self.going))

    def _part(self, begins: float, ends: float) -> tuple[float, float]:
        """Of the progress: each lap takes half of what is left."""
        if not self.lap:
            return begins, ends
        left = 0.1 * 0.5 ** (self.lap - 1)
        return 1.0 - left * (1.0 - 0.5 * begins), 1.0 - left * (1.0 - 0.5 * ends)

    def _spent(self) -> float:
        """Of the budget."""
        return (time.monotonic() - self.begun) / max(self.search.budget_s, 1e-9)

    def _over(self, share: float) -> bool:
        """Whether that share of the budget is spent, or who asked wants no more."""
        if self.stop is not None and self.stop():
            self.going.unlink(missing_ok=True)  # processes look at it
        return self._until(share).passed()

    def _run(
        self,
        calls: Sequence[Call],
        until: float,
        part: tuple[float, float],
        needed: int = 0,
        told: bool = True,
    ) -> list[Any]:
        """Values of the calls, None of those that failed or were not done until that share of the budget; the first ``needed`` are done in
        any case. ``told``: the others are shown and kept as rows as well."""
        left, enough = set(range(needed)), False

        def taken(number: int, answer: Answer) -> None:
            nonlocal enough
            left.discard(number)
            rows = _rows(answer.value)
            enough |= number < needed and any(row["in_tolerance"] >= ENOUGH for row in rows)
            for row in rows if told or number < needed else ():
                self._show(row)

        answers = self.crew.run(
            calls,
            taken,
            lambda: (enough or self._over(until)) and not left,
            self.context.part(*part),
        )
        if enough:  # what else was done until then is chance
            answers = [*answers[:needed], *([None] * (len(calls) - needed))]
        self.through &= enough or all(_done(answer) for answer in answers)
        for answer in answers if told else answers[:needed]:
            for row in [] if answer is None else _rows(answer.value):
                self.rows.append({**row, "better": row["in_tolerance"] > self._best() + rough.GAIN})
        failed = [one.error for one in answers if one is not None and one.error is not None]
        for error in failed:
            if not isinstance(error, InputError):
                raise error
        if failed and needed and all(one is None or one.value is None for one in answers):
            raise failed[0]
        return [None if answer is None else answer.value for answer in answers]

    def _best(self) -> float:
        return max((row["in_tolerance"] for row in self.rows), default=0.0)

    def _show(self, row: dict[str, Any]) -> None:
        better = row["in_tolerance"] > self.shown + rough.GAIN
        self.shown = max(self.shown, row["in_tolerance"])
        if self.told is not None:
            self.told({**row, "better": better})

    def _looked(self) -> tuple[Seen, list[Seen], list[Seen]]:
        """The job's own wheel, others that may be taken, and further ones."""
        wanted, fixed = self.first, self.search.fixed
        given = {"along": wanted["along"], "direction": list(wanted["direction"])}
        ways = [] if wanted["along"] == "auto" else [given]
        if not ways or not {"along", "direction"} & set(fixed):
            ways += reach_map.ways(self.data, wanted, self.context.part(0.0, 0.0))
            ways = reach_map.distinct(ways)
        self.ways = ways
        machines = [self.data["belt_machine"], *self.search.wheels, *self.search.further]
        calls = []
        for number, machine in enumerate(machines):
            angles: tuple[float, ...] = OTHER_ANGLES if number else OWN_ANGLES
            if "belt_angle_deg" in fixed:
                angles = (wanted["belt_angle_deg"],)
            job = {**self.data, "belt_machine": machine}
            calls.append(Call(tasks.alone, (reach_map.look, job, wanted, ways, angles)))
        answers = self._run(calls, 1.0, (0.0, 0.1), needed=len(calls))
        if answers[0] is None:  # which says why
            reach_map.look(self.data, wanted, ways, OWN_ANGLES, self.context.part(0.1, 0.1))
        seen = [answer and Seen(machine, answer) for machine, answer in zip(machines, answers)]
        count = 1 + len(self.search.wheels)
        others, further = ([one for one in some if one] for some in (seen[1:count], seen[count:]))
        return known(seen[0]), others, further

    def _coarse(self, start: Move, queue: Sequence[Move]) -> tuple[Tried | None, list[Tried]]:
        """(a rough plan of the start, if it can be laid; of candidates, the best first)."""
        few = len(queue) <= LEADERS or not rough.glances(self.data, self.first)
        how = rough.ROUGHLY if few else rough.GLANCE
        until = self._until(COARSE_UNTIL if few else GLANCES_UNTIL)
        calls = [self._call(tasks.begun, until, start, self.settings, self.zones)]
        for move in queue:
            calls.append(self._call(tasks.soon, until, move, self.settings, self.zones, how))
        default, *values = self._run(calls, COARSE_UNTIL + TO_END, (0.1, 0.3), 1, few)
        seen = glanced = _best_first(values)
        if few or (default is not None and default.in_tolerance >= ENOUGH):
            return default, seen
        found: list[Tried] = []
        seen_only: list[Tried] = []
        until, best = self._until(COARSE_UNTIL), 0.0
        while seen and (not found or found[0].in_tolerance > best + GAIN):
            best = found[0].in_tolerance if found else 0.0
            some, seen = seen[:LEADERS], seen[LEADERS:]
            calls = []
            for one in some:
                move = (one.change, one.machine, one.wanted)
                calls.append(self._call(tasks.soon, until, move, self.settings, self.zones))
            values = self._run(calls, COARSE_UNTIL + TO_END, (0.3, 0.5))
            found = _best_first([*found, *values])
            seen_only += [one for one, value in zip(some, values) if value is None]
        self.rows += [one.row(False) for one in [*seen_only, *seen]]
        return default, found or glanced

    def _brought(self, further: list[Seen], own: Seen, mine: list[Tried]) -> list[dict[str, Any]]:
        """What further wheels would bring: those that get to more are planned coarsely, as the own one was."""
        if not further:
            return []
        start: Move = ("first", own.machine, self.first)
        ahead = [one for one in further if one.most > own.most + GAIN] if mine else []
        ahead = sorted(ahead, key=lambda one: -one.most)[:FURTHER]
        until = self._until(RULES_UNTIL)
        calls, owner = [], []
        for number, one in enumerate(ahead):
            for move in of_further(one, start, self.search.fixed, mine[0]):
                calls.append(self._call(tasks.soon, until, move, self.settings, self.zones))
                owner.append(number)
        values = self._run(calls, RULES_UNTIL + TO_END, (0.4, 0.5))
        shares: dict[int, float] = {}
        for number, value in zip(owner, values):
            if value is not None:
                key = id(ahead[number])
                shares[key] = max(shares.get(key, 0.0), value.in_tolerance)
        return [_brings(one, shares.get(id(one)), mine) for one in further]

    def _ruled(self, default: Tried | None, coarse: list[Tried], until: float) -> list[Tried]:
        """Those that were tried, and what the rules find from them until that share of the budget, the best first: ``WIDE`` at a
        time, the most promising, and so on from each of them, as long as one of ``PATIENCE`` is better.
        """
        found = _best_first(_different([*([] if default is None else [default]), *coarse]))
        queue = Queue(
            [by_rules.others, Moves(self.search.fixed, self.lap, self.reachable)], self.seen
        )
        end = self._until(until)
        for one in found:
            queue.add(one)
        best, waited, longest = _most(found), 0, 0.0
        while waited < PATIENCE and not self._over(until - longest):
            moves, begun = queue.take(WIDE), self._spent()
            if not moves:
                break
            calls = [self._call(tasks.once, end, one, self.settings, self.zones) for one in moves]
            share = min(begun / until, 1.0)
            values = self._run(calls, until + TO_END, self._part(0.5 + 0.2 * share, 0.7))
            longest = max(longest, self._spent() - begun)
            for one in values:
                if one is not None:
                    queue.add(one)
                    found.append(one)
            waited = 0 if _most(found) > best + rough.GAIN else waited + len(moves)
            best = max(best, _most(found))
        return _best_first(found)

    def _grouped(self, tried: list[Tried]) -> list[Tried]:
        """Those that were tried, and before them the best with further groups of passes, their ways and belt angles by what the wheel
        gets to of what is left: as long as one brings more of the area into tolerance."""
        fixed = self.search.fixed
        if not tried or "further_passes" in fixed or {"along", "belt_angle_deg"} <= set(fixed):
            return tried
        for _ in range(GROUPS):
            best = tried[0]
            if best.left_share < rough.MATTERS or self._over(GROUPS_UNTIL):
                break
            job = {**self.data, "belt_machine": best.machine}
            near = {**best.wanted, **best.region()}
            angles = (best.wanted["belt_angle_deg"],) if "belt_angle_deg" in fixed else OWN_ANGLES
            call = Call(tasks.alone, (reach_map.look, job, near, self.ways, angles))
            (seen,) = self._run([call], GROUPS_UNTIL, (0.7, 0.7))
            if seen is None:
                break
            moves = further_groups(best, seen, fixed)[:OF_A_GROUP]
            until = self._until(GROUPS_UNTIL)
            calls = [
                self._call(tasks.soon, until, move, self.settings, self.zones) for move in moves
            ]
            values = self._run(calls, GROUPS_UNTIL + TO_END, (0.7, 0.75))
            found = [one for one in values if one is not None]
            found = [one for one in found if one.in_tolerance > best.in_tolerance + GAIN]
            if not found:
                break
            tried = [max(found, key=lambda one: one.in_tolerance), *tried]
        return tried

    def _finals(self, default: Tried | None, tried: list[Tried]) -> Tried:
        """The best of full plans of the best that have none yet, the start among them unless it is far behind."""
        chosen = _different(tried)[:FINALS]
        if default is not None and not any(_same(default, one) for one in chosen):
            if not chosen or default.in_tolerance > chosen[0].in_tolerance - FAR_BEHIND:
                chosen = sorted([*chosen[: FINALS - 1], default], key=lambda one: -one.in_tolerance)
        chosen = [one for one in chosen if not any(_same(one, done) for done in self.planned)]
        self.planned += chosen
        until = self._until(FULL_UNTIL)
        calls = [self._call(tasks.full, until, one, self.settings, self.zones) for one in chosen]
        own = [k for k, one in enumerate(chosen) if default is not None and _same(one, default)]
        needed = 1 + max(own, default=0)
        values = [
            one for one in self._run(calls, 1.0, self._part(0.7, 0.9), needed) if one is not None
        ]
        return max(values, key=lambda one: one.in_tolerance)


def _most(tried: Sequence[Tried]) -> float:
    return max((one.in_tolerance for one in tried), default=0.0)


def _best_first(values: Sequence[Tried | None]) -> list[Tried]:
    found = [one for one in values if one is not None]
    return sorted(found, key=lambda one: -one.in_tolerance)


def _rows(value: Any) -> list[dict[str, Any]]:
    """What is told of a call's value."""
    if isinstance(value, Tried):
        return [value.row(False)]
    return list(value[1]) if isinstance(value, tuple) and isinstance(value[0], Tried) else []


def _done(answer: Answer | None) -> bool:
    """Whether a call was worked at."""
    return answer is not None and (answer.value is not None or answer.error is not None)


def _different(tried: Sequence[Tried]) -> list[Tried]:
    """Each once, in their order, and of those that come to the same by other settings, as more smoothing where there is nothing to
    smooth, the first."""
    found: dict[tuple[float, int, float], Tried] = {}
    for one in tried:
        found.setdefault((one.in_tolerance, one.poses, one.process_time_s), one)
    return list(found.values())


def _same(one: Tried, other: Tried) -> bool:
    return one.machine == other.machine and one.wanted == other.wanted


def _brings(one: Seen, share: float | None, mine: list[Tried]) -> dict[str, Any]:
    return {
        "wheel": one.size,
        "reachable": one.most,
        "in_tolerance": share,
        "gain": None if share is None else share - mine[0].in_tolerance,
    }


def _geometry(one: Seen, reach: reach_map.Reach) -> dict[str, Any]:
    return {
        "wheel": one.size,
        "along": reach.way["along"],
        "direction": list(reach.way.get("direction", [])),
        "belt_angle_deg": reach.belt_angle_deg,
        "reachable": reach.share,
        "upright": reach.upright,
    }
