"""The law of removal from measured grinds, and the finish from measured roughnesses. What a macro calls; the modules
import each other, not this.
"""

from .calibrate import fit, fit_law, write
from .finish import fit_finish
from .law import predict
from .part_scan import calibrate_from_scan
from .table import read

__all__ = ["calibrate_from_scan", "fit", "fit_finish", "fit_law", "predict", "read", "write"]
