"""Robotic belt-grinding simulation: the same engine for FreeCAD, macros and the command line.

``run(job)`` grinds a job given as plain data (``job.json``); ``beltgrinding.objects`` does the same
with document objects inside FreeCAD. Units: millimetre, newton, second, megapascal.
"""

from .base.resources import documentation, resources
from .gui.common import command_registry
from .objects import view_providers

# Taken from the core when first asked for: without a core that fits, the workbench must still be able
# to say so.
ENGINE_NAMES = ("core", "InputError", "Cancelled", "RunContext", "__version__")


def run(job, context=None, recording=None):
    """Runs a job (a dict, or the path of a job.json); returns a ``job.Result``. ``recording``: as in
    ``job.run``.
    """
    from .job import load as jobs
    from .simulation import run as runs

    job = jobs.validate(job) if isinstance(job, dict) else jobs.load(job)
    return runs.run(job, context, recording)


def plan(job, settings=None, context=None, told=None):
    """Plans the feeds of a job (a dict, or the path of a job.json) so that the ground part keeps its tolerance; see
    ``planning.plan``.
    """
    from .job import load as jobs
    from .planning import rounds as plans

    job = jobs.validate(job) if isinstance(job, dict) else jobs.load(job)
    return plans.plan(job, settings, context, told)


def study(study, output=None, context=None, **options):
    """Makes the runs of a study (a dict, or the path of a study.json) and returns a ``studies.Study`` with their table; see
    ``studies.making.study``.
    """
    from .studies import making

    return making.study(study, output, context, **options)


def study_answers(folder, language="en", context=None):
    """Writes the answers of a study that lies in a folder (answers.json, report.html, pictures) and returns them; see
    ``studies.report.write_answers``."""
    from .studies import report as reports

    return reports.write_answers(folder, language, context)


def sort_castings(job, scans, folder=None, **options):
    """Sorts raw parts by their scans: passes, passes with a plan of its own, scrap. ``job``: a dict, or the path of a
    job.json; see ``studies.sorting.sort``."""
    from .job import load as jobs
    from .studies import sorting

    job = jobs.validate(job) if isinstance(job, dict) else jobs.load(job)
    return sorting.sort(job, scans, folder, **options)


def report(result, output=None, pdf=None, language="en", title=None, context=None):
    """Writes the report of a result as one HTML file; see ``reporting.report``."""
    from .reporting import report as reporting

    return reporting.report(result, output, pdf, language, title, context)


def view(result, output=None, language="en", title=None, context=None):
    """Writes the 3D view of a result as one HTML file; see ``reporting.view_page.view``."""
    from .reporting import view_page

    return view_page.view(result, output, language, title, context)


def converge(job, context=None):
    """Runs a job (a dict, or the path of a job.json) coarser, as given and finer; returns its
    ``job.Result`` with ``convergence``; see ``convergence.converge``.
    """
    from .job import load as jobs
    from .simulation import convergence

    job = jobs.validate(job) if isinstance(job, dict) else jobs.load(job)
    return convergence.converge(job, context)


def ground_mesh(result, path=None, ground=True, deflection_mm=None, context=None):
    """The whole part as ground, as one closed mesh (``closed_mesh.ground_mesh``); written to
    ``path`` (.stl, .ply, .3mf) if there is one. result: a ``job.Result`` or its folder.
    """
    from .inspection import closed_mesh
    from .job.tolerances import colour_scale
    from .simulation.result import Result

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
    "lay_stock",
    "make_belt_machine",
    "make_belt",
    "wear_belt",
    "follow_path",
    "import_program",
    "export_program",
    "make_raster",
    "set_up",
    "simulate",
    "make_plan",
    "apply_plan",
    "write_plan",
    "make_study",
    "open_study_run",
    "make_deviation",
    "make_section",
    "make_verdict",
    "set_zones",
    "make_figures",
    "write_report",
    "check_settings",
    "export_job",
    "import_result",
    "open_example",
    "open_job",
    "make_ground_mesh",
    "compare_scan",
    "learn_scan",
)


def __getattr__(name):
    if name in ENGINE_NAMES:
        from . import engine

        value = globals()[name] = getattr(engine, name)
        return value
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
    return sorted({*globals(), *ENGINE_NAMES, *DOCUMENT_FUNCTIONS})


# What objects and views need of the layers above them, which they must not import: handed down here,
# for no module of the package is imported before this one.


def _attach_view(view_object, name):
    from .gui.views import providers

    getattr(providers, name)(view_object)


def _register_commands():
    from .gui import commands

    commands.register()


view_providers.factory = _attach_view
command_registry.register = _register_commands
