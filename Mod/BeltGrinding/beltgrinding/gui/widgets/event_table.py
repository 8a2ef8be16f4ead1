"""The table of a simulation's events: filtered by kind and severity, the chosen one in full below."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

from ...cell.events import SEVERITIES
from ...objects.kinds import Event
from ..common import event_texts
from ..common.compat import QtCore, QtGui, translate
from ..common.figures import figure
from ..common.event_texts import COLOURS
from ..common.kinds import FaceName, Icon, Layout, QtEvent, TableItem, Widget
from .steady import steady

SHOWN = 5000  # rows; a table of more is no help
ROWS = 12  # that the table has room for at least
DETAILS = 5  # lines of text
ICON = 14  # pixels
NARROW = 4  # characters
WIDE = 300  # pixels that kinds and places need side by side
_Choice = tuple[str, str, Optional[str]]  # what is kept, its text, the severity of its icon


class EventTable(QtGui.QWidget):
    """Shows events; ``chosen(event)`` is called with the one that a person chooses.

    ``face_name(number)``: how a face is called, its number from 1.
    """

    def __init__(self, face_name: FaceName) -> None:
        super().__init__()
        self.face_name = face_name
        self.chosen = lambda event: None
        self.events: Sequence[Event] = []
        self.rows: list[Event] = []  # that are shown
        self.fresh = False
        body = QtGui.QVBoxLayout(self)
        body.setContentsMargins(0, 0, 0, 0)
        row = QtGui.QHBoxLayout()
        self.kind = self._choice("eventKind", row, 1)
        self.severity = self._choice("eventSeverity", row, 0)
        body.addLayout(row)
        self.table = QtGui.QTableWidget(0, 4)
        self.table.setObjectName("events")
        self.table.setHorizontalHeaderLabels(
            [
                translate("BeltGrinding", "Time, s"),
                translate("BeltGrinding", "Event"),
                translate("BeltGrinding", "Where"),
                translate("BeltGrinding", "Line"),
            ]
        )
        self.table.verticalHeader().hide()
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(QtGui.QHeaderView.ResizeToContents)
        self.table.setEditTriggers(QtGui.QAbstractItemView.NoEditTriggers)
        self.table.setSelectionBehavior(QtGui.QAbstractItemView.SelectRows)
        self.table.setSelectionMode(QtGui.QAbstractItemView.SingleSelection)
        self.table.setAlternatingRowColors(True)
        self.table.setShowGrid(False)
        self.table.setWordWrap(False)
        self.table.setIconSize(QtCore.QSize(ICON, ICON))
        height = self.table.fontMetrics().height() + 6
        self.table.verticalHeader().setDefaultSectionSize(height)
        self.table.setMinimumHeight((ROWS + 1) * height)
        self.table.itemSelectionChanged.connect(self._select)
        self.table.itemClicked.connect(self._clicked)  # again, to come back to the same one
        body.addWidget(self.table, 1)
        self.details = QtGui.QLabel()
        self.details.setObjectName("eventDetails")
        self.details.setWordWrap(True)
        self.details.setTextFormat(QtCore.Qt.RichText)
        self.details.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.details.setAlignment(QtCore.Qt.AlignTop | QtCore.Qt.AlignLeft)
        self.details.setMinimumHeight(DETAILS * self.details.fontMetrics().lineSpacing())
        body.addWidget(self.details)

    def _choice(self, name: str, row: Layout, stretch: int) -> Widget:
        choice = steady(QtGui.QComboBox())
        choice.setObjectName(name)
        choice.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
        choice.setMinimumContentsLength(NARROW)
        choice.setMinimumWidth(1)  # a panel must fit the combo view as it comes
        choice.currentIndexChanged.connect(self._fill)
        row.addWidget(choice, stretch)
        return choice

    def show_events(self, events: Sequence[Event]) -> None:
        """Shows a list of events, as a Simulation has them."""
        self.events = events
        kinds: dict[str, int] = {}  # how many there are
        severities: dict[str, int] = {}
        for event in events:
            kinds[event["kind"]] = kinds.get(event["kind"], 0) + 1
            severities[event["severity"]] = severities.get(event["severity"], 0) + 1
        titles = {event["kind"]: event_texts.title(event) for event in reversed(events)}
        worst = {e["kind"]: SEVERITIES.index(e["severity"]) for e in reversed(events)}
        every = translate("BeltGrinding", "All events ({})").format(len(events))
        rows: list[_Choice] = [("", every, None)]
        for kind in sorted(kinds, key=lambda kind: (worst[kind], -kinds[kind])):
            text = f"{titles[kind]} ({kinds[kind]})"
            rows.append((kind, text, SEVERITIES[worst[kind]]))
        self._offer(self.kind, rows)
        rows = [("", translate("BeltGrinding", "Any"), None)]
        for severity, (_, several) in event_texts.severities().items():
            if severity in severities:
                rows.append((severity, f"{several} ({severities[severity]})", severity))
        self._offer(self.severity, rows)
        self._fill()

    def _offer(self, choice: Widget, rows: Sequence[_Choice]) -> None:
        choice.blockSignals(True)
        choice.clear()
        for data, text, severity in rows:
            choice.addItem(severity_icon(severity) if severity else QtGui.QIcon(), text, data)
        choice.blockSignals(False)

    def _fill(self, *_: object) -> None:
        kind, severity = self.kind.currentData(), self.severity.currentData()
        self.rows = [
            event
            for event in self.events
            if kind in ("", event["kind"]) and severity in ("", event["severity"])
        ][:SHOWN]
        self.details.clear()
        table = self.table
        table.blockSignals(True)
        table.clearSelection()
        table.setCurrentCell(-1, -1)
        table.setRowCount(len(self.rows))
        several = len({event["program"] for event in self.events}) > 1
        for i, event in enumerate(self.rows):
            line = str(event["line"] or "")
            if several and line:
                line = f"{event['program'] + 1}: {line}"
            where = self.face_name(event["face"]) if event["face"] else event_texts.bodies(event)
            short = where.rpartition(".")[2] if event["face"] else where  # Face1 of Part.Face1
            message = event_texts.message(event)
            cells = (figure(event["time"], ".2f"), event_texts.title(event), short, line)
            for k, text in enumerate(cells):
                item = QtGui.QTableWidgetItem(text)
                item.setToolTip(f"{where}: {message}" if where else message)
                if k in (0, 3):
                    item.setTextAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
                table.setItem(i, k, item)
            table.item(i, 0).setIcon(severity_icon(event["severity"]))
        self._arrange()
        table.blockSignals(False)

    def resizeEvent(self, event: QtEvent) -> None:
        super().resizeEvent(event)
        self._arrange()

    def _arrange(self) -> None:
        """Hides what says nothing, and in a narrow panel what the text below says as well."""
        one_kind, wide = bool(self.kind.currentData()), self.width() >= WIDE
        table, header = self.table, self.table.horizontalHeader()
        placed = any(event["face"] or event["bodies"] for event in self.rows)
        table.setColumnHidden(1, one_kind and placed)  # the choice above tells the kind
        table.setColumnHidden(2, not placed or not (one_kind or wide))
        table.setColumnHidden(3, not any(event["line"] for event in self.rows))
        header.setSectionResizeMode(1, QtGui.QHeaderView.Stretch)
        if one_kind:
            header.setSectionResizeMode(2, QtGui.QHeaderView.Stretch)
        else:
            header.setSectionResizeMode(2, QtGui.QHeaderView.Interactive)
            table.setColumnWidth(2, min(table.sizeHintForColumn(2), self.width() // 3))

    def _clicked(self, item: TableItem) -> None:
        if self.details.text() and item.row() == self.table.currentRow() and not self.fresh:
            self.chosen(self.rows[item.row()])
        self.fresh = False

    def _select(self) -> None:
        rows = self.table.selectionModel().selectedRows()
        if not rows:
            return
        event = self.rows[rows[0].row()]
        self.fresh = True  # the click that selects comes after
        self.details.setText(details(event))
        self.chosen(event)


def details(event: Event) -> str:
    """An event in full, as rich text."""
    colour = COLOURS[event["severity"]]
    names = event_texts.severities()
    lines = [
        f"<b style='color:{colour}'>{names[event['severity']][0]}: "
        f"{_escape(event_texts.title(event))}</b>",
        _escape(_sentence(event_texts.message(event))),
    ]
    if event["advice"]:
        hint = translate("BeltGrinding", "Try:")
        lines.append(
            f"<i>{_escape(hint)} {_escape(_sentence(event_texts.advice(event), False))}</i>"
        )
    when = translate("BeltGrinding", "From {:.2f} s, for {:.2f} s; pose {}").format(
        event["time"], event["duration"], event["pose"] + 1
    )
    if event["line"]:
        when += translate("BeltGrinding", ", line {}").format(event["line"])
    if event["point"]:
        x, y, z = event["point"]
        when += f"; ({figure(x, '.2f')}, {figure(y, '.2f')}, {figure(z, '.2f')}) mm"
    return "<br>".join([*lines, f"<span style='color:gray'>{_escape(when)}</span>"])


def _sentence(text: str, begin: bool = True) -> str:
    text = text[:1].upper() + text[1:] if begin else text
    return text if text.endswith(".") else text + "."


def _escape(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def severity_icon(severity: str) -> Icon:
    """A sign that tells severities apart by form as well as by colour."""
    picture = QtGui.QPixmap(2 * ICON, 2 * ICON)
    picture.fill(QtCore.Qt.transparent)
    painter = QtGui.QPainter(picture)
    painter.setRenderHint(QtGui.QPainter.Antialiasing)
    painter.setPen(QtCore.Qt.NoPen)
    painter.setBrush(QtGui.QColor(COLOURS[severity]))
    size = 2 * ICON
    if severity == "error":
        painter.drawEllipse(1, 1, size - 2, size - 2)
    elif severity == "warning":
        corners = [(0.5, 0.04), (0.98, 0.94), (0.02, 0.94)]
        points = [QtCore.QPointF(size * x, size * y) for x, y in corners]
        painter.drawPolygon(QtGui.QPolygonF(points))
    else:
        painter.drawRoundedRect(2, 2, size - 4, size - 4, 4, 4)
    font = painter.font()
    font.setBold(True)
    font.setPixelSize(int(0.62 * size))
    painter.setFont(font)
    painter.setPen(QtGui.QColor("white"))
    below = int(0.12 * size) if severity == "warning" else 0
    sign = "i" if severity == "info" else "!"
    painter.drawText(QtCore.QRect(0, below, size, size), QtCore.Qt.AlignCenter, sign)
    painter.end()
    return QtGui.QIcon(picture)
