"""Runs of a study a second, by one worker process and by two: the second must bring 1.8 times as many.

tools/bench study; `python study_bench.py [--runs N] [--json FILE]` does the same. The job is a plate of 60 x 40 mm under one
pass; what varies are its force and where the part lies. Counted from the first tenth of the runs on: by then all workers are
there and warm. Needs a machine on which nothing else runs.
"""

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Mod" / "BeltGrinding"))

from beltgrinding.engine import core  # noqa: E402
from beltgrinding.studies import making  # noqa: E402

GOAL = 1.8  # times one worker
WARM = 0.1  # of the runs
DOWN = {"qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}


def study(runs, spacing):
    """A study of so many runs of a plate, sampled ``spacing`` mm apart."""
    corners = np.array([[0, 0, 0], [60, 0, 0], [60, 40, 0], [0, 40, 0]], np.float32)
    plate = core.TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    poses = [{"x_mm": x, "y_mm": 20, "z_mm": 0.2, **DOWN, "feed_mm_s": 30} for x in (10, 50)]
    job = {
        "design": {"brep": core.shape_from_mesh(plate).write_brep()},
        "sampling": {"spacing_mm": spacing},
        "stock": {"allowance_mm": 0.2},
        "belt_machine": {"wheel": {"radius_mm": 60, "width_mm": 15}},
        "programs": [{"poses": poses}],
    }
    vary = [
        {"name": "force", "key": "belt_machine.force_N", "range": [20, 60]},
        {
            "key": "placement.z_mm",
            "distribution": {"kind": "normal", "mean": 0.0, "sd": 0.05},
        },
    ]
    return {"job": job, "vary": vary, "design": {"method": "sobol", "runs": runs}}


def rate(given, workers):
    """(runs a second in warm workers, bytes of the table)."""
    times = []

    def told(progress):
        times.append((time.perf_counter(), progress.done))

    with tempfile.TemporaryDirectory() as folder:
        making.TOLD_S = 0.0
        found = making.study(given, folder, workers=workers, told=told)
        if not found.table.done.all():
            raise SystemExit(f"runs failed: {set(found.table['error'].tolist())}")
        data = found.table.csv_bytes()
    runs = len(found.table)
    first = next(k for k, (_, done) in enumerate(times) if done >= max(2, WARM * runs))
    last = next(k for k, (_, done) in enumerate(times) if done == runs)
    seconds = times[last][0] - times[first][0]
    return (times[last][1] - times[first][1]) / seconds, data


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=120)
    parser.add_argument("--spacing", type=float, default=0.3, help="mm")
    parser.add_argument("--json")
    arguments = parser.parse_args()
    given = study(arguments.runs, arguments.spacing)
    rates, tables = zip(*(rate(given, workers) for workers in (1, 2)))
    ratio = rates[1] / rates[0]
    print(f"study/1_worker  {rates[0]:.2f} runs/s")
    print(f"study/2_workers {rates[1]:.2f} runs/s")
    print(f"study/ratio     {ratio:.2f} (goal {GOAL})")
    print(f"study/tables    {'equal' if tables[0] == tables[1] else 'DIFFERENT'}")
    if arguments.json:
        found = [
            {
                "name": f"study/workers:{workers}",
                "real_time": 1000.0 / each,
                "time_unit": "ms",
                "runs_per_second": each,
            }
            for workers, each in zip((1, 2), rates)
        ]
        report = {"context": {}, "benchmarks": found}
        Path(arguments.json).write_text(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
