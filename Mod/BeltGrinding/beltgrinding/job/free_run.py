"""A free belt or a platen: how the belt lies that touches nothing, its rollers, the plate and the layers on it; the belt's
runs beyond the rollers and the arms that hold these.

All is in the contact frame: its origin lies on the belt's outer face, x along the travel, z into the work. ``machine``: a
job's belt_machine with its defaults; lengths mm, angles rad. Places are mm along the belt's outer face from the origin.
"""

import math

import numpy as np

from ..base.solids import box, prism, strip

NAMES = ("belt_before", "belt_behind")
ARMS = "arms"
CHORD = 0.02  # mm, by which the chords of a curved plate leave it
GAP = 1.0  # mm between belt and arms
ARM = 0.6  # of the rollers' radius, that the arms reach beyond their axes
LEAST_ARM = 1.0  # mm, half of their width at the pulleys
STEEPEST = math.radians(60.0)  # of a curved plate's ends
SIDES = {"both": (-1.0, 1.0), "minus_y": (-1.0,), "plus_y": (1.0,)}  # of the arms


def arc(machine):
    """(radius of the belt's outer face over a curved plate, angle by which it has turned at the plate's ends); (0, 0) of a
    flat one and of a free belt."""
    platen = machine.get("platen", {})
    radius = platen.get("radius_mm", 0.0)
    if machine["kind"] != "platen" or radius <= 0.0:
        return 0.0, 0.0
    end = math.asin(min(0.5 * platen["length_mm"] / radius, 1.0))
    return radius + machine["free_run"]["thickness_mm"], end


def length_on(machine):
    """mm of the belt's middle surface that lie on the plate."""
    radius, end = arc(machine)
    if radius == 0.0:
        return machine["platen"]["length_mm"]
    return 2.0 * (radius - 0.5 * machine["free_run"]["thickness_mm"]) * end


def line(machine, places, below=0.0):
    """Points [x, z] (n, 2) of the belt at ``places`` (n,), ``below`` mm under its outer face."""
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


def ends(machine):
    """Places at which the belt meets its two rollers."""
    run = machine["free_run"]
    half, shift = 0.5 * run["length_mm"], run["position_mm"]
    # The free length is the middle surface's, which is shorter round a plate.
    longer = 0.5 * run["thickness_mm"] * arc(machine)[1]
    return -half - shift - longer, half - shift + longer


def face(machine, chord=CHORD):
    """Places (n,) from roller to roller between which the belt is straight to ``chord`` mm."""
    first, last = ends(machine)
    radius, end = arc(machine)
    if radius == 0.0:
        return np.array([first, last])
    return np.r_[first, _angles(radius, end, chord) * radius, last]


def roller_axes(machine):
    """[x, z] (2, 2) of the rollers' axes: the belt's inner face lies on them."""
    run = machine["free_run"]
    return line(machine, ends(machine), run["thickness_mm"] + run["roller_radius_mm"])


def plate(machine):
    """(points (n, 3), triangles (m, 3)) of a platen's plate, behind its layers."""
    thick = machine["platen"]["plate_thickness_mm"]
    behind = machine["free_run"]["thickness_mm"] + _layers_thick(machine)
    if arc(machine)[0] == 0.0:
        return _slab(machine, -behind - thick, -behind)
    top = _on_plate(machine, behind)
    return strip(top, top - [0.0, thick], 0.5 * machine["free_run"]["width_mm"])


def layers(machine):
    """[(points (n, 3), triangles (m, 3))] of a platen's layers, from the plate outwards."""
    behind, found = machine["free_run"]["thickness_mm"] + _layers_thick(machine), []
    for layer in machine["platen"]["layers"]:
        above = behind - layer["thickness_mm"]
        if arc(machine)[0] == 0.0:
            found.append(_slab(machine, -behind, -above))
        else:
            lines = _on_plate(machine, above), _on_plate(machine, behind)
            found.append(strip(*lines, 0.5 * machine["free_run"]["width_mm"]))
        behind = above
    return found


