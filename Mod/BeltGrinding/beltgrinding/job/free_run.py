"""A free belt or a platen: where its rollers, its plate and the layers on it lie.

All is in the contact frame: its origin lies on the belt's outer face, x along the travel, z into the work. ``machine``: a
job's belt_machine with its defaults; lengths mm.
"""

from ..base.solids import box


def ends(machine):
    """x of the two rollers' axes, between which the belt runs."""
    run = machine["free_run"]
    half, shift = 0.5 * run["length_mm"], run["position_mm"]
    return -half - shift, half - shift


def roller_height(machine):
    """z of the rollers' axes: the belt's inner face lies on them."""
    run = machine["free_run"]
    return -run["thickness_mm"] - run["roller_radius_mm"]


def plate(machine):
    """(points (8, 3), triangles (12, 3)) of a platen's plate, behind its layers."""
    behind = _behind(machine)
    return _slab(machine, behind - machine["platen"]["plate_thickness_mm"], behind)


def layers(machine):
    """[(points (8, 3), triangles (12, 3))] of a platen's layers, from the plate outwards."""
    at, found = _behind(machine), []
    for layer in machine["platen"]["layers"]:
        found.append(_slab(machine, at, at + layer["thickness_mm"]))
        at += layer["thickness_mm"]
    return found


def _behind(machine):
    """z of the plate's face."""
    thick = sum(layer["thickness_mm"] for layer in machine["platen"]["layers"])
    return -machine["free_run"]["thickness_mm"] - thick


def _slab(machine, low, high):
    half, long = 0.5 * machine["free_run"]["width_mm"], 0.5 * machine["platen"]["length_mm"]
    return box([-long, -half, low], [long, half, high])
