"""From lines on a surface to a robot's poses: order, borders, gaps, approach and retract."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base import frames, records
from ..base.kinds import Floats, Json
from ..job import robot_time
from ..job.settings import Job
from . import turn_limits
from .kinds import Levels, Piece, Ramps, Room

STILL = 1e-6  # mm; less is no way
LEAST_LEAD = 0.2  # mm; a shorter way outside the border is none
RAMP_STEPS = 6  # poses in a ramp of the force, at most: that of a pose holds on the whole way to it
AHEAD = 0.8  # cosine: so near to its way out, the pass goes on beyond a gap
UNCUT = (False, False)  # neither end of a piece lies beside what was left out
CELL = ("base_from_work", "tcp_from_contact", "tcp_from_work", "base_from_contact")


def cell_of(job: Job) -> dict[str, Any]:
    """The cell's frames of a validated job, 4 x 4 in mm by name, and 'holding'."""
    cell = {name: frames.from_data(records.plain(getattr(job.cell, name))) for name in CELL}
    return {**cell, "holding": job.cell.holding}


def lever(cell: Json, points: Floats) -> float:
    """mm, the longest way from the tool centre point to a contact on ``points`` (n, 3)."""
    if cell["holding"] == "tool_in_hand":
        return float(np.linalg.norm(cell["tcp_from_contact"][:3, 3]))
    frame = cell["tcp_from_work"]
    return float(np.linalg.norm(points @ frame[:3, :3].T + frame[:3, 3], axis=1).max())


def assemble(
    levels: Levels, settings: Json, cell: Json, entry: Ramps, clearing: Room
) -> dict[str, Any]:
    """The whole path. ``levels``: for each level line its pieces, dict(points, normals, tangents
    (n, 3), closed, and perhaps cut); ``entry``: entry.Entry; ``clearing``: clearing.Clearing. Returns dict(frames, feeds, forces, rapid, lines, zones,
    contacts, contact (n,) bool: pose of a pass, passes, cuts: how often a pass ends where it would turn too
    fast or go back, beside (count of ends without room to come from outside)).
    """
    strokes, end, cuts = [], None, 0
    backwards = False
    for number, pieces in enumerate(levels):
        some, ended = _strokes(pieces, backwards, end, settings)
        cuts += ended
        strokes += [{**stroke, "level": number} for stroke in some]
        if some:
            end = some[-1]["points"][-1]
            backwards = backwards != (settings["order"] == "zigzag")
    strokes = clearing.cut(strokes)
    beside = _lead_in(strokes, settings, entry, clearing)
    stuck = _lifts(strokes, settings, clearing)
    parts, passes, count = [], [], 0
    for stroke in strokes:
        part = _stroke(stroke, settings, entry)
        first = count + int(np.argmax(part["contact"]))
        on = part["contacts"][part["contact"]]
        last = first + len(on) - 1
        length = float(np.linalg.norm(np.diff(on[:, :3, 3], axis=0), axis=1).sum())
        passes.append({"first": first, "last": last, "level": stroke["level"], "length_mm": length})
        count += len(part["contacts"])
        parts.append(part)
    names = ("contacts", "feeds", "forces", "rapid", "contact")
    joined = {name: np.concatenate([p[name] for p in parts]) if parts else [] for name in names}
    joined.update(passes=passes, cuts=cuts, beside=beside, stuck=stuck)
    if not parts:
        return joined
    joined["frames"] = frames.base_from_tcp(joined["contacts"], **cell)
    feeds = tcp_feeds(joined, settings["max_tcp_feed_mm_s"])
    joined["feeds"] = _within_blocks(joined, feeds, entry.limits.least_block_s)
    joined["lines"] = np.zeros(count, dtype=int)
    joined["zones"] = np.full(count, -1.0)  # the job's default
    return joined


def tcp_feeds(path: Json, most: float) -> Floats:
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


