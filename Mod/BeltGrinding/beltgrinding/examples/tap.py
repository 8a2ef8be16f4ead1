"""Example: a mixer tap whose spout a robot holds against a belt machine, part in hand.

``make(folder)`` writes tap.step, tap_spout.src and job.json. Needs FreeCAD's Part.
"""

import json
import math
from pathlib import Path

import numpy as np

from ..base import frames
from ..programs.writers.writer import write_program
from . import passes, surfaces

# The spout's profile, seen from the side, mm: x forward, z up. Each section lies between two of these.
UPPER = (
    (19, 116),
    (18.5, 102),
    (20, 88),
    (28, 73),
    (43, 64),
    (64, 59),
    (92, 55.5),
    (122, 53),
    (152, 50),
)
LOWER = (
    (-21, 110),
    (-21.5, 94),
    (-21.5, 77),
    (-20.5, 60),
    (-12, 43),
    (20, 34),
    (64, 34),
    (106, 31),
    (147, 27),
)
HALF_WIDTHS = (20.0, 20.5, 21.0, 21.5, 21.5, 21.0, 20.0, 19.0, 18.0)  # mm, across
EXPONENTS = (2.0, 2.0, 2.0, 2.0, 2.05, 2.1, 2.15, 2.2, 2.2)  # of the sections' superellipses
POINTS = 48  # round a section
SECTOR = 105.0  # degrees, both ways from the top, of what is ground
FOOT = (21.0, 50.0)  # mm: radius and height of the foot
FLANGE = (27.0, 6.0)  # mm: radius and height of the plate that it stands on
CARTRIDGE = (16.0, 24.0)  # mm: radius and depth of the bore under the lever
AERATOR = (5.0, 12.0)  # mm: the same of the bore in the spout's end

ALLOWANCE = 0.2  # mm
FORCE = 25.0  # N
BELT_SPEED = 25.0  # m/s, brass
COEFFICIENT = 0.000125  # mm2/N, the job's default
PASSES = 16
POSES_A_PASS = 60
MARGIN = 0.02  # of a pass, kept clear of both ends
INSET = 0.5  # mm, kept clear of both borders of the ground face
RETRACT = 25.0  # mm
WHEEL = {"radius_mm": 37.5, "width_mm": 12}
RIM = {"youngs_modulus_MPa": 1.7, "rim_thickness_mm": 10}  # 40 Shore A, by Gent's formula
TOLERANCE = [-0.05, 0.05]  # mm

ROBOT = "kuka_kr16_2"
HOLDING = "part_in_hand"
# The wheel stands before the robot, its contact towards it; the belt runs upwards there. The tool centre
# point is the middle of the tap's plate, in a gripper that stands askew on the flange.
CELL = {
    "base_from_work": None,
    "tcp_from_contact": None,
    "tcp_from_work": None,
    "base_from_contact": {"position_mm": [1000, 0, 900], "abc_deg": [0, -90, 0]},
}
FLANGE_FROM_TCP = {"position_mm": [0, 0, 180], "abc_deg": [0, 32, 0]}


def section(k):
    """Points (POINTS, 3) round the section k, from the top on; mm."""
    upper, lower = np.array(UPPER[k], dtype=float), np.array(LOWER[k], dtype=float)
    angle = np.linspace(0.0, 2.0 * math.pi, POINTS, endpoint=False)
    power = 2.0 / EXPONENTS[k]
    up = np.sign(np.cos(angle)) * np.abs(np.cos(angle)) ** power
    side = np.sign(np.sin(angle)) * np.abs(np.sin(angle)) ** power
    x, z = (0.5 * (upper + lower) + 0.5 * np.outer(up, upper - lower)).T
    return np.stack([x, HALF_WIDTHS[k] * side, z], axis=1)


