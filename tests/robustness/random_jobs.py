"""Random small jobs, also absurd ones, on the parts of BELTGRINDING_SHARED and on a box."""

import math
import os
import random
from pathlib import Path

import numpy as np

from beltgrinding.engine import core
from beltgrinding.base import frames
from beltgrinding.job import workpiece, load as jobs

SHARED = Path(os.environ.get("BELTGRINDING_SHARED", "/nowhere")) / "data"
SAMPLES = 1500  # of a job, more or less
BIGGEST = 2_000_000  # bytes of a part: reading it is not what is tested here
MODELS = ("wheel_rim", "bonded_layer", "half_space", "elastic_foundation", "geometric")
ABSURD = (0.0, 1e-12, 1e-6, 1e6, 1e12, -1.0, 1e300)  # one of them for a number of the job
BOX = "a box"
NOWHERE = dict.fromkeys(("x_mm", "y_mm", "z_mm", "qx", "qy", "qz"), 0.0) | {"qw": 1.0}
NO_PROGRAM = [{"poses": [NOWHERE, NOWHERE]}]  # a job without any does not pass


def parts():
    """Files of real parts, in a lasting order; and the box."""
    files = [p for name in ("cad", "cad_nasty") for p in sorted((SHARED / name).glob("*.*"))]
    return [p for p in files if p.stat().st_size <= BIGGEST] + [BOX]


def box():
    """The core.Shape of a box of 40 x 30 x 10 mm, faceted."""
    corners = np.array([(x, y, z) for z in (0, 10) for y in (0, 30) for x in (0, 40)], np.float32)
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return core.shape_from_mesh(core.TriangleMesh(corners, np.array(triangles, np.uint32)))


def random_job(number, places=None):
    """Job ``number``: the same each time, on the same ``places`` (as ``parts`` gives them). Raises
    InputError where the part itself cannot be read or sampled.
    """
    dice = random.Random(number)
    part = dice.choice(places or parts())
    design = {"brep": box().write_brep()} if part == BOX else {"file": str(part)}
    shape = workpiece.read_design(
        jobs.validate({"design": design, "programs": NO_PROGRAM})["design"]
    )
    count = shape.face_count
    faces = sorted(dice.sample(range(1, count + 1), min(count, dice.choice((1, 1, 2, 5)))))
    area = sum(shape.face_area(face - 1) for face in faces)
    spacing = max(math.sqrt(area / SAMPLES), 1e-4) if math.isfinite(area) else 1.0
    size = spacing * math.sqrt(SAMPLES)  # mm, of a square as large
    job = {
        "design": {**design, "faces": faces, "flip_normals": dice.random() < 0.1},
        "sampling": {"spacing_mm": spacing, "depth_mm": _spread(dice, 0.02 * size)},
        "stock": {"allowance_mm": dice.choice((0.0, 0.1, 0.3, _spread(dice, 0.01 * size)))},
        "belt_machine": _machine(dice, size),
        "law": _law(dice),
        "simulation": {"max_travel_mm": max(size / 40, 1e-3), "max_angle_deg": 5.0},
        "programs": NO_PROGRAM,
    }
    if dice.random() < 0.3:
        job["simulation"].update(timing="trapezoidal")
    field = workpiece.make_field(jobs.validate(job), shape, [], core.RunContext())
    count = dice.choice((1, 1, 2))
    job["programs"] = [{"poses": _poses(dice, field, size)} for _ in range(count)]
    if dice.random() < 0.15:
        _make_absurd(dice, job)
    return job


def _spread(dice, middle):
    """A number within a factor of 100 of ``middle``."""
    return middle * 10.0 ** dice.uniform(-2.0, 2.0)


