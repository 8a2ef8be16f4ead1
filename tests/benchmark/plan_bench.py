"""Plans of feeds on faces of the real parts of shared/data/cad, with even and uneven stock, before and after.

tools/bench plan [NAME] [--search]; `python plan_bench.py [NAME] [--search] [--json FILE]` does the same. A raster is laid with default
settings but a step-over of half the contact and poses every 3 mm; the stock is 0.3 mm, or 0.3 mm +- 0.15 mm in waves
of 40 to 90 mm; the tolerance +-0.05 mm; the feed, before, the default one. Columns:

before, feeds   of the area, in tolerance, %, before and with planned feeds
forces          the same where forces of 5 to 60 N are planned, too
one feed        the same with the one feed for all that leaves no more on the mean: what a calculation by hand gives
reached         of the area, that any motion removes something from, %
fringe          of the area, too much left beside where none does, %
cut             of what was reached and out of tolerance before, that is in tolerance with feeds and forces, %
rounds          simulations
plan            of a simulation's time, that planning takes between two of them, %
checked         with --search: forces, at half the spacing and step, %
searched        as forces, on passes that are searched for from there (`beltgrind grind`), %
searched cut    the same as cut, on those passes, %
"""

import argparse
import json
import math
import os
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]

from beltgrinding import planning
from beltgrinding.engine import InputError, core
from beltgrinding.inspection import verdict as verdicts
from beltgrinding.job import load as jobs, poses, workpiece
from beltgrinding.planning import grinding
from beltgrinding.raster import raster_path
from beltgrinding.simulation import run as runs

PARTS = Path(os.environ.get("BELTGRINDING_SHARED", ROOT.parent / "shared")) / "data" / "cad"
SETS = (
    ("blade_marine_upper", [1]),
    ("blade_airfoil_periodic", [1]),
    ("casting_3flange_open_shell", [9]),
    ("crank_arm", [2]),
    ("housing_with_spout", [93]),
    ("propeller_3blade", [38]),
    ("pump_cover", [6]),
    ("pump_cover", [1]),
)
WHEEL = {"radius_mm": 20, "width_mm": 15, "crown_radius_mm": 60}
FORCE, STOCK, WAVES = 30.0, 0.3, 0.15  # N, mm, mm
SAMPLES = 25_000
RASTER = {"step_over_share": 0.5, "max_distance_mm": 3.0}
HEAD = ("before", "one feed", "feeds", "forces", "reached", "fringe", "cut", "rounds", "plan", "s")
SEARCHED = ("checked", "searched", "searched cut")
FORCES = {"force_min_N": 5.0, "force_max_N": 60.0, "timing": "job"}


def uneven(shape, faces, folder):
    """A PLY file of the faces with uneven stock: waves of 40 to 90 mm in three directions."""
    area = sum(shape.face_area(k - 1) for k in faces)
    field, _ = core.sample_faces(shape, [k - 1 for k in faces], math.sqrt(area / 60_000))
    points = np.asarray(field.points)
    waves = sum(
        np.sin(2 * math.pi * (points @ np.array(way)) / length + phase)
        for way, length, phase in (
            ((1.0, 0.0, 0.0), 40.0, 0.3),
            ((0.0, 0.8, 0.6), 63.0, 1.1),
            ((0.3, -0.5, 0.81), 90.0, 2.0),
        )
    )
    height = STOCK + WAVES * waves / 3.0 * 1.5
    points = points + height[:, None] * np.asarray(field.normals)
    triangles = np.asarray(field.triangles)
    path = Path(folder) / "stock.ply"
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.zeros(len(triangles), dtype=[("n", "u1"), ("k", "<i4", 3)])
    rows["n"], rows["k"] = 3, triangles
    path.write_bytes(head.encode() + points.astype("<f4").tobytes() + rows.tobytes())
    return path


def job_of(file, faces, stock):
    """(validated job with its raster, poses every 3 mm)."""
    shape = workpiece.read_design({"file": str(file), "unit_mm": 1.0})
    area = sum(shape.face_area(k - 1) for k in faces)
    given = {
        "design": {"file": str(file), "faces": faces},
        "sampling": {"spacing_mm": min(math.sqrt(area / SAMPLES), 1.0)},
        "stock": stock,
        "belt_machine": {"wheel": WHEEL, "force_N": FORCE},
        "cell": {"check_collisions": False},
        "programs": [{"poses": []}],
    }
    laid = raster_path.raster(jobs.validate(given), RASTER)
    given["programs"] = [{"poses": poses.list_poses(laid)}]
    return jobs.validate(given)


