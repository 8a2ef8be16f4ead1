"""Task panel of a job's tolerance zones: a table, whose chosen zone's faces are tinted."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import FreeCADGui as Gui

from ...engine import InputError
from ...objects import job_data, preferences
from ...objects.kinds import DocumentObject
from ..common import gates
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import length_text
from ..common.kinds import Json, Layout, Table, Widget
from ..common.messages import error_text
from ..scene.face_tint import FaceTint
from ..widgets.rows import shown
from .job_panel import FaceGate
from .panel import Panel

COLUMNS = 9
NAME, FACES, LOWER, UPPER, EDGE, THIN, THICK, RA, LAY = range(COLUMNS)
# What a narrow dock has room for; the rest is of the chosen zone.
IN_TABLE = (NAME, FACES, LOWER, UPPER)
FIELDS = {EDGE: "zoneEdge", THIN: "zoneThin", THICK: "zoneThick", RA: "zoneRa", LAY: "zoneLay"}
LIMITS = ((LOWER, UPPER, "tolerance_mm"), (THIN, THICK, "thickness_mm"))
LIMIT_COLUMNS = (LOWER, UPPER, THIN, THICK)
SYMBOLS = (*((unit.symbol, unit.size) for unit in preferences.UNITS), ("um", 1e-3))  # may be typed
DIGITS = 12  # of a length in mm, so that 30 µm are 0.03
HEIGHT = 140  # pixels
ACCEPTANCES = ("Tmax", "T16%")
LAYS = {"=": "lay_direction", "⊥": "lay_direction", "C": "lay_centre_mm", "R": "lay_centre_mm"}
WITHOUT = ("X", "M", "P")  # lays that refer to nothing; P is refused, with the reason
TYPED = {"T": "⊥"}  # what a keyboard has in its place


class ZonesPanel(Panel):
    """Edits the zones of a BeltGrindingJob."""

    def __init__(self, obj: DocumentObject) -> None:
        super().__init__(obj, translate("BeltGrinding", "Tolerance zones"), "BeltGrinding_Zones")
        self.unit = preferences.deviation_unit()
        text = translate(
            "BeltGrinding",
            "Each zone has limits of its own; where several hold a place, the last one counts. "
            "Without faces a zone holds all; with an edge radius only convex edges with a smaller "
            "radius. Limits in {}, edge radii in mm; what is left empty is not inspected.",
        ).format(self.unit.symbol)
        label = QtGui.QLabel(text)
        label.setWordWrap(True)
        self.body.addWidget(label)
        self.table = self._table()
        self.body.addWidget(self.table)
        self.body.addLayout(self._buttons())
        self.fields: dict[int, Widget] = {}  # column: field of the chosen zone
        self.body.addWidget(self._chosen())
        self.finish()
        self.gate = FaceGate()
        gates.hold(self.gate)
        self.tint = FaceTint(self.document)
        self.quiet = False
        self.fill(job_data.zones(obj))
        self.changed()

    def _table(self) -> Table:
        table = QtGui.QTableWidget(0, COLUMNS)
        table.setObjectName("zones")
        titles = [
            translate("BeltGrinding", "Zone"),
            translate("BeltGrinding", "Faces"),
            translate("BeltGrinding", "Lower"),
            translate("BeltGrinding", "Upper"),
            translate("BeltGrinding", "Edge radius"),
            translate("BeltGrinding", "Thinner by"),
            translate("BeltGrinding", "Thicker by"),
            translate("BeltGrinding", "Ra, µm"),
            translate("BeltGrinding", "Lay"),
        ]
        table.setHorizontalHeaderLabels(titles)
        tips = {
            FACES: translate("BeltGrinding", "Numbers of faces; empty: all"),
            EDGE: translate("BeltGrinding", "Only convex edges with a smaller radius; empty: all"),
            THIN: translate("BeltGrinding", "Lower limit of the thickness against the design's"),
            THICK: translate("BeltGrinding", "Upper limit of the thickness against the design's"),
            RA: translate(
                "BeltGrinding",
                "Greatest roughness, such as 0.8; 0.8 T16%: up to 16 % of the area may have more, or "
                "scratches that are not the lay's. The job must compute the finish",
            ),
            LAY: translate(
                "BeltGrinding",
                "Direction of the scratches: = or ⊥ (or T) with a direction, such as = 1 0 0; X or M crossed; C or R "
                "with a centre, such as C 10 0 5",
            ),
        }
        for column, tip in tips.items():
            table.horizontalHeaderItem(column).setToolTip(tip)
        for column in set(range(COLUMNS)) - set(IN_TABLE):
            table.setColumnHidden(column, True)
        table.verticalHeader().hide()
        table.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
        table.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
        table.setMinimumSize(120, HEIGHT)
        header = table.horizontalHeader()
        header.setSectionResizeMode(QtGui.QHeaderView.ResizeToContents)
        header.setSectionResizeMode(NAME, QtGui.QHeaderView.Stretch)  # a long name is cut short
        table.itemChanged.connect(lambda _: self.changed())
        table.currentCellChanged.connect(lambda *_: self._chose())
        return table

    def _chosen(self) -> Widget:
        """Fields for what of the chosen zone the table has no room for."""
        self.box = QtGui.QGroupBox(translate("BeltGrinding", "Chosen zone"))
        form = QtGui.QFormLayout(self.box)
        form.setFieldGrowthPolicy(QtGui.QFormLayout.AllNonFixedFieldsGrow)
        form.setRowWrapPolicy(QtGui.QFormLayout.WrapLongRows)
        for column, name in FIELDS.items():
            head = self.table.horizontalHeaderItem(column)
            field = QtGui.QLineEdit()
            field.setObjectName(name)
            label = QtGui.QLabel(head.text())
            for one in (label, field):
                one.setToolTip(head.toolTip())
            field.textEdited.connect(lambda text, k=column: self._typed(k, text))
            form.addRow(label, field)
            self.fields[column] = field
        return self.box

    def _typed(self, column: int, text: str) -> None:
        item = self.table.item(self.table.currentRow(), column)
        if item is not None:
            item.setText(text)

    def _show_chosen(self) -> None:
        row = self.table.currentRow()
        self.box.setEnabled(row >= 0)
        for column, field in self.fields.items():
            item = self.table.item(row, column) if row >= 0 else None
            text = "" if item is None else item.text()
            if field.text() != text:
                field.setText(text)

    def _chose(self) -> None:
        if not self.quiet:
            self._show_chosen()
            self.tint_row()

    def _buttons(self) -> Layout:
        grid = QtGui.QGridLayout()
        for k, (name, text, action) in enumerate(
            (
                ("addZone", translate("BeltGrinding", "Add"), self.add),
                ("removeZone", translate("BeltGrinding", "Remove"), self.remove),
                ("zoneUp", translate("BeltGrinding", "Up"), lambda: self.move(-1)),
                ("zoneDown", translate("BeltGrinding", "Down"), lambda: self.move(1)),
                ("takeZoneFaces", translate("BeltGrinding", "Take selected faces"), self.take),
            )
        ):
            button = QtGui.QPushButton(text)
            button.setObjectName(name)
            button.clicked.connect(lambda *_, act=action: act())
            grid.addWidget(button, k // 2, k % 2, 1, 2 if k == 4 else 1)
        return grid

    # Between the table and the job's zones

    def fill(self, zones: Sequence[Json], row: int = 0) -> None:
        """Puts zones into the table."""
        self.quiet = True
        self.table.setRowCount(len(zones))
        for i, zone in enumerate(zones):
            texts = [""] * COLUMNS
            texts[NAME] = zone["name"]
            texts[FACES] = " ".join(map(str, zone.get("faces", [])))
            if "edge_radius_mm" in zone:
                texts[EDGE] = shown(zone["edge_radius_mm"])
            for low, high, key in LIMITS:
                if key in zone:
                    texts[low], texts[high] = map(self._limit, zone[key])
            finish = zone.get("finish", {})
            texts[RA], texts[LAY] = _ra_text(finish), _lay_text(finish)
            for k, text in enumerate(texts):
                item = QtGui.QTableWidgetItem(text)
                if k == LAY:  # what of it no cell shows
                    item.setData(QtCore.Qt.UserRole, finish.get("lay_tolerance_deg"))
                if k > FACES:
                    item.setTextAlignment(int(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter))
                self.table.setItem(i, k, item)
        if zones:
            self.table.setCurrentCell(min(row, len(zones) - 1), NAME)
        self.quiet = False

    def _limit(self, value: float) -> str:
        """A limit, mm, in the unit of deviations."""
        return shown(round(value / self.unit.size, DIGITS))

    def text(self, row: int, column: int) -> str:
        item = self.table.item(row, column)
        return item.text().strip() if item is not None else ""

    def zone(self, row: int) -> dict[str, Any]:
        """The zone in a row. Raises InputError naming the cell."""
        zone: dict[str, Any] = {"name": self.text(row, NAME), "faces": self._faces(row)}
        if not zone["name"]:
            raise InputError(
                "gui.zone_without_name", "Row {row}: a zone needs a name.", row=row + 1
            )
        if self.text(row, EDGE):
            zone["edge_radius_mm"] = self._number(row, EDGE)
        for low, high, key in LIMITS:
            given = [bool(self.text(row, column)) for column in (low, high)]
            if any(given) and not all(given):
                raise InputError(
                    "gui.both_limits", "{zone}: give both limits, or none.", zone=zone["name"]
                )
            if all(given):
                zone[key] = [self._number(row, low), self._number(row, high)]
        finish = self._finish(row)
        return {**zone, "finish": finish} if finish else zone

    def _finish(self, row: int) -> dict[str, Any]:
        """A zone's ``finish``; {} where the drawing calls for none."""
        found: dict[str, Any] = {}
        words = self.text(row, RA).split()
        if words:
            if words[-1] in ACCEPTANCES:  # may stand alone: it counts for the lay, too
                found["acceptance"] = words.pop()
            if len(words) > 1:
                raise InputError(
                    "gui.zone_acceptance",
                    "{zone}: after the roughness, '{text}' is neither Tmax nor T16%.",
                    zone=self.text(row, NAME),
                    text=" ".join(words[1:]),
                )
            if words:
                found["Ra_max_um"] = self._number(row, RA, words[0])
        words = self.text(row, LAY).split()
        if not words:
            return found
        symbol = TYPED.get(words[0], words[0])
        count = 3 if symbol in LAYS else 0
        if symbol not in (*LAYS, *WITHOUT) or len(words) != 1 + count:
            raise InputError(
                "gui.zone_lay",
                "{zone}: '{text}' is no lay: write = 1 0 0 (or ⊥, with a direction), C 10 0 5 (or R, with a centre), X or M.",
                zone=self.text(row, NAME),
                text=self.text(row, LAY),
            )
        found["lay"] = symbol
        if count:
            found[LAYS[symbol]] = [self._number(row, LAY, word) for word in words[1:]]
        tolerance = self.table.item(row, LAY).data(QtCore.Qt.UserRole)
        if tolerance is not None:
            found["lay_tolerance_deg"] = float(tolerance)
        return found

    def _faces(self, row: int) -> list[int]:
        words = self.text(row, FACES).replace(",", " ").replace("Face", " ").split()
        if not all(word.isdigit() for word in words):
            raise InputError(
                "gui.face_numbers",
                "{zone}: write the faces' numbers, such as 1 2 5.",
                zone=self.text(row, NAME),
            )
        return list(dict.fromkeys(int(word) for word in words))

    def _number(self, row: int, column: int, text: str | None = None) -> float:
        text = (self.text(row, column) if text is None else text).replace(",", ".")
        bare, size = text, self.unit.size if column in LIMIT_COLUMNS else 1.0
        for symbol, mm in SYMBOLS:
            if text.endswith(symbol) and column not in (RA, LAY):
                bare, size = text.removesuffix(symbol), mm
                break
        try:
            value = round(float(bare) * size, DIGITS)
        except ValueError:
            value = math.nan
        if math.isfinite(value):
            return value
        if column in (RA, LAY):
            raise InputError(
                "gui.zone_no_number",
                "{zone}: '{text}' is no number.",
                zone=self.text(row, NAME),
                text=text,
            )
        raise InputError(
            "gui.no_length",
            "{zone}: '{text}' is no length.",
            zone=self.text(row, NAME),
            text=text,
        )

    def zones(self) -> list[dict[str, Any]]:
        return [self.zone(row) for row in range(self.table.rowCount())]

    # What is changed

    def changed(self) -> None:
        """Takes the table over into the job, if it is sound; says what is wrong otherwise."""
        if self.quiet:
            return
        self._show_chosen()
        try:
            job_data.set_zones(self.obj, self.zones())
        except InputError as error:
            self.tell(error_text(error), True)
        else:
            count = self.table.rowCount()
            self.tell(
                translate("BeltGrinding", "Zones: {}. Elsewhere {} to {}.").format(
                    count,
                    length_text(self.obj.ToleranceLower.Value),
                    length_text(self.obj.ToleranceUpper.Value),
                )
            )
        self.tint_row()

    def check(self) -> None:
        job_data.set_zones(self.obj, self.zones())

    def add(self) -> None:
        names = {self.text(row, NAME) for row in range(self.table.rowCount())}
        number = len(names) + 1
        base = translate("BeltGrinding", "Zone")
        while f"{base} {number}" in names:
            number += 1
        limits = [self.obj.ToleranceLower.Value, self.obj.ToleranceUpper.Value]
        faces = self._selected()
        rows = self._rows()
        rows.append([f"{base} {number}", " ".join(map(str, faces)), *map(self._limit, limits)])
        self._set_rows(rows, len(rows) - 1)

    def remove(self) -> None:
        row = self.table.currentRow()
        rows = self._rows()
        if 0 <= row < len(rows):
            del rows[row]
            self._set_rows(rows, row)

    def move(self, step: int) -> None:
        row, rows = self.table.currentRow(), self._rows()
        if 0 <= row < len(rows) and 0 <= row + step < len(rows):
            rows[row], rows[row + step] = rows[row + step], rows[row]
            self._set_rows(rows, row + step)

    def take(self) -> None:
        """Gives the chosen zone the faces that are selected in the 3D view."""
        row, faces = self.table.currentRow(), self._selected()
        if row < 0:
            return self.tell(translate("BeltGrinding", "Choose a zone in the table first."), True)
        if not faces:
            return self.tell(translate("BeltGrinding", "Select faces in the 3D view first."), True)
        self.table.item(row, FACES).setText(" ".join(map(str, faces)))

    def _rows(self) -> list[list[Any]]:
        # Last of each what no cell shows.
        return [
            [
                *(self.text(row, k) for k in range(COLUMNS)),
                self.table.item(row, LAY).data(QtCore.Qt.UserRole),
            ]
            for row in range(self.table.rowCount())
        ]

    def _set_rows(self, rows: Sequence[Sequence[Any]], current: int) -> None:
        """Puts texts back as they are, sound or not."""
        self.fill([{"name": texts[NAME]} for texts in rows], current)
        self.quiet = True
        for i, texts in enumerate(rows):
            for k, text in enumerate(texts[:COLUMNS]):
                self.table.item(i, k).setText(text)
            if len(texts) > COLUMNS:
                self.table.item(i, LAY).setData(QtCore.Qt.UserRole, texts[COLUMNS])
        self.quiet = False
        self.changed()

    def _selected(self) -> list[int]:
        """Numbers of the job's faces that are selected in the 3D view."""
        found = []
        for one in Gui.Selection.getSelectionEx(self.document.Name):
            subs = tuple(s for s in one.SubElementNames if s.startswith("Face"))
            if subs:
                found += job_data.face_numbers(self.obj, one.Object, subs)
        return sorted(set(found))

    def tint_row(self) -> None:
        """Tints the faces of the chosen zone."""
        if self.quiet:
            return
        row = self.table.currentRow()
        try:
            shape, ground = job_data.design(self.obj)
            faces = self._faces(row) if row >= 0 else []
        except InputError:
            return self.tint.show([])
        if row >= 0 and not faces:
            faces = ground
        self.tint.show([shape.Faces[f - 1] for f in faces if 1 <= f <= len(shape.Faces)])

    def close(self) -> None:
        gates.release(self.gate)
        self.tint.close()


def _ra_text(finish: Json) -> str:
    """What stands for a zone's limit of the roughness."""
    accepted = finish.get("acceptance", ACCEPTANCES[0])
    words = [shown(finish["Ra_max_um"])] if "Ra_max_um" in finish else []
    return " ".join(words + [accepted] * (accepted != ACCEPTANCES[0]))


def _lay_text(finish: Json) -> str:
    """What stands for a zone's lay."""
    symbol = finish.get("lay", "")
    return " ".join([symbol, *map(shown, finish.get(LAYS.get(symbol, ""), []))])
