"""What a person says, in the document, of a program that only its controller knows."""

import json
import re
from dataclasses import dataclass
from typing import Any

from ..base import schemas
from ..base.files import write_whole
from ..base.regular_files import open_regular
from ..engine import Fact, InputError
from ..programs import given
from ..programs.program import MAX_FILE

KINDS = ("bases", "tools", "variables")
SHOWN = 8  # names in a sentence
TRUTH = {"true": True, "false": False, "wahr": True, "falsch": False}


@dataclass
class Row:
    """A value that a program asks for, or that is given: ``kind``: one of KINDS; ``frame``: whether it is
    six numbers (mm, degrees); ``line``: of the program's text where it stands first, 0: nowhere; ``value``:
    number, truth value, list of six, or None."""

    kind: str
    name: str
    frame: bool
    line: int = 0
    value: Any = None


def asked(program, path):
    """What a Program asks for as a JSON text: list of [kind, name, whether a frame, line]."""
    data = given.template(program)
    text = _lines(path)
    found = []
    for kind in KINDS:
        for name, value in data[kind].items():
            frame = isinstance(value, dict)
            found.append([kind, name, frame, _line(program, kind, name, text)])
    return json.dumps(found) if found else ""


def _lines(path):
    try:
        with open_regular(path, MAX_FILE) as file:
            return file.read().decode("utf-8", "replace").splitlines()
    except (OSError, InputError):
        return []


def _line(program, kind, name, text):
    if kind != "variables":
        key = kind[:-1]
        return next((m.line for m in program.motions if getattr(m, key) == name), 0)
    # A register may have a comment: R[5:speed].
    pattern = re.escape(name).replace(r"\]", r"\s*(?::[^\]]*)?\]").replace(r"\[", r"\s*\[\s*")
    end = "" if name.endswith("]") else r"(?!\w)"
    sought = re.compile(rf"(?<![\w$]){pattern}{end}", re.IGNORECASE)
    return next((k for k, line in enumerate(text, 1) if sought.search(line)), 0)


def held(obj):
    """What is given for a RobotPath's program, as in a values file: the object's own, or what lies in the
    file beside the program. Raises InputError of that file."""
    if obj.Values:
        return json.loads(obj.Values)
    file = given.beside(obj.Source)
    if not file.is_file():
        return {}
    given.load(file)
    return schemas.read_json(file)


def rows(obj):
    """list of Row: what the program of a RobotPath asks for, and what is given. Raises InputError."""
    data = held(obj)
    found = []
    names = {}
    for kind, name, frame, line in json.loads(obj.Asked or "[]"):
        row = Row(kind, name, frame, line)
        names[kind, _key(kind, name)] = row
        found.append(row)
    for kind in KINDS:
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


def no_path(obj):
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


def _key(kind, name):
    return "".join(name.upper().split()) if kind == "variables" else name


def text_of(value):
    """A Row's value as it is shown and typed."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return " ".join(f"{one:.12g}" for one in value) if isinstance(value, list) else f"{value:.12g}"


def value_of(row, text):
    """The value that is typed for a Row; None: not given. Raises InputError naming the row."""
    words = text.replace(";", " ").split()
    if not words:
        return None
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


def _told(row, value):
    if row.frame:
        return dict(zip(given.FRAME, value or [None] * len(given.FRAME)))
    return value


def data_of(found):
    """The content of a values file of Rows."""
    data = {kind: {} for kind in KINDS}
    for row in found:
        data[row.kind][row.name] = _told(row, row.value)
    return data


def save_beside(obj, data):
    """Writes NAME.values.json beside the program of a RobotPath; returns its path. Raises InputError."""
    file = given.beside(obj.Source)
    write_whole(file, (json.dumps(data, indent=2, ensure_ascii=False) + "\n").encode())
    return file
