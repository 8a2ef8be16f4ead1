"""Example: a compressor blade with a fillet at its root and both edges round, ground on both sides.

The tool is in the robot's hand. ``make(folder)`` writes vane.step, vane.mod and job.json. Needs FreeCAD's
Part.
"""

import json
import math
from pathlib import Path

import numpy as np

from ..base import frames
from ..programs.writers.writer import write_program
from . import passes, surfaces
from .aerofoil import STATIONS, placed, section

PLATFORM = (92.0, 58.0, 14.0)  # mm: length, depth, height
FILLET = 5.0  # mm, radius
MEETS = math.radians(15.0)  # at which the fillet meets the platform: tangent faces are hard to cut
FILLET_SECTIONS = 7
FOIL_SECTIONS = 9
ROUND = 7  # points round the trailing edge, between those of the two sides
CLOSE = 4  # points of each side at the trailing edge that lie too close for a smooth end
EDGE = 8  # points of a side that belong to the edge

ALLOWANCE = 0.2  # mm
FORCE = 15.0  # N
BELT_SPEED = 12.0  # m/s, titanium
COEFFICIENT = 0.000125  # mm2/N, the job's default
WHEEL = {"radius_mm": 25, "width_mm": 10}
RIM = {"youngs_modulus_MPa": 1.7, "rim_thickness_mm": 12}  # 40 Shore A, by Gent's formula
PASSES = 26  # on each side
POSES_A_PASS = 30
INSETS = (1.5, 0.5)  # mm, kept clear of the fillet and of the tip
LEADING, TRAILING = 2.5, 2.5  # mm, how far a pass goes straight on from the side over the edge
RETRACT = 25.0  # mm
OVER = 100.0  # mm over the tip, on the way from one side to the other
TOLERANCE = [-0.06, 0.06]  # mm

BASE_FROM_WORK = {"position_mm": [900, 0, 600]}  # the fixture before the robot
FLANGE_FROM_TCP = {"position_mm": [0, 0, 260]}  # the belt machine in its hand


def outline(low, high):
    """A closed section: the pressure side ``low`` from the trailing to the leading edge, the suction side
    ``high`` back, a half circle round the trailing edge; (n, 3) mm, and the numbers of the points at which
    pressure side, leading edge, suction side and trailing edge begin.
    """
    low, high = low[:-CLOSE], high[:-CLOSE]
    middle = 0.5 * (low[-1] + high[-1])
    out = 0.5 * (high[-1] - low[-1])
    back = middle - 0.5 * (low[-2] + high[-2])
    back *= np.linalg.norm(out) / np.linalg.norm(back)
    angle = np.linspace(0.0, math.pi, ROUND + 2)[1:-1, None]
    bend = middle + np.cos(angle) * out + np.sin(angle) * back
    points = np.concatenate([low[::-1], high[1:], bend])
    count = len(low)
    return np.roll(points, -EDGE, axis=0), (
        0,
        count - 1 - 2 * EDGE,
        count - 1,
        2 * (count - 1) - 2 * EDGE,
    )


def outline_at(height):
    """``outline`` at a height over the platform, mm; in the fillet widened as a quarter circle asks for."""
    columns = np.array(STATIONS).T
    chord, thickness, lift, stagger = (
        np.interp(height, columns[0], column) for column in columns[1:]
    )
    low, high = (placed(side, chord, stagger, height) for side in section(chord, thickness, lift))
    points, borders = outline(low, high)
    ways = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    outward = np.stack([ways[:, 1], -ways[:, 0], np.zeros(len(ways))], axis=1)
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    area = 0.5 * np.sum(
        points[:, 0] * np.roll(points[:, 1], -1) - points[:, 1] * np.roll(points[:, 0], -1)
    )
    below = max(FILLET - height, 0.0)
    widened = FILLET - math.sqrt(FILLET**2 - below**2)
    return points + math.copysign(widened, area) * outward, borders


