"""Run by tools/bench scale: bytes a sample and seconds a part of a run, and what they make of very large jobs.

    PYTHONPATH=Mod/BeltGrinding:build/release/python python3 tests/benchmark/scale_bench.py [--samples N]

docs/scale.md has its figures. A job (ground_plate.py) is run, each time in a process of its own: one lane on a small plate, which
tells what a run costs before it has any samples to speak of; then N / 4 and N samples, whose difference is what a sample
costs, bytes of the peak and processor seconds of each phase, by one thread. What tells its phases in seconds of the clock (a
run) is scaled to its processor time, so that a busy machine may measure, too. The step's figures (``step_ms``) are the
engine's of the day.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

import beltgrinding
from beltgrinding.engine import core
from beltgrinding.simulation.result import Result
from ground_plate import LANES, SIDE, plate, plate_job, top

SMALL_SIDE = 40.0  # mm, of the plate that hardly takes time: one lane, samples 1 mm apart
MOST = 1_000_000
HUGE_SAMPLES = 1e9  # a ship's propeller, 10 m2 at HUGE_SPACING
HUGE_JOBS = 1e6
WORKER_BYTES = 64e9  # memory of a worker
STEP = ("localise", "gap", "contact", "removal", "trace", "events")  # phases of a step
HUGE_SPACING = 0.1  # mm
RADIUS, DEEP = (
    100.0,
    2.0,
)  # mm, of the wheel, and how deep it goes into stock and gives way, at most


def status(name):
    """Bytes, of /proc/self/status: VmRSS now, VmHWM at most so far."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(name + ":"):
            return 1024 * int(line.split()[1])
    raise KeyError(name)


def one(samples, lanes, side):
    """What a run of so many samples costs: dict, bytes and processor seconds."""
    core.set_threads(1)
    job = plate_job(samples, lanes, side)
    shape = plate(side)
    face = top(shape)
    bare = status("VmRSS")
    start = time.process_time()
    field, _ = core.sample_faces(shape, [face - 1], side / samples**0.5)
    sampling = time.process_time() - start
    found = {"samples": field.size, "bare": bare, "field": field.bytes, "sample_s": sampling}
    del field
    start, clock = time.process_time(), time.perf_counter()
    result = beltgrinding.run(job)
    found["run_s"] = time.process_time() - start
    share = found["run_s"] / (time.perf_counter() - clock)
    found["steps"] = result.summary["steps"]
    phases = result.summary["wall_time_s"]
    found["phases_s"] = {name: share * seconds for name, seconds in phases.items()}
    found["ground_field"] = result.field.bytes
    found["peak"] = status("VmHWM") - bare
    folder = Path(os.environ["BELTGRINDING_BENCH_FOLDER"]) / str(samples)
    start = time.process_time()
    result.write(folder)
    found["write_s"] = time.process_time() - start
    found["write_peak"] = status("VmHWM") - bare
    found["file"] = sum(path.stat().st_size for path in folder.iterdir())
    start = time.process_time()
    Result.read(folder)
    found["read_s"] = time.process_time() - start
    return found


