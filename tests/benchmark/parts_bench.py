"""Raster paths with default settings on the real parts of shared/data/cad, laid and simulated.

tools/bench parts [NAME]; `python parts_bench.py [NAME] [--json FILE]` does the same. Faces of a part, by a
fixed rule: the largest free-form face, the largest cylinder or cone, the largest face of all, the face with
the most neighbours (holes, pockets), and the three largest faces together. Columns:

turn    largest turn between poses of a pass, degrees
/mm     fastest turn over the work there, degrees per mm
fast    pairs of poses above max_turn_deg or max_turn_deg_per_mm
back    reversals in contact
plunge  of the simulated removed volume, on the way down to passes and off them, %
ramp    of it, where the force has not its full value yet or no more, along the pass, %
left    of the area, left out because the wheel would stand in the part, %
reach   of the area that the wheel gets to, leaned if it must be, its belt as the passes want it, %
cover   of that area that the simulated contact touched, %
"""

import argparse
import json
import math
import os
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]

from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs, poses, workpiece
from beltgrinding.raster import path_check, raster_path, reachable
from beltgrinding.simulation import run as runs

PARTS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "cad"
WHEEL = {"radius_mm": 20, "width_mm": 15, "crown_radius_mm": 60}
FORCE = 30.0  # N
UNITS = {"hammer_claw": 0.001}  # mm, of files that are not in mm and do not say so
FREE_FORM = {"plane", "cylinder", "cone"}  # and all but these
SAMPLES = 15_000  # on the faces, at least
COARSEST = 1.5  # mm from sample to sample: the contact is some 6 mm across
SMALLEST = 20.0  # mm2; a face below it is none that one grinds
HEAD = (
    "turn",
    "/mm",
    "fast",
    "back",
    "plunge",
    "ramp",
    "left",
    "reach",
    "cover",
    "passes",
    "poses",
    "s",
)


def chosen(shape):
    """{name: faces from 1} by the rule above."""
    faces = [(shape.face_area(k), shape.surface_type(k), k) for k in range(shape.face_count)]
    faces = sorted((f for f in faces if f[0] >= SMALLEST), reverse=True)
    if not faces:
        return {}
    beside = shape.neighbours(core.RunContext())
    found = {"largest": [faces[0][2]]}
    for name, suits in (
        ("free-form", lambda kind: kind not in FREE_FORM),
        ("round", lambda kind: kind in {"cylinder", "cone"}),
    ):
        some = [k for _, kind, k in faces if suits(kind)]
        found[name] = some[:1]
    found["neighbours"] = [max((k for _, _, k in faces), key=lambda k: (len(beside[k]), -k))]
    found["three"] = [k for _, _, k in faces[:3]] if len(faces) > 2 else []
    told, unique = set(), {}
    for name, ks in found.items():
        if ks and tuple(ks) not in told:
            told.add(tuple(ks))
            unique[name] = [k + 1 for k in ks]
    return unique


def measure(design, shape, faces):
    """The figures of one set of faces, as in HEAD."""
    start = time.perf_counter()
    area = sum(shape.face_area(k - 1) for k in faces)
    job = jobs.validate(
        {
            "design": {**design, "faces": faces},
            "sampling": {"spacing_mm": min(math.sqrt(area / SAMPLES), COARSEST)},
            "belt_machine": {"wheel": WHEEL, "force_N": FORCE},
            "cell": {"check_collisions": False},
            "programs": [{"poses": []}],
        }
    )
    settings = raster_path.validate({})
    laid = raster_path.raster(job, settings)
    laid_s = time.perf_counter() - start
    found = path_check.check(job, settings, laid)
    job["programs"] = [{"poses": poses.list_poses(laid)}]
    ground = runs.run(jobs.validate(job))
    steps = ground.steps
    volume = np.bincount(
        steps["pose"], steps["removal_rate"] * steps["duration"], len(laid["frames"])
    )
    to = np.zeros(len(volume), dtype=bool)
    to[1:] = path_check.motion(laid)["within"]
    full = np.where(laid["forces"] < 0, FORCE, laid["forces"]) >= FORCE * (1 - 1e-9)
    seen = laid["places"]
    fits, areas = seen["fits"], seen["areas"]
    touched = ground.field.trace["peak_pressure"] > 0
    touched = touched[reachable.nearest(seen["points"], ground.field.points)]
    total = max(volume.sum(), 1e-12)
    return {
        "turn": found["turn_deg"],
        "/mm": math.inf if found["turn_deg_per_mm"] is None else found["turn_deg_per_mm"],
        "fast": found["fast_turns"],
        "back": found["reversals"],
        "plunge": 100.0 * volume[~to].sum() / total,
        "ramp": 100.0 * volume[to & ~full].sum() / total,
        "left": 100.0 * areas[seen["state"] == reachable.NO_ROOM].sum() / areas.sum(),
        "reach": 100.0 * areas[fits].sum() / areas.sum(),
        "cover": 100.0 * areas[fits & touched].sum() / max(areas[fits].sum(), 1e-12),
        "passes": found["passes"],
        "poses": found["poses"],
        "s": time.perf_counter() - start,
        "laid_s": laid_s,
        "path_s": found["duration_s"],
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name", nargs="?", default="", help="only parts whose name has this in it")
    parser.add_argument("--json", help="file for Google Benchmark's JSON")
    parser.add_argument("--only", default="", help="only this set of faces")
    arguments = parser.parse_args()
    if not PARTS.is_dir():
        print(f"parts: no data at {PARTS}")
        return
    print(f"| part | faces | {' | '.join(HEAD)} | |\n|{' --- |' * (len(HEAD) + 3)}", flush=True)
    benchmarks = []
    for file in sorted(PARTS.iterdir()):
        if arguments.name not in file.name:
            continue
        design = {"file": str(file), "unit_mm": UNITS.get(file.stem, 1.0)}
        shape = workpiece.read_design(design)
        for name, faces in chosen(shape).items():
            if arguments.only and arguments.only != name:
                continue
            label = f"{name}: {', '.join(map(str, faces))}"
            try:
                found = measure(design, shape, faces)
            except InputError as error:
                print(f"| {file.stem} | {label} |{' |' * len(HEAD)} {error} |", flush=True)
                continue
            cells = " | ".join(
                f"{found[key]}" if isinstance(found[key], int) else f"{found[key]:.1f}"
                for key in HEAD
            )
            print(f"| {file.stem} | {label} | {cells} | ok |", flush=True)
            row = {
                "name": f"parts/{file.stem}/{name}",
                "real_time": found.pop("s"),
                "time_unit": "s",
            }
            benchmarks.append({**row, **{key: float(value) for key, value in found.items()}})
    if arguments.json:
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": benchmarks}))


if __name__ == "__main__":
    main()
