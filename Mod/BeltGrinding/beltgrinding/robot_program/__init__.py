"""Programs for the whole robot: postures along the passes, links between them, from home to home."""

from .moves import Move, Whole
from .whole import plan

__all__ = ["Move", "Whole", "plan"]
