"""The law of removal from measured grinds. What a macro calls; the modules import each other, not this."""

from .calibrate import fit, fit_law, write
from .law import predict
from .part_scan import calibrate_from_scan
from .table import read

__all__ = ["calibrate_from_scan", "fit", "fit_law", "predict", "read", "write"]
