"""Coin nodes of a free belt, a platen and a fork: rollers, the belt round them, the plate and its layers; runs and arms.

All are in the contact frame: its origin lies on the belt's outer face, x along the travel, z into the work.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np

from ...engine import InputError
from ...geometry import fork, free_run, pressed_belt
from ...geometry.body_names import PLATE, ROLLERS
from ...geometry.solids import strip
from ...objects.belt_machine import KEYS, KIND_KEYS, LAYERS, PLATEN, check_run, layers_of
from ...objects.kinds import DocumentObject
from ...objects.properties import to_job
from ..common.kinds import Array, Json, Node, Surface
from .shapes3d import BELT, CORE, RUBBER, axes, material, revolved, separator, triangles

TURN = 24  # chords of the belt round a roller
ALONG = 96  # places of the belt between its rollers, where it is pressed
BELT_NODE = "BeltGrindingBelt"  # name of the belt's node in that of ""
LEAST = 0.004  # of the free length: a belt that is thinner is drawn so thick
AXES = 0.15  # of the free length


def parts(machine: DocumentObject) -> dict[str, Node]:
    """{name of the body in events, or '' for what is none: node} of a free belt or platen in the document; the belt as it
    touches nothing."""
    job = as_job(machine)
    found = {"": separator(belt_node(job), axes(AXES * job["free_run"]["length_mm"]))}
    for name, axis in zip(ROLLERS, free_run.roller_axes(job)):
        if job["free_run"]["roller_radius_mm"] > 0.0:
            found[name] = separator(material(CORE), triangles(*roller(job, axis)))
    if machine.Kind == PLATEN:
        found[PLATE] = separator(material(CORE), triangles(*free_run.plate(job), crease=0.0))
        for layer in free_run.layers(job):
            found[""].addChild(separator(material(RUBBER), triangles(*layer, crease=0.0)))
    if _runs(job):
        found.update(_runs_and_arms(free_run, job))
    return found


def fork_parts(machine: DocumentObject) -> dict[str, Node]:
    """{name of the body in events: node} of what holds a small wheel in the document: the belt's runs, the arms."""
    job = as_job(machine)
    return _runs_and_arms(fork, job) if fork.holds(job) else {}


def _runs_and_arms(holder: ModuleType, job: Json) -> dict[str, Node]:
    found = {}
    for name, side in zip(holder.NAMES, (-1.0, 1.0)):
        points, faces = holder.run(job, side)
        found[name] = separator(material(BELT), triangles(points, faces, crease=0.0))
    arms = [triangles(points, faces, crease=0.0) for points, faces in holder.arms(job)]
    if arms:
        found[holder.ARMS] = separator(material(CORE), *arms)
    return found


def as_job(machine: DocumentObject) -> dict[str, Any]:
    """A job's ``belt_machine`` of one in the document; layers that were written by hand and are none are left out, and so
    is a radius that a platen cannot have."""
    keys = (key for key in KIND_KEYS[machine.Kind] if key is not LAYERS)
    data: dict[str, Any] = {"belt_machine": {}}
    to_job(machine, (*keys, *KEYS), data)
    job: dict[str, Any] = data["belt_machine"]
    if machine.Kind == PLATEN:
        job["platen"]["layers"] = layers_of(machine)
        try:
            check_run(job)
        except InputError:
            job["platen"]["radius_mm"] = 0.0
    return job


def press(node: Node, job: Json, points: Array, triangles: Array, was_pressed: bool) -> bool:
    """Draws the belt in the node of '' of ``parts`` as a part presses it, a mesh with its points (n, 3) in the contact frame;
    whether that reaches through it. ``was_pressed``: what this said the last time."""
    section = pressed_belt.slab(points, triangles, 0.5 * job["free_run"]["width_mm"])
    pushed = pressed_belt.pushed(job, section)
    if pushed is not None or was_pressed:
        for k in range(node.getNumChildren()):
            if node.getChild(k).getName() == BELT_NODE:
                node.replaceChild(k, belt_node(job, pushed))
    return pushed is not None


