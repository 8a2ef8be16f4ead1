"""The coarse resolution against the full one on real parts of shared/data/cad: time, and what it is off by.

tools/bench coarse [NAME] [--plan]; `python coarse_bench.py [NAME] [--plan] [--json FILE]` does the same. The largest
face of each part, its passes by default settings, samples for some 60,000 of them. Heights are compared at the full
run's samples, between the coarse ones by distance. With --plan each job is planned twice, searched in full and
coarsely; the shares are those of the full resolution. Columns:

apart    mm between samples, full and coarse
samples  of both
s        of processor time, full over coarse, when all that is kept is there
rms, max mm, of the difference of the heights farther than 3 mm from the faces' borders
border   mm, the largest one nearer to them
in       % of the area in tolerance, full and coarse
"""

import argparse
import json
import math
import time
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree


import parts_bench as parts
from beltgrinding.engine import core
from beltgrinding.job import load as jobs, poses, resolution, workpiece
from beltgrinding.planning import rounds
from beltgrinding.raster import raster_path
from beltgrinding.simulation import run as runs

PARTS = ("ball_valve_lever", "crank_arm", "propeller_3blade")
SAMPLES = 60_000
COEFFICIENT = 2e-5  # mm2/N: with it the force of parts_bench grinds some tenths of a millimetre
FAR = 3.0  # mm from a border
PLAN = {"rounds": 6, "check": False}


def job_of(file):
    """The part's largest face with passes on it."""
    design = {"file": str(file), "unit_mm": parts.UNITS.get(file.stem, 1.0)}
    shape = workpiece.read_design(design)
    faces = parts.chosen(shape)["largest"]
    area = sum(shape.face_area(face - 1) for face in faces)
    job = jobs.validate(
        {
            "design": {**design, "faces": faces},
            "sampling": {"spacing_mm": math.sqrt(area / SAMPLES)},
            "stock": {"allowance_mm": 0.2},
            "belt_machine": {"wheel": parts.WHEEL, "force_N": parts.FORCE},
            "law": {"coefficient_mm2_per_N": COEFFICIENT},
            "cell": {"check_collisions": False},
            "programs": [{"poses": []}],
        }
    )
    laid = raster_path.raster(job, raster_path.validate({}))
    job["programs"] = [{"poses": poses.list_poses(laid)}]
    return jobs.validate(job)


def measured(job):
    runs.run(job, resume=False)
    begin = time.process_time()
    result = runs.run(job, resume=False)
    return result, time.process_time() - begin


def compare(job):
    full, full_s = measured(job)
    coarse, coarse_s = measured(resolution.with_mode(job, resolution.COARSE))
    a, b = full.field, coarse.field
    distance, near = cKDTree(b.points).query(a.points, k=3)
    weight = 1.0 / np.maximum(distance, 1e-9)
    error = (b.height[near] * weight).sum(axis=1) / weight.sum(axis=1) - a.height
    border = a.points[(a.flags & core.ON_BOUNDARY) > 0]
    far = cKDTree(border).query(a.points)[0] > FAR if len(border) else np.ones(a.size, bool)
    areas = a.areas[far].astype(float)
    return {
        "full_apart": a.spacing,
        "coarse_apart": b.spacing,
        "full_samples": a.size,
        "coarse_samples": b.size,
        "full_s": full_s,
        "coarse_s": coarse_s,
        "rms": math.sqrt(np.average(error[far] ** 2, weights=areas)),
        "max": float(np.abs(error[far]).max()),
        "border": float(np.abs(error[~far]).max(initial=0.0)),
        "full_in": full.summary["in_tolerance_area_share"],
        "coarse_in": coarse.summary["in_tolerance_area_share"],
    }


def plans(job):
    """{mode: (share in tolerance, s of processor time)} of a plan searched at each resolution."""
    found = {}
    for mode in (resolution.FULL, resolution.COARSE):
        begin = time.process_time()
        plan = rounds.plan(job, {**PLAN, "search_resolution": mode})
        share = rounds.summary(plan)["after"]["in_tolerance"]
        found[mode] = share, time.process_time() - begin
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name", nargs="?", default="", help="only parts whose name has this in it")
    parser.add_argument("--plan", action="store_true", help="plan as well")
    parser.add_argument("--json", help="file for Google Benchmark's JSON")
    arguments = parser.parse_args()
    if not parts.PARTS.is_dir():
        print(f"coarse: no data at {parts.PARTS}")
        return
    print("| part | apart | samples | s | rms | max | border | in |\n|" + " --- |" * 8, flush=True)
    benchmarks = []
    for file in sorted(parts.PARTS.iterdir()):
        if file.stem not in PARTS or arguments.name not in file.stem:
            continue
        job = job_of(file)
        one = compare(job)
        print(
            "| {} | {full_apart:.2f}, {coarse_apart:.2f} | {full_samples}, {coarse_samples} | "
            "{full_s:.2f} / {coarse_s:.2f} = {ratio:.1f} | {rms:.4f} | {max:.3f} | {border:.3f} | {full_in:.1%}, "
            "{coarse_in:.1%} |".format(file.stem, ratio=one["full_s"] / one["coarse_s"], **one),
            flush=True,
        )
        if arguments.plan:
            for mode, (share, seconds) in plans(job).items():
                print(f"  planned, searched {mode}: {share:.2%} in tolerance, {seconds:.1f} s")
                one[f"{mode}_planned_in"], one[f"{mode}_plan_s"] = share, seconds
        row = {"name": f"coarse/{file.stem}", "real_time": one["coarse_s"], "time_unit": "s"}
        benchmarks.append({**row, **{key: float(value) for key, value in one.items()}})
    if arguments.json:
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": benchmarks}))


if __name__ == "__main__":
    main()
