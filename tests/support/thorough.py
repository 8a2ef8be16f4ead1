"""How many cases a test of many tries takes: few within tools/test, all where BELTGRINDING_THOROUGH is set."""

import os

THOROUGH = bool(os.environ.get("BELTGRINDING_THOROUGH"))


def cases(short, whole):
    """``whole`` where BELTGRINDING_THOROUGH is set, else ``short``."""
    return whole if THOROUGH else short
