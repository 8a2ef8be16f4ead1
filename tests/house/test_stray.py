"""Nothing is stray: no name that is used nowhere, no list that stands twice, no test without a name."""

import ast
import re
import subprocess

from support.freecad import ROOT

PACKAGE = ROOT / "Mod" / "BeltGrinding" / "beltgrinding"
WORD = re.compile(r"\w+")
# Read by others than this repository's sources.
ASKED_FOR = {"__all__", "__getattr__", "__dir__"}


def _named(tree):
    """The names that the body of a module gives to functions, classes, and constants one by one: those of an
    enumeration belong together."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from (one.id for one in targets if isinstance(one, ast.Name))


def _used(tree):
    """(The names that a module reads as its own, those that it takes of others or has in strings)."""
    own, others = set(), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            own.add(node.id)
        elif isinstance(node, ast.Attribute):
            others.add(node.attr)
        elif isinstance(node, ast.ImportFrom):
            others.update(alias.name for alias in node.names)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            if len(node.value.split()) == 1:
                others.update(WORD.findall(node.value))
    return own, others


def unused(sources, around=frozenset()):
    """The names at the level of modules, of ``{file: text}``, that no module uses and that are not ``around``."""
    trees = {name: ast.parse(text) for name, text in sources.items()}
    used = {name: _used(tree) for name, tree in trees.items()}
    taken = set(around | ASKED_FOR).union(*(others for _, others in used.values()))
    return sorted(
        f"{name}: {one}"
        for name, tree in trees.items()
        for one in set(_named(tree)) - used[name][0] - taken
    )


def test_a_name_that_nothing_uses_is_found():
    sources = {
        "a.py": "USED = DEAD = 1\ndef called(): return USED\nclass Gone: pass\n",
        "b.py": "from a import called\nA, B = 1, 2\nLOST = USED = 3\nprint(A, called())\n",
    }
    assert unused(sources) == ["a.py: DEAD", "a.py: Gone", "b.py: LOST", "b.py: USED"]
    assert unused(sources, {"DEAD", "USED"}) == ["a.py: Gone", "b.py: LOST"]


def test_every_name_of_a_module_is_used():
    listed = subprocess.run(
        ["git", "ls-files", "Mod", "tests", "tools", "src", "examples", ".ci"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    files = {name: ROOT / name for name in listed.stdout.split("\n") if (ROOT / name).is_file()}
    own = {name for name in files if name.startswith("Mod/") and name.endswith(".py")}
    own.remove("Mod/BeltGrinding/beltgrinding/__init__.py")  # is for macros
    around = set()  # what is outside speaks to the package in programs that are strings, too
    for name in sorted(set(files) - own):
        if name.endswith((".py", ".cpp")) or "." not in name.split("/")[-1]:
            around.update(WORD.findall(files[name].read_text("utf-8", "replace")))
    assert unused({name: files[name].read_text("utf-8") for name in own}, around) == []


def test_the_api_has_what_the_package_offers():
    tree = ast.parse((PACKAGE / "objects" / "api.py").read_text("utf-8"))
    has = {name for name in _named(tree)}
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            has.update(alias.name for alias in node.names)
    from beltgrinding import DOCUMENT_FUNCTIONS

    assert sorted(set(DOCUMENT_FUNCTIONS) - has) == []
    assert len(set(DOCUMENT_FUNCTIONS)) == len(DOCUMENT_FUNCTIONS)


def test_no_docstring_speaks_of_what_is_gone():
    gone = re.compile(r"``job\.(Result|run)\b")
    found = [p for p in PACKAGE.rglob("*.py") if gone.search(p.read_text("utf-8"))]
    assert found == []


def _unnamed(text):
    """The parametrised suites of a C++ source that give their parameters no names: GoogleTest numbers them then, and a
    failed one cannot be found in its source."""
    for begin in re.finditer(r"INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+)", text):
        end, open_ = begin.end(), 1
        while open_:
            open_ += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        if not re.search(r"\[\]\(const auto& \w+\) *\{", text[begin.start() : end]):
            yield f"{begin[1]}/{begin[2]}"


def test_parameters_of_cpp_tests_have_names():
    bare = "INSTANTIATE_TEST_SUITE_P(A, B, ::testing::Values(P{1}, P{2}));\n"
    assert list(_unnamed(bare)) == ["A/B"]
    found = []
    for path in sorted((ROOT / "tests" / "core").rglob("*.cpp")):
        found += [f"{path.name}: {suite}" for suite in _unnamed(path.read_text("utf-8"))]
    assert found == []
    # Without it ctest's names hold what GoogleTest prints of a parameter: "24-byte object <A3-B1 ..>".
    assert "NO_PRETTY_VALUES" in (ROOT / "tests" / "core" / "CMakeLists.txt").read_text("utf-8")
