"""Raster paths. What a macro calls; the modules import each other, not this."""

from .raster_path import load_job, program, raster, summary, validate

__all__ = ["load_job", "program", "raster", "summary", "validate"]