def apart(folder, samples, lanes=LANES, side=SIDE):
    """``one`` in a process of its own, with its whole time and its processor time, s."""
    environment = {**os.environ, "BELTGRINDING_BENCH_FOLDER": folder}
    environment[
        "BELTGRINDING_KEPT_LIMIT_MB"
    ] = "0"  # what is kept for another run has a limit, and does not grow
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    done = subprocess.run(
        [sys.executable, __file__, "--one", *(str(value) for value in (samples, lanes, side))],
        env=environment,
        stdout=subprocess.PIPE,
        check=True,
    )
    found = json.loads(done.stdout)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    found["process_s"] = time.perf_counter() - start
    found["processor_s"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return found


def slope(few, many, *path):
    """What a sample adds of a figure."""
    low, high = few, many
    for key in path:
        low, high = low[key], high[key]
    return (high - low) / (many["samples"] - few["samples"])


def figures(least, few, many):
    """{name: (value, unit)}"""
    per_step = sum(many["phases_s"].get(name, 0.0) for name in STEP) / many["steps"]
    made = {
        "start_of_a_run": (least["process_s"], "s"),
        "start_of_a_run_cpu": (least["processor_s"], "s"),
        "field_bytes_a_sample": (slope(few, many, "field"), "B"),
        "ground_field_bytes_a_sample": (slope(few, many, "ground_field"), "B"),
        "peak_bytes_a_sample": (slope(few, many, "peak"), "B"),
        "write_peak_bytes_a_sample": (slope(few, many, "write_peak"), "B"),
        "files_bytes_a_sample": (slope(few, many, "file"), "B"),
        "sampling_ns_a_sample": (1e9 * slope(few, many, "sample_s"), "ns"),
        "write_ns_a_sample": (1e9 * slope(few, many, "write_s"), "ns"),
        "read_ns_a_sample": (1e9 * slope(few, many, "read_s"), "ns"),
        "step_ms": (1e3 * per_step, "ms"),
    }
    for name in STEP:
        made[f"step_{name}_ms"] = (1e3 * many["phases_s"].get(name, 0.0) / many["steps"], "ms")
    for phase in ("build", "verdict"):
        if phase in many["phases_s"]:
            made[f"{phase}_ns_a_sample"] = (1e9 * slope(few, many, "phases_s", phase), "ns")
    peak = made["write_peak_bytes_a_sample"][0]
    most = WORKER_BYTES / peak
    side = most**0.5 * HUGE_SPACING  # mm, of a square of them
    halo = (
        2.0 * RADIUS * DEEP
    ) ** 0.5  # mm around its own samples that the wheel touches with them
    made["samples_a_worker"] = (most, "")
    made["halo"] = (halo, "mm")
    made["halo_share"] = ((1 + 2 * halo / side) ** 2 - 1, "")
    made["huge_memory"] = (HUGE_SAMPLES * peak / 1e9, "GB")
    made["huge_workers"] = (HUGE_SAMPLES * (1 + made["halo_share"][0]) / most, "")
    made["huge_sampling"] = (made["sampling_ns_a_sample"][0] * HUGE_SAMPLES / 1e9 / 60, "min")
    made["huge_write"] = (made["write_ns_a_sample"][0] * HUGE_SAMPLES / 1e9 / 60, "min")
    made["huge_files"] = (made["files_bytes_a_sample"][0] * HUGE_SAMPLES / 1e9, "GB")
    made["jobs_start"] = (made["start_of_a_run_cpu"][0] * HUGE_JOBS / 3600 / 24, "processor days")
    return made


def main():
    import tempfile

    parser = argparse.ArgumentParser()
    parser.add_argument("--samples", type=float, default=MOST)
    parser.add_argument("--one", type=float, nargs=3, help=argparse.SUPPRESS)
    parser.add_argument("--json", help="file for the figures in Google Benchmark's form")
    arguments = parser.parse_args()
    if arguments.one is not None:
        samples, lanes, side = arguments.one
        json.dump(one(samples, int(lanes), side), sys.stdout)
        return
    with tempfile.TemporaryDirectory() as folder:
        runs = [
            apart(folder, SMALL_SIDE**2, 1, SMALL_SIDE),
            apart(folder, arguments.samples / 4),
            apart(folder, arguments.samples),
        ]
    made = figures(*runs)
    for name, (value, unit) in made.items():
        print(f"scale/{name:34} {value:14.4g} {unit}")
    print("phases of the largest run, s:", json.dumps(runs[-1]["phases_s"]))
    if arguments.json:
        benchmarks = [
            {"name": f"scale/{name}", "real_time": value, "time_unit": unit}
            for name, (value, unit) in made.items()
        ]
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": benchmarks}))


if __name__ == "__main__":
    main()
