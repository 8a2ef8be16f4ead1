"""Several wheels and belts, one after the other: which stages are worth their tool changes, by rough plans.

Single stages are planned first. Then the best of them get another stage: the same belt where too much is left, or a finer belt
everywhere, before which the stage before leaves an allowance. It ends where another stage brings nothing.
"""

from __future__ import annotations

import itertools
import math
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..base import records
from ..base.crew import Call, Crew
from ..base.kinds import Context, Facts, Floats, Json, known
from ..engine import Fact, InputError, core
from ..job.typed import typed
from ..job.workpiece import make_stocked_field, read_design
from ..raster import raster_path, reach_map, region
from ..simulation.result import Result
from . import rough, rounds, search as searches, wheels
from .belts import Belt, mounted
from .candidates import Seen, one_a_way, ranked
from .grinding import Ground, grind as grind_one, with_forces
from .rough import Zones
from .search import GAIN
from .tasks import alone

WAYS = 2  # of each wheel, on which it gets to most
ANGLES = (0.0, 90.0)  # degrees, of the belt to its passes
BEAM = 2  # sequences that get another stage, and as many that leave an allowance
LEAVES = (0.15, 0.3)  # of the mean stock: what a stage leaves to a finer belt
MOST = 4  # stages
CHOOSING = 0.4  # of the budget

Told = Callable[[dict[str, Any]], object]


class Tool(NamedTuple):
    """A wheel with a belt."""

    job: Json  # with them, validated
    belt: str  # its name; "": the job's own
    rank: int  # of the belts, the first one's 0


class Step(NamedTuple):
    """A stage to be."""

    tool: int
    everywhere: bool  # else only where too much is left
    leave_mm: float  # for a finer belt, above the tolerance


class Node(NamedTuple):
    """Stages that were planned coarsely, one after the other."""

    steps: tuple[Step, ...]
    shares: tuple[float, ...]  # of the area in tolerance after each
    times_s: tuple[float, ...]
    wanted: tuple[Json, ...]  # settings of the raster, without a region
    reached: float  # of the area, in the last stage's own tolerance
    open: int  # zones whose finish is not as wanted
    state: str  # file of the heights that are left

    def row(self, tools: Sequence[Tool]) -> dict[str, Any]:
        """As JSON has it."""
        stages = [
            {"belt": tools[one.tool].belt, **_size(tools[one.tool]), **one._asdict()}
            for one in self.steps
        ]
        return {
            "stages": [{k: v for k, v in one.items() if k != "tool"} for one in stages],
            "in_tolerance": self.shares[-1],
            "reached": self.reached,
            "finish_open": self.open,
            "process_time_s": sum(self.times_s),
        }


def tools(job: Json, machines: Sequence[Json], belts: Sequence[Belt]) -> list[Tool]:
    """Every one of the belt ``machines`` with every belt; without ``belts`` with the job's own. Raises InputError."""
    found = []
    for machine in machines:
        with_it = {**job, "belt_machine": machine}
        if not belts:
            found.append(Tool(with_it, "", 0))
        found += [Tool(mounted(with_it, one), one.name, k) for k, one in enumerate(belts)]
    return found


def _machine(tool: Tool) -> Json:
    return records.plain(typed(tool.job).belt_machine)


def _size(tool: Tool) -> dict[str, Any]:
    wheel = typed(tool.job).belt_machine.wheel
    names = ("radius_mm", "width_mm", "crown_radius_mm")
    return {"wheel": {name: getattr(wheel, name) for name in names}}


def name(tool: Tool) -> Fact:
    """Of a wheel with its belt."""
    wheel = wheels.name(_size(tool)["wheel"])
    if not tool.belt:
        return wheel
    return Fact("planning.wheel_and_belt", "{wheel}, belt {belt}", wheel=wheel, belt=tool.belt)


def changed(before: Tool, after: Tool) -> list[str]:
    """What is changed between two stages: wheel, belt, or both."""
    found = ["wheel"] if _size(before) != _size(after) else []
    return found + (["belt"] if before.belt != after.belt else [])


def job_of(tool: Tool, step: Step, left: Path | str | None) -> dict[str, Any]:
    """The job of a stage that begins with what the file ``left`` holds (None: with the job's stock), its tolerance above the
    part's by what it leaves."""
    given = {key: dict(tool.job[key]) for key in ("stock", "inspection")}
    if left is not None:
        given["stock"]["left_by"] = str(left)
        given["stock"][
            "offset_mm"
        ] = 0.0  # the first stage's raw part had them, and it left what they made of it
        given["stock"].pop("placement", None)
    if step.leave_mm:
        limits = given["inspection"]["tolerance_mm"]
        given["inspection"]["tolerance_mm"] = _above(limits, step.leave_mm)
        given["inspection"]["zones"] = [
            {**zone, "tolerance_mm": _above(zone["tolerance_mm"], step.leave_mm)}
            if "tolerance_mm" in zone
            else zone
            for zone in given["inspection"]["zones"]
        ]
    return {**tool.job, **given}


