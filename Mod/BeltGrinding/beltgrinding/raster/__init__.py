"""Raster paths. What a macro calls; the modules import each other, not this."""

from .path_check import check
from .raster_path import load_job, program, raster, summary, validate

__all__ = ["check", "load_job", "program", "raster", "summary", "validate"]