def measure(file, faces, stock, search):
    """The figures of HEAD, and where it is searched of SEARCHED."""
    begun = time.perf_counter()
    job = job_of(file, faces, stock)
    feeds = planning.plan(job, {"check": False, "timing": "job"}).after.summary[
        "in_tolerance_area_share"
    ]
    plan = planning.plan(job, {**FORCES, "check": search})
    before, after = plan.before, plan.after
    areas, reached = np.asarray(before.field.areas, dtype=float), plan.why["reached"]
    rounds = [one for one in plan.rounds if "planning_seconds" in one]
    share = sum(r["planning_seconds"] for r in rounds) / sum(
        r["seconds"] - r["planning_seconds"] for r in rounds
    )
    found = {
        "before": 100.0 * plan.rounds[0]["in_tolerance"],
        "one feed": 100.0 * hand(plan),
        "feeds": 100.0 * feeds,
        "forces": 100.0 * after.summary["in_tolerance_area_share"],
        "reached": 100.0 * areas[reached].sum() / areas.sum(),
        "fringe": 100.0 * plan.why["shares"]["fringe"],
        "cut": cut(plan),
        "rounds": len(plan.rounds),
        "plan": 100.0 * share,
        "s": time.perf_counter() - begun,
    }
    if search:
        searched = grinding.grind(job, RASTER, FORCES).plan
        found["checked"] = 100.0 * plan.checked["after"]["in_tolerance"]
        found["searched"] = 100.0 * searched.after.summary["in_tolerance_area_share"]
        found["searched cut"] = cut(searched)
    return found


def cut(plan):
    """Of the area that the plan's motions reach and that was out of tolerance, what no longer is, %."""
    lower, upper = verdicts.limits(plan.before.job, plan.before.field)
    areas = np.asarray(plan.before.field.areas, dtype=float)

    def out(result):
        height = np.asarray(result.field.height)
        return areas[plan.why["reached"] & ((height < lower) | (height > upper))].sum()

    was = out(plan.before)
    return 100.0 * (was - out(plan.after)) / max(was, 1e-12)


def hand(plan):
    """Share in tolerance with one feed for all: the mean of what is reached comes into the middle of the band."""
    before = plan.before
    lower, upper = verdicts.limits(before.job, before.field)
    areas, reached = np.asarray(before.field.areas, dtype=float), plan.why["reached"]
    excess = np.asarray(before.field.height, dtype=float) - 0.5 * (lower + upper)
    more = (areas * excess)[reached].sum() / before.summary["removed_volume_mm3"]
    feeds = plan.old / max(1.0 + more, 0.05)
    return runs.run(plan.commands.with_feeds(feeds)).summary["in_tolerance_area_share"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name", nargs="?", default="", help="only parts whose name has this in it")
    parser.add_argument("--search", action="store_true", help="check, and search for passes, too")
    parser.add_argument("--json", help="file for Google Benchmark's JSON")
    arguments = parser.parse_args()
    if not PARTS.is_dir():
        print(f"plan: no data at {PARTS}")
        return
    head = HEAD + (SEARCHED if arguments.search else ())
    print(
        f"| part | faces | stock | {' | '.join(head)} |\n|{' --- |' * (len(head) + 3)}", flush=True
    )
    benchmarks = []
    for name, faces in SETS:
        if arguments.name not in name:
            continue
        file = next(f for f in sorted(PARTS.iterdir()) if f.stem == name)
        shape = workpiece.read_design({"file": str(file), "unit_mm": 1.0})
        with tempfile.TemporaryDirectory() as folder:
            stocks = {
                "even": {"allowance_mm": STOCK},
                "uneven": {"kind": "mesh", "file": str(uneven(shape, faces, folder))},
            }
            for kind, stock in stocks.items():
                label = f"{name} | {', '.join(map(str, faces))} | {kind}"
                try:
                    found = measure(file, faces, stock, arguments.search)
                except InputError as error:
                    print(f"| {label} |{' |' * len(head)} {error}", flush=True)
                    continue
                cells = [f"{v:.1f}" if isinstance(v, float) else str(v) for v in found.values()]
                print(f"| {label} | {' | '.join(cells)} |", flush=True)
                row = {"name": f"plan/{name}/{faces}/{kind}", "real_time": found.pop("s")}
                benchmarks.append({**row, "time_unit": "s", **found})
    if arguments.json:
        Path(arguments.json).write_text(json.dumps({"context": {}, "benchmarks": benchmarks}))


if __name__ == "__main__":
    main()
