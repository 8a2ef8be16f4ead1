"""Writes changed speeds, forces and offsets back into a robot program: nothing else changes.

The original's bytes stay but for the edits. What is written has been read again before: exactly the
named motions differ, by what was asked, or nothing is written.
"""

from __future__ import annotations

import csv
import io
import math
import tempfile
from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeVar

import numpy as np

from ...base.kinds import Json
from ...base.regular_files import shown
from ..program import Fact, ProgramError, bytes_of, name_of
from ..registry import read_program
from . import forces, neighbours
from .text import SMALL, Overlap, Shift, Source, Work

if TYPE_CHECKING:
    from ..force_device import ForceDevice
    from ..program import Motion, Program

COLUMNS = ("speed_mm_s", "force_N", "dx_mm", "dy_mm", "dz_mm", "tool_dz_mm")
MAX_STEP = 1000.0  # mm; a larger offset is a mistake
MAX_SPEED = 10_000.0  # mm/s
MAX_FORCE = 10_000.0  # N
ROUNDING_N = 1e-6  # of a force that is written
UNCHANGED = 1e-9  # mm and of a rotation's matrix; numbers that were not edited read the same

Named: TypeAlias = "Mapping[int, Mapping[str, float]]"  # of motions, what is to be changed

# What of a motion a change must not alter.
ITS = {
    "kind": Fact("programs.patch.kind", "its kind"),
    "tool": Fact("programs.patch.tool", "its tool"),
    "base": Fact("programs.patch.base", "its base"),
    "aux": Fact("programs.patch.aux", "its aux"),
    "speed": Fact("programs.patch.speed", "its speed"),
    "force": Fact("programs.patch.force", "its force"),
    "pose": Fact("programs.patch.pose", "its pose"),
    "orientation": Fact("programs.patch.orientation", "its orientation"),
}


T = TypeVar("T")


class Language(Protocol):
    """The module that edits a language. Some have ``source(data)`` besides, and ``TURN_IS_FREE``."""

    @property
    def ROUNDING_MM(self) -> float:
        ...

    def derived(self, source: Source, line: int) -> bool:
        ...

    def rounding_mm_s(self, source: Source, line: int) -> float:
        ...

    def edit(self, source: Source, work: Work) -> None:
        ...


def _language(name: str, suffix: str) -> Language:
    """The module that edits a language: ``edit(source, work)``; ``suffix`` in lower case."""
    if name == "URScript" and suffix != ".script":  # script inside of a container
        name = f"{name} ({suffix})"
    if name == "KUKA KRL":
        from . import krl

        return krl
    if name == "ABB RAPID":
        from . import rapid

        return rapid
    if name == "URScript":
        from . import urscript

        return urscript
    if name in ("Fanuc TP", "Yaskawa INFORM"):
        from . import taught

        return taught
    if name in ("G-code", "APT"):
        from . import milling

        return milling
    if name == "CSV":
        from . import csv as table

        return table
    raise ProgramError(
        "programs.patch.language",
        "programs in {language} cannot be written back yet; change them by hand",
        language=name,
    )


