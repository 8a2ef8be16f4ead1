"""Example: a chef's knife, one side of whose blade a robot grinds on a belt machine, part in hand.

The robot speeds up and slows down. ``make(folder)`` writes knife.step, knife_side.script and job.json.
Needs FreeCAD's Part.
"""

import json
from pathlib import Path

import numpy as np

from ..base import frames
from ..programs.writers.writer import write_program
from . import passes, surfaces

# Heel to tip, mm: x; z of the edge; z of the spine; thickness at the spine.
STATIONS = (
    (0, 0.0, 46.0, 3.4), (14, 0.0, 46.0, 3.3), (40, 0.0, 46.0, 3.1), (80, 0.6, 45.5, 2.8), (115, 3.2, 44.5, 2.5),
    (145, 7.5, 43.2, 2.3), (170, 14.5, 41.4, 2.1), (190, 22.5, 39.0, 1.9),
)  # fmt: skip
RICASSO = 1  # number of the station up to which the blade is not ground
EDGE = 0.4  # mm, thickness of the edge before it is honed
POINTS = 9  # of a section, from the edge to the spine
ROUND = 0.8  # exponent of the thickness over the height: below 1 the side is convex
HANDLE = (118.0, 21.0, 30.0, 9.0)  # mm: length, width, height, radius of its edges
OVERLAP = 4.0  # mm of the blade that lie in the handle

ALLOWANCE = 0.1  # mm
FORCE = 8.0  # N
BELT_SPEED = 25.0  # m/s, stainless steel
COEFFICIENT = 0.000125  # mm2/N, the job's default
WHEEL = {"radius_mm": 50, "width_mm": 14}
RIM = {"youngs_modulus_MPa": 1.7, "rim_thickness_mm": 12}  # 40 Shore A, by Gent's formula
PASSES = 9
POSES_A_PASS = 40
HEEL, TIP = 4.5, 2.0  # mm, kept clear of both ends of the ground side
INSETS = (0.5, 0.5)  # mm, kept clear of edge and spine
RETRACT = 25.0  # mm
TOLERANCE = [-0.03, 0.03]  # mm

ROBOT = "ur10e"
HOLDING = "part_in_hand"
# The wheel stands before the robot, its contact towards it; the belt runs downwards there. The knife's
# handle is in the gripper, its tip points away from the flange.
CELL = {
    "base_from_work": None,
    "tcp_from_contact": None,
    "tcp_from_work": {"position_mm": [23, 0, 100], "abc_deg": [0, -90, 0]},
    "base_from_contact": {"position_mm": [750, 0, 450], "abc_deg": [0, 90, 180]},
}
FLANGE_FROM_TCP = {"position_mm": [0, 0, 120]}


def shape():
    """(solid, number of the blade's ground side from 1)."""
    import FreeCAD
    import Part

    up = np.linspace(0.0, 1.0, POINTS)
    sections = []
    for x, edge, spine, thickness in STATIONS:
        y = 0.5 * (EDGE + (thickness - EDGE) * up**ROUND)
        right = np.stack([np.full(POINTS, x), -y, edge + up * (spine - edge)], axis=1)
        left = right * (1, -1, 1)
        corners = (
            right,
            np.linspace(right[-1], left[-1], 3),
            left[::-1],
            np.linspace(left[0], right[0], 3),
        )
        sections.append([surfaces.side(points) for points in corners])
    at = [station[0] for station in STATIONS]
    faces = []
    for part in (slice(0, RICASSO + 1), slice(RICASSO, None)):
        faces += [surfaces.skin(curves, at[part]) for curves in zip(*sections[part])]
    blade = surfaces.closed(faces, (sections[0], sections[-1]))
    length, width, height, radius = HANDLE
    corner = FreeCAD.Vector(OVERLAP - length, -0.5 * width, STATIONS[0][2] - height + 4.0)
    handle = Part.makeBox(length, width, height, corner)
    handle = handle.makeFillet(
        radius, [edge for edge in handle.Edges if edge.BoundBox.XLength > 1.0]
    )
    solid = handle.fuse(blade).Solids[0]
    x, edge, spine, thickness = STATIONS[len(STATIONS) // 2]
    return solid, surfaces.nearest_face(solid, (x, -0.5 * thickness, 0.5 * (edge + spine)))


def strokes(face):
    """Passes from heel to tip and back, side by side from the edge to the spine."""
    low, high = face.ParameterRange[2:]
    along = np.linspace(low + HEEL, high - TIP, POSES_A_PASS)
    across = passes.evenly(face, PASSES, 0.5 * (low + high), INSETS)
    points, normals = passes.lines(face, across, along)
    tangents = np.gradient(points, axis=1)
    feeds = passes.feed(COEFFICIENT, BELT_SPEED, FORCE, ALLOWANCE, passes.widths(points, tangents))
    result = []
    for k in range(PASSES):
        contacts = passes.contact_frames(
            points[k] + ALLOWANCE * normals[k], normals[k], tangents[k]
        )
        way = slice(None) if k % 2 == 0 else slice(None, None, -1)
        result.append({"contacts": contacts[way], "feeds": feeds[k][way]})
    return result


def make(folder):
    """Writes the example to ``folder``; returns the path of its job.json."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    solid, face = shape()
    solid.exportStep(str(folder / "knife.step"))
    cell = {name: frames.from_data(frame) for name, frame in CELL.items()}
    write_program(
        folder / "knife_side.script",
        None,
        passes.motions(strokes(solid.Faces[face - 1]), RETRACT, {"holding": HOLDING, **cell}),
        tools=frames.from_data(FLANGE_FROM_TCP),
        bases=np.eye(4),
        comment="one side of the example knife",
    )
    job = {
        "schema": 1,
        "design": {"file": "knife.step", "faces": [face]},
        "sampling": {"spacing_mm": 0.25},
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
        "programs": [{"file": "knife_side.script"}],
        "simulation": {"timing": "trapezoidal"},
        "inspection": {"tolerance_mm": TOLERANCE, "colour_limit_mm": ALLOWANCE},
    }
    (folder / "job.json").write_text(json.dumps(job, indent=2, allow_nan=False) + "\n")
    return folder / "job.json"
