"""Names of types that stand in many signatures of the window. Those of Qt, Coin and FreeCAD have no types: to who checks
them they are Any."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional, TypeAlias

from ...base import kinds as plain

Json: TypeAlias = plain.Json
Array: TypeAlias = plain.Array
Context: TypeAlias = plain.Context
known = plain.known

Widget: TypeAlias = Any  # QWidget
Layout: TypeAlias = Any  # QLayout
Table: TypeAlias = Any  # QTableWidget
TableItem: TypeAlias = Any  # QTableWidgetItem
Menu: TypeAlias = Any  # QMenu
Painter: TypeAlias = Any  # QPainter
QtEvent: TypeAlias = Any  # QEvent
QtPoint: TypeAlias = Any  # QPointF
Polygon: TypeAlias = Any  # QPolygonF
Rectangle: TypeAlias = Any  # QRectF
Pen: TypeAlias = Any  # QPen
Image: TypeAlias = Any  # QImage, QPixmap
Icon: TypeAlias = Any  # QIcon
Colour: TypeAlias = Any  # QColor, or what it takes
Buttons: TypeAlias = Any  # of a task panel, as FreeCAD takes them
View3D: TypeAlias = Any  # Gui.View3DInventor
Node: TypeAlias = Any  # SoNode
ModelIndex: TypeAlias = Any  # QModelIndex
Quantity: TypeAlias = Any  # App.Units.Quantity

Surface: TypeAlias = tuple[Array, Array]  # points (n, 3) mm, triangles (m, 3)
Rgb: TypeAlias = Sequence[float]  # from 0 to 1
Texts: TypeAlias = Mapping[str, str]  # what is shown, by what is kept
Numbers: TypeAlias = Sequence[float]
Told: TypeAlias = Callable[[float], object]  # of the share that is done
Done: TypeAlias = Callable[
    [Any, Optional[BaseException]], object
]  # with what was made, or the error
Changed: TypeAlias = Callable[..., object]  # something was entered
FaceName: TypeAlias = Callable[[int], str]  # what a face is called, by its number from 1
