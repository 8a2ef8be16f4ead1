"""Presets of wheels, belts, materials and robots, and rubber's modulus.

What a macro calls; the modules import each other, not this.
"""

from .library import apply, belts, materials, problems, robots, settings, wheels
from .rubber import shore_to_modulus

__all__ = [
    "apply",
    "belts",
    "materials",
    "problems",
    "robots",
    "settings",
    "shore_to_modulus",
    "wheels",
]
