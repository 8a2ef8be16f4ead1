"""Where the wheel would stand in the part, or in what is fixed to it, or what goes with the wheel would meet them: there it
is leaned about the belt's travel, within a limit, or the pass is left out.

A lean about the wheel's own axis would change nothing of the wheel, so that with the belt along the pass the lean is
one about the feed. A leaned wheel stands on the pass with the point of its profile that lies deepest then: of a flat
wheel, its edge.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..base.kinds import Array, Context, Facts, Floats, Json
from ..cell import collision
from ..engine import InputError, core
from ..job.settings import Job
from ..job.typed import typed
from . import held, passes, tool as tools
from .kinds import Levels, Piece

PART_SAMPLES = 400_000  # at most, of the part and of all bodies
CHORD = 0.2  # of the length on which the wheel stands fit_mm deep in a plane: from sample to sample
NEAR = 0.2  # mm, of the same for a fit of 0
STEP = 2.5  # degrees from lean to lean
LEFT_OUT = 4.0  # leans by the limit, that a place left out is as bad as
CHANGE = 0.5  # of the same: a change of the lean from place to place, times its share of the limit
CUT = 25.0  # the same, for a pass that ends, or begins, besides its border
LIFTS = 8  # heights that are looked at, from a pass to its clearance
MOST_ON_WAY = 200  # places that are looked at on a rapid way
MARGIN = 0.5  # of fit_mm, that a leaned wheel keeps
OF_POINTS = ("points", "normals", "tangents")  # of a piece


class Clearing:
    """Looks whether the wheel of a validated job fits the part, and leans it where it does not."""

    def __init__(
        self,
        job: Job | Json,
        shape: core.Shape,
        settings: Json,
        warnings: Facts,
        context: Context,
        advance: float = 0.0,
    ) -> None:
        """``settings``: validated; ``advance``: as ``tool.of`` takes it. ``blind`` is true where the part cannot be
        sampled: then nothing is known, and everything fits. Raises InputError, Cancelled."""
        job = typed(job)
        self.settings, self.context = settings, context
        self.fit = settings["fit_mm"]
        most = settings["max_tilt_deg"] if settings["where_it_collides"] == "tilt" else 0.0
        count = math.ceil(most / STEP - 1e-9)
        steps = np.linspace(0.0, math.radians(most), count + 1)[1:]
        self.leans = np.concatenate([[0.0], np.column_stack([steps, -steps]).ravel()])
        self._turns = np.array([_about_x(lean) for lean in self.leans])
        self.held = held.Held(job, shape, warnings, context)
        self._mount(job, advance)
        try:
            self._points = self._solid(job, shape, warnings)
            self.blind = False
        except InputError as error:
            self.blind = True
            warnings.append(
                core.Fact(
                    "raster.blind",
                    "whether {tool} fits is not known: the part cannot be sampled ({reason})",
                    tool=self.tool.name,
                    reason=error,
                )
            )

    @property
    def name(self) -> core.Fact:
        """Fact: what it looks at, as a subject."""
        if not self.held.names:
            return self.tool.name
        return core.Fact("raster.with_held", "{tool}, or what goes with it,", tool=self.tool.name)

    def with_wheel(self, job: Job | Json) -> Clearing:
        """The same with the wheel of another job on the same part."""
        found = copy.copy(self)
        found.held = copy.copy(self.held)
        found._mount(typed(job))
        return found

    def _mount(self, job: Job, advance: float = 0.0) -> None:
        self.tool = tools.of(job, advance)
        self.held.mount(job.belt_machine, advance)
        self._shifts = np.array([self.tool.shift(lean) for lean in self.leans])

    def _solid(self, job: Job, shape: core.Shape, warnings: Facts) -> Floats:
        """Points (n, 3) of the part and of bodies that are fixed to it."""
        wanted = CHORD * min(self.tool.chord(max(self.fit, NEAR)), self.tool.width)
        area = sum(shape.face_area(face) for face in range(shape.face_count))
        spacing = max(wanted, math.sqrt(area / PART_SAMPLES))
        part, _ = core.sample_faces(shape, [], spacing, context=self.context)
        points = [part.points]
        _, with_part = held.sides(job)
        for body in job.cell.bodies:
            if body.frame not in with_part:
                continue
            placed = np.linalg.inv(with_part[body.frame])
            mesh = collision.read_body(body, body.name, warnings, self.context)
            found = _on_mesh(mesh, wanted, PART_SAMPLES)
            points.append(found @ placed[:3, :3].T + placed[:3, 3])
        return np.vstack(points)

    def depth(self, frames: Floats) -> Floats:
        """mm (n,) that the whole undeformed wheel stands in the part, or in bodies fixed to it, at work_from_contact
        (n, 4, 4); inf where what goes with it meets them, or comes as near as the fit."""
        found = self.tool_depth(frames)
        if self.blind:
            return found
        free = np.flatnonzero(found <= self.fit)
        found[free[self.held.first_met(frames[free], self.fit) >= 0]] = np.inf
        return found

    def tool_depth(self, frames: Floats) -> Floats:
        """The same of the wheel alone."""
        if self.blind or not len(frames):
            return np.zeros(len(frames))
        return self.tool.depth(frames, self._points, self.context)

    def fits_upright(self, frames: Floats) -> Array:
        """(n,) bool: the wheel fits as it stands, or is not asked to."""
        if self.settings["where_it_collides"] == "warn":
            return np.ones(len(frames), dtype=bool)
        return self.depth(frames) <= self.fit

    def fits(self, frames: Floats, alone: bool = False) -> Array:
        """(n,) bool: the wheel fits, at one of its leans at least; ``alone``: whatever goes with it."""
        depth = self.tool_depth if alone else self.depth
        found = depth(frames) <= self.fit
        for k in range(1, len(self.leans)):
            left = np.flatnonzero(~found)
            if not len(left):
                break
            found[left] = depth(self._leaned(frames[left], k)) <= MARGIN * self.fit
        return found

    def in_the_way(self, frames: Floats) -> list[str]:
        """Names of what goes with the wheel and is in its way at frames (n, 4, 4), what is most often first."""
        met = self.held.first_met(frames, self.fit)
        counts = np.bincount(met[met >= 0], minlength=len(self.held.names))
        return [self.held.names[k] for k in np.argsort(-counts, kind="stable") if counts[k]]

    def cleared(self, levels: Levels) -> Levels:
        """Pieces of passes by level, as the core's lines (dict(points, normals, tangents (n, 3), closed)), leaned
        where they must be; what fits no way is cut out. Pieces have a ``cut`` (bool, bool) then: ends that lie
        beside a place that is left out.
        """
        if self.blind or self.settings["where_it_collides"] == "warn":
            return levels
        flat = finer([piece for pieces in levels for piece in pieces], self.tool.check)
        depths = self._by_piece(flat, 0)
        wrong = [k for k, depth in enumerate(depths) if (depth > self.fit).any()]
        tried = {k: [depths[k]] for k in wrong}
        for lean in range(1, len(self.leans)):
            for k, depth in zip(wrong, self._by_piece([flat[k] for k in wrong], lean)):
                tried[k].append(depth)
        result, number = [], 0
        for pieces in levels:
            kept: list[Piece] = []
            for piece in pieces:
                if number in tried:
                    kept += self._chosen(piece, flat[number], np.array(tried[number]))
                else:
                    kept.append(piece)
                number += 1
            result.append(kept)
        return result

    def cut(self, strokes: list[Piece]) -> list[Piece]:
        """Strokes (as ``passes.assemble`` has them) without the poses at which the wheel does not fit: what
        smoothing, bridges and run-outs have changed."""
        if self.blind or self.settings["where_it_collides"] == "warn" or not strokes:
            return strokes
        result = []
        for stroke, depth in zip(strokes, self._by_piece(strokes, 0)):
            fits = depth <= self.fit * (1.0 + 1e-9)
            if fits.all():
                result.append(stroke)
                continue
            for run in runs(fits):
                part = part_of(stroke, run)
                if passes.length(part["points"]) >= max(self.settings["min_length_mm"], 1e-9):
                    result.append(part)
        return result

    def heights(self, frames: Floats, most: float) -> Floats:
        """mm (n,), up to ``most``, to which the wheel can be lifted along its normal from frames (n, 4, 4) of passes'
        ends without standing in the part; 0: not at all."""
        free, going = np.zeros(len(frames)), np.ones(len(frames), dtype=bool)
        for share in np.arange(1, LIFTS + 1) / LIFTS:
            some = np.flatnonzero(going)
            lifted = frames[some].copy()
            lifted[:, :3, 3] -= share * most * lifted[:, :3, 2]
            going[some] = self.fits_upright(lifted)
            free[going] = share * most
        return free

    def ways_blocked(self, contacts: Floats, rapid: Array) -> list[int]:
        """Numbers of the poses that are reached rapidly and through the part, on straight ways; ``contacts``
        (n, 4, 4), ``rapid`` (n,) bool of the way to each pose."""
        found: list[int] = []
        moves = np.flatnonzero(rapid[1:])
        frames, owner = [], []
        for k in moves:
            a, b = contacts[k], contacts[k + 1]
            way = np.linalg.norm(b[:3, 3] - a[:3, 3])
            count = min(max(math.ceil(way / self.tool.check), 1), MOST_ON_WAY)
            frames.append(passes.between(a, b, np.arange(1, count + 1) / count))
            owner += [k + 1] * count
        if not frames:
            return found
        deep = self.depth(np.concatenate(frames)) > self.fit
        return np.unique(np.array(owner)[deep]).tolist()

    def _by_piece(self, pieces: Sequence[Piece], lean: int) -> list[Floats]:
        """mm (n,) of each piece."""
        if not pieces:
            return []
        found = self.depth(self._leaned(self.frames(as_one(pieces)), lean))
        return np.split(found, begins(pieces)[1:])

    def frames(self, piece: Piece) -> Floats:
        """work_from_contact (n, 4, 4) at the points of a piece."""
        settings = self.settings
        points = piece["points"] + settings["offset_mm"] * piece["normals"]
        angle = math.radians(settings["belt_angle_deg"])
        return passes.contact_frames(points, piece["normals"], piece["tangents"], angle)

    def _leaned(self, frames: Floats, lean: int) -> Floats:
        """Frames by the lean of that number, standing on the same places."""
        if lean == 0:
            return frames
        found = frames.copy()
        found[:, :3, :3] = frames[:, :3, :3] @ self._turns[lean]
        found[:, :3, 3] -= found[:, :3, :3] @ self._shifts[lean]
        return found

    def _chosen(self, piece: Piece, fine: Piece, depths: Floats) -> list[Piece]:
        """The pieces that are left of one; ``depths`` (leans, n)."""
        limits = np.where(np.arange(len(self.leans)) == 0, self.fit, MARGIN * self.fit)
        states = _cheapest(depths <= limits[:, None], self.leans)
        result = []
        kept_runs = runs(states >= 0)
        for run in kept_runs:
            mine = states[run]
            kept = fine["own"][run]
            kept[[0, -1]] = True
            changes = np.flatnonzero(np.diff(mine))
            kept[changes] = kept[changes + 1] = True
            places = run[kept]
            part = self._posed({**piece, **part_of(fine, places)}, mine[kept])
            whole = len(run) == len(states)
            part["closed"] = piece["closed"] and whole
            before, after = piece.get("cut", passes.UNCUT)
            part["cut"] = (run[0] > 0 or before, run[-1] < len(states) - 1 or after)
            part.pop("own", None)
            result.append(part)
        if (
            piece["closed"]
            and len(kept_runs) > 1
            and kept_runs[0][0] == 0
            and kept_runs[-1][-1] == len(states) - 1
        ):
            last = result.pop()  # the beginning of a ring is no end
            for name in OF_POINTS:
                result[0][name] = np.vstack([last[name][:-1], result[0][name]])
            result[0]["cut"] = (True, True)
        return result

    def _posed(self, piece: Piece, states: Array) -> Piece:
        """The piece with its poses leaned as ``states`` (n,) say."""
        if not states.any():
            return piece
        frames, angle = self.frames(piece), math.radians(self.settings["belt_angle_deg"])
        for lean in np.unique(states[states > 0]):
            mine = states == lean
            frames[mine] = self._leaned(frames[mine], lean)
        normals = -frames[:, :3, 2]
        tangents = frames[:, :3, 0] * math.cos(angle) - frames[:, :3, 1] * math.sin(angle)
        points = frames[:, :3, 3] - self.settings["offset_mm"] * normals
        return {**piece, "points": points, "normals": normals, "tangents": tangents}


def _about_x(angle: float) -> Floats:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _on_mesh(mesh: core.TriangleMesh, spacing: float, most: int) -> Floats:
    """Points (n, 3) on a core.TriangleMesh, ``spacing`` mm apart at most, if they are not more than ``most``."""
    p = np.asarray(mesh.vertices, dtype=float)[np.asarray(mesh.triangles)]
    longest = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1)
    while True:
        parts = np.maximum(np.ceil(longest / spacing), 1).astype(int)
        if (parts.astype(float) ** 2).sum() <= 2.0 * most or (parts == 1).all():
            break
        spacing *= 1.5
    found = []
    for count in np.unique(parts):
        i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
        inside = i + j <= count
        a, b = i[inside] / count, j[inside] / count
        weights = np.column_stack([1.0 - a - b, a, b])
        found.append(np.einsum("kc,ncx->nkx", weights, p[parts == count]).reshape(-1, 3))
    return np.vstack(found)


def as_one(pieces: Sequence[Piece]) -> Piece:
    """Points, normals and tangents (n, 3) of all pieces: at a time, for they may be thousands of few points each."""
    return {name: np.concatenate([one[name] for one in pieces]) for name in OF_POINTS}


def begins(pieces: Sequence[Piece]) -> Array:
    """(pieces,) the number of each one's first point among those of all."""
    return np.cumsum([0, *(len(one["points"]) for one in pieces)])[:-1]


