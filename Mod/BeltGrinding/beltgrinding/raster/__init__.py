"""Raster paths. What a macro calls; the modules import each other, not this."""

from .in_turn import in_turn
from .path_check import check
from .raster_path import load_job, program, raster, summary, validate
from .region import of_result

__all__ = [
    "check",
    "in_turn",
    "load_job",
    "of_result",
    "program",
    "raster",
    "summary",
    "validate",
]
