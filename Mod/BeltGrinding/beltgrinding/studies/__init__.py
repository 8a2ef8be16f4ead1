"""Studies: one job many times, with what varies. What macros call is ``study``."""

from .making import Progress, Study, study
from .table import Table

__all__ = ["Progress", "Study", "Table", "study"]
