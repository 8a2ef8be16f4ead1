"""Task panel of a robot program."""

from __future__ import annotations

from pathlib import Path

from ...engine import Cancelled, InputError
from ...objects import program_values, robot_path, stored_facts
from ...objects.kinds import DocumentObject
from ..common.compat import QtGui, translate
from ..common.kinds import Json
from ..common.messages import error_text
from ..common.report_language import language
from ..widgets.active_programs import active_box
from ..widgets.form import Form
from ..widgets.pose_walk import PoseTable, PoseWalk
from ..widgets.program_values import ProgramValues
from ..common.editing import edit
from .panel import Panel

SHOWN_PROBLEMS = stored_facts.MOST  # more are kept in English only
TABLE_HEIGHT = 236  # pixels
_open: list[ProgramPanel] = []  # the panel that is open


def show_pose(obj: DocumentObject, index: int, opening: bool) -> None:
    """Selects the pose ``index`` (from 0) of a RobotPath in its panel, if that is open or with
    ``opening``, which opens it.
    """
    if opening and not _open:
        edit(obj)
    for panel in _open:
        if panel.obj == obj and index < obj.PoseCount:
            panel.walk.go(index)


class ProgramPanel(Panel):
    """Edits a RobotPath: its file, its overrides; shows its poses, their source, what could not be
    resolved. A pose chosen in the view, the table, the source or by the slider is chosen in all."""

    def __init__(self, obj: DocumentObject) -> None:
        title = translate("BeltGrinding", "Robot program")
        super().__init__(obj, title, "BeltGrinding_ImportProgram")
        form = Form(obj, translate("BeltGrinding", "Program"))
        if obj.SourceObject is None:
            from ..common.file_filters import programs_filter

            form.add("Source", translate("BeltGrinding", "File"), programs_filter())
        form.add("FeedOverride", translate("BeltGrinding", "Feed (0: as programmed)"))
        form.add("ForceOverride", translate("BeltGrinding", "Force (0: as programmed)"))
        form.add("PauseBefore", translate("BeltGrinding", "Pause before"), unit="s")
        form.add("DressBefore", translate("BeltGrinding", "Belt dressed before"))
        rolls = {
            "hold": translate("BeltGrinding", "held along a pass"),
            "along": translate("BeltGrinding", "along the pass"),
            "fixed": translate("BeltGrinding", "in a fixed direction"),
        }
        form.add("Roll", translate("BeltGrinding", "Belt's travel"), rolls)
        form.add("RollDirection", translate("BeltGrinding", "Direction of travel"))
        self.overrides = form
        self.body.addWidget(form)
        self.body.addWidget(active_box(obj, translate("BeltGrinding", "Active in runs")))
        again = QtGui.QPushButton(translate("BeltGrinding", "Read the file again"))
        again.setObjectName("reload")
        again.clicked.connect(self.reload)
        again.setVisible(obj.SourceObject is None)
        self.body.addWidget(again)
        self.walk = PoseWalk(obj.Document, obj.Machine, [obj])
        self.table = PoseTable()
        self.table.setMinimumHeight(TABLE_HEIGHT)
        self.problems = QtGui.QListWidget()
        self.problems.setObjectName("problems")
        self.problems.setWordWrap(True)
        self.each = QtGui.QCheckBox(translate("BeltGrinding", "Each place in a line of its own"))
        self.each.setObjectName("eachProblem")
        self.each.toggled.connect(self.show_problems)
        self.trouble = QtGui.QWidget()
        column = QtGui.QVBoxLayout(self.trouble)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.each)
        column.addWidget(self.problems)
        self.values = ProgramValues()
        self.values.applied = self.give
        self.values.saved = lambda data: self.give(data, True)
        self.values.wrong = lambda error: self.tell(error_text(error), True)
        self.walk.moved = self.table.show_pose
        self.table.chosen = self.walk.go
        self.body.addWidget(self.walk)
        self.body.addWidget(self.table, 1)
        self.source, self.roll = obj.Source, robot_path.roll_text(obj)
        form.changed = self.changed
        self.finish()
        self.show()
        _open.append(self)

    def changed(self) -> None:
        if self.obj.Source != self.source or robot_path.roll_text(self.obj) != self.roll:
            self.reload()
        else:
            self.describe()

    def reload(self) -> None:
        """Reads the file, or follows the path, again; on an error the poses stay as they were."""
        values = self.obj.Values
        try:
            if self.obj.SourceObject is not None:
                robot_path.follow(self.obj)
            else:
                if self.obj.Source != self.source:
                    self.obj.Values = ""  # of another program
                robot_path.load_program(self.obj, self.obj.Source)
                self.obj.Label = Path(self.obj.Source).stem
            self.source, self.roll = self.obj.Source, robot_path.roll_text(self.obj)
        except Cancelled:
            self.obj.Source, self.obj.Values = self.source, values
            return
        except InputError as error:
            self.obj.Source, self.obj.Values = self.source, values
            self.tell(error_text(error), True)
            return
        self.show()

    def give(self, data: Json, save: bool = False) -> None:
        """Reads the file with what a person says of it; on an error all stays as it was. ``save``: writes it
        beside the program, too."""
        try:
            robot_path.load_program(self.obj, self.obj.Source, data)
        except Cancelled:
            return
        except InputError as error:
            self.tell(error_text(error), True)
            return
        self.show()
        self.table.setCurrentWidget(self.values)
        try:
            if save:
                program_values.save_beside(self.obj, data)
        except InputError as error:
            self.tell(error_text(error), True)

    def show(self) -> None:
        """Poses, source and problems as they are now."""
        obj = self.obj
        rows = set(self.overrides.rows)
        if obj.Language not in robot_path.WITH_FREE_ROLL:
            rows -= {"Roll", "RollDirection"}
        elif obj.Roll != "fixed":
            rows -= {"RollDirection"}
        self.overrides.show_rows(rows)
        self.table.show_path(obj)
        self.walk.choose(0)
        if obj.Poses:
            self.table.show_pose(0)
        self.show_problems()
        at = self.table.indexOf(self.trouble)
        if at >= 0:
            self.table.removeTab(at)
        if obj.Problems:
            text = translate("BeltGrinding", "Problems ({})").format(len(obj.Problems))
            self.table.addTab(self.trouble, text)
        self.show_values()
        if len(obj.Poses) < 2 and self.table.indexOf(self.values) >= 0:
            self.table.setCurrentWidget(self.values)  # where it gets them from
        self.describe()

    def show_values(self) -> None:
        """What the program asks for, and what is given."""
        at = self.table.indexOf(self.values)
        if at >= 0:
            self.table.removeTab(at)
        rows = []
        if self.obj.SourceObject is None and self.obj.Source:
            try:
                rows = program_values.rows(self.obj)
            except (
                InputError
            ):  # the file beside it has gone bad since; reading the program again tells
                pass
        self.values.show_rows(rows)
        if rows:
            missing = sum(row.value is None for row in rows)
            text = translate("BeltGrinding", "Values ({} missing)").format(missing)
            self.table.addTab(self.values, text)

    def show_problems(self) -> None:
        """The list of problems: many of a kind in one line, or each place."""
        each, count = self.each.isChecked(), len(self.obj.Problems)
        most = None if each else SHOWN_PROBLEMS
        told = stored_facts.sentences(self.obj, "Problems", language(), most, alike=not each)
        self.problems.clear()
        self.problems.addItems(told)
        if not each and count > SHOWN_PROBLEMS:
            more = translate("BeltGrinding", "... and {} more").format(count - SHOWN_PROBLEMS)
            self.problems.addItem(more)
        self.each.setVisible(each or self.problems.count() < count)

    def describe(self) -> None:
        """Figures of the path."""
        obj = self.obj
        if "Touched" in obj.State:
            obj.recompute()
        missing = stored_facts.sentences(obj, "Problems", language(), 1)
        if len(obj.Poses) < 2 and obj.Asked and missing:
            self.tell(missing[0], True)
            return
        text = translate("BeltGrinding", "{} poses, {:.1f} mm, {:.1f} s ({})").format(
            obj.PoseCount, obj.PathLength.Value, obj.Duration, obj.Language
        )
        replaced = getattr(obj.Proxy, "replaced", [])  # by its import
        if replaced:
            note = translate(
                "BeltGrinding", "It takes the place of the passes that were proposed: {}"
            )
            text += "\n" + note.format(", ".join(replaced))
        self.tell(text)

    def close(self) -> None:
        _open.remove(self)
        self.walk.release()
        self.obj.Proxy.replaced = []
