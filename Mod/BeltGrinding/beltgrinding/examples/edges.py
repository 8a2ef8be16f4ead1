"""Example: both edges of a compressor blade, ground round by passes along the span that go round the noses.

The tool is in the robot's hand. ``make(folder)`` writes edges.step, edges.src and job.json. Needs FreeCAD's Part.
"""

import json
import math
from pathlib import Path

import numpy as np

from ..programs.writers.writer import write_program
from . import passes, surfaces

NOSES = (0.2, 0.15)  # mm, radii of leading and trailing edge
CHORD = 40.0  # mm
SIDE = 110.0  # mm, radius of both sides, tangent to the noses
SPAN = 30.0  # mm
ROOT = (50.0, 16.0, 10.0)  # mm: length, depth, height

ALLOWANCE = 0.1  # mm
FORCE = 1.0  # N
BELT_SPEED = 10.0  # m/s
COEFFICIENT = 0.000125  # mm2/N, the job's default
WHEEL = {"radius_mm": 20, "width_mm": 10}
RIM = {"youngs_modulus_MPa": 1.7, "rim_thickness_mm": 8}  # 40 Shore A, by Gent's formula
PASSES = 9  # round each nose
TURN = math.radians(75.0)  # of the outer passes from the middle one
FEEDS = (125.0, 165.0)  # mm/s, of the passes on the crowns
SLOWER = 0.8  # power of the cosine of the turn, by which the passes nearer to the flanks are slower
CLEAR = 3.0  # mm over the root
OVER = 4.0  # mm beyond the tip
RETRACT = 20.0  # mm
TOLERANCE = [-0.05, 0.05]  # mm, on the noses
SIDES = [-0.05, 0.15]  # mm: the sides keep their stock for another wheel


def centres():
    """Middles of both noses and of the upper side, (2,) each, mm; the leading edge's tip is at x = 0."""
    first, last = np.array([NOSES[0], 0.0]), np.array([CHORD - NOSES[1], 0.0])
    long, a, b = last[0] - first[0], SIDE - NOSES[0], SIDE - NOSES[1]
    x = 0.5 * (a**2 - b**2 + long**2) / long
    return first, last, first + (x, -math.sqrt(a**2 - x**2))


def shape():
    """(solid, numbers from 1 of its ground faces: leading edge, upper side, trailing edge, lower side)."""
    import FreeCAD
    import Part

    first, last, upper = centres()
    top = [c + r * (c - upper) / np.linalg.norm(c - upper) for c, r in zip((first, last), NOSES)]
    crown = upper + (0.0, SIDE)
    mirror = np.array([1.0, -1.0])
    arcs = [
        (top[0] * mirror, (0.0, 0.0), top[0]),
        (top[0], crown, top[1]),
        (top[1], (CHORD, 0.0), top[1] * mirror),
        (top[1] * mirror, crown * mirror, top[0] * mirror),
    ]
    place = lambda p: FreeCAD.Vector(float(p[0]), float(p[1]), -1.0)
    edges = [Part.Arc(*(place(p) for p in arc)).toShape() for arc in arcs]
    foil = Part.Face(Part.Wire(edges)).extrude(FreeCAD.Vector(0, 0, SPAN + 1.0))
    length, depth, height = ROOT
    corner = FreeCAD.Vector(0.5 * (CHORD - length), -0.5 * depth, -height)
    solid = Part.makeBox(length, depth, height, corner).fuse(foil).Solids[0]
    middles = [(*arc[1], 0.5 * SPAN) for arc in arcs]
    return solid, [surfaces.nearest_face(solid, middle) for middle in middles]


def strokes():
    """Passes along the span, from flank to flank round each nose; as ``passes.motions`` takes them."""
    along = np.array([CLEAR, SPAN + OVER])
    result = []
    for nose, radius, feed, middle in zip(centres(), NOSES, FEEDS, (math.pi, 0.0)):
        for k, turn in enumerate(np.linspace(-TURN, TURN, PASSES)):
            angle = middle + turn
            normal = np.array([math.cos(angle), math.sin(angle), 0.0])
            points = np.append(nose, 0.0) + (radius + ALLOWANCE) * normal
            points = points + along[:, None] * (0.0, 0.0, 1.0)
            both = np.tile(normal, (2, 1))
            tangents = np.tile((0.0, 0.0, 1.0), (2, 1))
            contacts = passes.contact_frames(points, both, tangents)
            way = slice(None) if k % 2 == 0 else slice(None, None, -1)
            result.append(
                {"contacts": contacts[way], "feeds": np.full(2, feed * math.cos(turn) ** SLOWER)}
            )
    return result


def make(folder):
    """Writes the example to ``folder``; returns the path of its job.json."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    solid, faces = shape()
    solid.exportStep(str(folder / "edges.step"))
    cell = {name: np.eye(4) for name in ("base_from_work", "tcp_from_contact", "tcp_from_work")}
    cell["base_from_contact"] = np.eye(4)
    write_program(
        folder / "edges.src",
        None,
        passes.motions(strokes(), RETRACT, {"holding": "tool_in_hand", **cell}),
        comment="both edges of the example blade",
    )
    middle = {"point_mm": [0.5 * CHORD, 0, 0.5 * SPAN + 0.1], "normal": [0, 0, 1]}
    job = {
        "schema": 1,
        "design": {"file": "edges.step", "faces": sorted(faces)},
        "sampling": {"spacing_mm": 0.5},
        "stock": {"kind": "allowance", "allowance_mm": ALLOWANCE},
        "belt_machine": {
            "wheel": WHEEL,
            "compliance": RIM,
            "belt_speed_m_s": BELT_SPEED,
            "force_N": FORCE,
        },
        "law": {"model": "local_linear", "coefficient_mm2_per_N": COEFFICIENT},
        "programs": [{"file": "edges.src"}],
        "inspection": {
            "tolerance_mm": SIDES,
            "colour_limit_mm": ALLOWANCE,
            "zones": [{"name": "noses", "faces": [faces[0], faces[2]], "tolerance_mm": TOLERANCE}],
            "sections": [
                {"name": "mid span", **middle, "leading": [-1, 0, 0], "edge_distances_mm": [0.5, 1]}
            ],
        },
    }
    (folder / "job.json").write_text(json.dumps(job, indent=2, allow_nan=False) + "\n")
    return folder / "job.json"