def read_changes(path: Path | str) -> list[dict[str, Any]]:
    """List of changes, a dict each, from a CSV with the columns ``index`` or ``line``, and any of
    ``COLUMNS``; an empty field changes nothing. Raises ProgramError naming the line."""
    name = name_of(path)
    try:
        text = bytes_of(path, "CSV").decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        raise ProgramError(
            "programs.patch.not_utf8", "{file}: is not UTF-8 text", file=shown(path)
        ) from None
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise ProgramError(
            "programs.patch.empty",
            "{file}: the file is empty; it needs the columns index or line",
            file=name,
        )
    delimiter = max(",;\t", key=lines[0][1].count)
    try:
        rows = [next(csv.reader(io.StringIO(t), delimiter=delimiter)) for _, t in lines]
    except csv.Error as error:
        raise ProgramError(
            "programs.no_sound_csv",
            "{file}: is no sound CSV: {reason}",
            file=name,
            reason=str(error),
        ) from None
    columns = [column.strip() for column in rows[0]]
    known = ("index", "line", *COLUMNS)
    for column in columns:
        if column not in known:
            raise ProgramError(
                "programs.patch.unknown_column",
                "{file}: unknown column '{column}'; known are {names}",
                file=name,
                column=column,
                names=", ".join(known),
            )
    if ("index" in columns) == ("line" in columns) or len(set(columns)) != len(columns):
        raise ProgramError(
            "programs.patch.columns",
            "{file}: it needs each column once, and either index or line",
            file=name,
        )
    changes = []
    for (number, _), row in zip(lines[1:], rows[1:]):
        if len(row) != len(columns):
            raise ProgramError.at(
                name,
                number,
                "programs.patch.values",
                "{count} values in {columns} columns",
                count=len(row),
                columns=len(columns),
            )
        given = {key: value.strip() for key, value in zip(columns, row) if value.strip()}
        try:
            change: dict[str, Any] = {
                key: int(value) if key in ("index", "line") else float(value)
                for key, value in given.items()
            }
        except ValueError as error:
            raise ProgramError.at(
                name, number, "programs.patch.no_value", "{reason}", reason=str(error)
            ) from None
        if not {"index", "line"} & change.keys():
            raise ProgramError.at(
                name, number, "programs.patch.names_no_motion", "it names no motion"
            )
        changes.append({**change, "where": (name, number)})
    return changes


def patch(
    path: Path | str,
    changes: Path | str | Iterable[Json],
    output: Path | str,
    force_device: ForceDevice | None = None,
) -> list[dict[str, Any]]:
    """Writes the program in ``path`` to ``output`` with the changes, and nothing else changed.

    changes: a CSV file (``read_changes``) or a list of dicts with the same keys: ``index`` (as in
    the table of poses, from 0) or ``line`` (all motions of that line), ``speed_mm_s``, ``force_N``,
    ``dx_mm``, ``dy_mm``, ``dz_mm`` along the axes of the motion's base and ``tool_dz_mm`` along the
    tool's z. ``force_device``: by whose statements the program sets its forces.

    Returns a list of dicts, one for each changed motion: index, line, and speed_mm_s, force_N,
    offset_mm as read back from what was written. Raises ProgramError, and writes nothing, where a
    change is not possible without another one.
    """
    path, output = Path(path), Path(output)
    if isinstance(changes, (str, Path)):
        changes = read_changes(changes)
    program = read_program(path, force_device=force_device)
    module = _language(program.language, path.suffix.lower())
    data = path.read_bytes()
    source: Source = getattr(module, "source", Source)(data)
    work = _work(program, changes, source, module)
    forces.edit(source, work, force_device)
    module.edit(source, work)
    try:
        written = source.result()
    except Overlap:
        raise ProgramError(
            "programs.patch.one_by_one",
            "{file}: two changes of the same place; give the changes one by one",
            file=program.file,
        ) from None
    _check_suffix(path, output)
    return _put(
        path,
        written,
        output,
        force_device,
        lambda again: _verify(program, again, work, source, module),
    )


def copy(path: Path | str, output: Path | str, force_device: ForceDevice | None = None) -> None:
    """Writes the program in ``path`` to ``output`` as it is, with the files without which it would read otherwise. Raises
    ProgramError."""
    path, output = Path(path), Path(output)
    program = read_program(path, force_device=force_device)

    def same(again: Program) -> None:
        if _content(again) != _content(program):
            raise ProgramError(
                "programs.patch.reads_differently",
                "{file}: the changed program does not read like the original; it is not written",
                file=program.file,
            )

    _put(path, path.read_bytes(), output, force_device, same)


def _content(program: Program) -> list[object]:
    return [
        *sorted(problem.message for problem in program.problems),
        *(
            (m.kind, m.line, m.speed_mm_s, m.force_N, None if m.pose is None else m.pose.tolist())
            for m in program.motions
        ),
    ]


