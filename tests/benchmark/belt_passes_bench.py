"""Passes laid for a free belt on real parts, beside those that are laid for a wheel, and at 0.7 of the belt's width; the
belt grinds them all.

tools/bench belt_passes [NAME]; `python belt_passes_bench.py [NAME]` does the same. Faces as in parts_bench.py, the largest free-form
one and the largest cylinder or cone. Columns, over the faces' whole area:

left     standard deviation of what is removed, by its mean: what stays of an allowance that comes off on the mean
untouched  of the area, %
reach    of the area that the belt gets to by its own passes, %
"""

import argparse
import math

import numpy as np
import parts_bench as parts

from beltgrinding.engine import InputError
from beltgrinding.job import load as jobs, poses, workpiece
from beltgrinding.raster import raster_path
from beltgrinding.simulation import run as runs

BELT = {"width_mm": 30, "length_mm": 200, "tension_N_per_mm": 3, "roller_radius_mm": 20}
WHEEL = {"radius_mm": 40, "width_mm": 30}
FORCE = 15.0  # N
SAMPLES = 8_000
WAYS = "belt", "wheel", "width"


def job_of(design, shape, faces, belt):
    area = sum(shape.face_area(k - 1) for k in faces)
    machine = {"wheel": WHEEL, "force_N": FORCE}
    if belt:
        machine.update(kind="free_belt", free_run=BELT, force_travel_mm=30, contact_spacing_mm=2.0)
    return {
        "design": {**design, "faces": faces},
        "sampling": {"spacing_mm": math.sqrt(area / SAMPLES)},
        "belt_machine": machine,
        "cell": {"check_collisions": False},
        "simulation": {"max_travel_mm": 4.0, "max_angle_deg": 8.0},
        "programs": [{"poses": []}],
    }


def measure(design, shape, faces, way):
    """dict(left, untouched, reach, passes) of one way."""
    given = {"belt_angle_deg": 90}
    if way == "width":
        given["step_over_mm"] = 0.7 * BELT["width_mm"]
    laid = raster_path.raster(jobs.validate(job_of(design, shape, faces, way != "wheel")), given)
    job = jobs.validate(job_of(design, shape, faces, True))
    job["programs"] = [{"poses": poses.list_poses(laid)}]
    field = runs.run(jobs.validate(job)).field
    removed = np.nan_to_num(np.asarray(field.stock_height - field.height, dtype=float))
    weight = field.areas / field.areas.sum()
    mean = (removed * weight).sum()
    spread = math.sqrt(((removed - mean) ** 2 * weight).sum())
    return {
        "left": spread / mean if mean > 0 else math.inf,
        "untouched": 100.0 * weight[removed <= 0.0].sum(),
        "reach": 100.0 * laid["reachable"]["share"],
        "passes": len(laid["passes"]),
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("name", nargs="?", default="", help="only parts whose name has this in it")
    arguments = parser.parse_args()
    if not parts.PARTS.is_dir():
        print(f"belt_passes: no data at {parts.PARTS}")
        return
    print("| part | faces | passes for | left | untouched | reach | passes |")
    print("| --- | --- | --- | --- | --- | --- | --- |", flush=True)
    for file in sorted(parts.PARTS.iterdir()):
        if arguments.name not in file.name:
            continue
        design = {"file": str(file), "unit_mm": parts.UNITS.get(file.stem, 1.0)}
        shape = workpiece.read_design(design)
        some = parts.chosen(shape)
        for name in ("free-form", "round"):
            for way in WAYS if name in some else ():
                label = f"{name}: {', '.join(map(str, some[name]))}"
                try:
                    found = measure(design, shape, some[name], way)
                except InputError as error:
                    print(f"| {file.stem} | {label} | {way} | {error} |", flush=True)
                    continue
                print(
                    f"| {file.stem} | {label} | {way} | {found['left']:.2f} | {found['untouched']:.0f} | "
                    f"{found['reach']:.0f} | {found['passes']} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
