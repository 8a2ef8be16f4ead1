"""What a person says of a program that only its controller knows: the file NAME.values.json beside it."""

import json
from pathlib import Path

from ..base import schemas
from ..base.files import in_file, write_whole
from ..base.frames import from_abc
from ..base.regular_files import shown
from ..engine import InputError
from .program import Fact, ProgramError

SUFFIX = ".values.json"
FRAME = ("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg")
SHAPES = {
    "frame": Fact("programs.values.frame", "a frame of six numbers"),
    "number": Fact("programs.values.number", "a number"),
    "truth": Fact("programs.values.truth", "true or false"),
}
LARGEST = 1e12  # of a number


def beside(path):
    """The side file of a program's file, whether it is there or not."""
    path = Path(path)
    return path.with_name(path.stem + SUFFIX)


def load(file):
    """What a values file holds, as ``parsed`` gives it. Raises ProgramError naming the file and the key."""
    file = Path(file)
    try:
        data = schemas.read_json(file)
    except InputError as error:
        raise ProgramError.of(in_file(error, file)) from None
    return parsed(data, file)


def parsed(data, source):
    """dict of bases, tools: {words: 4 x 4 in mm}, and variables: {NAME: number, truth value or six of a
    frame}, names in upper case without blanks; what is null is not given. ``data``: as in a values file;
    ``source``: the file, or the key of a job, that holds it. Raises ProgramError naming it and the key.
    """
    try:
        data = schemas.checked(data, schemas.schema("values"), "values")
    except InputError as error:
        raise ProgramError.of(in_file(error, source)) from None
    found = {"bases": {}, "tools": {}, "variables": {}}
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


def apply(program, given, file):
    """Puts the frames that are given where the program tells none; what the program does not use is a
    problem, since it may be misspelt. ``file``: how the values' file is named. Raises ProgramError where a
    value is not of the kind that the program takes."""
    used = {
        "bases": {m.base for m in program.motions},
        "tools": {m.tool for m in program.motions},
    }
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
    if unused:
        program.problem(
            file,
            1,
            "programs.values.unused",
            "the program does not ask for {names}: it tells them itself, or has no such name",
            names=", ".join(unused[:8]) + (", ..." if len(unused) > 8 else ""),
        )


def template(program, given=None):
    """The content of a values file as a dict: what is given, and null for what the program asks for."""
    empty = dict.fromkeys(FRAME)
    data = {"bases": {}, "tools": {}, "variables": {}}
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
    for kind in data if given else ():
        data[kind].update(given.get(kind, {}))
    return data


def write_template(program, path):
    """Writes, or completes, the side file of the program's file ``path``; returns (the file, how many it
    asks for). What it holds stays. Raises InputError; the file is unchanged then."""
    file, given = beside(path), None
    if file.exists():
        load(file)
        given = schemas.read_json(file)
        names = {"".join(n.upper().split()) for n in given.get("variables", {})}
        program.asked = {n: k for n, k in program.asked.items() if n not in names}
    data = template(program, given)
    write_whole(file, (json.dumps(data, indent=2, ensure_ascii=False) + "\n").encode())
    empty = (None, dict.fromkeys(FRAME))
    return file, sum(value in empty for part in data.values() for value in part.values())
