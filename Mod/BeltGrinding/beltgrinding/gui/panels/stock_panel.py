"""Task panel of the stock."""

from __future__ import annotations

from typing import Any

from ...engine import Cancelled, InputError
from ...objects import stock_scan
from ...objects.geometry import placement_from_job
from ...objects.kinds import DocumentObject
from ...objects.proxy import type_of
from ...objects.simulation import Simulation
from ...scan import start as scan_start
from ..common.compat import QtGui, translate
from ..common.figures import length_text
from ..common.messages import error_text
from ..common.runner import Background
from ..common.task_progress import TaskRow
from ..scene.stock_lines import StockLines
from ..widgets.form import Form
from ..widgets.steady import steady
from .panel import Panel

MESH_FILES = "*.stl *.ply *.obj *.off *.3mf"


class StockPanel(Panel):
    """Edits a Stock."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(obj, translate("BeltGrinding", "Stock"), "BeltGrinding_Stock")
        form = self.fields = Form(obj, translate("BeltGrinding", "Stock on the design faces"))
        kinds = {
            "allowance": translate("BeltGrinding", "Uniform allowance"),
            "solid": translate("BeltGrinding", "Solid"),
            "mesh": translate("BeltGrinding", "Mesh (a scan)"),
            "left": translate("BeltGrinding", "What another job leaves"),
        }
        form.add("Kind", translate("BeltGrinding", "Kind"), kinds)
        form.add("Allowance", translate("BeltGrinding", "Allowance"))
        form.add("Source", translate("BeltGrinding", "Object"), [])
        form.add(
            "File",
            translate("BeltGrinding", "or file"),
            translate("BeltGrinding", "Mesh") + f" ({MESH_FILES})",
        )
        form.add("FileUnit", translate("BeltGrinding", "Unit of the file"), unit="mm")
        form.add("FilePlacement", translate("BeltGrinding", "Place of the file"))
        form.add("Deflection", translate("BeltGrinding", "Chord error"))
        form.add("SearchAbove", translate("BeltGrinding", "Search outward"))
        form.add("SearchBelow", translate("BeltGrinding", "Search inward"))
        form.changed = self.arrange
        self.body.addWidget(form)
        self.work: Background | None = None
        self.scan = QtGui.QWidget()
        rows = QtGui.QFormLayout(self.scan)
        rows.setContentsMargins(0, 0, 0, 0)
        self.start = steady(QtGui.QComboBox())
        self.start.setObjectName("scanStart")
        self.start.addItem(translate("BeltGrinding", "as it lies"), None)
        self.start.addItem(translate("BeltGrinding", "principal axes"), "principal")
        rows.addRow(translate("BeltGrinding", "Start"), self.start)
        self.datum = QtGui.QLineEdit()
        self.datum.setObjectName("scanDatum")
        self.datum.setPlaceholderText(translate("BeltGrinding", "all not ground"))
        rows.addRow(translate("BeltGrinding", "Datum faces"), self.datum)
        self.lay = QtGui.QPushButton(translate("BeltGrinding", "Lay the scan on the design"))
        self.lay.setObjectName("layScan")
        self.lay.clicked.connect(self.align)
        rows.addRow(self.lay)
        self.progress = TaskRow()
        rows.addRow(self.progress)
        self.body.addWidget(self.scan)
        self.finish()
        self.lines = StockLines(self.document)
        self.arrange()

    def align(self) -> None:
        """Lays the file's mesh on the faces that are not ground; ``_laid`` follows."""
        try:
            job = self.obj.getParentGroup()
            stock, data, placed = stock_scan.prepare(job)
            options = {"start": self.start.currentData() or placed}
            if self.datum.text().strip():
                options["datum_faces"] = scan_start.face_numbers(self.datum.text())
        except InputError as error:
            self.tell(error_text(error), True)
            return
        self.lay.setEnabled(False)
        self.tell("")
        file, unit = stock.File, stock.FileUnit
        self.work = Background(
            lambda context: stock_scan.align(data, file, unit, context, **options), self._laid
        )
        self.progress.follow(self.work, translate("BeltGrinding", "Laying the scan on the design"))

    def _laid(self, found: Any, error: BaseException | None) -> None:
        self.work = None
        self.progress.end()
        self.lay.setEnabled(True)
        if isinstance(error, Cancelled):
            return
        if error is not None:
            self.tell(error_text(error), True)
            return
        placement, figures = found
        self.obj.FilePlacement = placement_from_job(placement)
        self.fields.refresh("FilePlacement")
        text = translate("BeltGrinding", "Laid on the design with {} rms.").format(
            length_text(figures["rms_mm"], 1, "")
        )
        warnings = [error_text(warning) for warning in figures["warnings"]]
        self.tell("\n".join([text, *warnings]), bool(warnings))

    def close(self) -> None:
        if self.work is not None:
            self.work.abandon()
            self.work = None
        self.lines.close()

    def arrange(self) -> None:
        """Shows the fields that the kind uses, and the stock's edges."""
        self.lines.show(self.obj.getParentGroup())
        self.scan.setVisible(
            self.obj.Kind == "mesh" and self.obj.Source is None and bool(self.obj.File)
        )
        self.fields.offer("Source", *self._sources())
        rays = {"Kind", "Source", "SearchAbove", "SearchBelow"}
        files = {"File", "FileUnit", "FilePlacement"} if self.obj.Source is None else set()
        self.fields.show_rows(
            {
                "allowance": {"Kind", "Allowance"},
                "solid": rays | {"Deflection"},
                "mesh": rays | files,
                "left": {"Kind", "Source"},
            }[self.obj.Kind]
        )
        self.tell("")

    def _sources(self) -> tuple[list[DocumentObject], list[str]]:
        """What the stock can be by its kind, and what that is called: a result by its job."""
        obj, others = self.obj, self.obj.Document.Objects
        if obj.Kind == "left":
            results = [one for one in others if type_of(one) == Simulation.TYPE]
            jobs = [one.getParentGroup() for one in results]
            found = [
                (one, job.Label)
                for one, job in zip(results, jobs)
                if job is not None and job != obj.getParentGroup()
            ]
        else:
            found = [
                (one, one.Label)
                for one in others
                if hasattr(one, "Shape") or hasattr(one, "Mesh") and not hasattr(one, "Simulation")
            ]
        return [one for one, _ in found], [label for _, label in found]

    def check(self) -> None:
        obj = self.obj
        if obj.Kind == "left" and obj.Source not in self._sources()[0]:
            raise InputError("gui.choose_left", "Choose the job that grinds before.")
        if obj.Kind == "solid" and not hasattr(obj.Source, "Shape"):
            raise InputError("gui.choose_solid", "Choose the solid that is the stock.")
        if obj.Kind == "mesh" and not (hasattr(obj.Source, "Mesh") or obj.File):
            raise InputError("gui.choose_mesh", "Choose the mesh: an object or a file.")
