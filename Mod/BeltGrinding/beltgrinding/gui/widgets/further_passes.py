"""The further groups of a raster path's passes: which ways they go, and a button that leaves them out."""

from __future__ import annotations

from collections.abc import Callable

from ...objects import raster_path
from ...objects.kinds import DocumentObject
from ..common.compat import QtGui, translate
from ..common.figures import way_of_passes


class FurtherPasses(QtGui.QGroupBox):
    """Is hidden where a RasterPath has none. ``changed()`` is called after they are left out."""

    def __init__(self, obj: DocumentObject, changed: Callable[[], object]) -> None:
        super().__init__(translate("BeltGrinding", "Further passes"))
        self.obj, self.changed = obj, changed
        rows = QtGui.QVBoxLayout(self)
        self.told = QtGui.QLabel()
        self.told.setObjectName("furtherPasses")
        self.told.setWordWrap(True)
        rows.addWidget(self.told)
        button = QtGui.QPushButton(translate("BeltGrinding", "Leave them out"))
        button.setObjectName("noFurtherPasses")
        button.clicked.connect(self.leave_out)
        rows.addWidget(button)
        self.refresh()

    def refresh(self) -> None:
        groups = raster_path.further_passes(self.obj)
        text = translate("BeltGrinding", "along {}, belt at {} degrees, near {} points")
        lines = [text.format(*way_of_passes(one), len(one["region_points"])) for one in groups]
        self.told.setText("\n".join(lines))
        self.setVisible(bool(groups))

    def leave_out(self) -> None:
        self.obj.FurtherPasses = "[]"
        self.refresh()
        self.changed()
