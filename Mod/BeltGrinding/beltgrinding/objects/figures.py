"""A spreadsheet with the figures of a job, live: its cells are expressions of the objects' properties.

Expressions name objects by their internal name, which no renaming changes. The sheet stands beside the
job, not in it: a child that reads its parent would be a circle.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import FreeCAD

from ..engine import InputError
from .belt_machine import BeltMachine
from .deviation import Deviation
from .job_data import child
from .job_object import BeltGrindingJob
from .kinds import DocumentObject, Sheet
from .simulation import Simulation, simulated
from .stock import Stock
from .verdict import Verdict

MARK = "Job"  # the sheet's property that links its job
PAGE, TABLE, BLANK = (
    "TechDraw::DrawPage",
    "TechDraw::DrawViewSpreadsheet",
    "A4_Portrait_blank.svg",
)
WIDTHS = {"A": 300, "B": 130, "C": 130}  # pixels
QT_TRANSLATE_NOOP = FreeCAD.Qt.QT_TRANSLATE_NOOP

# Heading: proxy of the object, and of every row the property, its label, and the unit that it is shown
# in; a unit in brackets stands behind a number that has none.
SECTIONS = (
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Deviation from the design"),
        Deviation,
        (
            ("ToleranceLower", QT_TRANSLATE_NOOP("BeltGrinding", "Tolerance, lower limit"), "µm"),
            ("ToleranceUpper", QT_TRANSLATE_NOOP("BeltGrinding", "Tolerance, upper limit"), "µm"),
            ("InTolerance", QT_TRANSLATE_NOOP("BeltGrinding", "Area in tolerance"), "[%]"),
            ("AboveTolerance", QT_TRANSLATE_NOOP("BeltGrinding", "Area with too much left"), "[%]"),
            ("BelowTolerance", QT_TRANSLATE_NOOP("BeltGrinding", "Area cut too deep"), "[%]"),
            ("Minimum", QT_TRANSLATE_NOOP("BeltGrinding", "Lowest deviation"), "µm"),
            ("Maximum", QT_TRANSLATE_NOOP("BeltGrinding", "Highest deviation"), "µm"),
            ("Mean", QT_TRANSLATE_NOOP("BeltGrinding", "Mean"), "µm"),
            ("RootMeanSquare", QT_TRANSLATE_NOOP("BeltGrinding", "Root mean square"), "µm"),
            ("Percentile05", QT_TRANSLATE_NOOP("BeltGrinding", "5 % of the area lie below"), "µm"),
            (
                "Percentile50",
                QT_TRANSLATE_NOOP("BeltGrinding", "Half of the area lies below"),
                "µm",
            ),
            ("Percentile95", QT_TRANSLATE_NOOP("BeltGrinding", "95 % of the area lie below"), "µm"),
            (
                "UncertaintyMean",
                QT_TRANSLATE_NOOP("BeltGrinding", "Standard deviation, mean; 0: not known"),
                "µm",
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Verdict by zones"),
        Verdict,
        (
            ("Overall", QT_TRANSLATE_NOOP("BeltGrinding", "Verdict"), ""),
            ("FacesFailed", QT_TRANSLATE_NOOP("BeltGrinding", "Faces out of tolerance"), ""),
            ("ZonesFailed", QT_TRANSLATE_NOOP("BeltGrinding", "Zones out of tolerance"), ""),
            (
                "InTolerance",
                QT_TRANSLATE_NOOP("BeltGrinding", "Area within the zones' limits"),
                "[%]",
            ),
            ("Worst", QT_TRANSLATE_NOOP("BeltGrinding", "Worst deviation"), "µm"),
            ("WorstBeyond", QT_TRANSLATE_NOOP("BeltGrinding", "Beyond its limit"), "µm"),
            ("LargestCluster", QT_TRANSLATE_NOOP("BeltGrinding", "Largest place out"), "mm^2"),
            ("UntouchedArea", QT_TRANSLATE_NOOP("BeltGrinding", "Never touched"), "mm^2"),
            ("ExcessVolume", QT_TRANSLATE_NOOP("BeltGrinding", "Left above the design"), "mm^3"),
            ("GougeVolume", QT_TRANSLATE_NOOP("BeltGrinding", "Missing below the design"), "mm^3"),
            ("WavinessAcross", QT_TRANSLATE_NOOP("BeltGrinding", "Waves across the feed"), "µm"),
            ("WavinessAlong", QT_TRANSLATE_NOOP("BeltGrinding", "Waves along the feed"), "µm"),
            (
                "UnresolvedMotions",
                QT_TRANSLATE_NOOP("BeltGrinding", "Motions not resolved; -1: not known"),
                "",
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Simulation"),
        Simulation,
        (
            ("StockVolume", QT_TRANSLATE_NOOP("BeltGrinding", "Stock before"), "mm^3"),
            ("RemovedVolume", QT_TRANSLATE_NOOP("BeltGrinding", "Removed"), "mm^3"),
            ("DesignArea", QT_TRANSLATE_NOOP("BeltGrinding", "Ground area"), "mm^2"),
            ("ProcessTime", QT_TRANSLATE_NOOP("BeltGrinding", "Time of the robot"), "[s]"),
            ("RemainingCut", QT_TRANSLATE_NOOP("BeltGrinding", "Cut left in the belt"), "[%]"),
            ("Samples", QT_TRANSLATE_NOOP("BeltGrinding", "Samples"), ""),
            ("Steps", QT_TRANSLATE_NOOP("BeltGrinding", "Steps"), ""),
            ("LawModel", QT_TRANSLATE_NOOP("BeltGrinding", "Law of removal"), ""),
            ("ElasticModel", QT_TRANSLATE_NOOP("BeltGrinding", "Elasticity"), ""),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "How sure that is"),
        Simulation,
        (
            ("OutOfDate", QT_TRANSLATE_NOOP("BeltGrinding", "An input has changed since"), ""),
            ("EventCount", QT_TRANSLATE_NOOP("BeltGrinding", "Events"), ""),
            ("MissedRays", QT_TRANSLATE_NOOP("BeltGrinding", "Samples without stock"), ""),
            (
                "DefectiveSamples",
                QT_TRANSLATE_NOOP("BeltGrinding", "Samples with stock below the design"),
                "",
            ),
            (
                "LawExtrapolated",
                QT_TRANSLATE_NOOP("BeltGrinding", "Outside of the law's range"),
                "",
            ),
            ("NotConverged", QT_TRANSLATE_NOOP("BeltGrinding", "Contacts not converged"), ""),
            ("WarningCount", QT_TRANSLATE_NOOP("BeltGrinding", "Warnings of the input"), ""),
            ("Calibrated", QT_TRANSLATE_NOOP("BeltGrinding", "The law is calibrated"), ""),
            (
                "FineEnough",
                QT_TRANSLATE_NOOP("BeltGrinding", "The settings are fine enough"),
                "",
            ),
            (
                "SettingsError",
                QT_TRANSLATE_NOOP("BeltGrinding", "Error of a depth because of the settings"),
                "µm",
            ),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Settings"),
        BeltGrindingJob,
        (
            ("Spacing", QT_TRANSLATE_NOOP("BeltGrinding", "Spacing of the samples"), "mm"),
            ("MaxTravel", QT_TRANSLATE_NOOP("BeltGrinding", "Step of the simulation"), "mm"),
            ("LawCoefficient", QT_TRANSLATE_NOOP("BeltGrinding", "Coefficient K"), "[mm²/N]"),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Belt machine"),
        BeltMachine,
        (
            ("WheelRadius", QT_TRANSLATE_NOOP("BeltGrinding", "Wheel radius"), "mm"),
            ("WheelWidth", QT_TRANSLATE_NOOP("BeltGrinding", "Wheel width"), "mm"),
            ("RunLength", QT_TRANSLATE_NOOP("BeltGrinding", "Free length"), "mm"),
            ("RunWidth", QT_TRANSLATE_NOOP("BeltGrinding", "Belt's width"), "mm"),
            ("RunTension", QT_TRANSLATE_NOOP("BeltGrinding", "Tension"), "[N/mm]"),
            ("BeltSpeed", QT_TRANSLATE_NOOP("BeltGrinding", "Belt speed"), "m/s"),
            ("Force", QT_TRANSLATE_NOOP("BeltGrinding", "Force"), "N"),
        ),
    ),
    (
        QT_TRANSLATE_NOOP("BeltGrinding", "Stock"),
        Stock,
        (("Allowance", QT_TRANSLATE_NOOP("BeltGrinding", "Allowance"), "mm"),),
    ),
)


def _in_words(text: str) -> str:
    """A text marked above, in FreeCAD's language."""
    in_language = FreeCAD.Qt.translate
    return in_language("BeltGrinding", text)