def _above(limits: Sequence[float], by: float) -> list[float]:
    return [round(limit + by, 6) for limit in limits]


def with_region(job: Json, wanted: Json) -> dict[str, Any]:
    """Settings of the raster that keep to where the stock that an earlier stage left is above the job's tolerance. Raises
    InputError where it is nowhere."""
    read = typed(job)
    field, _ = core.HeightField.from_hdf5(known(read.stock.left_by))
    points, margin = region.of_field(field, read)
    narrow = margin <= 0.5 * read.belt_machine.wheel.width_mm
    return {
        **wanted,
        "region_points": points.tolist(),
        "region_mm": 0.0 if narrow else margin,
    }


def judged(result: Result, end: Json) -> tuple[float, int]:
    """(of the area, that a stage's result has in tolerance at the ``end`` of all stages, by that job's limits; zones whose
    finish is not as wanted)."""
    lower, upper = typed(end).inspection.tolerance_mm
    share = float(core.deviation_statistics(result.field, lower, upper)["in_tolerance_share"])
    zones = known(result.verdict)["zones"]
    return share, sum(zone["finish"]["verdict"] != "pass" for zone in zones if "finish" in zone)


def pays(before: tuple[float, int], after: tuple[float, int]) -> bool:
    """Whether a stage brings half a point of the area, or a zone its finish; both as ``judged``."""
    return after[1] < before[1] or after[0] >= before[0] + GAIN


def planned(
    tool: Tool,
    step: Step,
    wanted: Json,
    settings: Json,
    zones: Zones | None,
    left: str | None,
    state: str,
) -> tuple[float, float, int, float, Json]:
    """Plans a stage coarsely and writes the heights that it leaves into the file ``state``. Returns (share in tolerance, share in
    its own, zones of open finish, seconds, the settings with their way found). Raises InputError.
    """
    job = job_of(tool, step, left)
    data, settings = rounds.in_time(job, with_forces(typed(job), settings))
    laid = wanted if step.everywhere or left is None else with_region(job, wanted)
    move = ("stage", records.plain(typed(data).belt_machine), laid)
    tried, plan = rough.attempted(data, move, settings, zones)
    plan.after.field.write_hdf5(state)
    share, open_zones = judged(plan.after, tool.job)
    kept = {k: v for k, v in tried.wanted.items() if k not in ("region_points", "region_mm")}
    kept = {**wanted, **kept}
    return share, tried.in_tolerance, open_zones, tried.process_time_s, kept