def _put(
    path: Path,
    written: bytes,
    output: Path,
    device: ForceDevice | None,
    check: Callable[[Program], T],
) -> T:
    """Writes a program as ``output``, once ``check`` has seen it read again: with the files that are its own, and if it needs
    them with others that lie beside ``path``. Returns what ``check`` does. Raises ProgramError."""
    alone, further = neighbours.own(path), neighbours.others(path)
    for files, last in ((alone, not further), ([*alone, *further], True)):
        with tempfile.TemporaryDirectory() as folder:
            for file in files:
                Path(folder, file.name).write_bytes(file.read_bytes())
            tried = Path(folder, path.name)
            tried.write_bytes(written)
            try:
                report = check(read_program(tried, force_device=device))
            except ProgramError:
                if last:
                    raise
                continue
        neighbours.put(files, path, output)
        neighbours.write(output, written)
        return report
    raise AssertionError("the last one is written, or raises")


def _check_suffix(path: Path, output: Path) -> None:
    if output.suffix.lower() != path.suffix.lower():
        raise ProgramError(
            "programs.patch.suffix",
            "{file}: the written program must end in {suffix}",
            file=shown(output),
            suffix=path.suffix,
        )


def _work(program: Program, changes: Iterable[Json], source: Source, module: Language) -> Work:
    """The changes sorted by statements. Raises ProgramError where they are not possible."""
    motions = program.motions
    lines: dict[int, list[int]] = {}
    before: list[int] = []
    ended = -1
    for i, motion in enumerate(motions):
        lines.setdefault(motion.line, []).append(i)
        before.append(ended)
        ended = ended if motion.aux else i
    named: dict[int, dict[str, float]] = {}
    for change in changes:
        _merge(named, change, program, lines)
    if not any(named.values()):
        raise ProgramError(
            "programs.patch.no_change", "{file}: no change is asked for", file=program.file
        )
    work = Work(program, steps=np.zeros((len(motions), 3)), lines=lines, before=before)
    for line in sorted({motions[i].line for i in named}):
        for key, found in (("speed_mm_s", work.speeds), ("force_N", work.forces)):
            value = _agreed(work, line, [i for i in lines[line] if not motions[i].aux], named, key)
            if value is not None and not _has(work, line, key, value):
                found[line] = value
        _shifts(work, line, named, source, module)
    return work


def _merge(
    named: dict[int, dict[str, float]],
    change: Json,
    program: Program,
    lines: Mapping[int, list[int]],
) -> None:
    def wrong(code: str, text: str, /, **arguments: object) -> Exception:
        if "where" in change:
            file, line = change["where"]
            return ProgramError.at(file, line, code, text, **arguments)
        return ProgramError(code, text, **arguments).within(
            "programs.in_file", "{file}: ", file=program.file
        )

    motions = program.motions
    values = {key: float(change[key]) for key in COLUMNS if change.get(key) is not None}
    for key, value in values.items():
        most = {"speed_mm_s": MAX_SPEED, "force_N": MAX_FORCE}.get(key, MAX_STEP)
        least = -MAX_STEP if key.startswith(("d", "t")) else 0.0
        if not least <= value <= most or (key == "speed_mm_s" and value == 0.0):
            raise wrong(
                "programs.patch.out_of_range",
                "{column} is {value:g}; it must be {least:g} to {most:g}",
                column=key,
                value=value,
                least=least,
                most=most,
            )
    if change.get("line") is not None:
        there = lines.get(change["line"], [])
        if not there:
            raise wrong(
                "programs.patch.no_motion_in_line",
                "no motion is in line {number} of {program}",
                number=change["line"],
                program=program.file,
            )
        # An arc's auxiliary point has a place of its own, and the speed of its end.
        members = [(i, values) for i in there]
    else:
        i = change.get("index")
        if i is None or not 0 <= i < len(motions):
            raise wrong(
                "programs.patch.no_motion",
                "there is no motion {motion}; {program} has 0 to {last}",
                motion=i,
                program=program.file,
                last=len(motions) - 1,
            )
        members = [(i, values)]
        if motions[i].aux:
            common = {k: v for k, v in values.items() if k in ("speed_mm_s", "force_N")}
            own = {k: v for k, v in values.items() if k not in common}
            members = [(i, own)]
            if common:
                end = next(
                    (k for k in range(i, len(motions)) if not motions[k].aux), len(motions) - 1
                )
                members.append((end, common))
    for i, given in members:
        for key, value in given.items():
            if motions[i].aux and key in ("speed_mm_s", "force_N"):
                continue
            if named.setdefault(i, {}).setdefault(key, value) != value:
                raise wrong(
                    "programs.patch.two_values",
                    "motion {motion} is given two values of {column}",
                    motion=i,
                    column=key,
                )