def finer(pieces: Sequence[Piece], spacing: float) -> list[Piece]:
    """The pieces with points no farther apart than ``spacing`` mm; ``own`` (n,) bool: those that they had."""
    if not pieces:
        return []
    whole, last = as_one(pieces), begins(pieces)[1:] - 1
    ways = np.linalg.norm(np.diff(whole["points"], axis=0), axis=1)
    count = np.append(np.maximum(np.ceil(ways / spacing), 1).astype(int), 1)
    count[last] = 1  # from piece to piece there is nothing
    i = np.repeat(np.arange(len(count)), count)
    first = np.cumsum(count) - count
    share = (np.arange(len(i)) - np.repeat(first, count)) / count[i]
    found: dict[str, Any] = {"own": share == 0.0}
    for name in OF_POINTS:
        a = whole[name]
        found[name] = a[i] + share[:, None] * (np.append(a[1:], a[-1:], axis=0)[i] - a[i])
        if name != "points":
            found[name] /= np.linalg.norm(found[name], axis=1)[:, None]
    parts = {name: np.split(all_, first[begins(pieces)[1:]]) for name, all_ in found.items()}
    return [
        {"closed": one["closed"], **{name: part[k] for name, part in parts.items()}}
        for k, one in enumerate(pieces)
    ]