def roller(job: Json, axis: Sequence[float]) -> Surface:
    """(points, triangles) of a roller whose axis lies at [x, z]. ``job``: a job's belt_machine."""
    run = job["free_run"]
    radius, half = run["roller_radius_mm"], 0.5 * run["width_mm"]
    line = np.array([[-half, 0.0], [-half, radius], [half, radius], [half, 0.0]])
    points, faces = revolved(line)
    return points + [axis[0], 0.0, axis[1]], faces


def belt_node(job: Json, pushed: tuple[Array, Array] | None = None) -> Node:
    """``pushed``: as of ``belt``."""
    node = separator(material(BELT), triangles(*belt(job, pushed), crease=0.8))
    node.setName(BELT_NODE)
    return node


def outline(job: Json) -> Array:
    """Points [x, z] (n, 2) of the belt's outer face, as ``belt`` has it; where it goes round, the first once more."""
    line = _round_rollers(job, free_run.line(job, free_run.face(job)), 0.0)
    return np.concatenate([line, line[:1]]) if _closed(job) else line


def belt(job: Json, pushed: tuple[Array, Array] | None = None) -> Surface:
    """(points, triangles) of the belt from roller to roller and round them, back from one to the other unless its runs are
    drawn apart. ``pushed``: (x, mm) by which its face is pressed in from where it touches nothing.
    """
    run = job["free_run"]
    thickness = max(run["thickness_mm"], LEAST * run["length_mm"])
    places = free_run.face(job)
    if pushed is not None:
        places = np.union1d(places, np.linspace(places[0], places[-1], ALONG + 1))
    lines = []
    for below in (thickness, 0.0):
        face = free_run.line(job, places, below)
        if pushed is not None:
            face[:, 1] -= np.interp(free_run.line(job, places)[:, 0], *pushed, left=0.0, right=0.0)
        lines.append(_round_rollers(job, face, below))
    inside, outside = lines
    return (band if _closed(job) else _between)(inside, outside, 0.5 * run["width_mm"])


def _between(inside: Array, outside: Array, half: float) -> Surface:
    return strip(outside, inside, half)


def _closed(job: Json) -> bool:
    """The belt goes on from one roller to the other behind them."""
    return job["free_run"]["roller_radius_mm"] > 0.0 and not _runs(job)


def _runs(job: Json) -> bool:
    return free_run.has_runs(job) and free_run.short_frame(job) is None


def _round_rollers(job: Json, face: Array, below: float) -> Array:
    """Points [x, z] (n, 2) of a line of the belt that goes on round the rollers, ``below`` mm under its outer face."""
    run = job["free_run"]
    if run["roller_radius_mm"] <= 0.0:
        return face
    radius = run["roller_radius_mm"] + run["thickness_mm"] - below
    first, last = free_run.roller_axes(job)
    start = free_run.arc(job)[1]  # the belt's normal there, from z towards the roller's outer side
    ends = [math.pi, math.pi]
    if _runs(job):
        for k, (side, axis) in enumerate(zip((-1.0, 1.0), (first, last))):
            x, z = (free_run.run_corners(job, side)[0] - axis) * [side, 1.0]
            ends[k] = math.atan2(x, z)
    before, after = (np.linspace(start, end, TURN + 1) for end in ends)
    left = first + radius * np.stack([-np.sin(before), np.cos(before)], axis=1)
    right = last + radius * np.stack([np.sin(after), np.cos(after)], axis=1)
    return np.concatenate([left[:0:-1], face, right[1:]])


def band(inside: Array, outside: Array, half: float) -> Surface:
    """(points, triangles) between two lines [x, z] (n, 2) that go round together, from the last point back to the first,
    ``half`` wide to both sides of y = 0."""
    rings = [
        np.stack([line[:, 0], np.full(len(line), y), line[:, 1]], axis=1)
        for line, y in ((inside, -half), (inside, half), (outside, half), (outside, -half))
    ]
    count, found = len(inside), []
    i = np.arange(count)
    after = (i + 1) % count
    for k in range(4):
        a, b = k * count, (k + 1) % 4 * count
        found.append(np.stack([a + i, a + after, b + after], axis=1))
        found.append(np.stack([a + i, b + after, b + i], axis=1))
    return np.concatenate(rings), np.concatenate(found)