def _agreed(work: Work, line: int, members: Sequence[int], named: Named, key: str) -> float | None:
    """The value all motions of a statement are given; None: none of them any."""
    values = {named.get(i, {}).get(key) for i in members}
    if values == {None} or not members:
        return None
    if len(values) > 1:
        numbers = ", ".join(map(str, members[:10])) + (", ..." if len(members) > 10 else "")
        raise work.refuse(
            line,
            "programs.patch.several_rounds_value",
            "this line is run through several times (motions {numbers}); a change of "
            "{column} changes all of them: name all with the same value",
            numbers=numbers,
            column=key,
        )
    motion = work.program.motions[members[0]]
    if motion.pose is None:
        raise work.refuse(
            line,
            "programs.patch.unchanged_without_pose",
            "motion {motion} has no pose that is known; it is not changed",
            motion=members[0],
        )
    if key == "speed_mm_s" and motion.kind == "PTP" and motion.speed_mm_s is None:
        raise work.refuse(
            line,
            "programs.patch.no_path_speed",
            "motion {motion} is a {kind} without a path speed",
            motion=members[0],
            kind=motion.kind,
        )
    return values.pop()


def _has(work: Work, line: int, key: str, value: float) -> bool:
    """Whether all motions of a line have the value already: nothing is to be written then."""
    ends = [work.program.motions[i] for i in work.lines[line]]
    return all(getattr(m, key) == value for m in ends)


def _shifts(work: Work, line: int, named: Named, source: Source, module: Language) -> None:
    """The displacements of a statement's targets."""
    motions, keys = work.program.motions, COLUMNS[2:]
    targets: dict[int, list[int]] = {}
    for i in work.lines[line]:
        derived = module.derived(source, line)
        if not motions[i].aux or not derived:
            second = not derived and not motions[i].aux and i > 0 and motions[i - 1].aux
            targets.setdefault(int(second), []).append(i)
        elif set(keys) & named.get(i, {}).keys() and not set(keys) & named.get(i + 1, {}).keys():
            raise work.refuse(
                line,
                "programs.patch.taught_points",
                "motion {motion} follows from taught points; offset those",
                motion=i,
            )
    for target, members in targets.items():
        given = {tuple(named.get(i, {}).get(key, 0.0) for key in keys) for i in members}
        if given == {(0.0,) * 4}:
            continue
        if len(given) > 1:
            numbers = ", ".join(map(str, members[:10])) + (", ..." if len(members) > 10 else "")
            raise work.refuse(
                line,
                "programs.patch.several_rounds_offset",
                "this line is run through several times (motions {numbers}); an offset "
                "moves all of them: name all with the same offset",
                numbers=numbers,
            )
        *base, tool_z = given.pop()
        shift = Shift(np.array(base), tool_z, members)
        for i in members:
            pose = motions[i].pose
            if pose is None:
                raise work.refuse(
                    line,
                    "programs.patch.unmoved_without_pose",
                    "motion {motion} has no pose that is known; it is not moved",
                    motion=i,
                )
            work.steps[i] = shift.base + tool_z * pose[:3, 2]
        work.shifts.setdefault(line, {})[target] = shift