def part_of(piece: Piece, places: Array) -> Piece:
    """The piece's points of these numbers."""
    return {**piece, **{name: piece[name][places] for name in OF_POINTS}}


def runs(wanted: Array) -> list[Array]:
    """Index arrays of the runs in which ``wanted`` (n,) is true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], wanted, [False]]).astype(int)))
    return [np.arange(a, b) for a, b in zip(edges[::2], edges[1::2])]


def _cheapest(fits: Array, leans: Floats) -> Array:
    """For each place the number of its lean, -1: left out, such that the sum of the costs is least (dynamic
    programming over the places). ``fits``: (leans, n) bool."""
    scale = max(abs(leans).max(), 1e-9)
    costs = np.append(abs(leans) / scale, LEFT_OUT)
    change = CHANGE * abs(leans[:, None] - leans[None]) / scale
    between = np.full((len(costs), len(costs)), CUT)
    between[:-1, :-1] = change * 2.0
    between[-1, -1] = 0.0
    count = fits.shape[1]
    usable = np.vstack([fits, np.ones(count, dtype=bool)])
    total = np.where(usable[:, 0], costs, np.inf)
    came = np.zeros((count, len(costs)), dtype=int)
    for k in range(1, count):
        ways = total[:, None] + between
        came[k] = ways.argmin(axis=0)
        total = ways[came[k], np.arange(len(costs))] + np.where(usable[:, k], costs, np.inf)
    states = np.zeros(count, dtype=int)
    states[-1] = int(np.argmin(total))
    for k in range(count - 1, 0, -1):
        states[k - 1] = came[k, states[k]]
    states[states == len(leans)] = -1
    return states
