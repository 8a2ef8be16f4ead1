"""Run by tools/bench inside FreeCAD: a pose of the example blade's program is moved, and the job is run again.

    BELTGRINDING_BENCH_SAMPLES=1e6

Writes Google Benchmark's JSON to BELTGRINDING_BENCH_OUT. Figures in ms of processor time, the least of a few runs in
turns, each with its preparations kept:

- start: the run with nothing to go on from, and no checkpoints taken;
- checkpoints: the same with checkpoints taken; cost: what that is more, % of the run, the median of all turns;
- at_10, at_50, at_90: with the pose moved that lies so far in the program, % of its motions; at_100: nothing moved;
- bytes: what the checkpoints take, MB; steps: of the program.

Every run that goes on from checkpoints is compared with one from the start, to the last bit.
"""

import json
import os
import statistics
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from beltgrinding.base import kept
from beltgrinding.examples import blade
from beltgrinding.job import load as jobs
from beltgrinding.simulation import checkpoints, run as runs

SAMPLES = float(os.environ.get("BELTGRINDING_BENCH_SAMPLES", "1e6"))
TIMES = int(os.environ.get("BELTGRINDING_BENCH_TIMES", "3"))
PLACES = (10, 50, 90)  # % of the motions
MOVED = 0.2  # mm
MOST_COST = 5.0  # % of a run
MOTION = "LIN {X "


class Changes:
    """The example's job, and the same with a pose moved."""

    def __init__(self, folder):
        self.path = blade.make(folder)
        self.job = json.loads(self.path.read_text())
        self.program = folder / self.job["programs"][0]["file"]
        self.text = self.program.read_text()

    def at(self, place):
        """The validated job with the pose moved that lies at ``place`` % of the program; 100: none."""
        lines = self.text.splitlines()
        motions = [k for k, line in enumerate(lines) if line.startswith(MOTION)]
        if place < 100:
            k = motions[len(motions) * place // 100]
            x, rest = lines[k][len(MOTION) :].split(",", 1)
            lines[k] = f"{MOTION}{float(x) + MOVED:.6f},{rest}"
        self.program.write_text("\n".join(lines) + "\n")
        self.path.write_text(json.dumps(self.job))
        return jobs.load(self.path)


class Stages(kept.Kept):
    """As it is, but what checkpoints take is told, and they may be forgotten."""

    forgets = False
    taken = 0  # bytes

    def find(self, stage, digest):
        return None if self.forgets else super().find(stage, digest)

    def put(self, stage, digest, value, size, reused):
        self.taken = size
        super().put(stage, digest, value, size, reused)


def run(job):
    """(result, ms of processor time)"""
    begin = time.process_time()
    result = runs.run(job)
    return result, 1000.0 * (time.process_time() - begin)


def bits(result):
    arrays = [result.field.height, *result.field.trace.values(), *result.steps.values()]
    return [np.asarray(array).tobytes() for array in arrays] + [json.dumps(result.events)]


def main(folder):
    changes = Changes(folder)
    size = runs.run(changes.at(100)).field.size
    changes.job["sampling"]["spacing_mm"] *= (size / SAMPLES) ** 0.5
    stages = Stages()
    took, costs, share = {}, [], checkpoints.SHARE

    def least(name, job):
        result, ms = run(job)
        took[name] = min(took.get(name, ms), ms)
        return result, ms

    with kept.instead(stages):
        runs.run(changes.at(100))  # prepares
        for _ in range(TIMES):
            for place in PLACES:
                checkpoints.SHARE = 0.0
                whole, without = least("start", changes.at(place))
                checkpoints.SHARE = share
                stages.forgets = True
                _, taken = least("checkpoints", changes.at(100))
                costs.append(100.0 * (taken / without - 1.0))
                stages.forgets = False
                assert stages.taken > 0, "nothing was kept"
                quick, _ = least(f"at_{place}", changes.at(place))
                again, _ = least("at_100", changes.at(place))
                assert bits(quick) == bits(again) == bits(whole), f"{place} %: another result"
    took["bytes"] = stages.taken / 1e6
    took["steps"] = len(whole.steps["time"])
    took["samples"] = whole.field.size
    took["cost"] = statistics.median(costs)
    return took


with TemporaryDirectory() as made_in:
    figures = main(Path(made_in))
units = {"bytes": "MB", "cost": "%", "steps": "", "samples": ""}
for name, value in figures.items():
    print(f"rerun_program/{name:18} {value:12.1f} {units.get(name, 'ms')}")
if figures["cost"] > MOST_COST:
    print(f"rerun_program/TOO SLOW: checkpoints must cost less than {MOST_COST:.0f} % of a run")
benchmarks = [
    {"name": f"rerun_program/{name}", "real_time": float(value), "time_unit": "ms"}
    for name, value in figures.items()
    if name not in units
]
Path(os.environ["BELTGRINDING_BENCH_OUT"]).write_text(
    json.dumps({"context": {}, "benchmarks": benchmarks})
)
