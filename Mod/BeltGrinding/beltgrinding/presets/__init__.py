"""Presets of machines, wheels, belts, materials, robots, controllers and force controls, and rubber's modulus.

What a macro calls; the modules import each other, not this.
"""

from .library import (
    actuators,
    apply,
    belts,
    controllers,
    machines,
    materials,
    problems,
    robots,
    settings,
    thermals,
    wheels,
)
from .rubber import shore_to_modulus

__all__ = [
    "actuators",
    "apply",
    "belts",
    "controllers",
    "machines",
    "materials",
    "problems",
    "robots",
    "settings",
    "shore_to_modulus",
    "thermals",
    "wheels",
]
