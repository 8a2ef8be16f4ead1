"""From lines on a surface to a robot's poses: order, borders, gaps, approach and retract."""

import math

import numpy as np

from ..base import frames

STILL = 1e-6  # mm; less is no way
CELL = ("base_from_work", "tcp_from_contact", "tcp_from_work", "base_from_contact")


def cell_of(job):
    """The cell's frames of a validated job, 4 x 4 in mm by name, and 'holding'."""
    cell = {name: frames.from_data(job["cell"].get(name)) for name in CELL}
    return {**cell, "holding": job["cell"]["holding"]}


def lever(cell, points):
    """mm, the longest way from the tool centre point to a contact on ``points`` (n, 3)."""
    if cell["holding"] == "tool_in_hand":
        return float(np.linalg.norm(cell["tcp_from_contact"][:3, 3]))
    frame = cell["tcp_from_work"]
    return float(np.linalg.norm(points @ frame[:3, :3].T + frame[:3, 3], axis=1).max())


def assemble(levels, settings, cell):
    """The whole path. ``levels``: for each level line its pieces, dict(points, normals, tangents
    (n, 3), closed). Returns dict(frames, feeds, forces, rapid, lines, zones, contacts, contact
    (n,) bool: pose of a pass, passes).
    """
    parts, passes, count, end = [], [], 0, None
    backwards = False
    for number, pieces in enumerate(levels):
        strokes = _strokes(pieces, backwards, end, settings)
        for stroke in strokes:
            part = _stroke(stroke, settings)
            first = count + int(np.argmax(part["contact"]))
            on = part["contacts"][part["contact"]]
            last = first + len(on) - 1
            length = float(np.linalg.norm(np.diff(on[:, :3, 3], axis=0), axis=1).sum())
            passes.append({"first": first, "last": last, "level": number, "length_mm": length})
            count += len(part["contacts"])
            parts.append(part)
            end = stroke["points"][-1]
        if strokes and settings["order"] == "zigzag":
            backwards = not backwards
    names = ("contacts", "feeds", "rapid", "contact")
    joined = {name: np.concatenate([p[name] for p in parts]) if parts else [] for name in names}
    joined["passes"] = passes
    if not parts:
        return joined
    joined["frames"] = frames.base_from_tcp(joined["contacts"], **cell)
    joined["feeds"] = tcp_feeds(joined, settings["max_tcp_feed_mm_s"])
    joined["forces"] = np.full(count, settings["force_N"] or -1.0)
    joined["lines"] = np.zeros(count, dtype=int)
    joined["zones"] = np.full(count, -1.0)  # the job's default
    return joined


def tcp_feeds(path, most):
    """mm/s of the tool centre point (n,) with which the contact has ``path["feeds"]`` over the work;
    at most ``most``. A controller that is told the feed of the contact itself (a KUKA with the tool
    outside, $IPO_MODE=#TCP) takes those.
    """
    tcp, contact = (
        np.linalg.norm(np.diff(path[name][:, :3, 3], axis=0), axis=1)
        for name in ("frames", "contacts")
    )
    feeds = path["feeds"].copy()
    # A turn on the spot has no feed of the contact, a turn about the tool centre point none of it.
    moves = np.flatnonzero((tcp > STILL) & (contact > STILL) & ~path["rapid"][1:])
    feeds[moves + 1] *= tcp[moves] / contact[moves]
    return np.minimum(feeds, most)


def _strokes(pieces, backwards, end, settings):
    """The pieces of a level in the order of travel, neighbours across short gaps joined, borders
    extended or kept clear of, what is too short left out.
    """
    left = [_turned(piece) if backwards else dict(piece) for piece in pieces]
    if end is not None:
        left = [_begun_near(piece, end) if piece["closed"] else piece for piece in left]
    ordered = []
    while left:
        # The first stroke begins where nothing of the level lies before it; then the nearest.
        k = _first(left) if not ordered else _nearest(left, ordered[-1]["points"][-1])
        ordered.append(left.pop(k))
    joined = []
    for piece in ordered:
        if joined and _joins(joined[-1], piece, settings):
            joined[-1] = _joined(joined[-1], piece)
        else:
            joined.append(piece)
    result = []
    for piece in joined:
        piece = piece if piece["closed"] else _run_out(piece, settings["run_out_mm"])
        if piece is not None and _length(piece["points"]) >= max(settings["min_length_mm"], 1e-9):
            result.append(piece)
    return result


def _turned(piece):
    """The piece travelled backwards; ``sense`` keeps the belt's travel as it was."""
    reversed_ = {name: piece[name][::-1] for name in ("points", "normals", "tangents")}
    return {**piece, **reversed_, "sense": -1.0}


def _begun_near(piece, place):
    """A closed piece that begins at its point nearest to ``place``."""
    k = int(np.argmin(np.linalg.norm(piece["points"][:-1] - place, axis=1)))
    turned = {
        name: np.vstack([piece[name][k:-1], piece[name][: k + 1]])
        for name in ("points", "normals", "tangents")
    }
    return {**piece, **turned}


