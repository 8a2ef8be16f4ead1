"""Every code of an error, an event or a warning has one English form and one in each other language.

The codes are read from the sources: pairs of literals, a code and the form after it.
"""

import ast
import json
import re
import string
from collections import defaultdict
from pathlib import Path

import pytest

from support import prose, texts

ROOT = Path(__file__).resolve().parents[2]
CODE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*(\.[a-z][a-z0-9]*(_[a-z0-9]+)*)+")
LITERAL = r'"(?:[^"\\\n]|\\.)*"'
# In C++: a code, then a form, which may be several literals side by side.
PAIR = re.compile(rf'"(?P<code>{CODE.pattern})"\s*,\s*(?P<form>(?:{LITERAL}\s*)+)')
ERRORS = ("InputError", "ProgramError", "Problem")
FACTS = ("Fact", "Unknown", "Missing", "Reason")  # of these, all given are arguments of the form
CULPRIT = {"key", "file", "line", "face", "pose"}  # may be given without being shown


def sources(folder, *patterns):
    return sorted(path for pattern in patterns for path in (ROOT / folder).rglob(pattern))


def fields(form):
    """{(name, format specification)}"""
    return {(name, spec) for _, name, spec, _ in string.Formatter().parse(form) if name is not None}


def names(form):
    return {name for name, _ in fields(form)}


def without_comments(text):
    """C++ without comments, literals kept."""
    token = re.compile(rf"{LITERAL}|'(?:[^'\\\n]|\\.)*'|//[^\n]*|/\*.*?\*/", re.DOTALL)
    return token.sub(lambda m: " " if m[0].startswith("/") else m[0], text)


def joined(literals):
    return "".join(ast.literal_eval(literal) for literal in re.findall(LITERAL, literals))


def braces(text, begin):
    """The text of the braces that open at ``begin``; None where none do."""
    if text[begin : begin + 1] != "{":
        return None
    depth = 0
    for token in re.finditer(rf"{LITERAL}|[{{}}]", text[begin:]):
        depth += {"{": 1, "}": -1}.get(token[0], 0)
        if depth == 0:
            return text[begin : begin + token.end()]
    raise AssertionError(f"a brace that does not close: {text[begin:begin + 80]}")


class Found:
    """What the sources say."""

    def __init__(self):
        self.forms = defaultdict(set)  # by code
        self.faults = []
        self.plain = {".cpp": [], ".py": []}  # places of errors without a code

    def take(self, where, code, form, given=None):
        """``given``: names of the arguments, None where they are not seen."""
        self.forms[code].add(form)
        try:
            wanted = names(form)
        except ValueError as error:
            self.faults.append(f"{where}: {code}: {error}")
            return
        if given is not None and not wanted <= given <= wanted | CULPRIT:
            self.faults.append(f"{where}: {code} names {sorted(wanted)}, given {sorted(given)}")

    def cpp(self, path):
        text = without_comments(path.read_text(encoding="utf-8"))
        where = path.relative_to(ROOT)
        for match in PAIR.finditer(text):
            before = text[: match.start()].rstrip()
            after = text[match.end() :]
            given = None
            if after.startswith(","):
                inside = braces(after[1:].lstrip(), 0)
                if inside is not None:
                    given = set(re.findall(r'{\s*"(\w+)"\s*,', inside))
            elif before.endswith(("InputError(", "Fact{")):
                given = set()
            self.take(where, match["code"], joined(match["form"]), given)
        # Neither a code nor a fact, as a variable's name or a function's.
        plain = rf'throw InputError\((?!\s*"{CODE.pattern}"\s*,)(?!\s*[\w.]+\s*[,)])'
        self.plain[".cpp"] += [where for _ in re.finditer(plain, text)]

    def python(self, path):
        where = path.relative_to(ROOT)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                self._call(f"{where}:{node.lineno}", node)
            elif isinstance(node, (ast.Tuple, ast.List)):
                for code, form in self._pairs(node.elts):
                    self.take(f"{where}:{node.lineno}", code, form)

    def _call(self, where, node):
        callee = getattr(node.func, "id", getattr(node.func, "attr", ""))
        pairs = list(self._pairs(node.args))
        given = {keyword.arg for keyword in node.keywords}
        for code, form in pairs:
            # Of a call of another name, not all need be arguments of the form.
            seen = given if callee in (*ERRORS, *FACTS) else given & (names(form) | CULPRIT)
            self.take(where, code, form, None if None in given else seen)
        if callee in ERRORS and node.args and not pairs and None not in given:
            first = node.args[0]
            if isinstance(first, ast.Constant) and CODE.fullmatch(str(first.value)):
                self.faults.append(f"{where}: the form of {first.value} is no plain literal")
            # A code and its form that stand elsewhere, as in a table, come as two names.
            named = [argument for argument in node.args if isinstance(argument, ast.Name)]
            if callee != "InputError" or not len(named) == len(node.args) == 2:
                self.plain[".py"].append(where)

    @staticmethod
    def _pairs(values):
        for code, form in zip(values, values[1:]):
            if not all(
                isinstance(v, ast.Constant) and isinstance(v.value, str) for v in (code, form)
            ):
                continue
            if CODE.fullmatch(code.value) and not re.fullmatch(r"\w*(\.\w+)+", form.value):
                yield code.value, form.value


