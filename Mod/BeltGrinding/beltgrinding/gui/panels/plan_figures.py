"""What a plan found, in its panel: rounds, before and after side by side, why the rest stays, a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCADGui as Gui

from ...objects import preferences, stored_facts
from ...objects.kinds import DocumentObject
from ...planning import pictures, reasons
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure, way_of_passes
from ..charts.feed_chart import FeedChart
from ..common.kinds import Json, QtEvent, Table, Texts
from ..common.report_language import language
from ..widgets.picture_label import PictureLabel

LARGE = 0.9  # of the screen
LEAST_GAIN, MOST_WHEELS = 0.01, 3  # of the area; lines about other wheels


class PlanFigures(QtGui.QWidget):
    """``words``: as ``pictures.WORDS``."""

    def __init__(self, words: Texts) -> None:
        super().__init__()
        self.words, self.obj = words, None
        body = QtGui.QVBoxLayout(self)
        body.setContentsMargins(0, 0, 0, 0)
        self.rounds = _table(
            "rounds",
            translate("BeltGrinding", "Round"),
            translate("BeltGrinding", "In tol."),
            translate("BeltGrinding", "RMS"),  # its unit is told below, where there is room
            translate("BeltGrinding", "Time, s"),
        )
        self.rounds.setWordWrap(False)
        self.table = _table(
            "figures",
            "",
            translate("BeltGrinding", "Before"),
            translate("BeltGrinding", "Planned"),
        )
        self.checked = QtGui.QLabel()
        self.checked.setObjectName("checked")
        self.checked.setWordWrap(True)
        self.reasons = QtGui.QLabel()
        self.reasons.setObjectName("reasons")
        self.reasons.setWordWrap(True)
        self.why = QtGui.QLabel(
            translate("BeltGrinding", "Of the area, what stays out of tolerance:")
        )
        self.why.setWordWrap(True)
        self.picture = PictureLabel("planPicture", self.enlarge)
        for widget in (self.rounds, self.table, self.checked, self.why, self.reasons, self.picture):
            body.addWidget(widget)

    def clear(self) -> None:
        """Shows nothing, before the first round."""
        self.obj = None
        self.show_rounds([])
        for widget in (self.table, self.checked, self.why, self.reasons, self.picture):
            widget.hide()

    def show_rounds(self, rounds: Sequence[Json]) -> None:
        """The rounds so far, as ``planning.Plan.rounds``."""
        self.rounds.setVisible(bool(rounds))
        self.rounds.setRowCount(len(rounds))
        number = 0
        for row, one in enumerate(rounds):
            for column, text in enumerate(_round(number, one)):
                item = QtGui.QTableWidgetItem(text)
                item.setToolTip(_passes(one))
                self.rounds.setItem(row, column, item)
            number += "change" not in one and "from_file" not in one
        _fit(self.rounds)

    def show_plan(self, obj: DocumentObject) -> None:
        """What a Plan object holds."""
        self.obj, data = obj, obj.Proxy.data(obj)
        files = [{**data["from_file"], "from_file": True}] if "from_file" in data else []
        self.show_rounds([*data.get("tried", []), *data["rounds"], *files])
        told = data["checked"] or data
        before, after = told["before"], told["after"]

        unit = preferences.deviation_unit()

        def percent(key: str) -> list[str]:
            return [f"{figure(100.0 * one[key], '.1f')} %" for one in (before, after)]

        rows: tuple[Any, ...] = (
            (translate("BeltGrinding", "In tolerance"), percent("in_tolerance")),
            (translate("BeltGrinding", "Too much left"), percent("above")),
            (translate("BeltGrinding", "Cut too deep"), percent("below")),
            (
                translate("BeltGrinding", "RMS, {}").format(unit.symbol),
                [
                    figure(one["rms_mm"] / unit.size, f".{unit.decimals}f")
                    for one in (before, after)
                ],
            ),
            (
                translate("BeltGrinding", "Process time, s"),
                [figure(one["process_time_s"], ".1f") for one in (before, after)],
            ),
        )
        rows += tuple(
            (name, percent(key))
            for key, name in (
                ("sure_share", translate("BeltGrinding", "Surely in tol.")),
                ("passing", translate("BeltGrinding", "Laws that pass")),
            )
            if key in after
        )
        self.table.setRowCount(len(rows))
        for row, (name, texts) in enumerate(rows):
            for column, text in enumerate((name, *texts)):
                self.table.setItem(row, column, QtGui.QTableWidgetItem(text))
        self.table.show()
        _fit(self.table)
        self.checked.setVisible(bool(data["checked"]))
        self.checked.setText("\n".join(_checked(obj, bool(files))))
        shares = data["out_of_tolerance"]
        told = [
            f'<span style="color:#{pictures.COLOURS[state] >> 8:06x}">■</span> '
            f"{figure(100.0 * shares[word], '.1f')} % {self.words[word]}"
            for state, word in sorted(reasons.WORDS.items(), key=lambda one: -shares[one[1]])
            if shares[word] > pictures.SMALLEST
        ]
        told += _further(data.get("search"))
        self.reasons.setText("<br>".join(told))
        for widget in (self.why, self.reasons):
            widget.setVisible(bool(told))
        self.picture.show_file(obj.Strip)

    def enlarge(self) -> None:
        """Picture and chart in a window of their own."""
        if self.obj is None:
            return
        screen = Gui.getMainWindow().screen().availableGeometry().size()
        window = QtGui.QDialog(Gui.getMainWindow())
        window.setObjectName("planWindow")
        window.setWindowTitle(self.obj.Label)
        window.setAttribute(QtCore.Qt.WA_DeleteOnClose)
        body = QtGui.QVBoxLayout(window)
        label = QtGui.QLabel()
        pixmap = QtGui.QPixmap(self.obj.Picture)
        chart = FeedChart()
        chart.show_plan(self.obj)
        room = QtCore.QSize(
            int(LARGE * screen.width()), int(LARGE * screen.height()) - chart.minimumHeight() - 40
        )
        label.setPixmap(
            pixmap.scaled(room, QtCore.Qt.KeepAspectRatio, QtCore.Qt.SmoothTransformation)
        )
        label.setAlignment(QtCore.Qt.AlignCenter)
        body.addWidget(label)
        body.addWidget(chart)
        window.show()


def _round(number: int, one: Json) -> tuple[str, str, str, str]:
    """The texts of a row: a round of a plan, or passes that were tried."""
    share = f"{figure(100.0 * one['in_tolerance'], '.1f')} %"
    if "change" in one:
        return _tried(one), share, "", ""
    name = str(number) if number else translate("BeltGrinding", "now")
    if "from_file" in one:
        name = translate("BeltGrinding", "file")
    if "levels" in one:
        name = translate("BeltGrinding", "{} feeds").format(one["levels"])
    if one.get("resolution") == "coarse":
        name = translate("BeltGrinding", "{} (coarse)").format(name)
    unit = preferences.deviation_unit()
    rms = figure(one["rms_mm"] / unit.size, f".{unit.decimals}f")
    return name, share, rms, figure(one["process_time_s"], ".1f")


def _tried(one: Json) -> str:
    """What passes that were tried are called."""
    name = f"{figure(one['step_over_mm'], '.2g')} mm"
    if one["repeats"] > 1:
        name += f" × {one['repeats']}"
    return name


def _further(search: Json | None) -> list[str]:
    """What the wheel gets to, and what others would bring, after a search."""
    if search is None:
        return []
    text = translate("BeltGrinding", "The wheel gets to {} % of the area, some wheel to {} %.")
    shares = (figure(100.0 * search[key], ".1f") for key in ("reachable", "reachable_by_any"))
    told = [text.format(*shares)]
    gains = [one for one in search["wheels"] if (one["gain"] or 0.0) >= LEAST_GAIN]
    for one in sorted(gains, key=lambda one: -one["gain"])[:MOST_WHEELS]:
        text = translate("BeltGrinding", "A wheel of {} mm radius, {} mm wide: {} points more.")
        sizes = (figure(one["wheel"][key], "g") for key in ("radius_mm", "width_mm"))
        told.append(text.format(*sizes, figure(100.0 * one["gain"], ".1f")))
    return told


def _checked(obj: DocumentObject, files: bool) -> list[str]:
    """How both columns were found, and where the programs' files fall short of the rounds."""
    if not files:  # a plan of an earlier version
        return [translate("BeltGrinding", "Both simulated at half the spacing and step.")]
    text = translate(
        "BeltGrinding",
        "Both simulated at half the spacing and step; planned: the program as it is written, read again.",
    )
    return [text, *stored_facts.sentences(obj, "FilesShort", language())]


