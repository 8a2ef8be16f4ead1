"""Names of types that stand in many signatures of documents. FreeCAD's have no types: to who checks them they are Any."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from ..engine import core

Document: TypeAlias = Any  # App.Document
DocumentObject: TypeAlias = Any  # App.DocumentObject
ViewObject: TypeAlias = Any  # Gui.ViewProviderDocumentObject
Placement: TypeAlias = Any  # App.Placement
Vector: TypeAlias = Any  # App.Vector
ParameterGroup: TypeAlias = Any  # a ParameterGrp, as App.ParamGet gives it
Sheet: TypeAlias = Any  # Spreadsheet::Sheet
PartShape: TypeAlias = Any  # Part.Shape
PartFace: TypeAlias = Any  # Part.Face
MeshShape: TypeAlias = Any  # Mesh.Mesh

Field: TypeAlias = "core.HeightField"
Event: TypeAlias = dict[str, Any]  # as events.schema.json says
Limits: TypeAlias = Sequence[float]  # mm, lower and upper
Scale: TypeAlias = tuple[
    float, float, float
]  # mm, lower and upper limit, end of the colours' ramps
Point: TypeAlias = Sequence[float]  # x, y, z
Names: TypeAlias = "str | Sequence[str]"  # of sub-elements, as FreeCAD gives them
Links: TypeAlias = Sequence[tuple[DocumentObject, Names]]
Properties: TypeAlias = Mapping[str, Any]  # by their names, as a macro gives them
Faces: TypeAlias = Iterable[Any]  # names such as "Face3", numbers from 1, or (object, names)
