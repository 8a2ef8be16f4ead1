"""Where the alignment of a scan starts, and in which words its freedoms are told."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from ..base.files import cannot_be_read
from ..base.kinds import Facts, Floats, Json
from ..base.regular_files import read_regular
from ..engine import InputError, core
from . import sizes as scan_sizes

MOST_BYTES = 100_000_000  # of a matrix or of pairs

AXES = ("x", "y", "z")
TRY_POINTS = 3_000  # of the scan, for one of the directions of its principal axes
TRY_ROUNDS = 25
AMBIGUOUS = 1.3  # times the best residual: another direction that fits nearly as well
OTHER_WAY = math.radians(10.0)  # between two directions that are not the same


def rigid(matrix: ArrayLike, name: str) -> Floats:
    """A 4 x 4 (or 3 x 4) rigid transform as an array, its rotation made exactly orthonormal. Raises
    InputError for one that is none by more than rounding.
    """
    try:
        given = np.asarray(matrix, dtype=float)
    except (TypeError, ValueError):
        raise InputError("scan.no_matrix", "{name}: not a matrix of numbers", name=name) from None
    if given.shape == (3, 4):
        given = np.vstack([given, [0, 0, 0, 1]])
    if given.shape != (4, 4) or not np.isfinite(given).all():
        raise InputError(
            "scan.matrix_rows", "{name}: write 4 rows (or 3) of 4 finite numbers", name=name
        )
    u, sizes, v = np.linalg.svd(given[:3, :3])
    if np.abs(sizes - 1).max() > 1e-3 or np.linalg.det(given[:3, :3]) < 0 or any(given[3, :3]):
        raise InputError(
            "scan.matrix_rotation", "{name}: its left part is no rotation (to 0.001)", name=name
        )
    result = np.eye(4)
    result[:3, :3] = u @ v
    result[:3, 3] = given[:3, 3]
    return result


def moved(points: Floats, matrix: Floats) -> Floats:
    """(n, 3) points by a 4 x 4 transform."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def by_pairs(pairs: ArrayLike, unit_mm: float = 1.0) -> tuple[Floats, float]:
    """(work_from_scan, rms in mm) from three or more pairs of places, (k, 2, 3): on the scan, in its
    unit, and on the design, mm. Least squares by singular values (Umeyama, IEEE Trans. PAMI 13,
    1991). Raises InputError for fewer, or for places on one line.
    """
    try:
        given = np.asarray(pairs, dtype=float)
    except (TypeError, ValueError):
        raise InputError("scan.pairs_no_numbers", "scan: the pairs are no numbers") from None
    if given.ndim != 3 or given.shape[1:] != (2, 3) or len(given) < 3:
        raise InputError(
            "scan.pairs_too_few", "scan: three pairs of points at least; six numbers each"
        )
    if not np.isfinite(given).all():
        raise InputError("scan.pairs_not_finite", "scan: the pairs are not finite")
    scan, work = given[:, 0] * unit_mm, given[:, 1]
    scan_sizes.by_pairs(scan, work, unit_mm)
    centres = scan.mean(axis=0), work.mean(axis=0)
    u, sizes, v = np.linalg.svd((work - centres[1]).T @ (scan - centres[0]))
    if sizes[1] < 1e-9 * max(sizes[0], 1e-300):
        raise InputError(
            "scan.pairs_on_a_line", "scan: the pairs lie on one line; a turn about it stays open"
        )
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ v))])
    matrix = np.eye(4)
    matrix[:3, :3] = u @ sign @ v
    matrix[:3, 3] = centres[1] - matrix[:3, :3] @ centres[0]
    off = moved(scan, matrix) - work
    return matrix, math.sqrt(float((off**2).sum(axis=1).mean()))


def principal_axes(points: Floats) -> tuple[Floats, Floats]:
    """(centre, axes as columns of a rotation) by falling spread."""
    centre = points.mean(axis=0)
    _, vectors = np.linalg.eigh(np.cov((points - centre).T))
    axes = vectors[:, ::-1]
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    return centre, axes


