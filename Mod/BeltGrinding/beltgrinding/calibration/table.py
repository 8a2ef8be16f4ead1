"""The table of measured grinds that a calibration reads: columns by name, units in the names."""

from __future__ import annotations

import csv
import difflib
import math
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..base.kinds import Array, Floats, Json
from ..base.regular_files import read_regular
from ..engine import InputError, core
from . import contacts

NOMINAL_DIAMETER = 200.0  # mm, of a drive wheel whose diameter is not known
NOMINAL_PRESSURE = 0.1  # MPa, mean of the grinds whose contact area nobody knows
MOST_BYTES = 50_000_000
UNKNOWN = ("", "nan", "na", "n/a", "none", "null", "-", "?")
# Canonical column: other names that it goes by, in small letters.
COLUMNS = {
    "force_N": ("avg_force_n", "mean_force_n", "normal_force_n", "force"),
    "belt_speed_m_s": ("avg_belt_speed_m_s", "speed_m_s", "belt_speed", "vb_m_s"),
    "rpm": ("avg_rpm", "wheel_rpm", "drive_rpm", "speed_rpm"),
    "time_s": ("grind_time_s", "duration_s", "contact_time_s"),
    "feed_mm_s": ("feed_rate_mm_s", "feed_speed_mm_s", "feed"),
    "length_mm": ("pass_length_mm", "ground_length_mm"),
    "passes": ("number_of_passes", "n_passes"),
    "contact_width_mm": ("pass_width_mm", "width_mm"),
    "area_mm2": ("grind_area_mm2", "contact_area_mm2", "area"),
    "work_J": ("belt_work_j", "initial_work_j"),
    "removed_so_far_mm3": ("belt_removed_mm3", "initial_removed_mm3"),
    "wear": ("initial_wear", "wear_number", "belt_wear"),
    "free_s": ("belt_free_s", "pause_s", "idle_s"),
    "removed_volume_mm3": ("removed_mm3", "volume_mm3", "removed_volume"),
    "depth_mm": ("removed_depth_mm", "depth"),
    "wheel_radius_mm": (),
    "wheel_width_mm": (),
    "rim_thickness_mm": (),
    "youngs_modulus_MPa": ("modulus_mpa",),
    "part_radius_mm": ("workpiece_radius_mm",),
}
CONVERTED = {  # other units: canonical column, factor
    "depth_um": ("depth_mm", 1e-3),
    "removed_depth_um": ("depth_mm", 1e-3),
    "feed_mm_min": ("feed_mm_s", 1 / 60),
    "feed_m_min": ("feed_mm_s", 1000 / 60),
    "feed_m_s": ("feed_mm_s", 1000.0),
    "belt_speed_m_min": ("belt_speed_m_s", 1 / 60),
    "belt_speed_mm_s": ("belt_speed_m_s", 1e-3),
    "time_min": ("time_s", 60.0),
    "area_cm2": ("area_mm2", 100.0),
    "removed_volume_cm3": ("removed_volume_mm3", 1000.0),
    "work_kj": ("work_J", 1000.0),
    "free_min": ("free_s", 60.0),
    "pause_min": ("free_s", 60.0),
}
MAY_BE_ZERO = ("work_J", "removed_so_far_mm3", "wear", "feed_mm_s", "free_s")
MAY_BE_UNKNOWN = (
    "area_mm2",
    "time_s",
    "feed_mm_s",
    "length_mm",
    "contact_width_mm",
    "wheel_radius_mm",
    "wheel_width_mm",
    "rim_thickness_mm",
    "youngs_modulus_MPa",
    "part_radius_mm",
)
WEAR = {"work_J": "work", "removed_so_far_mm3": "volume", "wear": "number"}


class Table(NamedTuple):
    """Measured grinds, (n,) float unless said. Unknown areas are nan; what is not in the file is None."""

    path: str
    lines: Array  # of the file, from 1
    force: Floats  # N
    speed: Floats  # m/s
    time: Floats  # s of contact: of the grind, or ground length over feed
    feed: Floats  # mm/s, 0 where the grind is stationary
    area: Floats  # mm2
    relative: Floats  # (n, m) pressure over F/A on equal shares of the contact; nan: not known
    wear: Floats  # zeros if not in the file
    wear_kind: str  # "", "work", "volume" or "number"
    spread: Floats  # mm2: 1 for volumes, nan for depths over the contact area
    measured: Floats  # mm3 or mm; nan where only a prediction is asked for
    notes: list[Any]  # texts for the user
    nominal_area: bool = False  # whether `area` stands for areas that nobody knows
    free: Floats = np.zeros(0)  # s that the belt ran free before each grind; (0,): not known

    def take(self, index: Array) -> Table:
        """The rows of ``index``, a mask or an array of places."""
        arrays = {
            key: value[index]
            for key, value in self._asdict().items()
            if hasattr(value, "dtype") and len(value) == len(self.force)
        }
        return self._replace(**arrays)


