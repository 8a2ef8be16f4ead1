"""Motions whose tool turns by a rule of its language, as such that turn from pose to pose."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...base.kinds import known
from ..program import Fact, circle_through, through_with, turned

if TYPE_CHECKING:
    from ..program import Motion

PIECE = math.radians(15.0)  # of an arc that turns with its path


def resolved(motions: list[Motion]) -> tuple[list[Motion], list[Fact]]:
    """(motions, Facts): the Motions with every ``turn`` empty. Poses have the orientation that the robot
    arrives with; arcs that turn against their path are several, within 0.1 degrees. The Facts say where
    that is not possible, since the frame changes on the way.
    """
    if not any(motion.turn for motion in motions):
        return motions, []
    found: list[Motion] = []
    notes: list[Fact] = []
    before: Motion | None = None
    aux: Motion | None = None
    for motion in motions:
        if motion.aux and motion.pose is not None:
            aux = motion
            continue
        own, start = motion, before
        if motion.pose is None or motion.kind == "PTP" or start is None:
            start = None
        elif motion.turn and (start.base, start.tool) != (motion.base, motion.tool):
            notes.append(
                Fact(
                    "programs.writers.turn",
                    "line {line}: the frame changes where the tool's orientation is held or follows the "
                    "path; it turns to the target's there",
                    line=motion.line,
                )
            )
            start = None
        if start is None or not motion.turn:
            found += [aux] if aux else []
            own = replace(motion, turn="")
            found.append(own)
        else:
            pieces = _pieces(start, aux, motion)
            found += pieces
            own = pieces[-1]
        before, aux = (own if own.pose is not None else None), None
    return found, notes


def _pieces(start: Motion, aux: Motion | None, motion: Motion) -> list[Motion]:
    first, last = known(start.pose), known(motion.pose)
    circle = circle_through(first, known(aux.pose), last) if aux else None
    if aux is None or circle is None or motion.turn == "hold":
        pose = through_with(last, first) if motion.turn.startswith("hold") else last
        return [replace(m, turn="") for m in (aux, replace(motion, pose=pose)) if m]
    centre, x_axis, y_axis, radius, angle = circle
    count = 2 * max(1, math.ceil(angle / PIECE))
    shares = np.arange(1, count + 1) / count
    rotations = turned(first, last, circle, motion.turn, shares)
    pieces = []
    for k, (share, rotation) in enumerate(zip(shares, rotations)):
        pose = np.eye(4)
        pose[:3, :3] = rotation
        at = share * angle
        pose[:3, 3] = centre + radius * (math.cos(at) * x_axis + math.sin(at) * y_axis)
        of = motion if k % 2 else aux
        pieces.append(replace(of, pose=pose, turn="", zone_mm=math.inf))
    pieces[-1] = replace(pieces[-1], zone_mm=motion.zone_mm)
    return pieces
