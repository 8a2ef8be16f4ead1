"""The stock in the document: a uniform allowance, a solid, a mesh, or what another job leaves."""

from __future__ import annotations

import hashlib
import os
import shutil
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from ..engine import InputError
from ..job.workpiece import OwnBrep
from .fields import field_of
from .geometry import export_solid, faces_digest, geometry_digest, placed_shape, placement_to_job
from .kinds import DocumentObject, PartShape
from .properties import Key, add_keys, check_limits, get_value
from .proxy import Proxy, checking

KEYS = (
    Key("Kind", "Enumeration", "Stock", "stock.kind"),
    Key("Allowance", "Distance", "Stock", "stock.allowance_mm"),
    Key("Deflection", "Length", "Solid", "stock.deflection_mm"),
    Key("FileUnit", "Float", "Mesh", "stock.unit_mm"),
    Key("SearchAbove", "Length", "Search", "stock.search_above_mm"),
    Key("SearchBelow", "Length", "Search", "stock.search_below_mm"),
)
USED = {
    "allowance": {"Kind", "Allowance"},
    "solid": {"Kind", "Deflection", "SearchAbove", "SearchBelow"},
    "mesh": {"Kind", "FileUnit", "SearchAbove", "SearchBelow"},
    "left": {"Kind"},
}
LINKS = (  # name, kind, group, text
    (
        "Source",
        "LinkGlobal",
        "Stock",
        "the Part or Mesh object that is the stock, or the result of another job, which leaves it",
    ),
    ("File", "File", "Mesh", "a mesh's file (STL, PLY, OBJ) in place of an object"),
    ("FilePlacement", "Placement", "Mesh", "where the file's mesh lies in the document"),
)


class Stock(Proxy):
    """Proxy. ``Source`` is a Part or a Mesh object, or another job's Simulation; ``File`` is a mesh's file in its place."""

    TYPE = "BeltGrinding::Stock"
    VIEW = "StockView"

    def add_properties(self, obj: DocumentObject) -> None:
        add_keys(obj, KEYS)
        for name, kind, group, text in LINKS:
            if name not in obj.PropertiesList:
                obj.addProperty(f"App::Property{kind}", name, group, text)

    def execute(self, obj: DocumentObject) -> None:
        """Raises InputError for a stock that cannot be; the tree shows it there."""
        with checking(obj):
            check_limits(obj, [key for key in KEYS if key.name in USED[obj.Kind]])
            if obj.Kind == "solid":
                _require_solid(obj)
            elif obj.Kind == "mesh":
                _require_mesh(obj)
            elif obj.Kind == "left":
                _require_result(obj)

    def settings(self, obj: DocumentObject) -> dict[str, Any]:
        """The part of a job under 'stock' that needs no geometry."""
        used = USED[obj.Kind]
        return {k.key.split(".")[1]: get_value(obj, k) for k in KEYS if k.name in used}

    def digest(self, obj: DocumentObject) -> str:
        """Hash of the stock's geometry; '' for an allowance."""
        if obj.Kind == "allowance":
            return ""
        if obj.Kind == "mesh" and obj.Source is None and obj.File:
            try:
                status = os.stat(obj.File)
            except OSError:
                return f"missing {obj.File}"
            file = _file_digest(obj.File, status.st_size, status.st_mtime_ns)
            return f"{file} {obj.FilePlacement.toMatrix().A}"
        if obj.Source is None:
            return "none"
        if hasattr(obj.Source, "HeightField"):
            return str(obj.Source.Fingerprint)
        if hasattr(obj.Source, "Mesh"):
            return geometry_digest(obj.Source)
        return faces_digest(_shape(obj).Faces)

    def to_job(self, obj: DocumentObject, folder: Path | str) -> dict[str, Any]:
        """The part of a job under 'stock'; a mesh of the document, and what another job
        leaves, are written to ``folder``."""
        job = self.settings(obj)
        if obj.Kind == "solid":
            job["brep"] = OwnBrep(_shape(obj).exportBrepToString())
        elif obj.Kind == "mesh":
            _require_mesh(obj)
            if obj.Source is not None:
                job.update(export_solid(obj.Source, folder, "stock"))
                job["unit_mm"] = 1.0
            else:
                job["file"] = obj.File
                job["placement"] = placement_to_job(obj.FilePlacement)
        elif obj.Kind == "left":
            job.update(_left(obj, folder))
        return job


@lru_cache(maxsize=8)
def _file_digest(path: str, size: int, time: int) -> str:
    hashed = hashlib.sha256()
    with open(path, "rb") as file:
        while chunk := file.read(1 << 20):
            hashed.update(chunk)
    return hashed.hexdigest()


def _require_solid(obj: DocumentObject) -> None:
    if obj.Source is None:
        raise InputError(
            "objects.no_solid", "{object}: choose the solid that is the stock", object=obj.Label
        )
    if not hasattr(obj.Source, "Shape"):
        raise InputError(
            "objects.source_no_solid",
            "{object}: {source} is no solid; set Kind to mesh",
            object=obj.Label,
            source=obj.Source.Label,
        )


def _require_mesh(obj: DocumentObject) -> None:
    if obj.Source is None and not obj.File:
        raise InputError(
            "objects.no_mesh", "{object}: choose the mesh: an object or a file", object=obj.Label
        )
    if obj.Source is not None and not hasattr(obj.Source, "Mesh"):
        raise InputError(
            "objects.source_no_mesh",
            "{object}: {source} is no mesh; set Kind to solid",
            object=obj.Label,
            source=obj.Source.Label,
        )


def _require_result(obj: DocumentObject) -> None:
    source, job = obj.Source, obj.getParentGroup()
    if source is None or not hasattr(source, "HeightField"):
        raise InputError(
            "objects.no_left",
            "{object}: choose the result of the job that grinds before",
            object=obj.Label,
        )
    if job is not None and source.getParentGroup() == job:
        raise InputError(
            "objects.left_by_itself",
            "{object}: a job does not begin with what it leaves itself; choose another job's result",
            object=obj.Label,
        )


def _left(obj: DocumentObject, folder: Path | str) -> dict[str, Any]:
    """What the job before leaves, written to ``folder``; on the whole it is no thicker than its thickest place, which
    is what collisions are looked for with. Raises InputError."""
    _require_result(obj)
    before = obj.Source.getParentGroup()
    field = field_of(obj.Source)
    if field is None or obj.Source.OutOfDate:
        raise InputError(
            "objects.left_out_of_date",
            "{object}: {job} is not simulated as it is now; simulate it first",
            object=obj.Label,
            job=before.Label if before is not None else obj.Source.Label,
        )
    path = Path(folder) / "left.h5"
    shutil.copyfile(obj.Source.HeightField, path)
    return {"left_by": str(path), "allowance_mm": float(np.max(field.height, initial=0.0))}


def _shape(obj: DocumentObject) -> PartShape:
    _require_solid(obj)
    return placed_shape(obj.Source)
