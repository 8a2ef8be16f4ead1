"""Coin nodes of a free belt, a platen and a fork: rollers, the belt round them, the plate and its layers; runs and arms.

All are in the contact frame: its origin lies on the belt's outer face, x along the travel, z into the work. The
belt is drawn as it runs when it touches nothing.
"""

import math

import numpy as np

from ...base.solids import box
from ...job import fork, free_run
from ...job.bodies import PLATE, ROLLERS
from ...objects.belt_machine import KEYS, KIND_KEYS, LAYERS, PLATEN, layers_of
from ...objects.properties import to_job
from .shapes3d import BELT, CORE, RUBBER, axes, material, revolved, separator, triangles

TURN = 24  # chords of the belt round a roller
LEAST = 0.004  # of the free length: a belt that is thinner is drawn so thick
AXES = 0.15  # of the free length


def parts(machine):
    """{name of the body in events, or '' for what is none: node} of a free belt or platen in the document."""
    job = _of_job(machine)
    found = {"": separator(material(BELT), triangles(*belt(job), crease=0.8))}
    found[""].addChild(axes(AXES * job["free_run"]["length_mm"]))
    for name, middle in zip(ROLLERS, free_run.ends(job)):
        if job["free_run"]["roller_radius_mm"] > 0.0:
            found[name] = separator(material(CORE), triangles(*roller(job, middle)))
    if machine.Kind == PLATEN:
        found[PLATE] = separator(material(CORE), triangles(*free_run.plate(job), crease=0.0))
        for layer in free_run.layers(job):
            found[""].addChild(separator(material(RUBBER), triangles(*layer, crease=0.0)))
    return found


def fork_parts(machine):
    """{name of the body in events: node} of what holds a small wheel in the document: the belt's runs, the arms."""
    job, found = _of_job(machine), {}
    for name, side in zip(fork.NAMES, (-1.0, 1.0) if fork.holds(job) else ()):
        found[name] = separator(material(BELT), triangles(*fork.run(job, side), crease=0.0))
    arms = [triangles(*arm, crease=0.0) for arm in fork.arms(job)]
    if arms:
        found[fork.ARMS] = separator(material(CORE), *arms)
    return found


def _of_job(machine):
    """A job's ``belt_machine`` of one in the document; layers that were written by hand and are none are left out."""
    keys = (key for key in KIND_KEYS[machine.Kind] if key is not LAYERS)
    job = {"belt_machine": {}}
    to_job(machine, (*keys, *KEYS), job)
    if machine.Kind == PLATEN:
        job["belt_machine"]["platen"]["layers"] = layers_of(machine)
    return job["belt_machine"]


def roller(job, middle):
    """(points, triangles) of a roller at x ``middle``. ``job``: a job's belt_machine."""
    run = job["free_run"]
    radius, half = run["roller_radius_mm"], 0.5 * run["width_mm"]
    line = np.array([[-half, 0.0], [-half, radius], [half, radius], [half, 0.0]])
    points, faces = revolved(line)
    return points + [middle, 0.0, free_run.roller_height(job)], faces


def belt(job):
    """(points, triangles) of the whole belt round its rollers; without rollers, of the free run."""
    run = job["free_run"]
    thickness = max(run["thickness_mm"], LEAST * run["length_mm"])
    inner, half = run["roller_radius_mm"], 0.5 * run["width_mm"]
    first, last = free_run.ends(job)
    if inner <= 0.0:
        return box([first, -half, -thickness], [last, half, 0.0])
    centre, outer = free_run.roller_height(job), inner + run["thickness_mm"]
    angles = np.linspace(0.5 * math.pi, -0.5 * math.pi, TURN + 1)
    lines = []
    for radius in (outer - thickness, outer):
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
