"""The files of a Stäubli VAL3 application: programs (.pgx) as trees of statements, data, project.

Schemas Program/2, Data/2 and Project/3 of VAL3 s7 and later (also s8, CS9), and those before (``version6``);
namespaces are ignored. A user type is a project of its own, whose data are its fields.
"""

from __future__ import annotations

import contextlib
import functools
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NoReturn

from ....base.stopping import check
from ...program import Fact, ProgramError, lines_of, name_of, work_of
from .data import Array
from ..core.tree import Node, grown
from ..xml_tree import Element, read_xml
from . import dtx
from .version6 import as_s7

INCH = 25.4  # mm
AROUND = 3  # folders around an application in which user types are looked for
MAX_TYPES = 200
MAX_PARTS = 10  # of a path
STRING_OR_COMMENT = re.compile(r'"[^"\n]*"|//[^\n]*')
WORD = re.compile(r"\w+")
CLOSED_BY = {
    "if": ("endif",),
    "for": ("endfor",),
    "while": ("endwhile",),
    "switch": ("endswitch",),
    "do": ("until",),
}


class Routine:
    """A program: its ``file``, ``line``, ``parameters`` (name, type, by reference), ``local_data``
    (name, type, size) and ``body``, a list of Nodes."""

    def __init__(self, name: str, file: str, line: int) -> None:
        self.name, self.file, self.line = name, file, line
        self.parameters: list[tuple[str, str, bool]] = []
        self.local_data: list[tuple[str, str, int]] = []
        self.body: list[Node] = []
        self.work = 0


class Project:
    """What lies beside a program: its data and, read when they are called, other programs."""

    def __init__(self, path: Path) -> None:
        self.path = Path(path)
        self.routines: dict[str, Routine | None] = {}
        self.notes: list[tuple[str, int, Fact]] = []  # (file, line, Fact)
        self.millimetres = True
        self.listed: list[Path] | None = None  # the data files that the .pjx names, once it is read
        self.types: Element | None = None  # the <Types> of the .pjx
        # Of user types: the Elements of their data by name
        self.definitions: dict[str, dict[str, Element] | None] = {}
        # What lies beside it, once asked for
        self._near: list[Path] | None = None
        self._names: dict[str, Path] = {}

    def routine(self, name: str) -> Routine | None:
        """The Routine of that name, or None. Raises ProgramError for one that cannot be read."""
        if name not in self.routines:
            self.routines[name] = None
            if re.fullmatch(r"\w+", name):
                path = self.beside(f"{name}.pgx")
                if path is not None:
                    self.routines.update({r.name: r for r in routines(path)})
        return self.routines[name]

    def data(self) -> dict[str, Array]:
        """Arrays by name of the application's .dtx; none where there is none."""
        own = self.path if self.path.suffix.lower() == ".dtx" else None
        path = own or self.beside(self.path.with_suffix(".dtx").name)
        listed = self.project()
        folder = self.of_suffix(".dtx")
        if path is None and listed:
            path = listed[0]
        if path is None and len(folder) == 1:
            path = folder[0]
        if path is None:
            if len(folder) > 1:
                names = ", ".join(p.name for p in folder[:5])
                what = Fact(
                    "programs.val3.which_data",
                    "which of {names} holds its data is not known; give that one its name",
                    names=names,
                )
            else:
                what = Fact(
                    "programs.val3.no_data",
                    "there is no .dtx beside it; what its data are is not known",
                )
            self.notes.append((name_of(self.path), 1, what))
            return {}
        file = name_of(path)
        arrays, notes = dtx.load(as_s7(read_xml(path)), file)
        self.notes += [(file, line, what) for line, what in notes]
        return arrays

    def project(self) -> list[Path]:
        """The data files that the .pjx beside the program names; sets the unit of length."""
        if self.listed is not None:
            return self.listed
        self.listed = []
        found = self.of_suffix(".pjx")
        if len(found) != 1:
            return []
        root = as_s7(read_xml(found[0]))
        self.types = root.find("Types")
        parameters, database = root.find("Parameters"), root.find("Database")
        if parameters is not None and parameters.get("millimeterUnit", "true").lower() == "false":
            self.millimetres = False
        files = [data.get("file", "") for data in (database.children if database else ())]
        names = [re.split(r"[\\/]", file)[-1] for file in files]
        self.listed = [p for p in map(self.beside, names) if p is not None]
        return self.listed

    def type_file(self, path: str) -> Path | None:
        """The .dtx of a user type, whose .pjx has a path on the controller's disk: beside the application, or in
        the folders around it; None: it is not here."""
        parts = [part for part in re.split(r"[\\/]", path.partition("://")[2] or path) if part]
        if not parts or len(parts) > MAX_PARTS or any(part in (".", "..") for part in parts[1:]):
            return None
        parts = parts[parts[0] == "." :]
        for folder in (self.path.parent, *self.path.parent.parents[:AROUND]):
            with contextlib.suppress(OSError, ValueError):  # a name that no file can have
                file = folder.joinpath(*parts).with_suffix(".dtx")
                if file.is_file():
                    return file
        return None

    def type_files(self) -> dict[str, Path]:
        """The .dtx of the user types that are here, those of their own types among them, by the type's name."""
        found: dict[str, Path] = {}
        waiting: list[Project] = [self]
        with contextlib.suppress(ProgramError):
            self.project()
        while waiting and len(found) < MAX_TYPES:
            types = waiting.pop().types
            for one in types.children if types is not None else ():
                file = self.type_file(one.get("path", ""))
                if file is not None and one.get("name", "") not in found:
                    found[one.get("name", "")] = file
                    inner = Project(file.with_suffix(".pgx"))
                    with contextlib.suppress(ProgramError):
                        inner.project()
                        waiting.append(inner)
        return found

    def fields(self, kind: str) -> dict[str, Element]:
        """{name: Element of <Data>} of a user type; none where it is not here. Raises ProgramError."""
        if not self.definitions:
            self.definitions = dict.fromkeys(self.files_of_types, None)
        if self.definitions.get(kind, {}) is None:
            root = as_s7(read_xml(self.files_of_types[kind]))
            holder = root.find("Datas")
            elements = holder.children if holder is not None else ()
            self.definitions[kind] = {
                one.get("name", ""): one for one in elements if one.get("access") == "public"
            }
        return self.definitions.get(kind) or {}

    @functools.cached_property
    def files_of_types(self) -> dict[str, Path]:
        return self.type_files()

    def near(self) -> list[Path]:
        """What lies in the program's folder, sorted."""
        if self._near is None:
            self._near = sorted(self.path.parent.glob("*"))
            self._names = {p.name.lower(): p for p in reversed(self._near)}
            self._names.update({p.name: p for p in self._near})  # the very name first
        return self._near

    def beside(self, name: str) -> Path | None:
        """The file of that name in the program's folder, its case aside, or None."""
        self.near()
        path = self._names.get(name) or self._names.get(name.lower())
        return path if path is not None and path.is_file() else None

    def of_suffix(self, suffix: str) -> list[Path]:
        """The files in the program's folder with a suffix, whatever its case, sorted."""
        return [p for p in self.near() if p.suffix.lower() == suffix]

    @property
    def unit(self) -> float:
        """mm of the application's unit of length."""
        return 1.0 if self.millimetres else INCH


