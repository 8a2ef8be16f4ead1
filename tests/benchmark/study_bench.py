"""Runs of a study a second, by one worker process and by two: the second must bring 1.8 times as many.

tools/bench study; `python study_bench.py [--runs N] [--json FILE]` does the same. The job is a plate of 60 x 40 mm under one
pass; what varies are its force and where the part lies. Counted from the first tenth of the runs on: by then all workers are
there and warm. Rates need a machine on which nothing else runs; processor seconds hardly: w a run in the workers and o beside them
(of who asked) let two workers on two cores make at most 2 w / (w + o) times as many runs as one.
"""

import argparse
import json
import os
import tempfile
import time
from pathlib import Path

import numpy as np


from beltgrinding.engine import core
from beltgrinding.studies import making
from support.workers import worker_processes

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


def processor_s(pid):
    """Processor seconds of a process, with those of its children that have ended."""
    words = Path("/proc", str(pid), "stat").read_text().rpartition(")")[2].split()
    return sum(map(int, words[11:15])) / os.sysconf("SC_CLK_TCK")


def spent():
    """(processor s of the workers, of this process) until now."""
    return sum(map(processor_s, worker_processes(os.getpid()))), time.process_time()


def rate(given, workers):
    """(runs a second in warm workers, processor s of a run in them, beside them, bytes of the table)."""
    runs, marks = given["design"]["runs"], []

    def told(progress):
        warm = progress.done >= max(2, WARM * runs) and not marks
        if warm or progress.done == runs:
            marks.append((time.perf_counter(), progress.done, *spent()))

    with tempfile.TemporaryDirectory() as folder:
        making.TOLD_S = 0.0
        found = making.study(given, folder, workers=workers, told=told)
        if not found.table.done.all():
            raise SystemExit(f"runs failed: {set(found.table['error'].tolist())}")
        data = found.table.csv_bytes()
    seconds, made, there, beside = np.subtract(marks[-1], marks[0])
    return made / seconds, there / made, beside / made, data


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=120)
    parser.add_argument("--spacing", type=float, default=0.3, help="mm")
    parser.add_argument("--json")
    arguments = parser.parse_args()
    given = study(arguments.runs, arguments.spacing)
    rates, there, beside, tables = zip(*(rate(given, workers) for workers in (1, 2)))
    ratio = rates[1] / rates[0]
    print(f"study/1_worker  {rates[0]:.2f} runs/s")
    print(f"study/2_workers {rates[1]:.2f} runs/s")
    print(f"study/ratio     {ratio:.2f} (goal {GOAL})")
    for workers, w, o in zip((1, 2), there, beside):
        text = f"{1e3 * w:.1f} ms of processor a run, {1e3 * o:.1f} ms beside"
        print(f"study/processor, {workers} worker(s): {text}; at most {2 * w / (w + o):.2f} by two")
    print(f"study/tables    {'equal' if tables[0] == tables[1] else 'DIFFERENT'}")
    if arguments.json:
        found = [
            {
                "name": f"study/workers:{workers}",
                "real_time": 1000.0 / each,
                "time_unit": "ms",
                "runs_per_second": each,
                "processor_ms": 1000.0 * w,
                "processor_ms_beside": 1000.0 * o,
            }
            for workers, each, w, o in zip((1, 2), rates, there, beside)
        ]
        report = {"context": {}, "benchmarks": found}
        Path(arguments.json).write_text(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
