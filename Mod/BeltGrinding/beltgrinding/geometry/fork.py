"""A small wheel in a fork: the belt's two runs beside the wheel and the arms that hold its axle, for collisions.

All is in the contact frame: the wheel's centre lies at z = -R, x along the belt's travel, y along the axle.
"""

from __future__ import annotations

import math

import numpy as np

from ..base import records
from ..base.kinds import Json, known
from ..job.settings import BeltMachine
from .body_names import FORK, RUNS
from .solids import Mesh, prism

NAMES, ARMS = RUNS, FORK
GAP = 1.0  # mm between wheel and arms
ARM = 0.6  # of the wheel's radius: half of an arm's height


def holds(machine: BeltMachine | Json) -> bool:
    """Whether the belt's pulleys lie outside of the wheel, so that there are runs."""
    machine = records.made(BeltMachine, machine)
    return known(machine.fork).length_mm > machine.wheel.radius_mm


def run(machine: BeltMachine | Json, side: float) -> Mesh:
    """(points (8, 3) mm, triangles (12, 3)) of the belt that comes to the wheel (``side`` -1) or leaves it (1), straight
    from where it leaves the rim to where it meets its pulley. ``machine``: a job's belt_machine with its defaults.
    """
    machine = records.made(BeltMachine, machine)
    wheel, fork = machine.wheel, known(machine.fork)
    radius, half = wheel.radius_mm, 0.5 * wheel.width_mm
    far = np.array([0.5 * fork.spread_mm, -fork.length_mm])  # from the axle, of the side 1
    square = float(far @ far)
    # The tangent's point on the rim, the outer one of the two.
    share = radius / square
    touch = share * (radius * far + math.sqrt(square - radius**2) * np.array([-far[1], far[0]]))
    inwards = -fork.belt_thickness_mm / radius * touch
    corners = [touch, far, far + inwards, touch + inwards]
    points = [[side * x, y, z - radius] for y in (-half, half) for x, z in corners]
    return np.array(points), prism()[:, :: int(side)]  # mirrored, they turn the other way


def arms(machine: BeltMachine | Json) -> list[Mesh]:
    """[(points (8, 3) mm, triangles (12, 3))] of the two arms beside the wheel; none without a thickness."""
    machine = records.made(BeltMachine, machine)
    wheel, fork = machine.wheel, known(machine.fork)
    radius, thick = wheel.radius_mm, fork.arm_thickness_mm
    if thick <= 0.0:
        return []
    tall, inner = ARM * radius, 0.5 * wheel.width_mm + GAP
    section = [[-tall, tall], [tall, tall], [tall, -fork.length_mm], [-tall, -fork.length_mm]]
    found = []
    for ends in ((-inner - thick, -inner), (inner, inner + thick)):
        points = [[x, y, z - radius] for y in ends for x, z in section]
        found.append((np.array(points), prism()))
    return found