def find(job: DocumentObject) -> Sheet | None:
    """The job's sheet, or None."""
    for obj in job.Document.Objects:
        if obj.TypeId == "Spreadsheet::Sheet" and getattr(obj, MARK, None) is job:
            return obj
    return None


def make(job: DocumentObject) -> Sheet:
    """The job's sheet, made where it is missing and filled anew with what the job now has. Cells of a
    user's own in other columns than A to C stay. Raises InputError.
    """
    simulated(job)
    sheet = find(job)
    if sheet is None:
        sheet = job.Document.addObject("Spreadsheet::Sheet", "Figures")
        sheet.Label = FreeCAD.Qt.translate("BeltGrinding", "Figures")
        sheet.addProperty("App::PropertyLink", MARK, "Base", "the job whose figures these are")
        setattr(sheet, MARK, job)
        sheet.setEditorMode(MARK, 1)
    _clear(sheet)
    row = 1
    for heading, proxy, rows in SECTIONS:
        obj = job if proxy is BeltGrindingJob else child(job, proxy)
        if obj is not None:
            row = _fill(sheet, row, heading, obj, rows)
    for column, width in WIDTHS.items():
        sheet.setColumnWidth(column, width)
    job.Document.recompute()
    return sheet


def make_page(job: DocumentObject) -> DocumentObject:
    """The job's drawing page with a table of its figures, which follows the sheet; made where it is missing. The sheet is
    made, too. Raises InputError."""
    sheet = make(job)
    last = max(int(cell[1:]) for cell in _filled(sheet) if cell[0] in WIDTHS and cell[1:].isdigit())
    found = next((obj for obj in sheet.InList if obj.TypeId == TABLE), None)
    table = found or job.Document.addObject(TABLE, "FiguresTable")
    table.Source, table.CellStart, table.CellEnd = sheet, "A1", f"C{last}"
    page = next((obj for obj in table.InList if obj.TypeId == PAGE), None)
    if page is None:
        page = _page(job)
        page.addView(table)
        table.X, table.Y = (
            0.5 * getattr(page.Template, side).Value for side in ("Width", "Height")
        )
    job.Document.recompute()
    return page