def _machine(dice, size):
    model = dice.choice(MODELS)
    wheel = {"radius_mm": _spread(dice, size), "width_mm": _spread(dice, 0.3 * size)}
    if dice.random() < 0.2:
        wheel["crown_radius_mm"] = dice.uniform(0.45, 20.0) * wheel["width_mm"]
    control = "position" if model == "geometric" else dice.choice(("force", "force", "position"))
    return {
        "wheel": wheel,
        "belt_speed_m_s": min(max(_spread(dice, 20.0), 0.1), 200.0),
        "control": control,
        "force_N": _spread(dice, 40.0),
        "force_travel_mm": _spread(dice, 0.1 * size),
        "robot_stiffness_N_per_mm": dice.choice((0.0, 300.0)),
        "contact_spacing_mm": max(_spread(dice, wheel["width_mm"] / 20), 0.02 * size),
        "compliance": {
            "model": model,
            "youngs_modulus_MPa": _spread(dice, 5.0),
            "poissons_ratio": dice.choice((0.0, 0.3, 0.45, 0.49)),
            "rim_thickness_mm": wheel["radius_mm"] * dice.uniform(0.05, 0.5),
            "stiffness_MPa_per_mm": dice.choice((0.0, 0.5)),
        },
    }


def _law(dice):
    law = {"coefficient_mm2_per_N": _spread(dice, 1e-4), "model": "local_linear"}
    if dice.random() < 0.4:
        law.update(
            model="local",
            pressure_exponent=dice.uniform(0.3, 3.0),
            pressure_threshold_MPa=dice.choice((0.0, 0.02)),
            saturation_pressure_MPa=dice.choice((0.0, 0.5)),
            speed_exponent=dice.uniform(0.0, 2.0),
        )
    elif dice.random() < 0.2:
        law["model"] = "hammann"
    if dice.random() < 0.3:
        law["wear"] = {"model": "exponential", "scale": _spread(dice, 1e4), "rest": 0.2}
    return law


def _poses(dice, field, size):
    """A few poses: on the surface, beside it, in it, tilted, or anywhere."""
    points, normals = field.points, field.normals
    rows = []
    at = dice.randrange(field.size)
    for _ in range(dice.randint(2, 6)):
        anywhere = dice.random() < 0.08
        if not anywhere:  # a place not far from the last
            near = np.linalg.norm(points - points[at], axis=1) < 0.5 * size
            at = int(dice.choice(np.flatnonzero(near)))
        z = -np.array(normals[at], dtype=float)
        if anywhere or dice.random() < 0.3:  # tilted; anyhow
            z = z + dice.choice((0.1, 0.5, 5.0)) * np.array([dice.gauss(0, 1) for _ in range(3)])
        z /= np.linalg.norm(z)
        x = np.cross(z, [dice.gauss(0, 1) for _ in range(3)])
        x /= np.linalg.norm(x)
        turn = np.column_stack([x, np.cross(z, x), z])
        w = frames.to_quaternions(turn[None])[0]
        offset = dice.choice((0.0, 0.0, dice.gauss(0, 0.02 * size), dice.gauss(0, size)))
        place = points[at] + offset * z
        row = dict(zip(("x_mm", "y_mm", "z_mm"), map(float, place)))
        row.update(zip(("qw", "qx", "qy", "qz"), map(float, w)))
        row["feed_mm_s"] = _spread(dice, 2.0 * size)
        if dice.random() < 0.2:
            row["force_N"] = dice.choice((0.0, _spread(dice, 40.0)))
        if dice.random() < 0.1:
            row["rapid"] = True
        rows.append(row)
    return rows


def _make_absurd(dice, job):
    """Changes one number somewhere to what nobody would want."""
    numbers = [place for place in _numbers(job) if "design" not in place]
    *way, key = dice.choice(numbers)
    holder = job
    for step in way:
        holder = holder[step]
    holder[key] = dice.choice(ABSURD)


def _numbers(value, way=()):
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, one in items:
        if isinstance(one, (dict, list)):
            yield from _numbers(one, (*way, key))
        elif isinstance(one, (int, float)) and not isinstance(one, bool):
            yield (*way, key)
