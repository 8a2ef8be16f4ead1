"""A free belt or a platen: how the belt lies that touches nothing, its rollers, the plate and the layers on it; the belt's
runs beyond the rollers and the arms that hold these.

All is in the contact frame: its origin lies on the belt's outer face, x along the travel, z into the work. ``machine``: a
job's belt_machine with its defaults; lengths mm, angles rad. Places are mm along the belt's outer face from the origin.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from ..base import records
from ..base.kinds import Floats, Json, known
from ..job.settings import BeltMachine
from . import body_names
from .solids import Mesh, box, prism, strip

NAMES, ARMS = body_names.RUNS, body_names.ARMS
CHORD = 0.02  # mm, by which the chords of a curved plate leave it
GAP = 1.0  # mm between belt and arms
ARM = 0.6  # of the rollers' radius, that the arms reach beyond their axes
LEAST_ARM = 1.0  # mm, half of their width at the pulleys
STEEPEST = math.radians(60.0)  # of a curved plate's ends
SIDES = {"both": (-1.0, 1.0), "minus_y": (-1.0,), "plus_y": (1.0,)}  # of the arms


def arc(machine: BeltMachine | Json) -> tuple[float, float]:
    """(radius of the belt's outer face over a curved plate, angle by which it has turned at the plate's ends); (0, 0) of a
    flat one and of a free belt."""
    machine = records.made(BeltMachine, machine)
    platen = machine.platen
    if machine.kind != "platen" or platen is None or platen.radius_mm <= 0.0:
        return 0.0, 0.0
    radius = platen.radius_mm
    end = math.asin(min(0.5 * platen.length_mm / radius, 1.0))
    return radius + known(machine.free_run).thickness_mm, end


def length_on(machine: BeltMachine | Json) -> float:
    """mm of the belt's middle surface that lie on the plate."""
    machine = records.made(BeltMachine, machine)
    radius, end = arc(machine)
    if radius == 0.0:
        return known(machine.platen).length_mm
    return 2.0 * (radius - 0.5 * known(machine.free_run).thickness_mm) * end


def line(machine: BeltMachine | Json, places: ArrayLike, below: float = 0.0) -> Floats:
    """Points [x, z] (n, 2) of the belt at ``places`` (n,), ``below`` mm under its outer face."""
    machine = records.made(BeltMachine, machine)
    s = np.asarray(places, dtype=float)
    radius, end = arc(machine)
    if radius == 0.0:
        return np.stack([s, np.full(len(s), -float(below))], axis=1)
    turned = np.clip(s / radius, -end, end)
    beyond = s - radius * turned
    x = radius * np.sin(turned) + beyond * math.cos(end)
    sagitta = 2.0 * radius * np.sin(0.5 * turned) ** 2
    z = -sagitta - np.abs(beyond) * math.sin(end)
    return np.stack([x - below * np.sin(turned), z - below * np.cos(turned)], axis=1)


def ends(machine: BeltMachine | Json) -> tuple[float, float]:
    """Places at which the belt meets its two rollers."""
    machine = records.made(BeltMachine, machine)
    run = known(machine.free_run)
    half, shift = 0.5 * run.length_mm, run.position_mm
    # The free length is the middle surface's, which is shorter round a plate.
    longer = 0.5 * run.thickness_mm * arc(machine)[1]
    return -half - shift - longer, half - shift + longer


def face(machine: BeltMachine | Json, chord: float = CHORD) -> Floats:
    """Places (n,) from roller to roller between which the belt is straight to ``chord`` mm."""
    machine = records.made(BeltMachine, machine)
    first, last = ends(machine)
    radius, end = arc(machine)
    if radius == 0.0:
        return np.array([first, last])
    return np.r_[first, _angles(radius, end, chord) * radius, last]


def roller_axes(machine: BeltMachine | Json) -> Floats:
    """[x, z] (2, 2) of the rollers' axes: the belt's inner face lies on them."""
    machine = records.made(BeltMachine, machine)
    run = known(machine.free_run)
    return line(machine, ends(machine), run.thickness_mm + run.roller_radius_mm)


def plate(machine: BeltMachine | Json) -> Mesh:
    """(points (n, 3), triangles (m, 3)) of a platen's plate, behind its layers."""
    machine = records.made(BeltMachine, machine)
    thick = known(machine.platen).plate_thickness_mm
    behind = known(machine.free_run).thickness_mm + _layers_thick(machine)
    if arc(machine)[0] == 0.0:
        return _slab(machine, -behind - thick, -behind)
    top = _on_plate(machine, behind)
    return strip(top, top - [0.0, thick], 0.5 * known(machine.free_run).width_mm)


