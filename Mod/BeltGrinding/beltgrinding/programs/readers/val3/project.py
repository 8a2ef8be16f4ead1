"""The files of a Stäubli VAL3 application: programs (.pgx) as trees of statements, data, project.

Schemas Program/2, Data/2 and Project/3 of VAL3 s7 and later (also s8, CS9); namespaces are ignored.
"""

import re
from pathlib import Path

from ....base.stopping import check
from ...program import Fact, ProgramError, lines_of, name_of, work_of
from ..rapid.text import Node
from ..xml_tree import read_xml
from . import data as val3_data

INCH = 25.4  # mm
MAX_NESTING = 60
STRING_OR_COMMENT = re.compile(r'"[^"\n]*"|//[^\n]*')
WORD = re.compile(r"\w+")
CLOSED_BY = {
    "if": ("endif",),
    "for": ("endfor",),
    "while": ("endwhile",),
    "switch": ("endswitch",),
    "do": ("until",),
}
ENDS = {end for ends in CLOSED_BY.values() for end in ends}


class Routine:
    """A program: its ``file``, ``line``, ``parameters`` (name, type, by reference), ``local_data``
    (name, type, size) and ``body``, a list of Nodes."""

    def __init__(self, name, file, line):
        self.name, self.file, self.line = name, file, line
        self.parameters, self.local_data, self.body = [], [], []
        self.work = 0


class Project:
    """What lies beside a program: its data and, read when they are called, other programs."""

    def __init__(self, path):
        self.path = Path(path)
        self.routines = {}
        self.notes = []  # (file, line, Fact)
        self.millimetres = True
        self.data_file = None
        self._near, self._names = None, {}  # what lies beside it, once asked for

    def routine(self, name):
        """The Routine of that name, or None. Raises ProgramError for one that cannot be read."""
        if name not in self.routines:
            self.routines[name] = None
            if re.fullmatch(r"\w+", name):
                path = self.beside(f"{name}.pgx")
                if path is not None:
                    self.routines.update({r.name: r for r in routines(path)})
        return self.routines[name]

    def data(self):
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
        self.data_file = name_of(path)
        arrays, notes = val3_data.load(read_xml(path), self.data_file)
        self.notes += [(self.data_file, *note) for note in notes]
        return arrays

    def project(self):
        """The data files that the .pjx beside the program names; sets the unit of length."""
        found = self.of_suffix(".pjx")
        if len(found) != 1:
            return []
        root = read_xml(found[0])
        parameters, database = root.find("Parameters"), root.find("Database")
        if parameters is not None and parameters.get("millimeterUnit", "true").lower() == "false":
            self.millimetres = False
        files = [data.get("file", "") for data in (database.children if database else ())]
        names = [re.split(r"[\\/]", file)[-1] for file in files]
        return [p for p in map(self.beside, names) if p is not None]

    def near(self):
        """What lies in the program's folder, sorted."""
        if self._near is None:
            self._near = sorted(self.path.parent.glob("*"))
            self._names = {p.name.lower(): p for p in reversed(self._near)}
            self._names.update({p.name: p for p in self._near})  # the very name first
        return self._near

    def beside(self, name):
        """The file of that name in the program's folder, its case aside, or None."""
        self.near()
        path = self._names.get(name) or self._names.get(name.lower())
        return path if path is not None and path.is_file() else None

    def of_suffix(self, suffix):
        """The files in the program's folder with a suffix, whatever its case, sorted."""
        return [p for p in self.near() if p.suffix.lower() == suffix]

    @property
    def unit(self):
        """mm of the application's unit of length."""
        return 1.0 if self.millimetres else INCH


def routines(path):
    """The Routines of a .pgx. Raises ProgramError naming file and line."""
    file = name_of(path)
    root = read_xml(path, text_of=("Code",))
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


def _routine(element, file):
    routine = Routine(element.get("name", ""), file, element.line)
    for section, target in (("Parameters", routine.parameters), ("Locals", routine.local_data)):
        holder = element.find(section)
        for item in holder.children if holder is not None else ():
            name, kind = item.get("name", ""), item.get("type", "")
            if section == "Parameters":
                target.append((name, kind, item.get("use", "") == "reference"))
            else:
                target.append((name, kind, val3_data.product_of(item.get("size", "1"), 0)))
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


def _tree(routine, code):
    text = STRING_OR_COMMENT.sub(lambda m: m.group() if m.group()[0] == '"' else "", code.text)
    open_nodes, body, begun, line = [], routine.body, False, code.text_line
    for line, statement in enumerate(lines_of(text, routine.file), code.text_line):
        check()
        statement = statement.strip()
        word = WORD.match(statement)
        word = word.group().lower() if word else ""
        if not statement or (word == "begin" and not begun and statement.lower() == "begin"):
            begun = begun or bool(statement)
            continue
        routine.work += work_of(statement)
        if word == "end" and statement.lower() == "end" and not open_nodes:
            return
        if word in ENDS:
            if not open_nodes or word not in CLOSED_BY[open_nodes[-1].word]:
                raise ProgramError.at(
                    routine.file,
                    line,
                    "programs.closes_nothing",
                    "{word} closes nothing",
                    word=statement[:20],
                )
            node = open_nodes.pop()
            if word == "until":
                node.text = statement[len("until") :].strip()
            continue
        node = Node(line, word, statement, [] if word in CLOSED_BY else None)
        (open_nodes[-1].body if open_nodes else body).append(node)
        if node.body is not None:
            open_nodes.append(node)
            if len(open_nodes) > MAX_NESTING:
                raise ProgramError.at(
                    routine.file, line, "programs.nested_blocks", "blocks are nested too deeply"
                )
    if open_nodes:
        node = open_nodes[-1]
        raise ProgramError.at(
            routine.file,
            line,
            "programs.val3.not_closed",
            "the {word} of line {begun} is not closed; is the file cut off?",
            word=node.word,
            begun=node.line,
        )
    raise ProgramError.at(
        routine.file, line, "programs.val3.no_end", "the program has no end; is the file cut off?"
    )