def shape():
    """(solid, numbers from 1 of its ground faces: pressure side, leading edge, suction side, trailing
    edge).
    """
    import FreeCAD
    import Part

    turns = np.linspace(0.5 * MEETS, 0.5 * math.pi, FILLET_SECTIONS)
    fillet = FILLET * (1.0 - np.cos(turns))
    foil = np.linspace(FILLET, STATIONS[-1][0], FOIL_SECTIONS)
    parts = []
    for heights, at in ((fillet, FILLET * turns), (foil, foil)):
        outlines = [outline_at(height) for height in heights]
        curves = [surfaces.pieces(*one) for one in outlines]
        parts.append((curves, [surfaces.skin(side, at) for side in zip(*curves)]))
    (bottom, low), (top, high) = parts
    body = surfaces.closed([*low, *high], (bottom[0], top[-1]))
    length, depth, height = PLATFORM
    top_of_it = FILLET * (1.0 - math.cos(MEETS))
    corner = FreeCAD.Vector(-0.5 * length, -0.5 * depth, top_of_it - height)
    solid = Part.makeBox(length, depth, height, corner).fuse(body).Solids[0]
    points, borders = outline_at(0.5 * STATIONS[-1][0])
    ends = [*borders[1:], len(points)]
    middles = [points[(first + last) // 2] for first, last in zip(borders, ends)]
    return solid, [surfaces.nearest_face(solid, middle) for middle in middles]


def strokes(face, leading_last):
    """Passes along the chord of one side, from the platform to the tip; as ``passes.motions`` takes them.
    ``leading_last``: whether the face's first parameter runs towards the leading edge.
    """
    low, high = face.ParameterRange[:2]
    across = passes.evenly(face, PASSES, 0.5 * (low + high), INSETS, swapped=True)
    along = np.linspace(low, high, POSES_A_PASS)
    points, normals = passes.lines(face, across, along, swapped=True)
    for length, at_end in ((LEADING, leading_last), (TRAILING, not leading_last)):
        points, normals = passes.run_out(points, normals, length, at_end)
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


def above(contact):
    """A contact frame over the tip, where the wheel passes from one side to the other."""
    frame = contact.copy()
    frame[:3, 3] -= OVER * frame[:3, 2]
    frame[2, 3] = STATIONS[-1][0] + OVER
    return frame


def make(folder):
    """Writes the example to ``folder``; returns the path of its job.json."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    solid, faces = shape()
    solid.exportStep(str(folder / "vane.step"))
    cell = {
        "base_from_work": frames.from_data(BASE_FROM_WORK),
        "tcp_from_contact": np.eye(4),
        "tcp_from_work": np.eye(4),
        "base_from_contact": np.eye(4),
    }
    pressure = strokes(solid.Faces[faces[0] - 1], True)
    suction = strokes(solid.Faces[faces[2] - 1], False)[
        ::-1
    ]  # from the tip, where the other side ends
    suction[0]["before"] = [above(pressure[-1]["contacts"][-1]), above(suction[0]["contacts"][0])]
    write_program(
        folder / "vane.mod",
        None,
        passes.motions([*pressure, *suction], RETRACT, {"holding": "tool_in_hand", **cell}),
        tools=frames.from_data(FLANGE_FROM_TCP),
        bases=np.eye(4),
        comment="both sides of the example blade with fillet and edges",
    )
    job = {
        "schema": 1,
        "design": {"file": "vane.step", "faces": sorted(faces)},
        "sampling": {"spacing_mm": 0.35},
        "stock": {"kind": "allowance", "allowance_mm": ALLOWANCE},
        "belt_machine": {
            "wheel": WHEEL,
            "compliance": RIM,
            "belt_speed_m_s": BELT_SPEED,
            "force_N": FORCE,
        },
        "law": {"model": "local_linear", "coefficient_mm2_per_N": COEFFICIENT},
        "cell": {"holding": "tool_in_hand", "base_from_work": BASE_FROM_WORK},
        "programs": [{"file": "vane.mod"}],
        "inspection": {"tolerance_mm": TOLERANCE, "colour_limit_mm": ALLOWANCE},
    }
    (folder / "job.json").write_text(json.dumps(job, indent=2, allow_nan=False) + "\n")
    return folder / "job.json"