def _within_blocks(path: Json, feeds: Floats, least: float) -> Floats:
    """mm/s (n,): ``feeds`` (n,) of the tool centre point, with which no motion but rapid ones lasts less than ``least``
    s; to the tenth below where that lowers them."""
    way = np.linalg.norm(np.diff(path["frames"][:, :3, 3], axis=0), axis=1)
    most = np.append(np.inf, np.where(way > STILL, way / least, np.inf))
    most[path["rapid"]] = np.inf
    return np.where(most < feeds, robot_time.rounded_feeds(most), feeds)


def _strokes(
    pieces: Sequence[Piece], backwards: bool, end: Floats | None, settings: Json
) -> tuple[list[Piece], int]:
    """(the pieces of a level in the order of travel, neighbours across short gaps joined, borders extended
    or kept clear of, what is too short left out; how often a piece ends at a limit of its turn).
    """
    left = [_turned(piece) if backwards else dict(piece) for piece in pieces]
    if end is not None:
        left = [_begun_near(piece, end) if piece["closed"] else piece for piece in left]
    ordered: list[Piece] = []
    while left:
        # The first stroke begins where nothing of the level lies before it; then the nearest.
        k = _first(left) if not ordered else _nearest(left, ordered[-1]["points"][-1])
        ordered.append(left.pop(k))
    joined: list[Piece] = []
    for one in ordered:
        if joined and _joins(joined[-1], one, settings):
            joined[-1] = _joined(joined[-1], one)
        else:
            joined.append(one)
    result, cuts = [], 0
    for whole in joined:
        piece = whole if whole["closed"] else _run_out(whole, settings["run_out_mm"])
        if piece is None:
            continue
        sense = piece.get("sense", 1.0)
        left = turn_limits.limited(piece, settings)
        cuts += max(len(left) - 1, not left)
        for one in left:
            if length(one["points"]) >= max(settings["min_length_mm"], 1e-9):
                result.append({**one, "sense": sense})
    return result, cuts


def _turned(piece: Piece) -> Piece:
    """The piece travelled backwards; ``sense`` keeps the belt's travel as it was."""
    reversed_ = {name: piece[name][::-1] for name in ("points", "normals", "tangents")}
    return {**piece, **reversed_, "sense": -1.0, "cut": piece.get("cut", UNCUT)[::-1]}


def _begun_near(piece: Piece, place: Floats) -> Piece:
    """A closed piece that begins at its point nearest to ``place``."""
    k = int(np.argmin(np.linalg.norm(piece["points"][:-1] - place, axis=1)))
    turned = {
        name: np.vstack([piece[name][k:-1], piece[name][: k + 1]])
        for name in ("points", "normals", "tangents")
    }
    return {**piece, **turned}


def _first(pieces: Sequence[Piece]) -> int:
    """The piece with the least of the others behind its beginning."""
    if len(pieces) == 1:
        return 0
    starts = np.array([p["points"][0] for p in pieces])
    ends = np.array([p["points"][-1] for p in pieces])
    # The end of the piece before lies near the beginning of the next: the loneliest begins.
    gaps = np.linalg.norm(starts[:, None] - ends[None], axis=2)
    np.fill_diagonal(gaps, np.inf)
    return int(np.argmax(gaps.min(axis=1)))


def _nearest(pieces: Sequence[Piece], place: Floats) -> int:
    return int(np.argmin([np.linalg.norm(p["points"][0] - place) for p in pieces]))


def _joins(before: Piece, piece: Piece, settings: Json) -> bool:
    """Whether the pass goes on across the gap: it is short, and the way over it leads on as both ends do."""
    if before["closed"] or piece["closed"]:
        return False
    if before.get("cut", UNCUT)[1] or piece.get("cut", UNCUT)[0]:
        return False  # what lies between was left out
    over = piece["points"][0] - before["points"][-1]
    gap = float(np.linalg.norm(over))
    most = settings["edge_turn_deg"]
    if gap > settings["bridge_mm"] or _degrees(before["normals"][-1], piece["normals"][0]) > most:
        return False
    leaves = before.get("sense", 1.0) * before["tangents"][-1]
    arrives = piece.get("sense", 1.0) * piece["tangents"][0]
    if _degrees(leaves, arrives) > most:
        return False
    return gap <= STILL or max(_degrees(leaves, over / gap), _degrees(over / gap, arrives)) <= most