def _verify(
    program: Program, again: Program, work: Work, source: Source, module: Language
) -> list[dict[str, Any]]:
    """Compares what was written with what was asked for. Raises ProgramError."""
    old, new = program.motions, again.motions
    problems = Counter(problem.message for problem in again.problems)
    before = Counter(problem.message for problem in program.problems)
    # A speed that was not known may be now.
    edited = {bisect_right(source.starts, begin) for begin, _, _ in source.edits}
    solved = Counter(p.message for p in program.problems if p.line in edited)
    if len(old) != len(new) or problems - before or before - solved - problems:
        raise ProgramError(
            "programs.patch.reads_differently",
            "{file}: the changed program does not read like the original; it is not written",
            file=program.file,
        )
    free = getattr(module, "TURN_IS_FREE", False)
    report = []
    for i, (a, b) in enumerate(zip(old, new)):
        speed, force = work.speeds.get(a.line), work.forces.get(a.line)
        step = work.steps[i]
        _same_words(i, a, b)
        speed = a.speed_mm_s if speed is None else speed
        rounding = module.rounding_mm_s(source, a.line) if a.line in work.speeds else 0.0
        _close(i, a, "speed", speed, b.speed_mm_s, rounding, work)
        rounding = ROUNDING_N if a.line in work.forces else 0.0
        _close(i, a, "force", a.force_N if force is None else force, b.force_N, rounding, work)
        if (a.pose is None) != (b.pose is None):
            raise _other(i, a, ITS["pose"])
        shifted = bool(step.any())
        if (
            a.pose is not None
            and b.pose is not None
            and not (a.aux and module.derived(source, a.line))
        ):
            rounding = module.ROUNDING_MM if shifted else 0.0
            error = np.abs(b.pose[:3, 3] - a.pose[:3, 3] - step).max()
            if error > rounding + UNCHANGED * (1.0 + np.abs(a.pose[:3, 3]).max()):
                place = Fact(
                    "programs.patch.place",
                    "its place, by {error:.4g} mm more than asked",
                    error=float(error),
                )
                if not shifted:
                    place = Fact(
                        "programs.patch.place_relative",
                        "{place}; is it relative to one that is moved?",
                        place=place,
                    )
                raise _other(i, a, place)
            columns = slice(2, 3) if free else slice(0, 3)
            turn = np.abs(b.pose[:3, columns] - a.pose[:3, columns]).max()
            if turn > (1e-6 if shifted else UNCHANGED):
                raise _other(i, a, ITS["orientation"])
        if a.line in work.speeds or a.line in work.forces or shifted:
            moved = (
                None
                if b.pose is None or a.pose is None
                else (b.pose[:3, 3] - a.pose[:3, 3]).tolist()
            )
            row = {"index": i, "line": a.line, "speed_mm_s": b.speed_mm_s, "force_N": b.force_N}
            report.append({**row, "offset_mm": moved})
    return report


def _same_words(i: int, a: Motion, b: Motion) -> None:
    for key in ("kind", "tool", "base", "aux"):
        if getattr(a, key) != getattr(b, key):
            raise _other(i, a, ITS[key])


def _close(
    i: int,
    motion: Motion,
    what: str,
    asked: float | None,
    found: float | None,
    rounding: float,
    work: Work,
) -> None:
    if asked is None or found is None:
        if asked is not found:
            raise _other(i, motion, ITS[what])
    elif not math.isclose(asked, found, rel_tol=1e-7, abs_tol=rounding + SMALL):
        named = motion.line in (work.speeds if what == "speed" else work.forces)
        if not named:
            raise _other(i, motion, ITS[what])
        told = Fact(
            "programs.patch.in_place_of",
            "{what} ({found:.6g} in place of {asked:.6g})",
            what=ITS[what],
            found=float(found),
            asked=float(asked),
        )
        raise _other(i, motion, told)


def _other(i: int, motion: Motion, what: Fact) -> ProgramError:
    return ProgramError.at(
        motion.file,
        motion.line,
        "programs.patch.otherwise",
        "the change would alter motion {motion} otherwise than asked: {what}; "
        "nothing is written",
        motion=i,
        what=what,
    )
