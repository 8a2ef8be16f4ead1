"""Cross-sections of a result: design, stock and ground profile where a plane cuts the surface.

A section is a dict: ``point`` and ``normal`` of its plane (mm, work frame), ``tolerance``
(lower, upper; mm) and ``pieces``, one for every uninterrupted line on one face, each a dict of
``face`` (from 0), ``closed`` and arrays of n values: ``s`` (arc length along the whole section, gaps
included), ``point`` (n, 3), ``normal`` (n, 3), ``stock_height`` before grinding, ``height`` (the
deviation) and, of a calibrated law, ``height_sd``; all mm. NaN where a sample missed the stock.
"""

from __future__ import annotations
import csv
import io
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.files import cannot_be_written, write_whole
from ..base.kinds import Array, Floats, Json
from ..engine import InputError, core
from . import edge_profile, section_plot

if TYPE_CHECKING:
    from .ground import Ground

COLUMNS = (
    "piece",
    "face",
    "s_mm",
    "x_mm",
    "y_mm",
    "z_mm",
    "nx",
    "ny",
    "nz",
    "stock_mm",
    "deviation_mm",
    "removed_mm",
    "sd_mm",
    "verdict",
)


def section(result: Ground, point: ArrayLike | str, normal: ArrayLike | str) -> dict[str, Any]:
    """The section of a ``simulation.result.Result`` by a plane.

    ``point`` mm and ``normal`` (any length) in the work frame. Raises InputError when the plane
    misses the faces.
    """
    return _cut(core.section_by_plane, result, _vector(point, "point"), _vector(normal, "normal"))


def between(result: Ground, start: ArrayLike | str, end: ArrayLike | str) -> dict[str, Any]:
    """The line on the surface between two points (mm), in the plane of both and the mean of their
    normals. Raises InputError when no such line exists.
    """
    return _cut(core.section_between, result, _vector(start, "from"), _vector(end, "to"))


def of_field(
    field: core.HeightField, tolerance: Sequence[float], point: ArrayLike, normal: ArrayLike
) -> dict[str, Any]:
    """The section of a core.HeightField by a plane; ``tolerance`` (lower, upper) in mm."""
    return {**core.section_by_plane(field, point, normal), "tolerance": tuple(tolerance)}


def of_field_between(
    field: core.HeightField, tolerance: Sequence[float], start: ArrayLike, end: ArrayLike
) -> dict[str, Any]:
    """The line on the surface of a core.HeightField between two points, as ``of_field``."""
    return {**core.section_between(field, start, end), "tolerance": tuple(tolerance)}


def _cut(
    cut: Callable[[core.HeightField, Any, Any], dict[str, Any]],
    result: Ground,
    a: list[float],
    b: list[float],
) -> dict[str, Any]:
    return {**cut(result.field, a, b), "tolerance": tuple(result.job["inspection"]["tolerance_mm"])}


def _vector(values: ArrayLike | str, name: str) -> list[float]:
    """Three finite numbers, from numbers or from a text "x,y,z"."""
    parts = values.split(",") if isinstance(values, str) else values
    vector: list[float]
    try:
        vector = [float(value) for value in parts]  # type: ignore[union-attr, arg-type]
    except (TypeError, ValueError):
        vector = []
    if len(vector) != 3 or not all(math.isfinite(value) for value in vector):
        raise InputError(
            "inspection.section_vector",
            "section: {name} '{given}': write three numbers x,y,z",
            name=name,
            given=values,
        )
    return vector


def verdicts(section: Json, piece: Json) -> Array:
    """(n,) of "good", "above", "below" or "missed" (no stock was found there)."""
    lower, upper = section["tolerance"]
    height = piece["height"]
    found = np.where(height > upper, "above", np.where(height < lower, "below", "good"))
    return np.where(np.isnan(height), "missed", found)


def summary(section: Json) -> dict[str, Any]:
    """Figures of a section, weighted by length: mm, shares in [0, 1]; ``edges`` as ``edge_profile.edges``, if any."""
    heights, stocks, lengths = [], [], []
    for piece in section["pieces"]:
        step = np.diff(piece["s"])
        weight = 0.5 * (np.append(step, 0.0) + np.insert(step, 0, 0.0))
        known = ~np.isnan(piece["height"])
        heights.append(piece["height"][known])
        stocks.append(piece["stock_height"][known])
        lengths.append(weight[known])
    height, stock, length = (np.concatenate(all) for all in (heights, stocks, lengths))
    lower, upper = section["tolerance"]
    figures: dict[str, Any] = {
        "pieces": len(section["pieces"]),
        "points": sum(len(piece["s"]) for piece in section["pieces"]),
        "length_mm": float(sum(piece["s"][-1] - piece["s"][0] for piece in section["pieces"])),
    }
    total = length.sum()
    if total > 0:
        mean = float((length * height).sum() / total)
        figures["deviation_mm"] = {
            "min": float(height.min()),
            "max": float(height.max()),
            "mean": mean,
            "rms": math.sqrt(float((length * height**2).sum() / total)),
        }
        removed = np.maximum(stock - height, 0.0)
        figures["removed_mean_mm"] = float((length * removed).sum() / total)
        good = (height >= lower) & (height <= upper)
        figures["in_tolerance_share"] = float(length[good].sum() / total)
    edges = edge_profile.edges(section)
    if edges:
        figures["edges"] = edges
    return figures


def csv_text(section: Json) -> str:
    """One row a point, mm; ``piece`` and ``face`` count from 1; empty where it is not known."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    for number, piece in enumerate(section["pieces"], 1):
        height, stock = piece["height"], piece["stock_height"]
        sd = piece.get("height_sd", np.full(len(height), np.nan))
        columns = [piece["s"], *piece["point"].T, *piece["normal"].T]
        columns += [stock, height, np.maximum(stock - height, 0.0), sd]
        for values, verdict in zip(np.column_stack(columns), verdicts(section, piece)):
            told = ["" if math.isnan(value) else f"{value:.9g}" for value in values]
            rows.writerow([number, piece["face"] + 1, *told, verdict])
    return text.getvalue()


def write_csv(section: Json, path: Path | str) -> None:
    """Writes ``csv_text``, whole or not at all. Raises InputError."""
    _write(path, csv_text(section))


def write_svg(
    section: Json, path: Path | str, mode: str = "unrolled", exaggeration: float | None = None
) -> None:
    """Writes the plot of ``section_plot.svg``, whole or not at all. Raises InputError."""
    _write(path, section_plot.svg(section, mode, exaggeration))


def _write(path: Path | str, text: str) -> None:
    try:
        write_whole(Path(path), text.encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None
