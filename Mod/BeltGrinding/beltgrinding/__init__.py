"""Robotic belt-grinding simulation: the same engine for FreeCAD, macros and the command line.

``run(job)`` grinds a job given as plain data (``job.json``); ``beltgrinding.objects`` does the same
with document objects inside FreeCAD. Units: millimetre, newton, second, megapascal.
"""

from pathlib import Path


# Taken from the core when first asked for: without a core that fits, the workbench must still be able
# to say so.
CORE_NAMES = {name: name for name in ("InputError", "Cancelled", "RunContext")}
CORE_NAMES["__version__"] = "VERSION"


def resources() -> Path:
    """The folder Resources, installed or of a checkout."""
    return _folder("Resources")


def documentation() -> Path:
    """The folder docs, installed or of a checkout."""
    return _folder("docs")


def _folder(name):
    here = Path(__file__).resolve()
    for folder in (here.parents[1] / name, here.parents[3] / name):
        if folder.is_dir():
            return folder
    raise FileNotFoundError(f"The folder {name} is missing; install the workbench again.")


def run(job, context=None, recording=None):
    """Runs a job (a dict, or the path of a job.json); returns a ``job.Result``. ``recording``: as in
    ``job.run``.
    """
    from . import job as jobs

    job = jobs.validate(job) if isinstance(job, dict) else jobs.load(job)
    return jobs.run(job, context, recording)


def report(result, output=None, pdf=None, language="en", title=None, context=None):
    """Writes the report of a result as one HTML file; see ``reporting.report``."""
    from . import reporting

    return reporting.report(result, output, pdf, language, title, context)


def converge(job, context=None):
    """Runs a job (a dict, or the path of a job.json) coarser, as given and finer; returns its
    ``job.Result`` with ``convergence``; see ``convergence.converge``.
    """
    from . import convergence, job as jobs

    job = jobs.validate(job) if isinstance(job, dict) else jobs.load(job)
    return convergence.converge(job, context)


def ground_mesh(result, path=None, ground=True, deflection_mm=None, context=None):
    """The whole part as ground, as one closed mesh (``closed_mesh.ground_mesh``); written to
    ``path`` (.stl, .ply, .3mf) if there is one. result: a ``job.Result`` or its folder.
    """
    from . import closed_mesh
    from .result import Result, colour_scale

    result = result if isinstance(result, Result) else Result.read(result)
    deflection = closed_mesh.DEFLECTION if deflection_mm is None else deflection_mm
    mesh = closed_mesh.ground_mesh(result, ground, deflection, context)
    if path is not None:
        closed_mesh.write(mesh, path, colour_scale(result.job))
    return mesh


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
    "make_verdict",
    "set_zones",
    "make_figures",
    "write_report",
    "check_settings",
    "export_job",
    "import_result",
    "open_job",
    "make_ground_mesh",
    "compare_scan",
)


def __getattr__(name):
    if name == "core" or name in CORE_NAMES:
        from . import core_library

        core = globals()["core"] = core_library.load()
        globals().update({ours: getattr(core, theirs) for ours, theirs in CORE_NAMES.items()})
        return globals()[name]
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
    return sorted({*globals(), "core", *CORE_NAMES, *DOCUMENT_FUNCTIONS})
