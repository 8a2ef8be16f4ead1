"""What a person says, in the document, of a program that only its controller knows."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..base import schemas
from ..base.files import write_whole
from ..base.kinds import Json
from ..base.regular_files import open_regular
from ..engine import Fact, InputError
from ..programs import given
from ..programs.program import MAX_FILE
from .kinds import DocumentObject

if TYPE_CHECKING:
    from ..programs.program import Program

UNIT = given.UNIT  # the kind and the name of the row of a file that does not say mm or inch
UNIT_WORDS = {"mm": "mm", "inch": "inch", "in": "inch", "inches": "inch", "zoll": "inch"}
SHOWN = 8  # names in a sentence
TRUTH = {"true": True, "false": False, "wahr": True, "falsch": False}


@dataclass
class Row:
    """A value that a program asks for, or that is given: ``kind``: one of ``given.KINDS``, or UNIT; ``frame``:
    whether it is six numbers (mm, degrees); ``line``: of the program's text where it stands first, 0: nowhere;
    ``value``: number, truth value, list of six, "mm" or "inch", or None."""

    kind: str
    name: str
    frame: bool
    line: int = 0
    value: Any = None


def asked(program: Program, path: Path | str) -> str:
    """What a Program asks for as a JSON text: list of [kind, name, whether a frame, line]."""
    data = given.template(program)
    text = _lines(path)
    found = [[UNIT, UNIT, False, 0]] if UNIT in data else []
    for kind in given.KINDS:
        for name, value in data[kind].items():
            frame = isinstance(value, dict)
            found.append([kind, name, frame, _line(program, kind, name, text)])
    return json.dumps(found, allow_nan=False) if found else ""


def _lines(path: Path | str) -> list[str]:
    try:
        with open_regular(path, MAX_FILE) as file:
            return file.read().decode("utf-8", "replace").splitlines()
    except (OSError, InputError):
        return []


def _line(program: Program, kind: str, name: str, text: Sequence[str]) -> int:
    if kind != "variables":
        key = kind[:-1]
        return next((m.line for m in program.motions if getattr(m, key) == name), 0)
    # A register may have a comment: R[5:speed].
    pattern = re.escape(name).replace(r"\]", r"\s*(?::[^\]]*)?\]").replace(r"\[", r"\s*\[\s*")
    end = "" if name.endswith("]") else r"(?!\w)"
    sought = re.compile(rf"(?<![\w$]){pattern}{end}", re.IGNORECASE)
    return next((k for k, line in enumerate(text, 1) if sought.search(line)), 0)


def held(obj: DocumentObject) -> dict[str, Any]:
    """What is given for a RobotPath's program, as in a values file: the object's own, or what lies in the
    file beside the program. Raises InputError of that file."""
    if obj.Values:
        return json.loads(obj.Values)
    file = given.beside(obj.Source)
    if not file.is_file():
        return {}
    given.load(file)
    return schemas.read_json(file)


def rows(obj: DocumentObject) -> list[Row]:
    """list of Row: what the program of a RobotPath asks for, and what is given. Raises InputError."""
    data = held(obj)
    found = []
    names = {}
    for kind, name, frame, line in json.loads(obj.Asked or "[]"):
        names[kind, _key(kind, name)] = Row(kind, name, frame, line)
        found.append(names[kind, _key(kind, name)])
    if data.get(UNIT):
        if (UNIT, UNIT) not in names:
            found.append(names.setdefault((UNIT, UNIT), Row(UNIT, UNIT, False)))
        names[UNIT, UNIT].value = data[UNIT]
    for kind in given.KINDS:
        for name, value in data.get(kind, {}).items():
            row = names.get((kind, _key(kind, name)))
            if row is None:
                row = Row(kind, name, isinstance(value, dict))
                found.append(row)
            row.name = name
            if isinstance(value, dict):
                six = [value[key] for key in given.FRAME]
                row.frame, row.value = True, None if None in six else six
            elif value is not None:
                row.frame, row.value = False, value
    return found


def no_path(obj: DocumentObject) -> list[Fact]:
    """[Fact] that a RobotPath whose program asks for values has no path yet, and which are missing; [] where it
    has one. Raises InputError of the file beside the program."""
    count = len(obj.Poses)
    if count > 1 or not obj.Asked or obj.SourceObject is not None:
        return []
    missing = [row.name for row in rows(obj) if row.value is None]
    if not missing:
        return [
            Fact(
                "objects.no_path_with_values",
                "no path yet: two poses make one, the program has {count}, though all values that it asks for are "
                "given; the other problems say why",
                count=count,
            )
        ]
    return [
        Fact(
            "objects.no_path_yet",
            "no path yet: two poses make one, the program has {count}; give what only the controller knows on the "
            "page Values: {names}",
            count=count,
            names=", ".join(missing[:SHOWN]) + (", ..." if len(missing) > SHOWN else ""),
        )
    ]


def _key(kind: str, name: str) -> str:
    return "".join(name.upper().split()) if kind == "variables" else name


def text_of(value: Any) -> str:
    """A Row's value as it is shown and typed."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    return " ".join(f"{one:.12g}" for one in value) if isinstance(value, list) else f"{value:.12g}"


def value_of(row: Row, text: str) -> Any:
    """The value that is typed for a Row; None: not given. Raises InputError naming the row."""
    words = text.replace(";", " ").split()
    if not words:
        return None
    if row.kind == UNIT:
        if len(words) != 1 or words[0].lower() not in UNIT_WORDS:
            raise InputError(
                "objects.unit",
                "{name}: '{text}' is no unit; give mm or inch",
                name=row.name,
                text=text[:60],
            )
        return UNIT_WORDS[words[0].lower()]
    if not row.frame and len(words) == 1 and words[0].lower() in TRUTH:
        return TRUTH[words[0].lower()]
    try:
        found = [float(word.replace(",", ".")) for word in words]
    except ValueError:
        found = []
    if row.frame and len(found) != len(given.FRAME):
        raise InputError(
            "objects.six_numbers",
            "{name}: '{text}' is no frame; give x y z in mm and a b c in degrees, blanks between them",
            name=row.name,
            text=text[:60],
        )
    if not row.frame and len(found) != 1:
        raise InputError(
            "objects.one_number",
            "{name}: '{text}' is no number, nor true or false",
            name=row.name,
            text=text[:60],
        )
    value = found if row.frame else found[0]
    given.parsed({row.kind: {row.name: _told(row, value)}}, row.name)  # its bounds
    return value


def _told(row: Row, value: Any) -> Any:
    if row.frame:
        return dict(zip(given.FRAME, value or [None] * len(given.FRAME)))
    return value


def data_of(found: Iterable[Row]) -> dict[str, Any]:
    """The content of a values file of Rows."""
    data: dict[str, Any] = {kind: {} for kind in given.KINDS}
    for row in found:
        if row.kind == UNIT:
            data[UNIT] = row.value
        else:
            data[row.kind][row.name] = _told(row, row.value)
    return data


def save_beside(obj: DocumentObject, data: Json) -> Path:
    """Writes NAME.values.json beside the program of a RobotPath; returns its path. Raises InputError."""
    file = given.beside(obj.Source)
    write_whole(
        file, (json.dumps(data, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode()
    )
    return file
