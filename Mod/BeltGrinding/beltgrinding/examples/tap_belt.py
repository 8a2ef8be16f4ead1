"""Example: the spout of the mixer tap, finished on a free belt that wraps round it, part in hand.

``make(folder)`` writes tap.step, tap_belt.src and job.json. Needs FreeCAD's Part.
"""

import json
from pathlib import Path

import numpy as np

from ..base import frames
from ..presets import library as presets
from ..programs.writers.writer import write_program
from . import passes, tap

MACHINE = "free_belt_40"  # preset
ALLOWANCE = 0.05  # mm
TOLERANCE = [-0.03, 0.03]  # mm
FORCE = 30.0  # N
FORCE_TRAVEL = 30.0  # mm: the belt gives way by many times what a wheel does
BELT_SPEED = 18.0  # m/s
PASSES = 9
POSES_A_PASS = 24
MARGIN = 0.11  # of a pass, kept clear of both ends: half the belt hangs over there
SPACING = 0.5  # mm, of samples
CELL = 2.0  # mm, of the contact: a free belt takes several times a wheel's time
MAX_TRAVEL, MAX_ANGLE = 5.0, 5.0  # mm and degrees of a step
RETRACT = 60.0  # mm: clear of the belt and its rollers

# The belt runs level before the robot, from its right to its left, the contact towards it: across the spout.
CONTACT = {"position_mm": [1050, 0, 900], "abc_deg": [90, 0, -90]}


def strokes(face):
    """Passes along the spout, side by side round it, the belt across them; as ``passes.motions`` takes them."""
    points, normals, tangents = tap.lines_along(face, PASSES, POSES_A_PASS, MARGIN)
    widths = passes.widths(points, tangents)
    feeds = passes.feed(tap.COEFFICIENT, BELT_SPEED, FORCE, ALLOWANCE, widths)
    return tap.there_and_back(points, normals, np.cross(tangents, normals), feeds)


def make(folder):
    """Writes the example to ``folder``; returns the path of its job.json."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    solid, face = tap.shape()
    solid.exportStep(str(folder / "tap.step"))
    cell = {name: frames.from_data(None) for name in tap.CELL}
    cell["base_from_contact"] = frames.from_data(CONTACT)
    write_program(
        folder / "tap_belt.src",
        None,
        passes.motions(strokes(solid.Faces[face - 1]), RETRACT, {"holding": tap.HOLDING, **cell}),
        comment="spout of the example tap, held against a free belt",
    )
    job = {
        "schema": 1,
        "design": {"file": "tap.step", "faces": [face]},
        "sampling": {"spacing_mm": SPACING},
        "stock": {"kind": "allowance", "allowance_mm": ALLOWANCE},
        "belt_machine": {
            "belt_speed_m_s": BELT_SPEED,
            "force_N": FORCE,
            "force_travel_mm": FORCE_TRAVEL,
            "contact_spacing_mm": CELL,
        },
        "law": {"model": "local_linear", "coefficient_mm2_per_N": tap.COEFFICIENT},
        "simulation": {"max_travel_mm": MAX_TRAVEL, "max_angle_deg": MAX_ANGLE},
        "cell": {"holding": tap.HOLDING, "base_from_contact": CONTACT},
        "robot": {"preset": tap.ROBOT, "flange_from_tcp": tap.FLANGE_FROM_TCP},
        "programs": [{"file": "tap_belt.src"}],
        "inspection": {"tolerance_mm": TOLERANCE, "colour_limit_mm": ALLOWANCE},
    }
    job = presets.apply(job, machine=MACHINE)
    (folder / "job.json").write_text(json.dumps(job, indent=2, allow_nan=False) + "\n")
    return folder / "job.json"
