"""Programs for the whole robot: postures along the passes, links between them, from home to home."""

from .whole import Move, Whole, plan

__all__ = ["Move", "Whole", "plan"]