def layers(machine: BeltMachine | Json) -> list[Mesh]:
    """[(points (n, 3), triangles (m, 3))] of a platen's layers, from the plate outwards."""
    machine = records.made(BeltMachine, machine)
    behind, found = known(machine.free_run).thickness_mm + _layers_thick(machine), []
    for layer in known(machine.platen).layers:
        above = behind - layer.thickness_mm
        if arc(machine)[0] == 0.0:
            found.append(_slab(machine, -behind, -above))
        else:
            lines = _on_plate(machine, above), _on_plate(machine, behind)
            found.append(strip(*lines, 0.5 * known(machine.free_run).width_mm))
        behind = above
    return found


def _layers_thick(machine: BeltMachine) -> float:
    return sum(layer.thickness_mm for layer in known(machine.platen).layers)


def _slab(machine: BeltMachine, low: float, high: float) -> Mesh:
    half, long = 0.5 * known(machine.free_run).width_mm, 0.5 * known(machine.platen).length_mm
    return box([-long, -half, low], [long, half, high])


def _on_plate(machine: BeltMachine, below: float) -> Floats:
    radius, end = arc(machine)
    return line(machine, _angles(radius, end, CHORD) * radius, below)


def _angles(radius: float, end: float, chord: float) -> Floats:
    step = 2.0 * math.acos(max(1.0 - chord / radius, -1.0))
    return np.linspace(-end, end, max(2 * math.ceil(end / step), 2) + 1)


def has_runs(machine: BeltMachine | Json) -> bool:
    """Whether the belt's runs beyond the rollers are known, to the pulley or pulleys that they come from."""
    machine = records.made(BeltMachine, machine)
    return known(machine.frame).length_mm > 0.0


def short_frame(machine: BeltMachine | Json) -> float | None:
    """mm that the pulleys must be away from the rollers' axes at least, where they are nearer; else None."""
    machine = records.made(BeltMachine, machine)
    run = known(machine.free_run)
    least = run.roller_radius_mm + run.thickness_mm
    return least if has_runs(machine) and known(machine.frame).length_mm <= least else None


def run_corners(machine: BeltMachine | Json, side: float) -> Floats:
    """Corners [x, z] (4, 2) of the belt that comes to the roller before the contact (``side`` -1) or leaves the one behind
    it (1): where it leaves the roller and where it meets its pulley, outside, then inside."""
    machine = records.made(BeltMachine, machine)
    run, frame = known(machine.free_run), known(machine.frame)
    thick = run.thickness_mm
    axis = roller_axes(machine)[0 if side < 0 else 1]
    far = np.array([_middle(machine) + 0.5 * side * frame.spread_mm, _lowest(machine)])
    way = (far - axis) * [side, 1.0]  # as of the side 1
    radius = run.roller_radius_mm + thick
    square = float(way @ way)
    # The tangent's point on the roller, the outer one of the two.
    root = math.sqrt(max(square - radius**2, 0.0))
    touch = radius / square * (radius * way + root * np.array([-way[1], way[0]]))
    inwards = -thick / radius * touch
    corners = np.array([touch, way, way + inwards, touch + inwards])
    return corners * [side, 1.0] + axis


def run(machine: BeltMachine | Json, side: float) -> Mesh:
    """(points (8, 3), triangles (12, 3)) of that run of the belt."""
    machine = records.made(BeltMachine, machine)
    half, corners = 0.5 * known(machine.free_run).width_mm, run_corners(machine, side)
    points = [[x, y, z] for y in (-half, half) for x, z in corners]
    return np.array(points), prism()[:, :: int(side)]  # mirrored, they turn the other way


def arms(machine: BeltMachine | Json) -> list[Mesh]:
    """[(points (n, 3), triangles (m, 3))] of the arms beside the belt, from roller to roller and back to the pulleys; none
    without a thickness."""
    machine = records.made(BeltMachine, machine)
    frame = known(machine.frame)
    thick = frame.arm_thickness_mm
    if not has_runs(machine) or thick <= 0.0:
        return []
    beyond = ARM * known(machine.free_run).roller_radius_mm  # the axes
    half = max(0.5 * frame.spread_mm + beyond, LEAST_ARM)
    top = roller_axes(machine) + [[-beyond, beyond], [beyond, beyond]]
    low = np.array([[_middle(machine) + s * half, _lowest(machine)] for s in (-1.0, 1.0)])
    inner, found = 0.5 * known(machine.free_run).width_mm + GAP, []
    for side in SIDES[frame.arm_sides]:
        points, faces = strip(top, low, 0.5 * thick)
        found.append((points + [0.0, side * (inner + 0.5 * thick), 0.0], faces))
    return found


def _middle(machine: BeltMachine) -> float:
    """x of the middle between the rollers."""
    return float(roller_axes(machine)[:, 0].mean())


def _lowest(machine: BeltMachine) -> float:
    """z of where the belt's runs meet their pulleys."""
    return float(roller_axes(machine)[:, 1].min()) - known(machine.frame).length_mm
