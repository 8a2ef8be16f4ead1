"""Robotic belt-grinding simulation: the same engine for FreeCAD, macros and the command line.

``run(job)`` grinds a job given as plain data (``job.json``); ``beltgrinding.objects`` does the same
with document objects inside FreeCAD. Units: millimetre, newton, second, megapascal.
"""

import os
import sys
from pathlib import Path


def _find_core():
    """Imports ``beltgrinding_core``: installed beside this package, or from a checkout's build."""
    here = Path(__file__).resolve().parent
    places = [here.parent, here.parents[2] / "build" / "release" / "python"]
    if "BELTGRINDING_BUILD" in os.environ:
        places.insert(0, Path(os.environ["BELTGRINDING_BUILD"]) / "python")
    for place in places:
        if any(place.glob("beltgrinding_core*.so")) and str(place) not in sys.path:
            sys.path.append(str(place))
    try:
        import beltgrinding_core
    except ImportError as error:
        looked = ", ".join(str(place) for place in places)
        raise ImportError(
            f"The simulator's library beltgrinding_core cannot be loaded ({error}). Looked in: "
            f"{looked}. Build it (tools/test does) or install the workbench for this Python, "
            f"{sys.version.split()[0]}."
        ) from error
    return beltgrinding_core


core = _find_core()
InputError = core.InputError
Cancelled = core.Cancelled
RunContext = core.RunContext
__version__ = core.VERSION


def resources() -> Path:
    """The folder Resources, installed or of a checkout."""
    here = Path(__file__).resolve()
    for folder in (here.parents[1] / "Resources", here.parents[3] / "Resources"):
        if folder.is_dir():
            return folder
    raise FileNotFoundError("The folder Resources is missing; install the workbench again.")


def run(job, context=None):
    """Runs a job (a dict, or the path of a job.json); returns a ``job.Result``."""
    from . import job as jobs

    return jobs.run(jobs.validate(job) if isinstance(job, dict) else jobs.load(job), context)


# What a macro calls inside FreeCAD: document objects (beltgrinding.objects.api).
DOCUMENT_FUNCTIONS = (
    "make_job",
    "make_stock",
    "make_belt_machine",
    "make_belt",
    "wear_belt",
    "follow_path",
    "import_program",
    "export_program",
    "make_raster",
    "simulate",
    "make_deviation",
    "make_section",
    "export_job",
    "import_result",
    "open_job",
)


def __getattr__(name):
    if name not in DOCUMENT_FUNCTIONS:
        raise AttributeError(f"module 'beltgrinding' has no attribute '{name}'")
    try:
        from .objects import api
    except ImportError as error:
        raise ImportError(
            f"beltgrinding.{name} works on a FreeCAD document ({error}): call it in FreeCAD or "
            "freecadcmd; beltgrinding.run(job) needs no FreeCAD"
        ) from None
    return getattr(api, name)


def __dir__():
    return sorted([*globals(), *DOCUMENT_FUNCTIONS])
