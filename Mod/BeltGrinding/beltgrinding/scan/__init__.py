"""Scans of the part as really ground. What a macro calls; the modules import each other, not this."""

from .comparison import align, compare, datum, measure, statistics, write

__all__ = ["align", "compare", "datum", "measure", "statistics", "write"]
