"""Coin nodes of a free belt, a platen and a fork: rollers, the belt round them, the plate and its layers; runs and arms.

All are in the contact frame: its origin lies on the belt's outer face, x along the travel, z into the work. The
belt is drawn as it runs when it touches nothing.
"""

import math

import numpy as np

from ...base.solids import box
from ...job import fork
from ...job.bodies import PLATE, ROLLERS
from ...objects.belt_machine import KEYS, KIND_KEYS, PLATEN, layers_of
from ...objects.properties import to_job
from .shapes3d import BELT, CORE, RUBBER, axes, material, revolved, separator, triangles

TURN = 24  # chords of the belt round a roller
LEAST = 0.004  # of the free length: a belt that is thinner is drawn so thick
AXES = 0.15  # of the free length


def parts(machine):
    """{name of the body in events, or '' for what is none: node} of a free belt or platen in the document."""
    found = {"": separator(material(BELT), triangles(*belt(machine), crease=0.8))}
    found[""].addChild(axes(AXES * machine.RunLength.Value))
    for name, middle in zip(ROLLERS, ends(machine)):
        if machine.RollerRadius.Value > 0.0:
            found[name] = separator(material(CORE), triangles(*roller(machine, middle)))
    if machine.Kind == PLATEN:
        plate, layers = platen(machine)
        found[PLATE] = separator(material(CORE), triangles(*plate, crease=0.0))
        for layer in layers:
            found[""].addChild(separator(material(RUBBER), triangles(*layer, crease=0.0)))
    return found


def fork_parts(machine):
    """{name of the body in events: node} of what holds a small wheel in the document: the belt's runs, the arms."""
    job = {"belt_machine": {}}
    to_job(machine, (*KIND_KEYS[machine.Kind], *KEYS), job)
    job = job["belt_machine"]
    found = {}
    for name, side in zip(fork.NAMES, (-1.0, 1.0) if fork.holds(job) else ()):
        found[name] = separator(material(BELT), triangles(*fork.run(job, side), crease=0.0))
    arms = [triangles(*arm, crease=0.0) for arm in fork.arms(job)]
    if arms:
        found[fork.ARMS] = separator(material(CORE), *arms)
    return found


def ends(machine):
    """x of the two rollers' axes."""
    half, shift = 0.5 * machine.RunLength.Value, machine.RunPosition.Value
    return -half - shift, half - shift


def roller(machine, middle):
    """(points, triangles) of a roller at x ``middle``, on whose top the belt's inner face lies."""
    radius, half = machine.RollerRadius.Value, 0.5 * machine.RunWidth.Value
    line = np.array([[-half, 0.0], [-half, radius], [half, radius], [half, 0.0]])
    points, faces = revolved(line)
    return points + [middle, 0.0, -machine.RunThickness.Value - radius], faces


def belt(machine):
    """(points, triangles) of the whole belt round its rollers; without rollers, of the free run."""
    thickness = max(machine.RunThickness.Value, LEAST * machine.RunLength.Value)
    inner, half = machine.RollerRadius.Value, 0.5 * machine.RunWidth.Value
    first, last = ends(machine)
    if inner <= 0.0:
        return box([first, -half, -thickness], [last, half, 0.0])
    centre = -machine.RunThickness.Value - inner
    angles = np.linspace(0.5 * math.pi, -0.5 * math.pi, TURN + 1)
    lines = []
    for radius in (
        inner + machine.RunThickness.Value - thickness,
        inner + machine.RunThickness.Value,
    ):
        x, z = radius * np.cos(angles), radius * np.sin(angles) + centre
        lines.append(np.stack([np.r_[last + x, first - x[::-1]], np.r_[z, z[::-1]]], axis=1))
    return band(*lines, half)


def band(inside, outside, half):
    """(points, triangles) between two closed lines [x, z] (n, 2), ``half`` wide to both sides of y = 0."""
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


def platen(machine):
    """((points, triangles) of the plate, [the same of each layer on it])."""
    half, long = 0.5 * machine.RunWidth.Value, 0.5 * machine.PlatenLength.Value
    layers = layers_of(machine)
    at = -machine.RunThickness.Value - sum(layer["thickness_mm"] for layer in layers)
    plate = box([-long, -half, at - machine.PlateThickness.Value], [long, half, at])
    found = []
    for layer in layers:
        found.append(box([-long, -half, at], [long, half, at + layer["thickness_mm"]]))
        at += layer["thickness_mm"]
    return plate, found
