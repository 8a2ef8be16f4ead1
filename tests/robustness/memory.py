"""Grinds a plate of ten million samples, writes the result, and prints what that took: one line of JSON.

    memory.py FOLDER [SPACING_MM]
"""

import json
import resource
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "Mod" / "BeltGrinding"))
import beltgrinding  # noqa: E402
from beltgrinding.engine import core  # noqa: E402

LENGTH, WIDTH = 400.0, 250.0  # mm
DOWN = {"qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0, "z_mm": 0.2, "feed_mm_s": 100}


def plate_job(spacing):
    corners = [[0, 0, 0], [LENGTH, 0, 0], [LENGTH, WIDTH, 0], [0, WIDTH, 0]]
    triangles = [[0, 1, 2], [0, 2, 3]]
    mesh = core.TriangleMesh(np.array(corners, np.float32), np.array(triangles, np.uint32))
    ways = [(x, y) for y in (60, 125, 190) for x in (20, 380)]
    return {
        "design": {"brep": core.shape_from_mesh(mesh).write_brep()},
        "sampling": {"spacing_mm": spacing},
        "stock": {"allowance_mm": 0.3},
        "belt_machine": {"wheel": {"radius_mm": 100, "width_mm": 40}},
        "programs": [{"poses": [{"x_mm": x, "y_mm": y, **DOWN} for x, y in ways]}],
    }


def main():
    folder, spacing = sys.argv[1], float((sys.argv[2:] or ["0.1"])[0])
    begin = time.perf_counter()
    result = beltgrinding.run(plate_job(spacing))
    result.write(folder)
    told = {
        "samples": result.summary["samples"],
        "seconds": time.perf_counter() - begin,
        "peak_GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e9,
    }
    print(json.dumps(told))


main()
