"""A square plate and the job that grinds its top: what benchmarks of whole runs grind."""

import numpy as np

from beltgrinding.engine import core

SIDE, THICKNESS = 500.0, 10.0  # mm
ALLOWANCE = 0.2  # mm
LANES = 20
DOWN = {"qw": 0.0, "qx": 1.0, "qy": 0.0, "qz": 0.0}
SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6))


def plate(side=SIDE):
    """A core.Shape, mm; its top lies in z = 0."""
    corners = [[x, y, z] for z in (-THICKNESS, 0.0) for y in (0.0, side) for x in (0.0, side)]
    triangles = [half for a, b, c, d in SIDES for half in ((a, b, c), (a, c, d))]
    mesh = core.TriangleMesh(np.array(corners, np.float32), np.array(triangles, np.uint32))
    return core.shape_from_mesh(mesh)


def top(shape):
    """Its number from 1."""
    for face in range(shape.face_count):
        field, _ = core.sample_faces(shape, [face], THICKNESS / 4)
        if field.points[:, 2].min() > -1e-6:
            return face + 1
    raise AssertionError("the plate has no top")


def plate_job(samples, lanes=LANES, side=SIDE):
    """A job that grinds the plate's top, of about so many samples, in lanes side by side."""
    shape, poses = plate(side), []
    for k in range(lanes):
        ends = (5.0, side - 5.0)[:: 1 if k % 2 == 0 else -1]
        y = side * (k + 0.5) / lanes
        poses += [
            {"x_mm": x, "y_mm": y, "z_mm": ALLOWANCE, **DOWN, "feed_mm_s": 50.0} for x in ends
        ]
    return {
        "design": {"brep": shape.write_brep(), "faces": [top(shape)]},
        "sampling": {"spacing_mm": side / samples**0.5},
        "stock": {"allowance_mm": ALLOWANCE},
        "belt_machine": {
            "wheel": {"radius_mm": 100, "width_mm": 22},
            "compliance": {"model": "elastic_foundation"},
            "force_N": 60,
        },
        "simulation": {"max_travel_mm": 5.0},
        "programs": [{"poses": poses}],
    }
