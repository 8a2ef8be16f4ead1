"""The commands of a job's programs whose feed can be planned: what has one feed in the program is one variable."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base import records, schemas
from ..base.kinds import Array, Facts, Floats, Json
from ..cell.tool_path import tool_path
from ..engine import InputError, core
from ..job import engine_input, poses, robot_time
from ..job.poses import program_name
from ..job.settings import Job
from ..job.typed import typed
from ..presets import robot as robots
from ..programs.force_device import of_job
from ..robot_program import feeds as joint_feeds, whole as robot_program

STILL = 1e-9  # mm; less is no way
SAME = 1e-6  # of a time
DEFAULTS = schemas.schema("plan")["properties"]
FASTEST = 2000.0  # mm/s, of robots' tool centre points
MOST_OVER = 100.0  # times the feed of the contact, that a tool centre point may have
PATH = (
    "frames",
    "forces",
    "rapid",
    "lines",
    "zones",
)  # of a program's arrays, as core.ToolPath takes them
FORCE_DIGITS = 1  # of N, in programs


class Commands:
    """Feeds of all programs of a validated job, and which motions change together: those of one line of a program's
    file, for a line has one feed, however often it is run through and into however many poses its arc is cut. Poses
    that stand in the job have a feed each."""

    def __init__(
        self, job: Job | Json, settings: Json, sources: Sequence[str | None] | None = None
    ) -> None:
        """``sources``: of each program the file whose lines its poses name, or None; by default those that the job
        names. By ``settings.timing`` robot the job is to be that of ``robot_time.timed``, and feeds, forces and poses
        get the digits of programs. Raises InputError for lines that no motion has."""
        self.job: Json = records.plain(job)  # as data, which plans hand out
        job = typed(job)
        self.device = of_job(job)  # by which programs set their forces
        self.limits = robot_time.limits(job) if settings["timing"] == "robot" else None
        self._time_law = engine_input.time_law(job.simulation)
        self.sources = sources or [program.file for program in job.programs]
        self.arrays: list[dict[str, Array]] = []
        warnings: Facts = []
        for k, program in enumerate(job.programs):
            self.arrays.append(
                poses.program_arrays(
                    program,
                    program_name(job, k),
                    warnings,
                    robots.pose_function(self.job["robot"]),
                    job.cell.holding,
                    self.device,
                )
            )
        if self.limits is not None:
            self.arrays = [
                one if source else robot_time.laid_out(one, self.limits)
                for source, one in zip(self.sources, self.arrays)
            ]
        groups: list[int] = []
        programs: list[int] = []
        for k, (source, arrays) in enumerate(zip(self.sources, self.arrays)):
            lines = arrays["lines"] if source else np.zeros(len(arrays["lines"]))
            names: dict[int, int] = {}
            for i, line in enumerate(lines.tolist()):
                name = line if line > 0 else -1 - i
                groups.append(names.setdefault(name, len(programs) + len(names)))
            programs += [k] * len(names)
        self.group = np.array(groups, dtype=np.uint32)  # (motions,), through all programs
        self.program = np.array(programs)  # (commands,) from 0
        self.feeds = np.concatenate([a["feeds"] for a in self.arrays])  # (motions,) mm/s
        given = np.concatenate([a["forces"] for a in self.arrays])
        self.forces = np.where(given < 0, float(job.belt_machine.force_N), given)  # (motions,) N
        self.lines = np.concatenate([a["lines"] for a in self.arrays])
        self.rapid = np.concatenate([a["rapid"] for a in self.arrays])
        self.of_program = np.repeat(
            np.arange(len(self.arrays)), [len(a["feeds"]) for a in self.arrays]
        )
        # In the robot's time: the programs' files set no force, nor can they, and one for all is set by hand.
        self.by_hand = (
            self.limits is not None
            and self.device is None
            and all(self.sources)
            and bool((given < 0).all())
        )
        self.kept = np.zeros(len(self), dtype=bool)
        self._keep(settings["keep"])
        self.force_range = self._force_range(
            settings
        )  # (commands,) twice: least and greatest factor
        self.feed_range = self._feed_range(settings)  # (commands,) twice: least and greatest mm/s

    def __len__(self) -> int:
        return len(self.program)

    def _keep(self, wanted: Sequence[Json]) -> None:
        own = np.concatenate([np.arange(1, len(a["feeds"]) + 1) for a in self.arrays])
        for number, one in enumerate(wanted):
            what = "line" if one["first_line"] else "pose"
            first = one[f"first_{what}"]
            last = max(one[f"last_{what}"], first)
            if not first or (one["first_line"] and one["first_pose"]):
                raise InputError(
                    "planning.keep_what",
                    "{key}: give either first_line or first_pose",
                    key=f"keep[{number}]",
                )
            numbers = self.lines if what == "line" else own
            mine = (self.of_program == one["program"] - 1) & (numbers >= first) & (numbers <= last)
            if not mine.any():
                given = {
                    "key": f"keep[{number}]",
                    "program": one["program"],
                    "first": first,
                    "last": last,
                }
                if what == "pose":
                    raise InputError(
                        "planning.keep_no_pose",
                        "{key}: program {program} has no motion in poses {first} to {last}",
                        **given,
                    )
                raise InputError(
                    "planning.keep_nothing",
                    "{key}: program {program} has no motion in lines {first} to {last}",
                    **given,
                )
            self.kept[self.group[mine]] = True

    def _force_range(self, settings: Json) -> tuple[Floats, Floats]:
        """Factors on the forces of commands: a program's greatest force may become what the settings allow, and all
        others change with it, so that ramps at the ends of passes stay ramps."""
        least, greatest = np.ones(len(self)), np.ones(len(self))
        for k in range(len(self.arrays)):
            mine = (self.of_program == k) & ~self.rapid
            reference = self.forces[mine].max() if mine.any() else 0.0
            if reference > 0.0:
                own = (self.program == k) & (~self.kept | self.by_hand)
                if settings["force_min_N"] > 0.0:
                    least[own] = min(1.0, settings["force_min_N"] / reference)
                if settings["force_max_N"] > 0.0:
                    greatest[own] = max(1.0, settings["force_max_N"] / reference)
        return least, greatest

    def _feed_range(self, settings: Json) -> tuple[Floats, Floats]:
        """Least and greatest feeds of commands, mm/s: as the settings say, and in the robot's time no greater than its
        blocks, its accelerations and, in a job with a home, its joints let it go."""
        faster = self._over_contact()
        least = faster * settings["feed_min_mm_s"]
        whole = faster * settings["feed_max_mm_s"]
        own = self.feed()
        # A limit that nobody has chosen allows what the program has itself.
        if settings["feed_max_mm_s"] == DEFAULTS["feed_max_mm_s"]["default"]:
            whole = np.maximum(whole, own)
        if settings["feed_min_mm_s"] == DEFAULTS["feed_min_mm_s"]["default"]:
            least = np.minimum(least, own)
        whole = np.minimum(whole, FASTEST)
        if self.limits is None:
            return least, whole
        way, allowed = self._lengths(), whole.copy()
        block = np.where(way > STILL, way / self.limits.least_block_s, np.inf)
        np.minimum.at(whole, self.group, np.where(self.rapid, np.inf, block))
        # Slower than its own feeds a file's program is not made: that would only cut deeper.
        whole = np.where(self.too_short(), np.minimum(self.feed(), allowed), whole)
        if robot_program.wanted(self.job):
            joints = joint_feeds.greatest(typed(self.job), self.arrays, settings["feed_max_mm_s"])
            np.minimum.at(whole, self.group, np.where(self.rapid, np.inf, joints))
        fastest = np.where(self.kept, self.feed(), whole)
        reached = self._reached(fastest)
        whole = robot_time.rounded_feeds(np.where(reached > 0.0, np.minimum(whole, reached), whole))
        return np.minimum(least, whole), whole

    def too_short(self) -> Array:
        """(commands,) bool: at its own feed a block of a program's file lasts less than the controller needs."""
        if self.limits is None:
            return np.zeros(len(self), dtype=bool)
        lasts = self.motion_seconds(self.feed())
        sourced = np.array([bool(one) for one in self.sources])[self.program]
        return sourced & (lasts > 0.0) & (lasts < self.limits.least_block_s * (1.0 - SAME))

    def _over_contact(self) -> Floats:
        """(commands,) of a program's feed in that of the contact over the work: 1 where the robot holds the tool; the tool
        centre point of a part in hand may go many times as fast as the belt over the part."""
        found = np.full(len(self), np.inf)
        if typed(self.job).cell.holding != "part_in_hand":
            return np.ones(len(self))
        over = []
        for k in range(len(self.arrays)):
            places = tool_path(self.job, k, []).work_from_contact()[:, :3, 3]
            over.append(np.append(0.0, np.linalg.norm(np.diff(places, axis=0), axis=1)))
        way, contact = self._lengths(), np.concatenate(over)
        share = np.where(way > STILL, way / np.maximum(contact, STILL), np.inf)
        np.minimum.at(found, self.group, np.where(self.rapid, np.inf, share))
        return np.where(np.isfinite(found), np.clip(found, 1.0 / MOST_OVER, MOST_OVER), 1.0)

    def presses(self) -> bool:
        """Whether forces may change."""
        least, greatest = self.force_range
        return bool((greatest > least).any())

    def force(self, factors: Floats) -> Floats:
        """(commands,) N: the greatest of a command's motions, with factors (commands,)."""
        found = np.zeros(len(self))
        np.maximum.at(found, self.group, self.forces)
        return found * factors

    def written(self, forces: Floats) -> Floats:
        """Forces N with the digits that programs have, in the robot's time; else as they are."""
        return forces if self.limits is None else np.round(forces, FORCE_DIGITS)

    def feed(self) -> Floats:
        """(commands,) mm/s; that of its last motion that grinds, for a line that has several."""
        found = np.zeros(len(self))
        found[self.group[self.rapid]] = self.feeds[self.rapid]
        found[self.group[~self.rapid]] = self.feeds[~self.rapid]
        return found

    def seconds(self, feeds: Floats) -> Floats:
        """(commands,) s that they take at feeds (commands,) mm/s, without acceleration; 0 of rapid motions."""
        return np.bincount(self.group, self._lengths(), len(self)) / np.maximum(feeds, 1e-9)

    def times(self, feeds: Floats) -> Array:
        """(commands,) s that they take at feeds (commands,) mm/s by the job's time law; 0 of rapid motions."""
        lasts = [np.diff(path.times(), prepend=0.0) for path in self._paths(feeds)]
        own = np.where(self.rapid, 0.0, np.concatenate(lasts))
        return np.bincount(self.group, own, len(self))

    def _reached(self, feeds: Floats) -> Array:
        """(commands,) mm/s: the greatest speed that the job's time law lets them come to at feeds (commands,) mm/s; less
        of a feed would only take longer. 0 of rapid motions."""
        speeds = np.concatenate([path.greatest_speeds() for path in self._paths(feeds)])
        found = np.zeros(len(self))
        np.maximum.at(found, self.group, np.where(self.rapid, 0.0, speeds))
        return found

    def _paths(self, feeds: Floats) -> list[core.ToolPath]:
        """The programs' paths at feeds (commands,) mm/s, by the job's time law."""
        new = np.where(self.rapid, self.feeds, feeds[self.group])
        paths = []
        for k, arrays in enumerate(self.arrays):
            given: dict[str, Any] = {name: arrays[name] for name in PATH}
            given.update(feeds=new[self.of_program == k], time_law=self._time_law)
            paths.append(core.ToolPath(**given))
        return paths

    def way(self) -> Array:
        """(commands,) mm, 0 of rapid motions."""
        return np.bincount(self.group, self._lengths(), len(self))

    def motion_seconds(self, feeds: Floats) -> Floats:
        """(commands,) s that the shortest motion of each takes."""
        found = np.full(len(self), np.inf)
        np.minimum.at(found, self.group, np.where(self.rapid, np.inf, self._lengths()))
        return np.where(np.isfinite(found), found, 0.0) / np.maximum(feeds, 1e-9)

    def neighbours(self) -> tuple[Array, Array, Floats]:
        """(first, second (pairs,) numbers of commands, way (pairs,) mm between the middles of their motions): of commands
        that follow each other without a rapid motion between them, each pair once."""
        way = self._lengths()
        a, b = self.group[:-1].astype(int), self.group[1:].astype(int)
        joined = (self.of_program[:-1] == self.of_program[1:]) & ~self.rapid[:-1] & ~self.rapid[1:]
        joined &= a != b
        pairs, which = np.unique(
            np.stack([np.minimum(a, b), np.maximum(a, b)])[:, joined], axis=1, return_inverse=True
        )
        between = np.full(pairs.shape[1], np.inf)
        np.minimum.at(between, which.reshape(-1), 0.5 * (way[:-1] + way[1:])[joined])
        return pairs[0], pairs[1], between

    def _lengths(self) -> Floats:
        """(motions,) mm, 0 of rapid ones."""
        lengths = [
            np.append(0.0, np.linalg.norm(np.diff(a["frames"][:, :3, 3], axis=0), axis=1))
            for a in self.arrays
        ]
        return np.where(self.rapid, 0.0, np.concatenate(lengths))

    def with_feeds(self, feeds: Floats, factors: Floats | None = None) -> dict[str, Any]:
        """A copy of the job, its programs given pose by pose, with feeds (commands,) mm/s on all but rapid motions,
        and ``factors`` (commands,) on the forces of those."""
        new = np.where(self.rapid, self.feeds, feeds[self.group])
        given = np.concatenate([a["forces"] for a in self.arrays])
        factor = np.ones(len(given)) if factors is None else factors[self.group]
        if self.by_hand:
            factor = np.ones(len(given))
        forces = np.where(self.rapid | (factor == 1.0), given, self.forces * factor)
        if self.device is not None:
            for k in np.flatnonzero(~self.rapid & (forces >= 0.0)):
                forces[k] = self.device.settable(float(forces[k]))
        if self.limits is not None:
            forces = np.round(forces, FORCE_DIGITS)
        programs = []
        begin = 0
        for program, arrays in zip(self.job["programs"], self.arrays):
            end = begin + len(arrays["feeds"])
            kept = {name: program[name] for name in ("name", "unresolved") if name in program}
            changed = {"feeds": new[begin:end], "forces": forces[begin:end]}
            listed = poses.list_poses({**arrays, **changed})
            programs.append({**kept, **poses.rests(program), "poses": listed})
            begin = end
        return {**self.pressed(factors), "programs": programs}

    def pressed(self, factors: Floats | None = None) -> dict[str, Any]:
        """The job with the force that ``factors`` set by hand."""
        if not self.by_hand or factors is None:
            return dict(self.job)
        machine = records.plain(typed(self.job).belt_machine)
        return {**self.job, "belt_machine": {**machine, "force_N": self.hand_force(factors)}}

    def hand_force(self, factors: Floats) -> float:
        """N that is set by hand on the belt machine, with the one factor of ``factors``; in the robot's time to a tenth."""
        force = float(typed(self.job).belt_machine.force_N)
        factor = float(factors[0])
        if factor == 1.0:
            return force
        return force * factor if self.limits is None else round(force * factor, FORCE_DIGITS)