class Chooser:
    """Plans sequences of stages coarsely, side by side."""

    def __init__(
        self,
        given: Sequence[Tool],
        first: Json,
        settings: Json,
        search: searches.Search,
        zones: Zones | None = None,
        told: Told | None = None,
        stop: Callable[[], bool] | None = None,
        context: Context = None,
    ) -> None:
        """``first``: validated settings of the raster; ``settings``: of the plan, validated; ``search``: budget, settings that stay, and
        processes; ``told(row)``: as ``Node.row``; ``stop()``: whether the best so far is enough."""
        self.tools, self.first, self.settings = list(given), first, settings
        self.search, self.zones, self.told, self.stop = search, zones, told, stop
        self.context = context or core.RunContext()
        self.nodes: list[Node] = []
        self._numbers = itertools.count()

    def choose(self, most: int = MOST) -> Node:
        """The fewest stages, at most ``most``, that reach what any reach but for half a point; of as many the quickest. Its
        ``state`` is gone. Raises InputError, Cancelled."""
        seconds = CHOOSING * self.search.budget_s or math.inf  # without a search all is tried
        self._ends = time.monotonic() + seconds
        with Crew(self.search.workers) as self.crew, tempfile.TemporaryDirectory() as folder:
            self.folder = Path(folder)
            ways = self._ways()
            level = self._level([(None, step) for step in self._firsts(most)], ways, None)
            while level and max(len(one.steps) for one in level) < most and not self._over():
                best = _best(self.nodes)
                level = self._level(self._following(level), ways, self._over)
                if _best(self.nodes) is best:
                    break
        return _best(self.nodes)

    def _ways(self) -> list[list[Json]]:
        """Of each tool, settings of the raster on which its wheel gets to most."""
        job = self.tools[0].job
        fixed = self.search.fixed
        own = {k: self.first[k] for k in ("along", "direction")}
        ways = [own] if self.first["along"] != "auto" else []
        if not ways or not {"along", "direction"} & set(fixed):
            ways = reach_map.distinct([*ways, *reach_map.ways(job, self.first)])
        angles = (self.first["belt_angle_deg"],) if "belt_angle_deg" in fixed else ANGLES
        calls = [
            Call(alone, (reach_map.look, tool.job, self.first, ways, angles)) for tool in self.tools
        ]
        found = []
        for tool, answer in zip(self.tools, self.crew.run(calls, context=self._part())):
            one = known(answer)
            if one.error is not None:
                raise one.error
            seen = Seen(_machine(tool), one.value)
            start = ("first", _machine(self.tools[0]), self.first)
            moves = one_a_way(ranked(seen, start, fixed))[:WAYS]
            found.append([move[2] for _, move in moves] or [self.first])
        return found

    def _firsts(self, most: int) -> list[Step]:
        """Single stages, and those that leave something to a finer belt."""
        steps = [Step(k, True, 0.0) for k in range(len(self.tools))]
        finest = max(tool.rank for tool in self.tools)
        if most < 2 or not finest:
            return steps
        mean = _mean_stock(self.tools[0].job, self._part())
        for k, tool in enumerate(self.tools):
            if tool.rank < finest:
                steps += [Step(k, True, round(share * mean, 3)) for share in LEAVES]
        return steps

    def _following(self, level: Sequence[Node]) -> list[tuple[Node | None, Step]]:
        rough = [one for one in level if one.steps[-1].leave_mm]
        done = [one for one in level if not one.steps[-1].leave_mm]
        rough = sorted(rough, key=lambda one: -one.reached)[:BEAM]
        done = sorted(done, key=lambda one: (one.open, -one.shares[-1]))[:BEAM]
        found: list[tuple[Node | None, Step]] = []
        for node in [*done, *rough]:
            last = node.steps[-1]
            for k, tool in enumerate(self.tools):
                finer = tool.rank - self.tools[last.tool].rank
                if finer < 0 or k == last.tool:
                    continue
                if finer:
                    found.append((node, Step(k, True, 0.0)))
                elif not last.leave_mm:
                    found += [(node, Step(k, False, 0.0)), (node, Step(k, True, 0.0))]
                else:
                    found.append((node, Step(k, False, last.leave_mm)))
        return found

    def _level(
        self,
        wanted: Sequence[tuple[Node | None, Step]],
        ways: Sequence[Sequence[Json]],
        over: Callable[[], bool] | None,
    ) -> list[Node]:
        """Nodes of (node before, step) that could be planned, the better of each step's ways; all of them where ``over`` is None."""
        calls, owners = [], []
        for node, step in wanted:
            for way in ways[step.tool]:
                state = str(self.folder / f"{next(self._numbers)}.h5")
                left = None if node is None else node.state
                given = (self.tools[step.tool], step, way, self.settings, self.zones, left, state)
                calls.append(Call(alone, (planned, *given)))
                owners.append((node, step, state))
        answers = self.crew.run(calls, over=over, context=self._part())
        found: dict[tuple[int, Step], Node] = {}
        failed: list[Exception] = []
        for (node, step, state), answer in zip(owners, answers):
            if answer is None:
                continue
            if answer.error is not None:
                if not isinstance(answer.error, InputError):
                    raise answer.error
                failed.append(answer.error)
                continue
            one = _node(node, step, state, answer.value)
            key = (id(node), step)
            if key not in found or _sort(one) < _sort(found[key]):
                found[key] = one
        if failed and not found and not self.nodes:
            raise failed[0]
        for one in found.values():
            self.nodes.append(one)
            if self.told is not None:
                self.told(one.row(self.tools))
        return list(found.values())

    def _over(self) -> bool:
        """Whether the time is spent, or who asked wants no more."""
        return time.monotonic() > self._ends or (self.stop is not None and self.stop())

    def _part(self) -> core.RunContext:
        return self.context.part(0.0, 0.0)


def _node(
    before: Node | None, step: Step, state: str, value: tuple[float, float, int, float, Json]
) -> Node:
    share, reached, open_zones, seconds, wanted = value
    if before is None:
        return Node((step,), (share,), (seconds,), (wanted,), reached, open_zones, state)
    return Node(
        (*before.steps, step),
        (*before.shares, share),
        (*before.times_s, seconds),
        (*before.wanted, wanted),
        reached,
        open_zones,
        state,
    )


def _sort(one: Node) -> tuple[int, float, float]:
    return one.open, -one.reached, sum(one.times_s)


def _best(nodes: Sequence[Node]) -> Node:
    """The fewest stages of those that reach most, the quickest of as many."""
    done = [one for one in nodes if not one.steps[-1].leave_mm]
    least = min(one.open for one in done)
    done = [one for one in done if one.open == least]
    most = max(one.shares[-1] for one in done)
    near = [one for one in done if one.shares[-1] > most - GAIN]
    return min(near, key=lambda one: (len(one.steps), sum(one.times_s)))


