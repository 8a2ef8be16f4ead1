"""Passes of the wheel over a face, their feeds, and the robot's motions for them; numpy only.

Lengths are in mm, feeds in mm/s, forces in N. Frames are 4 x 4, named a_from_b; the contact frame has
z into the work and x along the belt's travel.
"""

import numpy as np

from ..base import frames
from ..programs.program import Motion

STILL = 1e-6  # mm; less is no way
PIECES = 200  # in which a line's length is measured


def contact_frames(points, normals, tangents):
    """work_from_contact (n, 4, 4): z against the outward normals, x along the tangents; all (n, 3)."""
    z = -normals
    x = tangents - (tangents * z).sum(axis=1)[:, None] * z
    x = x / np.linalg.norm(x, axis=1)[:, None]
    result = np.zeros((len(points), 4, 4))
    result[:, :3, 0], result[:, :3, 1], result[:, :3, 2] = x, np.cross(z, x), z
    result[:, :3, 3] = points
    result[:, 3, 3] = 1.0
    return result


def lines(face, across, along, swapped=False):
    """Points and outward normals on a Part face: two arrays (lines, n, 3). ``across``: the face's first
    parameter on each line; ``along``: its second one, which runs along the lines. ``swapped``: the lines
    run along the first one.
    """
    places = [[(a, c) if swapped else (c, a) for a in along] for c in across]
    points = [[tuple(face.valueAt(*place)) for place in line] for line in places]
    normals = [[tuple(face.normalAt(*place)) for place in line] for line in places]
    return np.array(points), np.array(normals)


def run_out(points, normals, length, at_end):
    """The same lines, going straight on for ``length`` mm at their end or at their begin; (lines, n + 1, 3)."""
    end, inside = (-1, -2) if at_end else (0, 1)
    way = points[:, end] - points[:, inside]
    way *= length / np.linalg.norm(way, axis=1)[:, None]
    place = points.shape[1] if at_end else 0
    return (
        np.insert(points, place, points[:, end] + way, axis=1),
        np.insert(normals, place, normals[:, end], axis=1),
    )


def widths(points, tangents):
    """mm, how wide a strip each place of each line has to grind, half the way to its neighbours on both
    sides, square to the line; ``points`` and ``tangents`` are of (lines, n, 3), the result of (lines, n).
    The outer lines have as much outside as inside.
    """
    ways = np.diff(points, axis=0)
    units = tangents / np.linalg.norm(tangents, axis=2)[..., None]
    units = 0.5 * (units[1:] + units[:-1])
    gaps = np.linalg.norm(ways - (ways * units).sum(axis=2)[..., None] * units, axis=2)
    return 0.5 * (np.vstack([gaps[:1], gaps]) + np.vstack([gaps, gaps[-1:]]))


def evenly(face, count, along, insets=(0.0, 0.0), swapped=False):
    """``count`` values of the face's first parameter that share it evenly on the surface, where its second
    one is ``along``; all but ``insets`` mm at its two borders. ``swapped``: as for ``lines``.
    """
    ends = face.ParameterRange[2:] if swapped else face.ParameterRange[:2]
    values = np.linspace(*ends, PIECES + 1)
    line = lines(face, values, [along], swapped)[0][:, 0]
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    room = lengths[-1] - sum(insets)
    return np.interp(insets[0] + (np.arange(count) + 0.5) / count * room, lengths, values)


def feed(coefficient, belt_speed, force, allowance, width):
    """mm/s at which a pass takes ``allowance`` (mm) off a strip ``width`` (mm) wide on the mean, by
    Hammann's law: coefficient (mm2/N), belt speed (m/s), force (N).
    """
    return coefficient * 1000.0 * belt_speed * force / (allowance * width)


def motions(passes, retract, cell):
    """The robot's Motions for passes, dicts of ``contacts`` (n, 4, 4), ``feeds`` (n,) of the contact over
    the work towards each of them and, optionally, ``forces`` (n,) N, and ``before``, frames by which the
    robot comes there. Each begins and ends ``retract`` mm above the surface. ``cell``: keywords of
    ``frames.base_from_tcp``.

    The feeds written are those of the tool centre point that give these.
    """
    result = []
    for one in passes:
        contacts, feeds = np.asarray(one["contacts"]), np.asarray(one["feeds"], dtype=float)
        forces = one.get("forces", [None] * len(contacts))
        for pose in (
            frames.base_from_tcp(np.array(one["before"]), **cell) if "before" in one else ()
        ):
            result.append(Motion("PTP", pose, 0, ""))
        ends = contacts[[0, -1]].copy()
        ends[:, :3, 3] -= retract * ends[:, :3, 2]
        contacts = np.concatenate([ends[:1], contacts, ends[1:]])
        feeds = np.concatenate([feeds[:1], feeds[:1], feeds[1:], feeds[-1:]])
        forces = [None, *forces, None]
        poses = frames.base_from_tcp(contacts, **cell)
        ways = [np.linalg.norm(np.diff(f[:, :3, 3], axis=0), axis=1) for f in (poses, contacts)]
        turns = (ways[0] > STILL) & (ways[1] > STILL)
        feeds[1:][turns] *= ways[0][turns] / ways[1][turns]
        for k, pose in enumerate(poses):
            kind, speed = ("PTP", None) if k == 0 else ("LIN", round(float(feeds[k]), 3))
            force = forces[k] if forces[k] is None else round(float(forces[k]), 2)
            result.append(Motion(kind, pose, 0, "", speed, force))
    return result
