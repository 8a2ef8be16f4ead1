"""Reads a scan's file: a triangle mesh, or a cloud of points."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.kinds import Array, Floats, known
from ..base.regular_files import open_regular, read_regular
from ..engine import InputError, core

TEXT_SUFFIXES = (".xyz", ".asc", ".txt", ".csv", ".pts")
SPREAD = 100_000  # points on a mesh that align it
MOST_BYTES = 4 << 30  # of a text: more is no scan, or not one for this memory


class Scan:
    """``points`` (n, 3) mm in the scan's frame; ``triangles`` (m, 3) counter-clockwise seen from
    outside, or None for a cloud; ``unit_mm``: mm of the file's 1; ``warnings``: Facts of its file.
    """

    def __init__(
        self,
        points: ArrayLike,
        triangles: Array | None = None,
        unit_mm: float = 1.0,
        warnings: Iterable[core.Fact] = (),
    ) -> None:
        self.points = np.ascontiguousarray(points, dtype=float)
        self.triangles = triangles
        self.unit_mm = unit_mm
        self.warnings = list(warnings)

    def turned(self) -> Scan:
        """The same with its other side outside."""
        return Scan(self.points, known(self.triangles)[:, [0, 2, 1]], self.unit_mm, self.warnings)

    def scaled(self, factor: float) -> Scan:
        """The same so many times larger."""
        return Scan(self.points * factor, self.triangles, self.unit_mm * factor)

    def spread(self, count: int = SPREAD) -> tuple[Floats, Floats]:
        """(points (k, 3), outward normals (k, 3) or (0, 3)) evenly on the surface: a mesh's vertices
        may lie anyhow. The same at every call.
        """
        if self.triangles is None:
            return self.points, np.empty((0, 3))
        corners = self.points[self.triangles]
        twice = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(twice, axis=1)
        if not size.sum() > 0:
            raise InputError("scan.no_area", "scan: its triangles have no area")
        random = np.random.default_rng(0)
        chosen = np.sort(random.choice(len(size), count, p=size / size.sum()))
        u, v = random.random((2, count, 1))
        u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
        a, b, c = corners[chosen].transpose(1, 0, 2)
        return a + u * (b - a) + v * (c - a), twice[chosen] / size[chosen, None]


def read(path: Path | str, unit_mm: float = 1.0) -> Scan:
    """The ``Scan`` in a file; ``unit_mm``: mm of the file's 1, 1: also what a 3MF says. Raises InputError naming the file."""
    path = Path(path)
    if not (isinstance(unit_mm, (int, float)) and unit_mm > 0 and math.isfinite(unit_mm)):
        raise InputError(
            "scan.unit",
            "{file}: the scan's unit must be a positive number of millimetres",
            file=path,
        )
    open_regular(path, sys.maxsize).close()
    if path.suffix.lower() in TEXT_SUFFIXES:
        return Scan(read_text(path) * unit_mm, None, unit_mm)
    if path.suffix.lower() == ".ply":
        points, triangles, turned = core.read_ply(str(path))
        points = np.asarray(points) * unit_mm
        if not len(points):
            raise InputError("scan.no_point", "{file}: the scan has no point", file=path)
        if not np.isfinite(points).all():
            row = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
            raise InputError(
                "scan.vertex_not_finite",
                "{file}: vertex {vertex} is not finite",
                file=path,
                vertex=row,
            )
        told = []
        if turned:
            told.append(
                core.Fact(
                    "mesh.turned",
                    "{file}: {count} closed pieces of the mesh are inside out; they are turned",
                    file=str(path),
                    count=turned,
                )
            )
        return Scan(points, np.asarray(triangles) if len(triangles) else None, unit_mm, told)
    if path.suffix.lower() == ".obj" and not _has_faces(path):
        return Scan(_obj_points(path) * unit_mm, None, unit_mm)
    report: dict[str, Any] = {}
    mesh = core.read_mesh(str(path), float(unit_mm), report=report)
    told = [
        fact for fact in report["warnings"] if fact.code != "mesh.size"
    ]  # the design tells better
    return Scan(np.asarray(mesh.vertices), np.asarray(mesh.triangles), report["unit_mm"], told)


def read_text(path: Path | str) -> Floats:
    """(n, 3) of a text's first three columns; blanks, tabs, commas or semicolons between them; lines
    that begin with # or //, and one line of headings or a count before the first point, are passed
    over.
    """
    text = read_regular(path, MOST_BYTES).decode("latin-1")
    rows: list[tuple[float, float, float]] = []
    headings = 0
    for number, line in enumerate(text.splitlines(), 1):
        line = line.strip()
        if not line or line.startswith(("#", "//")):
            continue
        try:
            words = _words(line)
            row = (float(words[0]), float(words[1]), float(words[2]))
        except (ValueError, IndexError):
            headings += 1
            if rows or headings > 1 or line[0] in "+-.0123456789" and " " in line:
                raise InputError(
                    "scan.no_coordinates",
                    "{file}: line {line}: '{text}' does not begin with three numbers; the decimal "
                    "sign is a point",
                    file=path,
                    line=number,
                    text=line[:40],
                ) from None
            continue
        if not all(math.isfinite(value) for value in row):
            raise InputError(
                "scan.coordinate_not_finite",
                "{file}: line {line}: a coordinate is not finite",
                file=path,
                line=number,
            )
        rows.append(row)
    if not rows:
        raise InputError("scan.no_point", "{file}: the scan has no point", file=path)
    return np.array(rows)


def _words(line: str) -> list[str]:
    """The columns of a line. ValueError where a comma may be a decimal sign."""
    if ";" in line:
        words = [word.strip() for word in line.split(";")]
    else:
        words = line.split()
        if len(words) == 1:
            return line.split(",")
        words = [word[:-1] if word.endswith(",") else word for word in words]
    if any("," in word for word in words[:3]):
        raise ValueError("a decimal comma")
    return words


def _has_faces(path: Path | str) -> bool:
    with open(path, "rb") as file:
        return any(line.lstrip().startswith(b"f ") for line in file)


def _obj_points(path: Path | str) -> Floats:
    rows = []
    with open(path, encoding="latin-1") as file:
        for number, line in enumerate(file, 1):
            words = line.split()
            if not words or words[0] != "v":
                continue
            try:
                row = [float(word) for word in words[1:4]]
            except ValueError:
                row = []
            if len(row) != 3 or not all(math.isfinite(value) for value in row):
                raise InputError(
                    "scan.no_vertex",
                    "{file}: line {line}: a vertex is three finite numbers",
                    file=path,
                    line=number,
                )
            rows.append(row)
    if not rows:
        raise InputError("scan.no_point", "{file}: the scan has no point", file=path)
    return np.array(rows)