def _page(job: DocumentObject) -> DocumentObject:
    """An empty drawing page for a job."""
    folder = Path(FreeCAD.getResourceDir(), "Mod", "TechDraw", "Templates")
    file = next(folder.rglob(BLANK), None)  # in a folder of its own from 1.1 on
    if file is None:
        raise InputError(
            "objects.no_template",
            "TechDraw's template {file} is not in {folder}: install FreeCAD's TechDraw",
            file=BLANK,
            folder=str(folder),
        )
    page = job.Document.addObject(PAGE, "FiguresPage")
    page.Label = FreeCAD.Qt.translate("BeltGrinding", "Figures in a drawing")
    template = job.Document.addObject("TechDraw::DrawSVGTemplate", "FiguresTemplate")
    template.Template = str(file)
    page.Template = template
    return page


def _filled(sheet: Sheet) -> list[str]:
    """Names of the cells that hold something."""
    return list(sheet.getUsedCells() if hasattr(sheet, "getUsedCells") else _used(sheet))


def _clear(sheet: Sheet) -> None:
    """Takes out what ``make`` has put in."""
    for cell in _filled(sheet):
        if cell[0] in WIDTHS and cell[1:].isdigit():
            sheet.clear(cell)


def _used(sheet: Sheet) -> list[str]:
    """Names of the cells that hold something, of FreeCADs that do not tell."""
    return re.findall(r'<Cell address="([A-Z]+[0-9]+)"', sheet.cells.Content)


def _fill(
    sheet: Sheet, row: int, heading: str, obj: DocumentObject, rows: Iterable[tuple[str, str, str]]
) -> int:
    """Writes a section from ``row`` on; returns the next free row."""
    sheet.set(f"A{row}", _in_words(heading))
    sheet.setStyle(f"A{row}", "bold")
    for name, label, unit in rows:
        if name not in obj.PropertiesList or "Hidden" in obj.getEditorMode(name):
            continue  # of another kind of machine
        row += 1
        sheet.set(f"A{row}", _in_words(label))
        sheet.set(f"B{row}", f"={obj.Name}.{name}")
        if unit.startswith("["):
            sheet.set(f"C{row}", unit[1:-1])
        elif unit:
            sheet.setDisplayUnit(f"B{row}", unit)
        sheet.setAlignment(f"B{row}", "right|vcenter")
    return row + 2
