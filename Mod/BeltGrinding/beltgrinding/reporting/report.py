"""The report of a result: one HTML file that holds everything, and a PDF of it."""

from __future__ import annotations
from typing import Any

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Context
from ..engine import InputError, core
from ..inspection import verdict as verdicts
from ..job import workpiece
from ..job.tolerances import colour_scale
from ..simulation.result import Result
from . import charts, page, pictures, view, worst_spots
from .content import Content
from .language import Language


def report(
    result: Result | Path | str,
    output: Path | str | None = None,
    pdf: Path | str | None = None,
    language: str = "en",
    title: str | None = None,
    context: Context = None,
    notes: Sequence[str] = (),
) -> Path:
    """Writes the report of a result as one self-contained HTML file, as a PDF, or as both.

    ``result``: the folder that a run wrote, or a ``Result``; ``output``: the file, by default
    report.html in that folder; one that ends in .pdf is a PDF, beside which nothing is written (needs
    WeasyPrint); ``pdf``: a file for the same as PDF; ``language``: "en" or "de"; ``title``: what the
    part is called; ``notes``: sentences to be shown on top. Returns ``output``. Raises InputError,
    Cancelled.
    """
    folder = None if isinstance(result, Result) else Path(result)
    if output is None and folder is None:
        raise InputError("reporting.no_output", "report: say by output what file to write")
    output = Path(output) if output is not None else folder / "report.html"
    words = Language(language)
    only_pdf = output.suffix.lower() == ".pdf"
    printer = _printer() if only_pdf or pdf is not None else None
    context = context or core.RunContext()
    content = load(result, title, notes, context)
    plain, whole = render(content, words, context, not only_pdf, printer is not None)
    context.throw_if_cancelled()
    printed = None if printer is None else printer(plain)
    files = {output: printed if only_pdf else whole.encode()}
    if pdf is not None:
        files[Path(pdf)] = printed
    write(content.result, files)
    return output


def write(result: Result, files: Mapping[Path, bytes]) -> None:
    """Writes bytes by path. Those in the result's own folder belong to it from now on: another result
    removes them."""
    folder = os.path.realpath(result.folder) if result.folder else None
    own = {p.name: data for p, data in files.items() if os.path.realpath(p.parent) == folder}
    if own:
        result.update(others=own)
    for path, data in files.items():
        if own and os.path.realpath(path.parent) == folder:
            continue
        try:
            write_whole(path, data)
        except OSError as error:
            raise cannot_be_written(error.filename or path, error) from None


def load(
    result: Result | Path | str,
    title: str | None = None,
    notes: Sequence[str] = (),
    context: Context = None,
) -> Content:
    """The ``Content`` of a folder that a run wrote, or of a ``Result``. Raises InputError."""
    source = ""
    if not isinstance(result, Result):
        source, result = str(result), Result.read(result)
    notes = list(notes)
    try:
        shape = workpiece.read_design(result.job["design"], context)
    except InputError as error:
        shape = None
        notes.append(error.fact)
    if result.folder is not None and "judged_by" in result.summary:
        notes.append(
            core.Fact(
                "reporting.judged_by_others",
                "The verdict is by the limits of another job, by which this result was judged since; the limits and the job "
                "below are the run's.",
            )
        )
    bins = result.bins if result.bins or result.steps is None else charts.binned(result.steps)
    return Content(
        result,
        title or page.facts.part_name(result.job),
        source,
        shape,
        bins,
        _verdict(result, shape, notes),
        result.convergence,
        notes,
    )


def _verdict(result: Result, shape: core.Shape | None, notes: list[Any]) -> dict[str, Any] | None:
    """The result's verdict; of an older one, it is found now. None where it cannot be."""
    if result.verdict is not None:
        return result.verdict
    try:
        return verdicts.of_result(result, shape)
    except InputError as error:
        notes.append(error.fact)
        return None


def render(
    content: Content,
    words: Language,
    context: Context = None,
    turning: bool = True,
    still: bool = True,
) -> tuple[str | None, str | None]:
    """(without, with) the 3D view: the HTML texts of a ``Content`` in the words of a ``Language``; not
    ``turning``: twice without; not ``still``: None in place of the first.
    """
    result = content.result
    scale = colour_scale(result.job)
    found = worst_spots.worst(result.field, scale[:2], content.verdict)
    lacking = view.missing(words) if turning else None

    def turned(sides: Any) -> Any:
        return view.view(content, scale, found, sides, words, context)

    beside = turned if turning and lacking is None else None
    drawn = pictures.draw(result.field, scale, content.shape, found, context, beside=beside)
    plain = page.document(content, words, scale, found, drawn) if still or not turning else None
    if not turning:
        return plain, plain
    return plain, page.document(content, words, scale, found, drawn, drawn["beside"], lacking)


def _printer() -> Callable[[str], bytes]:
    """html -> bytes of a PDF. Raises InputError where there is no WeasyPrint."""
    try:
        from weasyprint import HTML
    except (
        ImportError,
        OSError,
    ) as error:  # OSError: a library of the system that it needs
        raise InputError(
            "reporting.no_weasyprint",
            "a PDF needs WeasyPrint ({reason}); install Debian's weasyprint, or print the "
            "HTML report from a browser",
            reason=error,
        ) from None
    return lambda html: HTML(string=html, base_url="").write_pdf()
