"""Tests that pytest runs inside of FreeCAD: ``@pytest.mark.freecad``, with ``window=True`` for its window.

The file is read twice: by pytest, which collects it, makes the fixtures and hands their values over
(pickled), and in FreeCAD, where the function runs (support/serve.py). Outside, what only FreeCAD can import
is left away, so its names are for bodies of functions.
"""

import ast
import importlib.machinery
import importlib.util
import re
import sys
from pathlib import Path

import pytest
from _pytest.assertion.rewrite import rewrite_asserts

from support.freecad import FreeCad

# What is not to be had outside; PySide is FreeCAD's name for it.
FREECADS = {"FreeCAD", "FreeCADGui", "PySide", "pivy", "Part", "Mesh", "MeshPart", "Path", "Robot"}
FREECADS |= {"Import", "Inspection", "Points", "importlib_freecad"}
ASKS = re.compile(r"\bmark\.freecad\b|\bfreecad\.call\(")
# FreeCAD cuts a long traceback off, anywhere, and prints the error behind it.
TRACEBACK = re.compile(
    r"^Traceback \(most recent call last\):\n(?:(?! .*<class 'beltgrinding) .*\n)*(.*)", re.M
)
REFUSED = re.compile(r"InputError|<class 'beltgrinding[\w.]*Error'>")
_place = pytest.StashKey()  # of an item: where it runs
_shared = pytest.StashKey()  # of the session: {whether it has a window: FreeCad}


class Absent:
    """Stands outside of FreeCAD for what only FreeCAD can import."""

    def __init__(self, error):
        if (error.name or "").split(".")[0] not in FREECADS:
            raise error
        self.__error = error

    def __getattr__(self, name):
        raise ImportError(f"Only inside of FreeCAD: {self.__error}")


class _Lazy(ast.NodeTransformer):
    """Lets the imports of a file's top fail that only FreeCAD can do."""

    def visit_Import(self, node):
        names = [(a.asname or a.name).split(".")[0] for a in node.names if a.name != "*"]
        bound = "".join(f"{name} = " for name in names)
        template = f"try: pass\nexcept ImportError as error: {bound}__absent__(error)"
        (guarded,) = ast.parse(template).body
        for part in ast.walk(guarded):
            ast.copy_location(part, node)
        guarded.body = [node]
        return guarded

    visit_ImportFrom = visit_Import

    def visit_FunctionDef(self, node):
        return node

    visit_ClassDef = visit_FunctionDef


class Loader(importlib.machinery.SourceFileLoader):
    """Reads a test file; its assertions are rewritten as pytest does it."""

    outside = False

    def get_code(self, fullname):
        source = self.get_data(self.path)
        tree = ast.parse(source, self.path)
        if self.outside:
            tree = _Lazy().visit(tree)
        rewrite_asserts(tree, source, self.path)
        return compile(tree, self.path, "exec", dont_inherit=True)

    def exec_module(self, module):
        module.__absent__ = Absent
        super().exec_module(module)


class Outside(Loader):
    """As a finder: takes the test files of which something runs inside, also where one imports another."""

    outside = True

    @classmethod
    def find_spec(cls, name, path=None, target=None):
        for folder in sys.path if name.startswith("test_") else ():
            file = Path(folder, f"{name}.py")
            if file.is_file():
                return spec_of(file, cls) if asks(file) else None
        return None


def spec_of(file, loader):
    """The spec of a test file's module."""
    return importlib.util.spec_from_file_location(
        file.stem, file, loader=loader(file.stem, str(file))
    )


def asks(file):
    """Whether something of a test file runs inside of FreeCAD."""
    return bool(ASKS.search(file.read_text(encoding="utf-8")))


def load(file, loader=Loader):
    """The module of a test file."""
    file = Path(file)
    if file.stem not in sys.modules:
        spec = spec_of(file, loader)
        module = sys.modules[file.stem] = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(module)
        except BaseException:
            del sys.modules[file.stem]
            raise
    return sys.modules[file.stem]


class Module(pytest.Module):
    """A file with tests of which some run inside of FreeCAD."""

    def _getobj(self):
        return load(self.path, Outside)


def pytest_configure():
    sys.meta_path.insert(0, Outside)


def pytest_unconfigure():
    sys.meta_path.remove(Outside)


def pytest_pycollect_makemodule(module_path, parent):
    if asks(module_path):
        return Module.from_parent(parent, path=module_path)
    return None


@pytest.fixture(autouse=True)
def _inside(request, tmp_path_factory):
    """Finds the FreeCAD that a marked test runs in: this process's, or a ``fresh`` one."""
    mark = request.node.get_closest_marker("freecad")
    if mark is None:
        yield
        return
    asked = {"window": False, "fresh": False, "quiet": True, **mark.kwargs}
    shared = request.session.stash.setdefault(_shared, {})
    key = "fresh" if asked["fresh"] else asked["window"]
    if key not in shared:
        shared[key] = FreeCad(tmp_path_factory.mktemp("freecad"))
    request.node.stash[_place] = shared[key], asked, request.getfixturevalue("tmp_path")
    yield
    if asked["fresh"]:
        shared.pop(key).close()


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    found = pyfuncitem.stash.get(_place, None)
    if found is None:
        return None
    home, asked, folder = found
    names = pyfuncitem._fixtureinfo.argnames
    values = {name: pyfuncitem.funcargs[name] for name in names}
    home.call(pyfuncitem.function, folder=folder, window=asked["window"], **values)
    if asked["quiet"]:
        # An object that refuses its input fails its recompute by an InputError, or a kind of it as ProgramError,
        # which FreeCAD prints so.
        ends = [end for end in TRACEBACK.findall(home.output) if not REFUSED.search(end)]
        assert not ends, home.output
    return True


def pytest_sessionfinish(session):
    for home in session.stash.get(_shared, {}).values():
        home.close()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item):
    report = (yield).get_result()
    if report.failed:
        report.sections.append(("To run it alone", f'/usr/bin/python3 -m pytest "{item.nodeid}"'))
