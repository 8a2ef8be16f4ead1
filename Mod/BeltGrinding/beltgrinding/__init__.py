"""Robotic belt-grinding simulation: the same engine for FreeCAD, macros and the command line.

``run(job)`` grinds a job given as plain data (``job.json``); ``beltgrinding.objects`` does the same
with document objects inside FreeCAD. Units: millimetre, newton, second, megapascal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from .base import messages, vendored
from .base.kinds import Context, Json
from .base.resources import documentation, resources
from .geometry import body_names
from .gui.common import command_registry
from .objects import DOCUMENT_FUNCTIONS, view_providers

if TYPE_CHECKING:
    from .engine import core
    from .planning.rounds import Plan
    from .simulation.result import Result
    from .studies.making import Study
    from .studies.sorting import Batch

vendored.offer()

# Taken from the core when first asked for: without a core that fits, the workbench must still be able
# to say so.
ENGINE_NAMES = ("core", "InputError", "Cancelled", "RunContext", "__version__")

Job: TypeAlias = "dict[str, Any] | Path | str"  # or a study: itself, or the path of its file


def _checked(job: Job) -> dict[str, Any]:
    """A job with its defaults, of a dict or of the path of a job.json. Raises InputError."""
    from .job import load

    return load.validate(job) if isinstance(job, dict) else load.load(job)


def run(job: Job, context: Context = None, recording: core.Recording | None = None) -> Result:
    """Runs a job (a dict, or the path of a job.json); returns a ``simulation.result.Result``.
    ``recording``: as in ``simulation.run.run``.
    """
    from .simulation import run as runs

    return runs.run(_checked(job), context, recording)


def plan(
    job: Job,
    settings: Json | None = None,
    context: Context = None,
    told: Callable[[dict[str, Any]], object] | None = None,
) -> Plan:
    """Plans the feeds of a job (a dict, or the path of a job.json) so that the ground part keeps its tolerance; see
    ``planning.plan``.
    """
    from .planning import rounds as plans

    return plans.plan(_checked(job), settings, context, told)


def study(
    study: Job, output: Path | str | None = None, context: Context = None, **options: Any
) -> Study:
    """Makes the runs of a study (a dict, or the path of a study.json) and returns a ``studies.Study`` with their table; see
    ``studies.making.study``.
    """
    from .studies import making

    return making.study(study, output, context, **options)


def study_answers(
    folder: Path | str, language: str = "en", context: Context = None
) -> dict[str, Any]:
    """Writes the answers of a study that lies in a folder (answers.json, report.html, pictures) and returns them; see
    ``studies.report.write_answers``."""
    from .studies import report as reports

    return reports.write_answers(folder, language, context)


def sort_castings(
    job: Job, scans: Iterable[Path | str], folder: Path | str | None = None, **options: Any
) -> Batch:
    """Sorts raw parts by their scans: passes, passes with a plan of its own, scrap. ``job``: a dict, or the path of a
    job.json; see ``studies.sorting.sort``."""
    from .studies import sorting

    return sorting.sort(_checked(job), scans, folder, **options)


def report(
    result: Result | Path | str,
    output: Path | str | None = None,
    pdf: Path | str | None = None,
    language: str = "en",
    title: str | None = None,
    context: Context = None,
) -> Path:
    """Writes the report of a result as one HTML file; see ``reporting.report``."""
    from .reporting import report as reporting

    return reporting.report(result, output, pdf, language, title, context)


def view(
    result: Result | Path | str,
    output: Path | str | None = None,
    language: str = "en",
    title: str | None = None,
    context: Context = None,
) -> Path:
    """Writes the 3D view of a result as one HTML file; see ``reporting.view_page.view``."""
    from .reporting import view_page

    return view_page.view(result, output, language, title, context)


def converge(job: Job, context: Context = None) -> Result:
    """Runs a job (a dict, or the path of a job.json) coarser, as given and finer; returns its
    ``simulation.result.Result`` with ``convergence``; see ``simulation.convergence.converge``.
    """
    from .simulation import convergence

    return convergence.converge(_checked(job), context)


def ground_mesh(
    result: Result | Path | str,
    path: Path | str | None = None,
    ground: bool = True,
    deflection_mm: float | None = None,
    context: Context = None,
) -> core.GroundMesh:
    """The whole part as ground, as one closed mesh (``closed_mesh.ground_mesh``); written to
    ``path`` (.stl, .ply, .3mf) if there is one. result: a ``simulation.result.Result`` or its folder.
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


def __getattr__(name: str) -> Any:
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


def __dir__() -> list[str]:
    return sorted({*globals(), *ENGINE_NAMES, *DOCUMENT_FUNCTIONS})


# What objects and views need of the layers above them, which they must not import: handed down here,
# for no module of the package is imported before this one.


def _attach_view(view_object: object, name: str) -> None:
    from .gui.views import providers

    getattr(providers, name)(view_object)


def _register_commands() -> None:
    from .gui import commands

    commands.register()


messages.name_bodies(body_names.told)
view_providers.factory = _attach_view
command_registry.register = _register_commands