def read(
    path: Path | str,
    wheel_diameter_mm: float | None = None,
    measured: bool = True,
    contact: Json | None = None,
) -> Table:
    """Table of a CSV file. ``measured``: whether the measured removal must be there;
    ``contact``: what the table does not say of it (contacts.of_machine). Raises InputError with file, line, column and what to do.
    """
    header, rows, lines = split(Path(path), _canonical)
    return from_columns(
        {name: [row[i] for row in rows] for i, name in enumerate(header)},
        wheel_diameter_mm,
        measured,
        str(path),
        lines,
        contact,
    )


def split(
    path: Path | str, canonical: Callable[[str], str | None]
) -> tuple[list[str | None], list[list[str]], list[int]]:
    """(names, rows of texts, their line numbers) of a CSV; ``canonical(name)``: None for no column of the table.
    Raises InputError.
    """
    content = read_regular(path, MOST_BYTES)
    encoding = "utf-16" if content[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    text = content.decode(encoding, errors="replace").replace("\0", "\ufffd")
    numbered = [
        (i, line.strip()) for i, line in enumerate(re.split("\r\n|\r|\n", text), 1) if line.strip()
    ]
    header = None
    rows, lines = [], []
    for number, line in numbered:
        if header is None:
            candidate = line.lstrip("#").strip()
            separator = max(";\t,", key=candidate.count)
            names = [name.strip().strip('"') for name in candidate.split(separator)]
            if sum(canonical(name) is not None for name in names) >= 2:
                header = names
            elif not line.startswith("#"):
                raise InputError(
                    "calibration.no_header",
                    "{file}: line {line}: this is no header; name the columns in the first line, "
                    "such as force_N, belt_speed_m_s, time_s, area_mm2, removed_volume_mm3",
                    file=path,
                    line=number,
                )
            continue
        if line.startswith("#"):
            continue
        try:
            cells = [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
        except (csv.Error, StopIteration) as error:
            raise InputError(
                "calibration.no_row",
                "{file}: line {line}: {reason}",
                file=path,
                line=number,
                reason=error,
            ) from None
        while len(cells) > len(header) and not cells[-1]:
            cells.pop()
        if len(cells) != len(header):
            hint = ""
            if separator == "," and len(cells) > len(header):
                hint = core.Fact(
                    "calibration.decimal_comma",
                    "; with a decimal comma, separate the columns by ';'",
                )
            raise InputError(
                "calibration.columns",
                "{file}: line {line}: {count} columns where the header has {expected}{hint}",
                file=path,
                line=number,
                count=len(cells),
                expected=len(header),
                hint=hint,
            )
        rows.append(cells)
        lines.append(number)
    if header is None or not rows:
        what = core.Fact("calibration.a_header", "a header")
        if header is not None:
            what = core.Fact("calibration.a_row", "a row of measured grinds")
        raise InputError(
            "calibration.empty",
            "{file}: there is not even {what} in it",
            file=path,
            what=what,
        )
    return header, rows, lines


def small_name(name: str) -> str:
    """A column's name in small letters, without what divides its words but '_'."""
    return re.sub(r"[\s\[\]()/.]+", "_", name.strip().lower().replace("\u00b5", "u")).strip("_")


def _canonical(name: str) -> tuple[str, float] | None:
    """(canonical name of a column, factor to its unit), or None."""
    small = small_name(name)
    for canonical, aliases in COLUMNS.items():
        if small == canonical.lower() or small in aliases:
            return canonical, 1.0
    return CONVERTED.get(small)


def from_columns(
    columns: Mapping[str, Sequence[Any]],
    wheel_diameter_mm: float | None = None,
    measured: bool = True,
    path: str = "grinds",
    lines: Sequence[int] | None = None,
    contact: Json | None = None,
) -> Table:
    """Table of columns by name (lists of numbers or texts). Raises InputError."""
    notes, raw, given, factor = [], {}, {}, {}
    for name, values in columns.items():
        known = _canonical(name)
        canonical = known[0] if known else None
        if canonical is None:
            near = difflib.get_close_matches(name.lower(), [c.lower() for c in COLUMNS], 1)
            hint = ""
            if near:
                hint = core.Fact("calibration.near", " (did you mean '{name}'?)", name=near[0])
            notes.append(
                core.Fact(
                    "calibration.unknown_column",
                    "the column '{column}' is not known and left out{hint}",
                    column=name[:40],
                    hint=hint,
                )
            )
        elif canonical in raw:
            raise InputError(
                "calibration.same_column",
                "{file}: '{first}' and '{second}' are the same column",
                file=path,
                first=given[canonical],
                second=name,
            )
        else:
            raw[canonical], given[canonical], factor[canonical] = (
                list(values),
                name,
                known[1],
            )
    count = len(next(iter(raw.values()), ()))
    if count == 0:
        raise InputError("calibration.no_grind", "{file}: there is no grind in it", file=path)
    for name, values in raw.items():
        if len(values) != count:
            raise InputError(
                "calibration.column_length",
                "{file}: '{column}' has {count} values, others {expected}",
                file=path,
                column=given[name],
                count=len(values),
                expected=count,
            )
    lines = np.arange(1, count + 1) if lines is None else np.asarray(lines)
    places = [{"file": path, "line": line} for line in lines]
    if not measured:
        for name in ("removed_volume_mm3", "depth_mm"):
            raw[name] = [1.0 if _unknown(cell) else cell for cell in raw.get(name, [])] or None
        raw = {name: cells for name, cells in raw.items() if cells is not None}
    c = {
        name: np.array([number(cell, at, given[name], name) for cell, at in zip(cells, places)])
        * factor[name]
        for name, cells in raw.items()
    }
    _require(c, path, ("force_N",), core.Fact("calibration.the_force", "the normal force"))
    speed = _speed(c, path, wheel_diameter_mm, notes)
    time, feed, spread, figure = _exposure(c, path, lines, measured)
    area, relative = _area(c, contact, notes)
    kinds = [name for name in WEAR if name in c]
    if len(kinds) > 1:
        notes.append(
            core.Fact(
                "calibration.wear_column",
                "the belt's wear is taken from '{column}', not from {others}",
                column=kinds[0],
                others=", ".join(kinds[1:]),
            )
        )
    if measured and "removed_volume_mm3" in c and "depth_mm" in c:
        notes.append(
            core.Fact(
                "calibration.removal_column",
                "the removal is taken from 'removed_volume_mm3', not from 'depth_mm'",
            )
        )
    table = Table(
        path=path,
        lines=lines,
        force=c["force_N"],
        speed=speed,
        time=time,
        feed=feed,
        area=area,
        relative=relative,
        wear=c[kinds[0]] if kinds else np.zeros(count),
        wear_kind=WEAR[kinds[0]] if kinds else "",
        spread=spread,
        measured=figure,
        notes=notes,
        free=c.get("free_s", np.zeros(0)),
    )
    return with_areas(table) if measured else table


def _unknown(cell: object) -> bool:
    return str(cell).strip().lower() in UNKNOWN


def number(
    cell: object,
    place: Json,
    shown: str,
    name: str,
    may_be_unknown: Collection[str] = MAY_BE_UNKNOWN,
) -> float:
    """A cell as a number; nan where it may be unknown. Raises InputError."""
    if _unknown(cell):
        if name in may_be_unknown:
            return math.nan
        raise InputError(
            "calibration.empty_cell",
            "{file}: line {line}: column '{column}' is empty; fill it in, or take the line out",
            **place,
            column=shown,
        )
    text = str(cell).strip()
    if isinstance(cell, str) and "," in text:
        # A decimal comma; with points as well, the last of the two divides the decimals.
        swapped = text.rfind(",") > text.rfind(".")
        text = text.replace(".", "").replace(",", ".") if swapped else text.replace(",", "")
    try:
        value = float(text)
    except ValueError:
        raise InputError(
            "calibration.no_number",
            "{file}: line {line}: column '{column}': '{text}' is no number; write it without a unit",
            **place,
            column=shown,
            text=text[:40],
        ) from None
    if not math.isfinite(value) or value < 0 or (value == 0 and name not in MAY_BE_ZERO):
        given = {**place, "column": shown, "text": text[:40]}
        if name in MAY_BE_ZERO:
            raise InputError(
                "calibration.cell_negative",
                "{file}: line {line}: column '{column}' is {text}; it must be zero or positive",
                **given,
            )
        raise InputError(
            "calibration.cell_not_positive",
            "{file}: line {line}: column '{column}' is {text}; it must be positive",
            **given,
        )
    if not 1e-12 < max(value, 1e-11) < 1e15:
        raise InputError(
            "calibration.improbable",
            "{file}: line {line}: column '{column}' is {text}; look at its unit",
            **place,
            column=shown,
            text=text[:40],
        )
    return value


def _require(c: Mapping[str, Any], path: Any, names: Sequence[str], what: str) -> None:
    if not any(name in c for name in names):
        raise InputError(
            "calibration.no_column",
            "{file}: {what} is missing; add a column {columns}",
            file=path,
            what=what,
            columns=" or ".join(names),
        )


def _speed(c: Mapping[str, Any], path: Any, diameter: float | None, notes: list[Any]) -> Floats:
    """Belt speed, m/s."""
    _require(
        c,
        path,
        ("belt_speed_m_s", "rpm"),
        core.Fact("calibration.the_speed", "the belt's speed"),
    )
    if "belt_speed_m_s" in c:
        return c["belt_speed_m_s"]
    if diameter is None:
        diameter = NOMINAL_DIAMETER
        notes.append(
            core.Fact(
                "calibration.nominal_wheel",
                "only the rotation speed is known: the coefficient and the reference speed refer "
                "to a nominal drive wheel of {diameter:g} mm diameter; give --wheel-diameter if "
                "you know it",
                diameter=diameter,
            )
        )
    elif not (math.isfinite(diameter) and diameter > 0):
        raise InputError("calibration.drive_wheel", "the drive wheel's diameter must be positive")
    return math.pi * diameter / 1000.0 * c["rpm"] / 60.0


def _exposure(
    c: Mapping[str, Any], path: Any, lines: Any, needed: Any
) -> tuple[Any, Any, Any, Any]:
    """(time s, feed mm/s or 0, spread mm2, measured figure)."""
    _require(
        c,
        path,
        ("time_s", "feed_mm_s"),
        core.Fact("calibration.the_time", "the time of grinding, or the feed of the pass,"),
    )
    if needed:
        _require(
            c,
            path,
            ("removed_volume_mm3", "depth_mm"),
            core.Fact("calibration.the_removal", "the measured removal"),
        )
    count = len(c["force_N"])
    unknown = np.full(count, math.nan)
    feed = np.nan_to_num(c.get("feed_mm_s", np.zeros(count)))
    moving = feed > 0
    length, width = c.get("length_mm", unknown), c.get("contact_width_mm", unknown)
    time = np.where(moving & ~np.isnan(length), length / np.maximum(feed, 1e-12), math.nan)
    time = np.where(np.isnan(time), c.get("time_s", unknown), time)
    # Without the removal, what is asked for is the volume, or where it has no sense the depth.
    volume = "removed_volume_mm3" in c or not ("depth_mm" in c or np.isnan(time).any())
    figure = c.get("removed_volume_mm3", c.get("depth_mm", np.ones(count)))
    spread = np.ones(count)
    if not volume:
        spread = np.where(moving, width, math.nan)
        time = np.where(moving, 1.0 / np.maximum(feed, 1e-12), time)  # per mm of the pass
        _complete(
            width,
            moving,
            path,
            lines,
            core.Fact(
                "calibration.the_width",
                "contact_width_mm, over which a pass removes it,",
            ),
        )
    _complete(
        time,
        ~moving,
        path,
        lines,
        core.Fact("calibration.time_without_feed", "time_s of a grind without feed"),
    )
    _complete(
        time,
        moving,
        path,
        lines,
        core.Fact(
            "calibration.the_length",
            "length_mm, on which the volume of a pass depends,",
        ),
    )
    return time * c.get("passes", np.ones(count)), feed, spread, figure


def _complete(values: Any, where: Any, path: Any, lines: Any, what: str) -> None:
    bad = np.flatnonzero(where & np.isnan(values))
    if len(bad):
        raise InputError(
            "calibration.cell_missing",
            "{file}: line {line}: {what} is missing; add it",
            file=path,
            line=lines[bad[0]],
            what=what,
        )


def _area(c: Mapping[str, Any], contact: Json | None, notes: list[Any]) -> tuple[Any, Any]:
    """(contact area in mm2, nan where it is not known; relative pressures, see contacts.of_table)."""
    area, relative = contacts.of_table(c, contact, notes)
    given = c.get("area_mm2", np.full(len(area), math.nan))
    both = np.isfinite(area) & np.isfinite(given)
    if both.any():
        notes.append(
            core.Fact(
                "calibration.areas_not_taken",
                "{count} contact areas are taken from wheel and part, not from the table, whose areas "
                "are {ratio:.2f} times as great on average",
                count=int(both.sum()),
                ratio=float(np.exp(np.log(given[both] / area[both]).mean())),
            )
        )
    return np.where(np.isnan(area), given, area), relative


def with_areas(table: Table) -> Table:
    """The table with a nominal contact area if none is known; a note says what becomes of areas."""
    unknown = np.isnan(table.area)
    if unknown.all():
        nominal = float(np.exp(np.log(table.force).mean())) / NOMINAL_PRESSURE
        table.notes.append(
            core.Fact(
                "calibration.nominal_area",
                "no contact area is known: {area:.3g} mm² is taken for all, so that the "
                "coefficient holds for that area only; add area_mm2, or the wheel's and part's "
                "geometry",
                area=nominal,
            )
        )
        return table._replace(area=np.full(len(unknown), nominal), nominal_area=True)
    if unknown.any():
        table.notes.append(
            core.Fact(
                "calibration.areas_unknown",
                "{unknown} of {count} contact areas are unknown; each is taken as one of the "
                "known ones, by its probability (expectation maximisation)",
                unknown=int(unknown.sum()),
                count=len(unknown),
            )
        )
    return table