def shape():
    """(solid, number of the spout's ground face from 1)."""
    import FreeCAD
    import Part

    ground = 2 * round(SECTOR / 360.0 * POINTS)  # steps from point to point round the ground face
    outlines = [np.roll(section(k), ground // 2, axis=0) for k in range(len(UPPER))]
    curves = [surfaces.pieces(outline, (0, ground)) for outline in outlines]
    at = surfaces.stations([outline.mean(axis=0) for outline in outlines])
    faces = [surfaces.skin(side, at) for side in zip(*curves)]
    spout = surfaces.closed(faces, (curves[0], curves[-1]))
    up = FreeCAD.Vector(0, 0, 1)
    foot = Part.makeCylinder(*FOOT, FreeCAD.Vector(0, 0, 0), up)
    solid = spout.fuse(foot)
    for outline, (radius, depth) in ((outlines[0], CARTRIDGE), (outlines[-1], AERATOR)):
        inward = _inward(outline, outlines[len(outlines) // 2])
        solid = solid.cut(
            Part.makeCylinder(radius, depth, FreeCAD.Vector(*outline.mean(axis=0)), inward)
        )
    flange = Part.makeCylinder(*FLANGE, FreeCAD.Vector(0, 0, 0), up)
    rim = [edge for edge in flange.Edges if edge.Closed and edge.CenterOfMass.z > 1.0]
    solid = solid.fuse(flange.makeFillet(2.0, rim)).removeSplitter().Solids[0]
    return solid, surfaces.nearest_face(
        solid, UPPER[len(UPPER) // 2][:1] + (0,) + UPPER[len(UPPER) // 2][1:]
    )


def _inward(outline, inside):
    """The unit normal of a flat end, towards the points ``inside``."""
    import FreeCAD

    middle = outline.mean(axis=0)
    normal = np.linalg.svd(outline - middle)[2][2]
    return FreeCAD.Vector(*(normal * np.sign(normal @ (inside.mean(axis=0) - middle))))


def strokes(face):
    """Passes along the spout, side by side round it; as ``passes.motions`` takes them."""
    points, normals, tangents = lines_along(face, PASSES, POSES_A_PASS)
    feeds = passes.feed(COEFFICIENT, BELT_SPEED, FORCE, ALLOWANCE, passes.widths(points, tangents))
    return there_and_back(points + ALLOWANCE * normals, normals, tangents, feeds)


def lines_along(face, count, poses, margin=MARGIN):
    """Points, outward normals and tangents (count, poses, 3) of lines along the spout, side by side round it."""
    low, high = face.ParameterRange[2:]
    margin *= high - low
    along = np.linspace(low + margin, high - margin, poses)
    across = passes.evenly(face, count, 0.5 * (low + high), (INSET, INSET))
    points, normals = passes.lines(face, across, along)
    return points, normals, np.gradient(points, axis=1)


def there_and_back(points, normals, travels, feeds):
    """Passes with the belt's travel along ``travels``, every second one backwards."""
    result = []
    for k in range(len(points)):
        contacts = passes.contact_frames(points[k], normals[k], travels[k])
        way = slice(None) if k % 2 == 0 else slice(None, None, -1)
        result.append({"contacts": contacts[way], "feeds": feeds[k][way]})
    return result


def make(folder):
    """Writes the example to ``folder``; returns the path of its job.json."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    solid, face = shape()
    solid.exportStep(str(folder / "tap.step"))
    cell = {name: frames.from_data(frame) for name, frame in CELL.items()}
    write_program(
        folder / "tap_spout.src",
        None,
        passes.motions(strokes(solid.Faces[face - 1]), RETRACT, {"holding": HOLDING, **cell}),
        comment="spout of the example tap, held against the belt",
    )
    job = {
        "schema": 1,
        "design": {"file": "tap.step", "faces": [face]},
        "sampling": {"spacing_mm": 0.35},
        "stock": {"kind": "allowance", "allowance_mm": ALLOWANCE},
        "belt_machine": {
            "wheel": WHEEL,
            "compliance": RIM,
            "belt_speed_m_s": BELT_SPEED,
            "force_N": FORCE,
        },
        "law": {"model": "local_linear", "coefficient_mm2_per_N": COEFFICIENT},
        "cell": {"holding": HOLDING, **{name: frame for name, frame in CELL.items() if frame}},
        "robot": {"preset": ROBOT, "flange_from_tcp": FLANGE_FROM_TCP},
        "programs": [{"file": "tap_spout.src"}],
        "inspection": {"tolerance_mm": TOLERANCE, "colour_limit_mm": ALLOWANCE},
    }
    (folder / "job.json").write_text(json.dumps(job, indent=2, allow_nan=False) + "\n")
    return folder / "job.json"
