"""Task panel of a robot program."""

from pathlib import Path

from .. import InputError
from ..objects import robot_path
from ..programs import file_pattern
from .compat import QtGui, translate
from .form import Form
from .panel import Panel

SHOWN_PROBLEMS = 200


class ProgramPanel(Panel):
    """Edits a RobotPath: its file, its overrides; shows what could not be resolved."""

    def __init__(self, obj):
        title = translate("BeltGrinding", "Robot program")
        super().__init__(obj, title, "BeltGrinding_ImportProgram")
        form = Form(obj, translate("BeltGrinding", "Program"))
        form.add("Source", translate("BeltGrinding", "File"), f"Robot programs ({file_pattern()})")
        form.add("FeedOverride", translate("BeltGrinding", "Feed (0: as programmed)"))
        form.add("ForceOverride", translate("BeltGrinding", "Force (0: as programmed)"))
        self.body.addWidget(form)
        again = QtGui.QPushButton(translate("BeltGrinding", "Read the file again"))
        again.setObjectName("reload")
        again.clicked.connect(self.reload)
        self.body.addWidget(again)
        self.problems = QtGui.QListWidget()
        self.problems.setObjectName("problems")
        self.body.addWidget(self.problems)
        self.source = obj.Source
        form.changed = self.changed
        self.finish()
        self.describe()

    def changed(self):
        if self.obj.Source != self.source:
            self.reload()
        else:
            self.describe()

    def reload(self):
        """Reads the file; on an error the poses stay as they were."""
        try:
            robot_path.load_program(self.obj, self.obj.Source)
            self.source = self.obj.Source
            self.obj.Label = Path(self.obj.Source).stem
        except InputError as error:
            self.obj.Source = self.source
            self.tell(str(error), True)
            return
        self.describe()

    def describe(self):
        """Figures of the path and the list of problems."""
        obj = self.obj
        obj.recompute()
        self.tell(
            translate("BeltGrinding", "{} poses, {:.1f} mm, {:.1f} s ({})").format(
                obj.PoseCount, obj.PathLength.Value, obj.Duration, obj.Language
            )
        )
        self.problems.clear()
        self.problems.addItems(obj.Problems[:SHOWN_PROBLEMS])
        if len(obj.Problems) > SHOWN_PROBLEMS:
            more = len(obj.Problems) - SHOWN_PROBLEMS
            self.problems.addItem(translate("BeltGrinding", "... and {} more").format(more))
        self.problems.setVisible(bool(obj.Problems))
