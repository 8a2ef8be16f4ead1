"""Poses from a CSV file: one row a pose, columns named in the first row (docs/programs.md)."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...base import frames
from ...base.regular_files import shown
from ...base.stopping import check
from ...engine import InputError
from ..program import MAX_COORDINATE, Fact, Motion, Program, ProgramError, bytes_of, name_of

POSITION = ("x_mm", "y_mm", "z_mm")
QUATERNION = ("qw", "qx", "qy", "qz")
ANGLES = ("a_deg", "b_deg", "c_deg")
OPTIONAL = ("feed_mm_s", "force_N", "zone_mm", "motion")
MOTIONS = ("LIN", "PTP")


def read(path: Path | str) -> Program:
    """The Program in a CSV file. Raises ProgramError naming file and line."""
    name = name_of(path)
    try:
        text = bytes_of(path, "CSV").decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        raise ProgramError(
            "programs.csv.not_utf8",
            "{file}: is not UTF-8 text; save the table as CSV, UTF-8",
            file=shown(path),
        ) from None
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise ProgramError(
            "programs.csv.empty",
            "{file}: the file is empty; it needs a row of column names and poses",
            file=name,
        )
    number, head = lines[0]
    delimiter = max(",;\t", key=head.count)
    columns = [column.strip() for column in head.split(delimiter)]
    _check(columns, name, number)
    program = Program("CSV", name)
    try:
        rows = list(csv.reader((line for _, line in lines[1:]), delimiter=delimiter, strict=True))
    except csv.Error as error:
        raise ProgramError(
            "programs.no_sound_csv",
            "{file}: is no sound CSV: {reason}",
            file=name,
            reason=str(error),
        ) from None
    if len(rows) != len(lines) - 1:
        raise ProgramError(
            "programs.csv.quoted", "{file}: a quoted field runs over several lines", file=name
        )
    for (number, _), row in zip(lines[1:], rows):
        if len(row) != len(columns):
            raise ProgramError.at(
                name,
                number,
                "programs.csv.values",
                "{count} values in {columns} columns; use a point as the decimal mark",
                count=len(row),
                columns=len(columns),
            )
        check()
        program.motions.append(_motion(dict(zip(columns, row)), name, number))
    if not text.endswith(("\n", "\r")):
        program.problem(
            name,
            lines[-1][0],
            "programs.csv.cut",
            "the last line has no end; a number in it may be cut off",
        )
    if "qw" in columns:
        _turn(program.motions)
    return program


def _turn(motions: Sequence[Motion]) -> None:
    """Poses of all motions at once: one by one they would take most of the time."""
    values = np.array([motion.pose for motion in motions], dtype=float).reshape(-1, 7)
    try:
        poses = frames.from_quaternions(values[:, :3], values[:, 3:])
    except InputError:
        for motion, row in zip(motions, values):  # which one it is
            try:
                frames.from_quaternion(row[:3], row[3:])
            except InputError as error:
                raise ProgramError.of(error).in_line(motion.file, motion.line) from None
        raise
    for motion, pose in zip(motions, poses):
        motion.pose = pose


def _check(columns: Sequence[str], name: str, number: int) -> None:
    for group in (POSITION, QUATERNION if "qw" in columns else ANGLES):
        for column in group:
            if column not in columns:
                raise ProgramError.at(
                    name,
                    number,
                    "programs.csv.missing_column",
                    "the column {column} is missing; a pose needs {position} and "
                    "{quaternion} or {angles}",
                    column=column,
                    position=", ".join(POSITION),
                    quaternion=", ".join(QUATERNION),
                    angles=", ".join(ANGLES),
                )
    known = {*POSITION, *QUATERNION, *ANGLES, *OPTIONAL}
    for column in columns:
        if column not in known:
            raise ProgramError.at(
                name,
                number,
                "programs.csv.unknown_column",
                "unknown column '{column}'; known are {names}",
                column=column,
                names=", ".join(sorted(known)),
            )
    if len(set(columns)) != len(columns):
        raise ProgramError.at(name, number, "programs.csv.column_twice", "a column occurs twice")


def _motion(row: dict[str, str], name: str, line: int) -> Motion:
    def number(column: str) -> float:
        try:
            value = float(row[column])
        except ValueError:
            raise ProgramError.at(
                name,
                line,
                "programs.csv.no_number",
                "{column} is '{text}', no number",
                column=column,
                text=row[column].strip()[:40],
            ) from None
        if not math.isfinite(value):
            raise ProgramError.at(
                name, line, "programs.csv.not_finite", "{column} is not finite", column=column
            )
        if abs(value) > MAX_COORDINATE:
            raise ProgramError.at(
                name,
                line,
                "programs.csv.out_of_bounds",
                "{column} is {value:g}, out of all bounds",
                column=column,
                value=value,
            )
        return value

    def optional(column: str, least: float) -> float | None:
        if not row.get(column, "").strip():
            return None
        value = number(column)
        if value < least or (column == "feed_mm_s" and value == 0.0):
            raise ProgramError.at(
                name,
                line,
                "programs.csv.not_positive",
                "{column} is {value:g}; it must be positive",
                column=column,
                value=value,
            )
        return value

    position = [number(column) for column in POSITION]
    if "qw" in row:
        pose: Any = [
            *position,
            *(number(column) for column in QUATERNION),
        ]  # _turn makes a pose of it
    else:
        pose = frames.from_abc(position, [number(column) for column in ANGLES])
    kind = row.get("motion", "").strip().upper() or "LIN"
    if kind not in MOTIONS:
        raise ProgramError.at(
            name,
            line,
            "programs.csv.motion",
            "motion is '{kind}'; use {names}",
            kind=kind,
            names=Fact("programs.or", "{one} or {other}", one=MOTIONS[0], other=MOTIONS[1]),
        )
    feed, force, zone = (optional(c, 0.0) for c in ("feed_mm_s", "force_N", "zone_mm"))
    return Motion(kind, pose, line, name, feed, force, zone_mm=zone)