def _degrees(a: Floats, b: Floats) -> float:
    """Between unit vectors."""
    return math.degrees(math.acos(np.clip(a @ b, -1.0, 1.0)))


def _joined(before: Piece, piece: Piece) -> Piece:
    names = ("points", "normals", "tangents")
    joined = {name: np.vstack([before[name], piece[name]]) for name in names}
    return {**before, **joined, "cut": (before.get("cut", UNCUT)[0], piece.get("cut", UNCUT)[1])}


def length(points: Floats) -> float:
    """mm along points (n, 3)."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _run_out(piece: Piece, distance: float) -> Piece | None:
    """Straight on beyond both ends, but where something is left out; for a negative distance, cut back. None if
    nothing is left."""
    p, n, t = piece["points"], piece["normals"], piece["tangents"]
    sense = piece.get("sense", 1.0)
    if distance > 0:
        for at, cut in zip((0, -1), piece.get("cut", UNCUT)):
            if not cut:
                piece = _run_on(piece, at, distance * _outward({**piece, "sense": sense}, at))
        return piece
    if distance < 0:
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


def contact_frames(points: Floats, normals: Floats, tangents: Floats, angle: float = 0.0) -> Floats:
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


def _lead_in(strokes: list[Piece], settings: Json, entry: Ramps, clearing: Room) -> int:
    """Runs the strokes on beyond their ends, where there is room; rings overlap. How many ends have none."""
    for stroke in strokes:
        stroke["leads"] = [0.0, 0.0]
        if stroke["closed"] and entry.ramp() > 0.0:
            stroke.update(_overlapping(stroke, entry.ramp()))
    if not entry.lead > LEAST_LEAD:
        return 0
    ends = [(k, at) for k, stroke in enumerate(strokes) if not stroke["closed"] for at in (0, -1)]
    if not ends:
        return 0
    angle = math.radians(settings["belt_angle_deg"])
    rows = []
    for k, at in ends:
        one = strokes[k]
        frame = contact_frames(
            one["points"][[at]], one["normals"][[at]], one["tangents"][[at]], angle
        )
        rows.append((one["points"][at], _outward(one, at), frame[0]))
    places, outwards, turned = (np.array(a) for a in zip(*rows))
    turned[:, :3, 3] += settings["offset_mm"] * -turned[:, :3, 2]
    most = _to_neighbours(places, outwards, [strokes[k]["level"] for k, _ in ends], entry.lead)
    leads = entry.leads(turned, outwards, most, clearing)
    for (k, at), lead, outward in zip(ends, leads, outwards):
        if lead > 0.0:
            strokes[k].update(_run_on(strokes[k], at, lead * outward))
            strokes[k]["leads"][at] = float(lead)
    return int((leads <= 0.0).sum())


def _outward(piece: Piece, at: int) -> Floats:
    """Unit vector in which the pass goes on beyond its first (0) or last (-1) point: the belt's way, unless a turn
    that is spread along the pass has it lag behind the way of the points."""
    tangent = (1.0 if at else -1.0) * piece["sense"] * piece["tangents"][at]
    ways = np.diff(piece["points"], axis=0)[:: 1 if at else -1] * (1.0 if at else -1.0)
    moves = ways[np.linalg.norm(ways, axis=1) > STILL]
    if not len(moves):
        return tangent
    normal = piece["normals"][at]
    way = moves[-1] - (moves[-1] @ normal) * normal
    length = np.linalg.norm(way)
    return way / length if length > STILL and way @ tangent < AHEAD * length else tangent


def _to_neighbours(places: Floats, outwards: Floats, levels: Sequence[int], lead: float) -> Floats:
    """mm, how far each end may run on: halfway over a gap, beyond which its own level line goes on."""
    most, numbers = np.full(len(places), lead), np.array(levels)
    for level in np.unique(numbers):
        mine = np.flatnonzero(numbers == level)
        over = places[mine][None] - places[mine][:, None]
        gap = np.linalg.norm(over, axis=2)
        ahead = (over * outwards[mine][:, None]).sum(axis=2) > AHEAD * gap
        gap[~ahead | (gap <= STILL)] = np.inf
        most[mine] = np.minimum(most[mine], 0.5 * gap.min(axis=1))
    return most


def _run_on(piece: Piece, at: int, shift: Floats) -> Piece:
    """The piece with one more point beyond its first (0) or last (-1)."""
    order = slice(None, None, 1 if at else -1)
    grown = {name: piece[name][order] for name in ("points", "normals", "tangents")}
    grown = {name: np.vstack([a, a[-1:]]) for name, a in grown.items()}
    grown["points"][-1] += shift
    return {**piece, **{name: a[order] for name, a in grown.items()}}


def _overlapping(piece: Piece, length: float) -> Piece:
    """A ring that goes on over its beginning for ``length`` mm, at most once round."""
    s = _places(piece["points"])
    more = (s > 0.0) & (s < length)
    names = ("points", "normals", "tangents")
    return {name: np.vstack([piece[name], piece[name][more]]) for name in names}


def _places(points: Floats) -> Floats:
    """mm along the piece (n,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def _with_ramps(piece: Piece, settings: Json, entry: Ramps) -> Piece:
    """The piece with poses in its ramps, between which the force changes, and none needlessly so near that the robot would
    be slow: a ramp changes at poses that are there already, if they are not farther than half a block.
    """
    piece = _spaced(piece, entry.block, settings)
    s = _places(piece["points"])
    ramps = entry.ramps(piece["leads"], s[-1])
    if ramps[0] <= 0.0:
        return piece
    block = min(entry.block, settings["max_distance_mm"])
    first, last = (_ramp_places(ramp, block) for ramp in ramps)
    more = np.sort(np.concatenate([first, s[-1] - last]))
    near = 0.5 * min(block, float(ramps.max()))
    more = more[abs(more[:, None] - s[None]).min(axis=1) > near]
    more = more[np.diff(more, prepend=-np.inf) > near]
    return _posed(piece, s, np.sort(np.concatenate([s, more])))


def _posed(piece: Piece, s: Floats, places: Floats) -> Piece:
    """The piece with poses at ``places`` (k,) mm along it, of which its own are at ``s`` (n,)."""
    posed = {
        name: np.column_stack([np.interp(places, s, piece[name][:, k]) for k in range(3)])
        for name in ("points", "normals", "tangents")
    }
    for name in ("normals", "tangents"):
        posed[name] /= np.linalg.norm(posed[name], axis=1)[:, None]
    return {**piece, **posed}


def _ramp_places(ramp: float, block: float) -> Floats:
    """mm from the end of a pass of the poses in a ramp of ``ramp`` mm, none nearer than ``block`` mm to the next."""
    count = int(np.clip(ramp / max(block, STILL), 1, RAMP_STEPS))
    return ramp * np.arange(1, count + 1) / count


def _spaced(piece: Piece, block: float, settings: Json) -> Piece:
    """The piece with its inner poses ``block`` mm apart at least, as far as it keeps chord_error_mm, max_turn_deg and
    max_distance_mm: those that are nearer are left out, or moved on."""
    most = math.radians(settings["max_turn_deg"])
    points, normals, tangents = piece["points"], piece["normals"], piece["tangents"]
    s = _places(points)
    if len(s) < 3 or (np.diff(s) <= 0.0).any():
        return piece
    places, one = [0.0], 0
    for k in range(1, len(s) - 1):
        before, other = places[-1], k + 1
        over, way = points[one + 1 : other] - points[one], points[other] - points[one]
        share = np.clip(over @ way / max(float(way @ way), STILL), 0.0, 1.0)
        missed = np.linalg.norm(over - share[:, None] * way, axis=1).max()
        # No less than the turn of both together.
        turn = sum(
            math.acos(np.clip(axis[one] @ axis[other], -1.0, 1.0)) for axis in (normals, tangents)
        )
        free = turn <= most and missed <= settings["chord_error_mm"]
        if free and min(s[k] - before, s[other] - s[k]) < block - STILL:
            if s[other] - before <= settings["max_distance_mm"]:
                continue
            if s[other] - before >= 2.0 * block:
                places.append(float(np.clip(s[k], before + block, s[other] - block)))
                one = k
                continue
        places.append(float(s[k]))
        one = k
    return _posed(piece, s, np.array([*places, s[-1]]))


def _lifts(strokes: list[Piece], settings: Json, clearing: Room) -> int:
    """Gives each stroke its ``lifts``: approach and clearance, mm, of both ends, as far as the wheel has room above
    them. How many ends have none: there they are as the settings have them."""
    if not strokes:
        return 0
    angle = math.radians(settings["belt_angle_deg"])
    ends = [
        contact_frames(
            one["points"][[0, -1]], one["normals"][[0, -1]], one["tangents"][[0, -1]], angle
        )
        for one in strokes
    ]
    most = max(settings["clearance_mm"], settings["approach_mm"])
    free = clearing.heights(np.concatenate(ends), most).reshape(-1, 2)
    for stroke, room in zip(strokes, free):
        stroke["lifts"] = [
            {
                "approach_mm": min(settings["approach_mm"], height or most),
                "clearance_mm": min(settings["clearance_mm"], height or most),
            }
            for height in room
        ]
    return int((free <= 0.0).sum())


def between(a: Floats, b: Floats, shares: Floats) -> Floats:
    """Frames (k, 4, 4) between two (4, 4): straight, turned evenly, at ``shares`` (k,) of the way."""
    ends = frames.to_quaternions(np.stack([a[:3, :3], b[:3, :3]]))
    turns = turn_limits.slerp(ends[0], ends[1], shares)
    places = a[:3, 3] + shares[:, None] * (b[:3, 3] - a[:3, 3])
    return frames.from_quaternions(places, turns)


def _stroke(piece: Piece, settings: Json, entry: Ramps) -> dict[str, Any]:
    """dict(contacts, feeds, forces, rapid, contact) of one pass with its approach and retract."""
    piece = _with_ramps(piece, settings, entry)
    points = piece["points"] + settings["offset_mm"] * piece["normals"]
    angle = math.radians(settings["belt_angle_deg"])
    on = contact_frames(points, piece["normals"], piece["tangents"], angle)
    sense = piece["sense"]
    low, high = ({**settings, **one} for one in piece["lifts"])
    before = _approach(on[0], -sense * piece["tangents"][0], low)
    after = _approach(on[-1], sense * piece["tangents"][-1], high)[::-1]
    contacts = np.concatenate([before, on, after])
    count, lead = len(on), len(before)
    s = _places(piece["points"])
    share = entry.shares(
        0.5 * (s[1:] + s[:-1]), piece["leads"], s[-1]
    )  # of the force, on the way to all but the first
    feeds = np.full(len(contacts), float(settings["feed_mm_s"]))
    if settings["entry_feed_mm_s"] > 0.0:
        feeds[lead + 1 : lead + count][share < 1.0] = settings["entry_feed_mm_s"]
    if entry.border:  # so that as much is removed
        feeds[lead + 1 : lead + count] *= np.maximum(share, entry.border)
    feeds[: lead + 1] = feeds[lead + count :] = settings["approach_feed_mm_s"]
    rapid = np.zeros(len(contacts), dtype=bool)
    # Between the pass's height of clearance and the beginning of the approach nothing is ground.
    rapid[: 2 if lead > 1 else 1] = True
    rapid[-1] = lead > 1
    contact = np.zeros(len(contacts), dtype=bool)
    contact[lead : lead + count] = True
    touch = settings["touch_force_share"] if settings["entry"] != "direct" else 1.0
    shares = np.full(len(contacts), touch)
    shares[lead + 1 : lead + count] = share
    forces = np.full(len(contacts), settings["force_N"] or -1.0)
    if entry.force is not None:
        forces[shares < 1.0] = entry.force * shares[shares < 1.0]
    return {
        "contacts": contacts,
        "feeds": feeds,
        "forces": forces,
        "rapid": rapid,
        "contact": contact,
    }


def _approach(frame: Floats, away: Floats, settings: Json) -> Floats:
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
