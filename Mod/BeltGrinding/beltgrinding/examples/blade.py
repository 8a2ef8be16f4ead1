"""Example: a compressor blade whose pressure side is ground on a belt, tool in hand.

``make(folder)`` writes blade.step, blade_pressure_side.src and job.json. Needs FreeCAD's Part.
"""

import json
from pathlib import Path

import numpy as np

from ..programs.writers.writer import write_program
from .aerofoil import blade_sides

ROOT_BLOCK = (90.0, 50.0, 25.0)  # mm: length, depth, height of the root
ALLOWANCE = 0.3  # mm
FORCE = 30.0  # N
FEED = 50.0  # mm/s
BELT_SPEED = 20.0  # m/s
PASSES = 10
WHEEL = {"radius_mm": 40, "width_mm": 16, "crown_radius_mm": 60}
RETRACT = 30.0  # mm along the normal before and after a pass
POSES_A_PASS = 25
MARGIN = 0.08  # of the span, kept clear of the root's corner and of the tip


def shape():
    """(solid, number of its pressure side from 1)."""
    import FreeCAD
    import Part

    def spline(points):
        curve = Part.BSplineCurve()
        curve.interpolate([FreeCAD.Vector(*point) for point in points])
        return curve.toShape()

    def wire(low, high):
        edge = Part.makeLine(FreeCAD.Vector(*low[-1]), FreeCAD.Vector(*high[-1]))
        return Part.Wire([spline(low), edge, spline(high[::-1])])

    pressure, suction = blade_sides()
    foil = Part.makeLoft([wire(low, high) for low, high in zip(pressure, suction)], True, False)
    length, depth, height = ROOT_BLOCK
    corner = FreeCAD.Vector(-0.5 * length, -0.5 * depth, 1.0 - height)
    solid = Part.makeBox(length, depth, height, corner).fuse(foil).removeSplitter().Solids[0]
    middle = pressure[len(pressure) // 2]
    probe = Part.Vertex(*middle[len(middle) // 2])
    face = min(range(len(solid.Faces)), key=lambda i: solid.Faces[i].distToShape(probe)[0])
    return solid, face + 1


def passes(face):
    """Spanwise passes over the face, side by side along the chord: list of (n, 4, 4), mm.

    z goes into the work, x along the span (the belt's travel and the feed).
    """
    u0, u1, v0, v1 = face.ParameterRange
    result = []
    for k in range(PASSES):
        u = u0 + (u1 - u0) * (k + 0.5) / PASSES
        spans = np.linspace(v0 + MARGIN * (v1 - v0), v1 - MARGIN * (v1 - v0), POSES_A_PASS)
        poses = []
        for v in spans if k % 2 == 0 else spans[::-1]:
            point = np.array(face.valueAt(u, v))
            z = -np.array(face.normalAt(u, v))
            x = np.array(face.tangentAt(u, v)[1])
            x -= (x @ z) * z
            x /= np.linalg.norm(x)
            pose = np.eye(4)
            pose[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
            pose[:3, 3] = point - ALLOWANCE * z
            poses.append(pose)
        result.append(np.array([_lifted(poses[0]), *poses, _lifted(poses[-1])]))
    return result


def _lifted(pose):
    lifted = pose.copy()
    lifted[:3, 3] -= RETRACT * pose[:3, 2]
    return lifted


def make(folder):
    """Writes the example to ``folder``; returns the path of its job.json."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    solid, face = shape()
    solid.exportStep(str(folder / "blade.step"))
    write_program(
        folder / "blade_pressure_side.src",
        None,
        [{"poses": poses, "feed_mm_s": FEED} for poses in passes(solid.Faces[face - 1])],
        comment="pressure side of the example blade",
    )
    area = solid.Faces[face - 1].Area
    chord = area / 120.0
    # As much as the passes together should take off, by Hammann's law with the step-over as width.
    coefficient = ALLOWANCE * FEED * (chord / PASSES) / (1000.0 * BELT_SPEED * FORCE)
    job = {
        "schema": 1,
        "design": {"file": "blade.step", "faces": [face]},
        "sampling": {"spacing_mm": 0.3},
        "stock": {"kind": "allowance", "allowance_mm": ALLOWANCE},
        "belt_machine": {"wheel": WHEEL, "belt_speed_m_s": BELT_SPEED, "force_N": FORCE},
        "law": {"model": "local_linear", "coefficient_mm2_per_N": round(coefficient, 8)},
        "programs": [{"file": "blade_pressure_side.src"}],
        "inspection": {"tolerance_mm": [-0.05, 0.05], "colour_limit_mm": 0.3},
    }
    (folder / "job.json").write_text(json.dumps(job, indent=2, allow_nan=False) + "\n")
    return folder / "job.json"