def by_principal_axes(
    points: Floats, datum: Json, register: Callable[..., Json], size: float, warnings: Facts
) -> Floats:
    """work_from_scan for the best of the 24 ways in which the principal axes can lie on each other,
    each aligned coarsely; a warning where another fits nearly as well.
    """
    here, axes = principal_axes(datum["points"])
    there, others = principal_axes(points)
    tried = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            turn = np.zeros((3, 3))
            turn[order, range(3)] = signs
            if np.linalg.det(turn) < 0:
                continue
            matrix = np.eye(4)
            matrix[:3, :3] = axes @ turn @ others.T
            matrix[:3, 3] = here - matrix[:3, :3] @ there
            try:
                found = register(matrix, size / 10, TRY_POINTS, TRY_ROUNDS)
            except InputError:
                continue
            # The distance shrinks with the residual: few points that fit well are no fit.
            tried.append((found["rms"] / max(found["used_share"], 1e-9), found))
    if not tried:
        raise InputError(
            "scan.principal_axes",
            "scan: by its principal axes the scan lies nowhere on the datum; it may hold "
            "much that is not the part. Start from pairs of points or a matrix",
        )
    tried.sort(key=lambda one: one[0])
    best = tried[0][1]
    for score, found in tried[1:]:
        if score > AMBIGUOUS * tried[0][0]:
            break
        turn = found["work_from_scan"][:3, :3] @ best["work_from_scan"][:3, :3].T
        if math.acos(np.clip((np.trace(turn) - 1) / 2, -1, 1)) > OTHER_WAY:
            warnings.append(
                core.Fact(
                    "scan.symmetric",
                    "the scan fits nearly as well turned another way: the part looks symmetric; "
                    "check the side, or start from pairs of points",
                )
            )
            break
    return np.asarray(best["work_from_scan"])


def motion_words(motion: Floats) -> core.Fact | str:
    """A unit motion (6,) in words, as a fact: "shift along (1.00, 0.00, 0.00)"."""
    shift, turn = np.asarray(motion[:3]), np.asarray(motion[3:])
    told = []
    for vector, code, text in (
        (shift, "scan.shift", "shift along {direction}"),
        (turn, "scan.turn", "turn about {direction}"),
    ):
        if np.linalg.norm(vector) > 0.3:
            unit = vector / np.linalg.norm(vector)
            unit = unit * (1 if unit[np.argmax(np.abs(unit))] > 0 else -1)
            direction = f"({', '.join(f'{value + 0:.2f}' for value in unit)})"
            told.append(core.Fact(code, text, direction=direction))
    if len(told) < 2:
        return told[0] if told else ""
    return core.Fact("scan.shift_and_turn", "{shift} with {turn}", shift=told[0], turn=told[1])


def face_numbers(text: str) -> list[int]:
    """[1, 2] of "1,2". Raises InputError."""
    try:
        return [int(word) for word in text.split(",") if word.strip()]
    except ValueError:
        raise InputError(
            "scan.face_numbers", "scan: datum faces '{text}': write numbers, as 1,2,5", text=text
        ) from None


def read_matrix(path: Path | str | None) -> Floats | None:
    """A rigid transform from a text of 3 or 4 rows of 4 numbers; # begins a comment. None for None."""
    return None if path is None else rigid(_numbers(path, 4), f"{path}")


def read_pairs(path: Path | str | None) -> Floats | None:
    """(k, 2, 3) from a text of rows x, y, z (scan), x, y, z (design). None for None."""
    return None if path is None else np.reshape(_numbers(path, 6), (-1, 2, 3))


def _numbers(path: Path | str, columns: int) -> list[list[float]]:
    """Rows of numbers with commas, semicolons or blanks between them. Raises InputError."""
    try:
        lines = read_regular(path, MOST_BYTES).decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise cannot_be_read(path, error) from None
    rows = []
    for number, line in enumerate(lines, 1):
        words = line.split("#")[0].replace(",", " ").replace(";", " ").split()
        if not words:
            continue
        try:
            row = [float(word) for word in words]
        except ValueError:
            row = []
        if len(row) != columns or not all(math.isfinite(value) for value in row):
            raise InputError(
                "scan.row",
                "{file}: line {line}: write {columns} numbers",
                file=path,
                line=number,
                columns=columns,
            )
        rows.append(row)
    if not rows:
        raise InputError("scan.no_numbers", "{file}: there are no numbers", file=path)
    return rows
