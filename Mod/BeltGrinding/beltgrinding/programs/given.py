"""What a person says of a program that only its controller knows: the file NAME.values.json beside it."""

from __future__ import annotations

import contextlib
import copy
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base import schemas
from ..base.files import in_file, write_whole
from ..base.frames import from_abc
from ..base.kinds import Json
from ..base.regular_files import shown
from ..engine import InputError
from .program import Fact, ProgramError

if TYPE_CHECKING:
    from .program import Program

SUFFIX = ".values.json"
KINDS = ("bases", "tools", "variables")
UNIT = "units"  # key of the unit of length
UNITS = ("mm", "inch")
FRAME = ("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg")
SHAPES = {
    "frame": Fact("programs.values.frame", "a frame of six numbers"),
    "number": Fact("programs.values.number", "a number"),
    "truth": Fact("programs.values.truth", "true or false"),
}
LARGEST = 1e12  # of a number
ROUNDS = 8  # of values that show up only when others are known
# What is taken in turn for values that are not known, to see what else is asked for: (number, truth value, whether
# a value of which the program does not tell what it is is a frame)
GUESSES = ((1.0, True, False), (0.0, False, False), (1.0, True, True))


def beside(path: Path | str) -> Path:
    """The side file of a program's file, whether it is there or not."""
    path = Path(path)
    return path.with_name(path.stem + SUFFIX)


def load(file: Path | str) -> dict[str, Any]:
    """What a values file holds, as ``parsed`` gives it. Raises ProgramError naming the file and the key."""
    file = Path(file)
    try:
        data = schemas.read_json(file)
    except InputError as error:
        raise ProgramError.of(in_file(error, file)) from None
    return parsed(data, file)


def parsed(data: Json, source: Path | str) -> dict[str, Any]:
    """dict of units ("mm", "inch" or None), bases, tools: {words: 4 x 4 in mm}, and variables: {NAME: number, truth value or six of a
    frame}, names in upper case without blanks; what is null is not given. ``data``: as in a values file;
    ``source``: the file, or the key of a job, that holds it. Raises ProgramError naming it and the key.
    """
    try:
        data = schemas.checked(data, schemas.schema("values"), "values")
    except InputError as error:
        raise ProgramError.of(in_file(error, source)) from None
    found: dict[str, Any] = {UNIT: data.get(UNIT), "bases": {}, "tools": {}, "variables": {}}
    for kind in ("bases", "tools"):
        for words, frame in data.get(kind, {}).items():
            six = [frame[key] for key in FRAME]
            if None not in six:
                found[kind][words] = from_abc(six[:3], six[3:])
    for name, value in data.get("variables", {}).items():
        if isinstance(value, dict):
            value = tuple(None if value[key] is None else float(value[key]) for key in FRAME)
            value = None if None in value else value
        elif value is not None and not isinstance(value, bool):
            value = float(value)
            if abs(value) > LARGEST:
                raise ProgramError(
                    "programs.values.too_large",
                    "{file}: variables: {name} is too large a number",
                    file=shown(source),
                    name=name[:60],
                )
        key = "".join(name.upper().split())
        if key in found["variables"]:
            raise ProgramError(
                "programs.values.twice",
                "{file}: variables: {name} is there twice",
                file=shown(source),
                name=name[:60],
            )
        if value is not None:
            found["variables"][key] = value
    return found


def apply(program: Program, given: Json, file: str) -> None:
    """Puts the frames that are given where the program tells none; what the program does not use is a
    problem, since it may be misspelt. ``file``: how the values' file is named. Raises ProgramError where a
    value is not of the kind that the program takes."""
    used = {
        "bases": {m.base for m in program.motions},
        "tools": {m.tool for m in program.motions},
    }
    program.given = {*given["variables"], *([UNIT] if given[UNIT] else [])}
    unused = []
    for kind, kept in (("bases", program.base_frames), ("tools", program.tool_frames)):
        for words, frame in given[kind].items():
            if words in used[kind] and words not in kept:
                kept[words] = frame
            else:
                unused.append(words)
    for name, value in given["variables"].items():
        shape = program.asked.get(name)
        told = "frame" if isinstance(value, tuple) else "truth"
        if told == "truth" and not isinstance(value, bool):
            told = "number"
        if shape and shape != told:
            raise ProgramError(
                "programs.values.shape",
                "{file}: variables: {name}: the program takes {shape} there",
                file=file,
                name=name[:60],
                shape=SHAPES[shape],
            )
    unused += [name for name in given["variables"] if name not in program.asked]
    if given[UNIT] and not program.asks_units:
        unused.append(UNIT)
    if unused:
        program.problem(
            file,
            1,
            "programs.values.unused",
            "the program does not ask for {names}: it tells them itself, or has no such name",
            names=", ".join(unused[:8]) + (", ..." if len(unused) > 8 else ""),
        )