def routines(path: Path) -> list[Routine]:
    """The Routines of a .pgx. Raises ProgramError naming file and line."""
    file = name_of(path)
    root = as_s7(read_xml(path, text_of=("Code", "code")))
    found = [e for e in root.children if e.tag == "Program"] if root.tag == "Programs" else []
    if not found:
        raise ProgramError.at(
            file,
            root.line,
            "programs.val3.no_program",
            "<{tag}> holds no VAL3 program of s7 or later; save it with Stäubli Robotics Suite",
            tag=root.tag,
        )
    return [_routine(element, file) for element in found]


def _routine(element: Element, file: str) -> Routine:
    routine = Routine(element.get("name", ""), file, element.line)
    for section in ("Parameters", "Locals"):
        holder = element.find(section)
        for item in holder.children if holder is not None else ():
            name, kind = item.get("name", ""), item.get("type", "")
            if section == "Parameters":
                routine.parameters.append((name, kind, item.get("use", "") == "reference"))
            else:
                routine.local_data.append((name, kind, dtx.product_of(item.get("size", "1"), 0)))
    code = element.find("Code")
    if code is None or code.text is None:
        raise ProgramError.at(
            file,
            element.line,
            "programs.val3.no_code",
            "the program {name} has no code",
            name=routine.name,
        )
    routine.line = code.text_line
    _tree(routine, code)
    return routine


def _tree(routine: Routine, code: Element) -> None:
    def stray(line: int, word: str, text: str, node: Node | None) -> NoReturn:
        raise ProgramError.at(
            routine.file,
            line,
            "programs.closes_nothing",
            "{word} closes nothing",
            word=text[:20],
        )

    def unclosed(node: Node, line: int) -> NoReturn:
        raise ProgramError.at(
            routine.file,
            line,
            "programs.val3.not_closed",
            "the {word} of line {begun} is not closed; is the file cut off?",
            word=node.word,
            begun=node.line,
        )

    rows: list[tuple[int, str, str]] = []
    ended, line = False, code.text_line
    for line, word, statement in _statements(routine, code):
        if word == "end" and statement.lower() == "end":
            ended = True
            break
        rows.append((line, word, statement))
        routine.work += work_of(statement)
    routine.body = grown(rows, CLOSED_BY, routine.file, stray, unclosed)
    if not ended:
        raise ProgramError.at(
            routine.file,
            line,
            "programs.val3.no_end",
            "the program has no end; is the file cut off?",
        )


def _statements(routine: Routine, code: Element) -> Iterator[tuple[int, str, str]]:
    """(line, first word in lower case, text) of each statement; "begin" is left out."""
    text = STRING_OR_COMMENT.sub(lambda m: m.group() if m.group()[0] == '"' else "", code.text)
    begun = False
    for line, statement in enumerate(lines_of(text, routine.file), code.text_line):
        check()
        statement = statement.strip()
        first = WORD.match(statement)
        word = first.group().lower() if first else ""
        if word == "begin" and not begun and statement.lower() == "begin":
            begun = True
        elif statement:
            yield line, word, statement
