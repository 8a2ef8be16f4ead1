"""Studies: one job many times, with what varies. What macros call is ``study``."""