@pytest.fixture(scope="module")
def found():
    result = Found()
    for path in sources("src", "*.cpp", "*.h"):
        result.cpp(path)
    for path in sources("Mod/BeltGrinding", "*.py"):
        result.python(path)
    return result


def test_the_sources_are_read(found):
    assert len(found.forms) > 30, "the scan finds nothing: has the way of writing changed?"
    assert not found.faults, "\n".join(found.faults)


def test_a_code_has_one_form(found):
    several = {code: sorted(forms) for code, forms in found.forms.items() if len(forms) > 1}
    assert not several, json.dumps(several, indent=2)


@pytest.mark.parametrize("file", sorted((ROOT / "Resources" / "messages").glob("*.json")))
def test_every_form_is_translated(found, file):
    told = json.loads(file.read_text(encoding="utf-8"))
    told.pop("report")  # by English text: tests/workbench/test_report.py
    told.pop("window")  # by context and English text: tests/gui/test_translations.py
    missing = sorted(set(found.forms) - set(told))
    assert not missing, f"{file.name} lacks {missing}"
    orphans = sorted(set(told) - set(found.forms))
    assert not orphans, f"{file.name} has what nobody says: {orphans}"
    for code, form in told.items():
        assert fields(form) == fields(min(found.forms[code])), f"{file.name}: {code}"
    assert list(told) == sorted(told), f"{file.name} is not in order"


def test_every_error_has_a_code(found):
    assert not found.plain[".cpp"], "an error needs a code: beltgrinding/error.h"
    assert not found.plain[".py"], "an error needs a code: InputError's docstring"


def test_messages_and_labels_have_none_of_our_idioms(found):
    forms = [(code, form) for code, several in found.forms.items() for form in several]
    labels = [(place, text) for (_, text), place in texts.marked(ROOT / "Mod/BeltGrinding").items()]
    wrong = [f"{where}: {text}" for where, text in forms + labels if prose.IDIOMS.search(text)]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize(
    "code, fault",
    [
        ('throw InputError("a.b", "{x} is bad", {{"y", 1}});', "names ['x'], given ['y']"),
        ('throw InputError("a.b", "{x} is bad");', "names ['x'], given []"),
        ('Fact{"a.b", "{x:.3g is bad", {}}', "unmatched '{'"),
    ],
)
def test_faults_of_cpp_are_found(tmp_path, monkeypatch, code, fault):
    monkeypatch.setitem(globals(), "ROOT", tmp_path)
    (tmp_path / "one.cpp").write_text(code)
    result = Found()
    result.cpp(tmp_path / "one.cpp")
    assert len(result.faults) == 1 and fault in result.faults[0]


@pytest.mark.parametrize(
    "code, fault",
    [
        ('raise InputError("a.b", "{x} is bad", y=1)', "names ['x'], given ['y']"),
        ('self.problem(3, "a.b", "{x} is bad")', "names ['x'], given []"),
        ('raise InputError("a.b", f"{x} is bad")', "no plain literal"),
        ('raise InputError("a.b")', "no plain literal"),
    ],
)
def test_faults_of_python_are_found(tmp_path, monkeypatch, code, fault):
    monkeypatch.setitem(globals(), "ROOT", tmp_path)
    (tmp_path / "one.py").write_text(code)
    result = Found()
    result.python(tmp_path / "one.py")
    assert len(result.faults) == 1 and fault in result.faults[0]