def _layers_thick(machine):
    return sum(layer["thickness_mm"] for layer in machine["platen"]["layers"])


def _slab(machine, low, high):
    half, long = 0.5 * machine["free_run"]["width_mm"], 0.5 * machine["platen"]["length_mm"]
    return box([-long, -half, low], [long, half, high])


def _on_plate(machine, below):
    radius, end = arc(machine)
    return line(machine, _angles(radius, end, CHORD) * radius, below)


def _angles(radius, end, chord):
    step = 2.0 * math.acos(max(1.0 - chord / radius, -1.0))
    return np.linspace(-end, end, max(2 * math.ceil(end / step), 2) + 1)


def has_runs(machine):
    """Whether the belt's runs beyond the rollers are known, to the pulley or pulleys that they come from."""
    return machine["frame"]["length_mm"] > 0.0


def short_frame(machine):
    """mm that the pulleys must be away from the rollers' axes at least, where they are nearer; else None."""
    run = machine["free_run"]
    least = run["roller_radius_mm"] + run["thickness_mm"]
    return least if has_runs(machine) and machine["frame"]["length_mm"] <= least else None


def run_corners(machine, side):
    """Corners [x, z] (4, 2) of the belt that comes to the roller before the contact (``side`` -1) or leaves the one behind
    it (1): where it leaves the roller and where it meets its pulley, outside, then inside."""
    run, frame = machine["free_run"], machine["frame"]
    thick = run["thickness_mm"]
    axis = roller_axes(machine)[0 if side < 0 else 1]
    far = np.array([_middle(machine) + 0.5 * side * frame["spread_mm"], _lowest(machine)])
    way = (far - axis) * [side, 1.0]  # as of the side 1
    radius = run["roller_radius_mm"] + thick
    square = float(way @ way)
    # The tangent's point on the roller, the outer one of the two.
    root = math.sqrt(max(square - radius**2, 0.0))
    touch = radius / square * (radius * way + root * np.array([-way[1], way[0]]))
    inwards = -thick / radius * touch
    corners = np.array([touch, way, way + inwards, touch + inwards])
    return corners * [side, 1.0] + axis


def run(machine, side):
    """(points (8, 3), triangles (12, 3)) of that run of the belt."""
    half, corners = 0.5 * machine["free_run"]["width_mm"], run_corners(machine, side)
    points = [[x, y, z] for y in (-half, half) for x, z in corners]
    return np.array(points), prism()[:, :: int(side)]  # mirrored, they turn the other way


def arms(machine):
    """[(points (n, 3), triangles (m, 3))] of the arms beside the belt, from roller to roller and back to the pulleys; none
    without a thickness."""
    frame = machine["frame"]
    thick = frame["arm_thickness_mm"]
    if not has_runs(machine) or thick <= 0.0:
        return []
    beyond = ARM * machine["free_run"]["roller_radius_mm"]  # the axes
    half = max(0.5 * frame["spread_mm"] + beyond, LEAST_ARM)
    top = roller_axes(machine) + [[-beyond, beyond], [beyond, beyond]]
    low = np.array([[_middle(machine) + s * half, _lowest(machine)] for s in (-1.0, 1.0)])
    inner, found = 0.5 * machine["free_run"]["width_mm"] + GAP, []
    for side in SIDES[frame["arm_sides"]]:
        points, faces = strip(top, low, 0.5 * thick)
        found.append((points + [0.0, side * (inner + 0.5 * thick), 0.0], faces))
    return found


def _middle(machine):
    """x of the middle between the rollers."""
    return float(roller_axes(machine)[:, 0].mean())


def _lowest(machine):
    """z of where the belt's runs meet their pulleys."""
    return float(roller_axes(machine)[:, 1].min()) - machine["frame"]["length_mm"]
