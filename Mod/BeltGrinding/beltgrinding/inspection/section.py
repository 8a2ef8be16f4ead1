"""Cross-sections of a result: design, stock and ground profile where a plane cuts the surface.

A section is a dict: ``point`` and ``normal`` of its plane (mm, work frame), ``tolerance``
(lower, upper; mm) and ``pieces``, one for every uninterrupted line on one face, each a dict of
``face`` (from 0), ``closed`` and arrays of n values: ``s`` (arc length along the whole section, gaps
included), ``point`` (n, 3), ``normal`` (n, 3), ``stock_height`` before grinding, ``height`` (the
deviation) and, of a calibrated law, ``height_sd``; all mm. NaN where a sample missed the stock.
"""

import csv
import io
import math
from pathlib import Path

import numpy as np

from ..base.files import cannot_be_written, write_whole
from ..engine import InputError, core
from . import edge_profile, section_plot

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


def section(result, point, normal):
    """The section of a ``simulation.result.Result`` by a plane.

    ``point`` mm and ``normal`` (any length) in the work frame. Raises InputError when the plane
    misses the faces.
    """
    return _cut(core.section_by_plane, result, _vector(point, "point"), _vector(normal, "normal"))


def between(result, start, end):
    """The line on the surface between two points (mm), in the plane of both and the mean of their
    normals. Raises InputError when no such line exists.
    """
    return _cut(core.section_between, result, _vector(start, "from"), _vector(end, "to"))


def of_field(field, tolerance, point, normal):
    """The section of a core.HeightField by a plane; ``tolerance`` (lower, upper) in mm."""
    return {**core.section_by_plane(field, point, normal), "tolerance": tuple(tolerance)}


def of_field_between(field, tolerance, start, end):
    """The line on the surface of a core.HeightField between two points, as ``of_field``."""
    return {**core.section_between(field, start, end), "tolerance": tuple(tolerance)}


def _cut(cut, result, a, b):
    return {**cut(result.field, a, b), "tolerance": tuple(result.job["inspection"]["tolerance_mm"])}


def _vector(values, name):
    """Three finite numbers, from numbers or from a text "x,y,z"."""
    parts = values.split(",") if isinstance(values, str) else values
    try:
        vector = [float(value) for value in parts]
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


def verdicts(section, piece):
    """(n,) of "good", "above", "below" or "missed" (no stock was found there)."""
    lower, upper = section["tolerance"]
    height = piece["height"]
    found = np.where(height > upper, "above", np.where(height < lower, "below", "good"))
    return np.where(np.isnan(height), "missed", found)


def summary(section):
    """Figures of a section, weighted by length: mm, shares in [0, 1]; ``edges`` as ``edge_profile.edges``, if any."""
    height, stock, length = [], [], []
    for piece in section["pieces"]:
        step = np.diff(piece["s"])
        weight = 0.5 * (np.append(step, 0.0) + np.insert(step, 0, 0.0))
        known = ~np.isnan(piece["height"])
        height.append(piece["height"][known])
        stock.append(piece["stock_height"][known])
        length.append(weight[known])
    height, stock, length = (np.concatenate(all) for all in (height, stock, length))
    lower, upper = section["tolerance"]
    figures = {
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
        figures["removed_mean_mm"] = float((length * stock).sum() / total) - mean
        good = (height >= lower) & (height <= upper)
        figures["in_tolerance_share"] = float(length[good].sum() / total)
    edges = edge_profile.edges(section)
    if edges:
        figures["edges"] = edges
    return figures


def csv_text(section):
    """One row a point, mm; ``piece`` and ``face`` count from 1; empty where it is not known."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    for number, piece in enumerate(section["pieces"], 1):
        height, stock = piece["height"], piece["stock_height"]
        sd = piece.get("height_sd", np.full(len(height), np.nan))
        columns = [piece["s"], *piece["point"].T, *piece["normal"].T]
        columns += [stock, height, stock - height, sd]
        for values, verdict in zip(np.column_stack(columns), verdicts(section, piece)):
            told = ["" if math.isnan(value) else f"{value:.9g}" for value in values]
            rows.writerow([number, piece["face"] + 1, *told, verdict])
    return text.getvalue()


def write_csv(section, path):
    """Writes ``csv_text``, whole or not at all. Raises InputError."""
    _write(path, csv_text(section))


def write_svg(section, path, mode="unrolled", exaggeration=None):
    """Writes the plot of ``section_plot.svg``, whole or not at all. Raises InputError."""
    _write(path, section_plot.svg(section, mode, exaggeration))


def _write(path, text):
    try:
        write_whole(Path(path), text.encode())
    except OSError as error:
        raise cannot_be_written(path, error) from None
