"""A check box for each program of a job: whether runs take it."""

from __future__ import annotations

from collections.abc import Sequence

from ...objects.kinds import DocumentObject
from ..common.compat import QtGui, translate


class ActivePrograms(QtGui.QWidget):
    """Sets ``Active`` of the programs, in the order in which they are ground."""

    def __init__(self, programs: Sequence[DocumentObject]) -> None:
        super().__init__()
        self.programs = programs
        column = QtGui.QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        for path in programs:
            box = QtGui.QCheckBox(path.Label)
            box.setObjectName(f"active{path.Name}")
            box.setToolTip(path.getDocumentationOfProperty("Active"))
            box.setChecked(path.Active)
            box.toggled.connect(lambda on, path=path: setattr(path, "Active", on))
            column.addWidget(box)

    def summary(self) -> str:
        """How many a run takes."""
        count = sum(path.Active for path in self.programs)
        return translate("BeltGrinding", "{} of {}").format(count, len(self.programs))
