"""The commands of a job's programs whose feed can be planned: what has one feed in the program is one variable."""

import numpy as np

from ..engine import InputError
from ..job import poses
from ..job.poses import program_name
from ..presets import robot as robots


class Commands:
    """Feeds of all programs of a validated job, and which motions change together: those of one line of a program's
    file, for a line has one feed, however often it is run through and into however many poses its arc is cut. Poses
    that stand in the job have a feed each."""

    def __init__(self, job, settings):
        """Raises InputError for lines that no motion has."""
        self.job = job
        self.arrays = []
        warnings = []
        for k, program in enumerate(job["programs"]):
            self.arrays.append(
                poses.program_arrays(
                    program,
                    program_name(job, k),
                    warnings,
                    robots.pose_function(job["robot"]),
                    job["cell"]["holding"],
                )
            )
        groups, programs = [], []
        for k, (program, arrays) in enumerate(zip(job["programs"], self.arrays)):
            lines = arrays["lines"] if "poses" not in program else np.zeros(len(arrays["lines"]))
            names = {}
            for i, line in enumerate(lines.tolist()):
                name = line if line > 0 else -1 - i
                groups.append(names.setdefault(name, len(programs) + len(names)))
            programs += [k] * len(names)
        self.group = np.array(groups, dtype=np.uint32)  # (motions,), through all programs
        self.program = np.array(programs)  # (commands,) from 0
        self.feeds = np.concatenate([a["feeds"] for a in self.arrays])  # (motions,) mm/s
        self.lines = np.concatenate([a["lines"] for a in self.arrays])
        self.rapid = np.concatenate([a["rapid"] for a in self.arrays])
        self.of_program = np.repeat(
            np.arange(len(self.arrays)), [len(a["feeds"]) for a in self.arrays]
        )
        self.kept = np.zeros(len(self), dtype=bool)
        self._keep(settings["keep"])

    def __len__(self):
        return len(self.program)

    def _keep(self, wanted):
        for number, one in enumerate(wanted):
            first, last = one["first_line"], max(one["last_line"], one["first_line"])
            mine = (self.of_program == one["program"] - 1) & (self.lines >= first)
            mine &= self.lines <= last
            if not mine.any():
                raise InputError(
                    "planning.keep_nothing",
                    "{key}: program {program} has no motion in lines {first} to {last}",
                    key=f"keep[{number}]",
                    program=one["program"],
                    first=first,
                    last=last,
                )
            self.kept[self.group[mine]] = True

    def by_command(self, values, weights):
        """(commands,) mean of values (motions,), by weights (motions,)."""
        count = len(self)
        total = np.bincount(self.group, weights, count)
        return np.bincount(self.group, values * weights, count) / np.maximum(total, 1e-300)

    def feed(self):
        """(commands,) mm/s; that of its last motion that grinds, for a line that has several."""
        found = np.zeros(len(self))
        found[self.group[self.rapid]] = self.feeds[self.rapid]
        found[self.group[~self.rapid]] = self.feeds[~self.rapid]
        return found

    def with_feeds(self, feeds):
        """A copy of the job, its programs given pose by pose, with feeds (commands,) mm/s on all but rapid motions."""
        new = np.where(self.rapid, self.feeds, feeds[self.group])
        job = {**self.job, "programs": []}
        begin = 0
        for program, arrays in zip(self.job["programs"], self.arrays):
            end = begin + len(arrays["feeds"])
            kept = {name: program[name] for name in ("name", "unresolved") if name in program}
            listed = poses.list_poses({**arrays, "feeds": new[begin:end]})
            job["programs"].append({**kept, "poses": listed})
            begin = end
        return job