def template(program: Program, given: Json | None = None) -> dict[str, Any]:
    """The content of a values file as a dict: what is given, and null for what the program asks for."""
    empty = dict.fromkeys(FRAME)
    data: dict[str, Any] = {UNIT: None} if program.asks_units else {}
    data.update(bases={}, tools={}, variables={})
    motions = [m for m in program.motions if m.pose is not None]
    for kind, key, kept in (
        ("bases", "base", program.base_frames),
        ("tools", "tool", program.tool_frames),
    ):
        words = dict.fromkeys(getattr(m, key) for m in motions)
        if len(words) > 1:  # one frame need not be known
            data[kind].update({one: dict(empty) for one in words if one not in kept})
    for name, kind in program.asked.items():
        data["variables"][name] = dict(empty) if kind == "frame" else None
    given = given or {}
    for kind in KINDS:
        data[kind].update(given.get(kind, {}))
    if given.get(UNIT):
        data[UNIT] = given[UNIT]
    return data


def explored(
    program: Program, path: Path | str, read: Callable[[dict[str, Any]], Program]
) -> tuple[dict[str, Any], bool]:
    """(template of all that the program in ``path`` asks for, also behind values that are not known yet, with what
    its side file holds; whether that depends on what they are). ``read(values)``: the Program with the content of a
    values file. Raises InputError of the side file."""
    held = _held(path)
    asked, varies = dict(program.asked), False
    data = _completed(program, held)
    for _ in range(ROUNDS):
        before, found = copy.deepcopy(data), []
        for guess in GUESSES:
            with contextlib.suppress(InputError):
                other = read(_guessed(before, asked, *guess))
                found.append(set(other.asked))
                asked.update({n: k for n, k in other.asked.items() if not asked.get(n)})
                more = _completed(other, held)
                for kind in KINDS:
                    data[kind] = {**more[kind], **data[kind]}
        varies = varies or any(one != found[0] for one in found)
        if data == before:
            break
    return data, varies


def _guessed(
    data: Json, asked: Mapping[str, str], number: float, truth: bool, frames: bool
) -> dict[str, Any]:
    """The content of a values file with a guess in place of each null."""
    zero = dict.fromkeys(FRAME, 0.0)
    guess: dict[str, Any] = copy.deepcopy(dict(data))
    if UNIT in guess:
        guess[UNIT] = guess[UNIT] or UNITS[0]
    for kind in KINDS:
        for name, value in guess[kind].items():
            told = asked.get(name, "number")
            if (
                isinstance(value, dict)
                and None in value.values()
                or value is None
                and frames
                and not told
            ):
                guess[kind][name] = zero
            elif value is None:
                guess[kind][name] = truth if told == "truth" else number
    return guess


def _held(path: Path | str) -> dict[str, Any] | None:
    """The content of the side file of the program's file ``path``; None without one. Raises InputError."""
    file = beside(path)
    if not file.exists():
        return None
    load(file)
    held: dict[str, Any] = schemas.read_json(file)
    return held


def _completed(program: Program, held: Json | None) -> dict[str, Any]:
    """The template with what ``held`` has, whose names may be written otherwise."""
    names = {"".join(n.upper().split()) for n in (held or {}).get("variables", {})}
    asked, program.asked = program.asked, {n: k for n, k in program.asked.items() if n not in names}
    data = template(program, held)
    program.asked = asked
    return data


def missing(program: Program) -> list[str]:
    """Words and names of what a Program asks for and nobody gave."""
    data = template(program)
    names = [UNIT] if UNIT in data else []
    for kind in KINDS:
        names += data[kind]
    return [name for name in names if name not in program.given]


def write_template(
    program: Program, path: Path | str, data: Json | None = None
) -> tuple[Path, int]:
    """Writes, or completes, the side file of the program's file ``path``; returns (the file, how many it
    asks for). What it holds stays. ``data``: as ``explored`` gives it. Raises InputError; the file is unchanged
    then."""
    file = beside(path)
    data = data or _completed(program, _held(path))
    write_whole(
        file, (json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()
    )
    empty = (None, dict.fromkeys(FRAME))
    count = sum(value in empty for kind in KINDS for value in data[kind].values())
    return file, count + (UNIT in data and data[UNIT] is None)
