"""Tests are Python that a formatter, a linter and a search see, not text that a FreeCAD is given."""

import ast
import re
import textwrap

import pytest

from support.freecad import ROOT

# Lines of Python in strings: programs that another process runs whole, and tests of the tests themselves.
MOST_IN_STRINGS = 81
MOST_NOQA = 46
MOST_PATHS = 14  # scripts that people start by themselves, outside of pytest and tools/bench
PROGRAM = re.compile(
    r"^\s*(import|from|for|while|def|with|assert|if)\b.*|^\s*[\w.\[\]]+ = .*|^\s*[\w.]+\(.*\)$"
)


def python_in_strings(path):
    """Lines of the file's string literals that are programs: at least three lines, all of them Python."""
    lines = 0
    tree = ast.parse(path.read_text(encoding="utf-8"))
    docs = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef))
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Constant) and isinstance(node.value, str)) or id(node) in docs:
            continue
        text = textwrap.dedent(node.value)
        if text.count("\n") < 3 or not any(PROGRAM.match(line) for line in text.splitlines()):
            continue
        try:
            statements = ast.parse(text).body
        except SyntaxError:
            continue
        if any(
            not isinstance(one, ast.Expr) or isinstance(one.value, ast.Call) for one in statements
        ):
            lines += len(text.strip().splitlines())
    return lines


def sources(*folders):
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]


def counted(pattern, files):
    return {p.name: n for p in files if (n := len(re.findall(pattern, p.read_text("utf-8"))))}


def test_programs_in_strings_are_found(tmp_path):
    path = tmp_path / "test_it.py"
    body = "import FreeCAD\\ndoc = FreeCAD.newDocument()\\nassert doc.Name\\nprint(doc)\\n"
    path.write_text(
        f'"""Doc."""\nfreecad.run("{body}")\nTEXT = "one\\ntwo words\\nthree\\nfour"\n'.replace(
            'TEXT = "one\n', 'TEXT = """one\n'
        ).replace('four"', 'four"""')
    )
    assert python_in_strings(path) == 4


def test_tests_are_no_strings():
    found = {
        p.name: n for p in sources("tests/gui", "tests/workbench") if (n := python_in_strings(p))
    }
    assert sum(found.values()) <= MOST_IN_STRINGS, found


@pytest.mark.parametrize(
    "pattern, most", [(r"# noqa", MOST_NOQA), (r"sys\.path(?:\.insert\(|\[:0\] =)", MOST_PATHS)]
)
def test_imports_stand_where_they_belong(pattern, most):
    found = counted(
        pattern, [p for p in sources("tests", "Mod", "tools") if p.name != "test_tests_are_code.py"]
    )
    assert sum(found.values()) <= most, found
