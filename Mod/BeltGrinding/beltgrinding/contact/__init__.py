"""Single contacts, surrogates trained on them, and their finite-element reference.

What a macro calls; the modules import each other, not this.
"""

from .single_contact import at_pose, load, rim, run, summary, validate, write_csv

__all__ = ["at_pose", "load", "rim", "run", "summary", "validate", "write_csv"]