def _first(pieces):
    """The piece with the least of the others behind its beginning."""
    if len(pieces) == 1:
        return 0
    starts = np.array([p["points"][0] for p in pieces])
    ends = np.array([p["points"][-1] for p in pieces])
    # The end of the piece before lies near the beginning of the next: the loneliest begins.
    gaps = np.linalg.norm(starts[:, None] - ends[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    return int(np.argmax(gaps.min(axis=1)))


def _nearest(pieces, place):
    return int(np.argmin([np.linalg.norm(p["points"][0] - place) for p in pieces]))


def _joins(before, piece, settings):
    if before["closed"] or piece["closed"]:
        return False
    gap = np.linalg.norm(piece["points"][0] - before["points"][-1])
    turn = math.acos(np.clip(before["normals"][-1] @ piece["normals"][0], -1.0, 1.0))
    return gap <= settings["bridge_mm"] and math.degrees(turn) <= settings["edge_turn_deg"]


def _joined(before, piece):
    names = ("points", "normals", "tangents")
    return {**before, **{name: np.vstack([before[name], piece[name]]) for name in names}}


def _length(points):
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _run_out(piece, distance):
    """Straight on beyond both ends; for a negative distance, cut back. None if nothing is left."""
    p, n, t = piece["points"], piece["normals"], piece["tangents"]
    sense = piece.get("sense", 1.0)
    if distance > 0:
        p = np.vstack([p[0] - distance * sense * t[0], p, p[-1] + distance * sense * t[-1]])
        n, t = (np.vstack([a[:1], a, a[-1:]]) for a in (n, t))
    elif distance < 0:
        s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
        low, high = -distance, s[-1] + distance
        if high <= low:
            return None
        inside = (s > low) & (s < high)
        at = np.concatenate([[low], s[inside], [high]])
        p, n, t = (
            np.column_stack([np.interp(at, s, a[:, k]) for k in range(3)]) for a in (p, n, t)
        )
        n /= np.linalg.norm(n, axis=1)[:, None]
    return {**piece, "points": p, "normals": n, "tangents": t}


def contact_frames(points, normals, tangents, angle=0.0):
    """work_from_contact (n, 4, 4): z against the outward normal, x the belt's travel, turned by
    ``angle`` (rad) about z from the tangent.
    """
    z = -normals
    x = tangents - (tangents * z).sum(axis=1)[:, None] * z
    x = x / np.linalg.norm(x, axis=1)[:, None]
    y = np.cross(z, x)
    x = math.cos(angle) * x + math.sin(angle) * y
    result = np.zeros((len(points), 4, 4))
    result[:, :3, 0], result[:, :3, 1], result[:, :3, 2] = x, np.cross(z, x), z
    result[:, :3, 3] = points
    result[:, 3, 3] = 1.0
    return result


def _stroke(piece, settings):
    """dict(contacts, feeds, rapid, contact) of one pass with its approach and retract."""
    points = piece["points"] + settings["offset_mm"] * piece["normals"]
    angle = math.radians(settings["belt_angle_deg"])
    on = contact_frames(points, piece["normals"], piece["tangents"], angle)
    sense = piece.get("sense", 1.0)
    before = _approach(on[0], -sense * piece["tangents"][0], settings)
    after = _approach(on[-1], sense * piece["tangents"][-1], settings)[::-1]
    contacts = np.concatenate([before, on, after])
    count, lead = len(on), len(before)
    feeds = np.full(len(contacts), float(settings["feed_mm_s"]))
    feeds[: lead + 1] = feeds[lead + count :] = settings["approach_feed_mm_s"]
    rapid = np.zeros(len(contacts), dtype=bool)
    # Between the pass's height of clearance and the beginning of the approach nothing is ground.
    rapid[: 2 if lead > 1 else 1] = True
    rapid[-1] = lead > 1
    contact = np.zeros(len(contacts), dtype=bool)
    contact[lead : lead + count] = True
    return {"contacts": contacts, "feeds": feeds, "rapid": rapid, "contact": contact}


def _approach(frame, away, settings):
    """Poses from the clearance to just before ``frame``; ``away``: unit vector along the surface
    from which an arc comes.
    """
    out, length = -frame[:3, 2], settings["approach_mm"]
    shifts = []
    if settings["approach"] == "arc":
        # Cosine of the step whose chord misses the arc by the chord error.
        chord = max(1.0 - settings["chord_error_mm"] / length, 0.0)
        count = max(2, math.ceil(0.5 * math.pi / (2.0 * math.acos(chord))))
        for k in range(count, 0, -1):
            a = 0.5 * math.pi * k / count
            shifts.append(length * ((1.0 - math.cos(a)) * out + math.sin(a) * away))
    else:
        shifts.append(length * out)
    if settings["clearance_mm"] > length:
        shifts.insert(0, shifts[0] + (settings["clearance_mm"] - length) * out)
    result = np.repeat(frame[None], len(shifts), axis=0)
    result[:, :3, 3] += shifts
    return result