def _mean_stock(job: Json, context: core.RunContext) -> float:
    """mm on the faces, above the middle of the tolerance."""
    data = rounds.settled(job, context)
    field = make_stocked_field(typed(data), read_design(typed(data).design, context), [], context)
    heights: Floats = np.asarray(field.height, dtype=float)
    areas: Floats = np.asarray(field.areas, dtype=float)
    middle = float(np.mean(typed(job).inspection.tolerance_mm))
    return max(float((heights * areas).sum() / areas.sum()) - middle, 0.0)


def first_settings(given: Json) -> dict[str, Any]:
    """Settings of the raster that stages begin with, validated. Raises InputError for a region, which is the stages' own."""
    found = raster_path.validate(given)
    for key in ("region_points", "further_passes"):
        if found[key]:
            raise InputError(
                "planning.stages_region", "{key}: stages choose their own regions", key=key
            )
    return found


class Stage(NamedTuple):
    """A stage that was planned in full, and written."""

    step: Step
    tool: Tool
    ground: Ground
    result: Result  # what its written program does
    share: float  # of the area in tolerance at the end of all, after it
    open: int  # zones whose finish is not as wanted

    def row(self) -> dict[str, Any]:
        """As JSON has it."""
        step = self.step._asdict()
        del step["tool"]
        return {
            "belt": self.tool.belt,
            **_size(self.tool),
            **step,
            "process_time_s": self.result.summary["process_time_s"],
            "in_tolerance": self.share,
            "finish_open": self.open,
        }


class Staged(NamedTuple):
    """Stages in full."""

    stages: list[Stage]
    dropped: Facts  # stages that brought too little

    def changes(self) -> list[list[str]]:
        """What is changed before each stage but the first."""
        pairs = itertools.pairwise(one.tool for one in self.stages)
        return [changed(*pair) for pair in pairs]

    def report(self, chooser: Chooser) -> dict[str, Any]:
        """As JSON has it."""
        changes = [[], *self.changes()]
        return {
            "stages": [{**one.row(), "changed": what} for one, what in zip(self.stages, changes)],
            "tool_changes": sum(map(bool, changes)),
            "dropped": [str(one) for one in self.dropped],
            "tried": [one.row(chooser.tools) for one in chooser.nodes],
        }


Write = Callable[[int, Ground, core.RunContext], "tuple[Result, Path]"]


def grind(
    chooser: Chooser,
    node: Node,
    write: Write,
    told: Told | None = None,
    stop: Callable[[], bool] | None = None,
) -> Staged:
    """Plans a node's stages in full, each with what the one before left. ``write(number, ground, context)``: writes the
    files of a stage, numbered from 1, and returns what they do and the file of the heights that they leave; ``told``, ``stop``: as
    ``grinding.grind`` takes them. A stage that does not pay is not written. Raises InputError, Cancelled.
    """
    context, search = chooser.context, chooser.search
    share = (1.0 - CHOOSING) * search.budget_s / len(node.steps)
    search = search._replace(budget_s=share, wheels=(), further=())
    found: list[Stage] = []
    dropped: Facts = []
    left: Path | None = None
    for k, (step, wanted) in enumerate(zip(node.steps, node.wanted)):
        tool = chooser.tools[step.tool]
        begins, ends = k / len(node.steps), (k + 1) / len(node.steps)
        middle = 0.5 * (begins + ends)
        job = job_of(tool, step, left)
        try:
            laid = wanted if step.everywhere or left is None else with_region(job, wanted)
            ground = grind_one(
                job,
                laid,
                chooser.settings,
                context.part(begins, middle),
                told,
                chooser.zones,
                search if share and laid is wanted else None,
                stop,
            )
        except InputError as error:
            if not found:
                raise
            dropped.append(_dropped(tool, error))
            continue
        if found and not step.leave_mm:
            before = (found[-1].share, found[-1].open)
            after = judged(ground.plan.after, tool.job)
            if not pays(before, after):
                dropped.append(_dropped(tool, _too_little(before[0], after[0])))
                continue
        result, left = write(len(found) + 1, ground, context.part(middle, ends))
        found.append(Stage(step, tool, ground, result, *judged(result, tool.job)))
    return Staged(found, dropped)


def _dropped(tool: Tool, why: Fact | InputError) -> Fact:
    return Fact("planning.stage_dropped", "no stage with {tool}: {why}", tool=name(tool), why=why)


def _too_little(before: float, after: float) -> Fact:
    return Fact(
        "planning.stage_too_little",
        "it brings {points:+.1f} points, from {before:.1f} % in tolerance",
        points=100.0 * (after - before),
        before=100.0 * before,
    )
