"""Check boxes of a job's programs: whether runs take them."""

from __future__ import annotations

from collections.abc import Sequence

from ...objects.kinds import DocumentObject
from ..common.compat import QtGui, translate
from ..common.kinds import Widget


def active_box(path: DocumentObject, text: str) -> Widget:
    """A check box that sets ``Active`` of a program."""
    box = QtGui.QCheckBox(text)
    box.setObjectName(f"active{path.Name}")
    box.setToolTip(path.getDocumentationOfProperty("Active"))
    box.setChecked(path.Active)
    box.toggled.connect(lambda on: setattr(path, "Active", on))
    return box


class ActivePrograms(QtGui.QWidget):
    """Sets ``Active`` of the programs, in the order in which they are ground."""

    def __init__(self, programs: Sequence[DocumentObject]) -> None:
        super().__init__()
        self.programs = programs
        column = QtGui.QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        for path in programs:
            column.addWidget(active_box(path, path.Label))

    def summary(self) -> str:
        """How many a run takes."""
        count = sum(path.Active for path in self.programs)
        return translate("BeltGrinding", "{} of {}").format(count, len(self.programs))