def _passes(one: Json) -> str:
    """What a row of passes that were tried says in full."""
    if "change" not in one:
        return ""
    text = translate(
        "BeltGrinding", "Passes {:.3g} mm apart, run-out {:.3g} mm, run through {} times, {} poses"
    )
    told = text.format(one["step_over_mm"], one["run_out_mm"], one["repeats"], one["poses"])
    text = translate("BeltGrinding", "along {}, belt at {} degrees, {} N")
    lines = [told, text.format(*way_of_passes(one), figure(one["force_N"], ".3g"))]
    text = translate("BeltGrinding", "then, where too much is left: along {}, belt at {} degrees")
    lines += [text.format(*way_of_passes(group)) for group in one.get("further_passes", [])]
    return "\n".join(lines)


def _table(name: str, *columns: str, stretched: int = 0) -> Table:
    table = _Table(0, len(columns))
    table.setObjectName(name)
    table.setHorizontalHeaderLabels(list(columns))
    table.verticalHeader().hide()
    table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
    table.setSelectionMode(QtGui.QAbstractItemView.NoSelection)
    table.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
    table.setVerticalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
    head = table.horizontalHeader()
    head.setSectionResizeMode(QtGui.QHeaderView.ResizeToContents)
    head.setSectionResizeMode(stretched, QtGui.QHeaderView.Stretch)
    head.setMinimumSectionSize(24)
    table.setMinimumWidth(10)
    return table


class _Table(QtGui.QTableWidget):
    """As high as its rows, which wrap where it is narrow."""

    def resizeEvent(self, event: QtEvent) -> None:
        super().resizeEvent(event)
        _fit(self)


def _fit(table: Table) -> None:
    """Makes a table as high as its rows."""
    table.resizeRowsToContents()
    rows = sum(table.rowHeight(row) for row in range(table.rowCount()))
    table.setFixedHeight(table.horizontalHeader().sizeHint().height() + rows + 4)
