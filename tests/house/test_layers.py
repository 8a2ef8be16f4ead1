"""The layers of the Python package: docs/layers.md's table against what is really imported.

All imports count, those inside functions too. What is imported by being a folder above (a package's
``__init__`` when one of its modules is imported) does not: these are what macros call, and nothing
inside the package may name them.
"""

import ast
import re
import sys
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "Mod" / "BeltGrinding" / "beltgrinding"
NAME = PACKAGE.name
FREECAD = {"FreeCAD", "Draft", "Inspection", "Mesh", "Part", "Path", "Robot", "Spreadsheet"}
WINDOW = {"FreeCADGui", "PySide", "PySide2", "PySide6", "pivy"}
# Layers that see a document, and those that see the window.
WITH_FREECAD = {"engine", "examples", "objects"}
WITH_WINDOW = {"gui"}
# Callbacks that the package itself hands down to a lower layer: see its __init__.
PACKAGE_ITSELF = "beltgrinding"


@lru_cache(maxsize=None)
def modules():
    """{dotted name: path}, packages by their own name."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@lru_cache(maxsize=None)
def imports():
    """{module: (our modules that it imports, foreign packages)}."""
    found = {}
    for module, path in modules().items():
        package = module if path.name == "__init__.py" else module.rpartition(".")[0]
        ours, foreign = set(), set()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            for name in _imported(node, package):
                if name == NAME or name.startswith(NAME + "."):
                    ours.add(name)
                else:
                    foreign.add(name.partition(".")[0])
        found[module] = ours, foreign
    return found


def _imported(node, package):
    """The modules that a statement imports; of ``from package import name`` the module ``name`` if it
    is one, else the package."""
    if isinstance(node, ast.Import):
        for alias in node.names:
            yield alias.name
    elif isinstance(node, ast.ImportFrom):
        parts = package.split(".")
        parts = parts[: len(parts) - node.level + 1] if node.level else []
        origin = ".".join([*parts, *([node.module] if node.module else [])])
        for alias in node.names:
            whole = f"{origin}.{alias.name}"
            yield whole if whole in modules() else origin


def table():
    """{layer: layers that it may import}, in the order of docs/layers.md."""
    text = (ROOT / "docs" / "layers.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([\w./]+)` \| [^|]* \| ([^|]*) \|$", text, re.MULTILINE)
    assert rows, "docs/layers.md has no table of layers"
    return {
        _layer_name(place): {_layer_name(name) for name in re.findall(r"`([\w./]+)`", allowed)}
        for place, allowed in rows
    }


def _layer_name(place):
    return place.rstrip("/").removesuffix(".py").replace("/", ".")


def layer_of(module, layers):
    """The layer of a module: the longest of the names that it begins with."""
    inside = module.removeprefix(NAME).removeprefix(".")
    while inside and inside not in layers:
        inside = inside.rpartition(".")[0]
    return inside or PACKAGE_ITSELF


def circles(graph):
    """Strongly connected sets of more than one node (Tarjan 1972), and nodes that name themselves."""
    index, low, stack, found = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in graph.get(node, ()):
            if other not in index:
                visit(other)
                low[node] = min(low[node], low[other])
            elif other in stack:
                low[node] = min(low[node], index[other])
        if low[node] == index[node]:
            cut = stack.index(node)
            if len(stack) - cut > 1 or node in graph.get(node, ()):
                found.append(sorted(stack[cut:]))
            del stack[cut:]

    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(max(limit, 10 * len(graph) + 100))
    for node in graph:
        if node not in index:
            visit(node)
    sys.setrecursionlimit(limit)
    return found


def used():
    """{layer: {layer that it imports: one of the imports}}."""
    layers = table()
    found = {}
    for module, (ours, _) in imports().items():
        layer = layer_of(module, layers)
        found.setdefault(layer, {})
        for other in sorted(ours):
            target = layer_of(other, layers)
            if target != layer:
                found[layer].setdefault(target, f"{module} imports {other}")
    return found


def test_circles_are_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}}) == [["a", "b", "c"]]
    assert circles({"a": {"a"}}) == [["a"]]
    assert circles({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == []


def test_the_statements_are_understood():
    def of(text, package):
        return [n for node in ast.walk(ast.parse(text)) for n in _imported(node, package)]

    assert of("from ..job import load as jobs, poses", f"{NAME}.cell") == [
        f"{NAME}.job.load",
        f"{NAME}.job.poses",
    ]
    assert of("def f():\n    from . import core", f"{NAME}.engine") == [f"{NAME}.engine"]
    assert of("from .files import write_whole", f"{NAME}.base") == [f"{NAME}.base.files"]
    assert of("import numpy.linalg", NAME) == ["numpy.linalg"]


def test_no_module_imports_itself_by_way_of_others():
    assert circles({module: ours for module, (ours, _) in imports().items()}) == []


def test_nothing_inside_imports_the_package_itself():
    asking = [m for m, (ours, _) in imports().items() if NAME in ours]
    assert asking == [], "what macros call is not for the package's own modules: import from engine"


def test_every_layer_imports_what_the_table_says():
    layers = table()
    real = used()
    real.pop(PACKAGE_ITSELF)  # it may import all
    assert set(real) == set(layers)
    for layer, allowed in layers.items():
        wrong = [how for target, how in real[layer].items() if target not in allowed]
        assert not wrong, f"{layer} may not: {wrong}"
        idle = allowed - set(real[layer])
        assert not idle, f"docs/layers.md lets {layer} import {sorted(idle)}; it does not"


def test_a_layer_sees_only_those_above_it_in_the_table():
    layers = list(table())
    for layer, allowed in table().items():
        below = [other for other in allowed if layers.index(other) >= layers.index(layer)]
        assert not below, f"{layer} stands above {below}"


def test_freecad_stays_in_its_layers():
    for module, (_, foreign) in imports().items():
        top = module.split(".")[1] if "." in module else ""
        if top not in WITH_FREECAD | WITH_WINDOW:
            assert not foreign & FREECAD, f"{module} imports {foreign & FREECAD}"
        if top not in WITH_WINDOW:
            assert not foreign & WINDOW, f"{module} imports {foreign & WINDOW}"


def test_what_documents_store_is_found():
    """Classes that documents of 0.1.0 name: FreeCAD imports them by these paths."""
    text = {module: path.read_text(encoding="utf-8") for module, path in modules().items()}
    for module in ("deviation_view", "ground_mesh_view", "section_view"):
        assert f"from .views.{module} import" in text[f"{NAME}.gui.{module}"]
    providers = text[f"{NAME}.gui.views.providers"]
    for name in re.findall(r'VIEW = "(\w+)"', "\n".join(text.values())):
        assert f'"{name}"' in providers, f"gui.views has no {name}"


@lru_cache(maxsize=None)
def _names(path):
    """What a module binds at its top: definitions, imports, assignments."""
    found = set()
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        for part in (
            ast.walk(node) if not isinstance(node, (ast.FunctionDef, ast.ClassDef)) else [node]
        ):
            if isinstance(part, (ast.FunctionDef, ast.ClassDef)):
                found.add(part.name)
            elif isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store):
                found.add(part.id)
            elif isinstance(part, ast.alias):
                found.add((part.asname or part.name).partition(".")[0])
    return found


def test_what_is_taken_from_a_module_of_ours_is_there():
    """A moved name is missed only when its line runs, which may be in nobody's test."""
    lazy = {NAME, f"{NAME}.engine"}
    missing = []
    for module, path in modules().items():
        package = module if path.name == "__init__.py" else module.rpartition(".")[0]
        tree = ast.parse(path.read_text(encoding="utf-8"))
        bound = {}
        for node in ast.walk(tree):
            if not isinstance(node, ast.ImportFrom):
                continue
            for alias, whole in zip(node.names, _imported(node, package)):
                if whole.rpartition(".")[2] == alias.name and whole in modules():
                    bound[alias.asname or alias.name] = whole
                elif whole in modules() and whole not in lazy and alias.name != "*":
                    if alias.name not in _names(modules()[whole]):
                        missing.append(f"{module}: {whole} has no {alias.name}")
        stored = {
            n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)
        }
        stored |= {n.arg for n in ast.walk(tree) if isinstance(n, ast.arg)}
        for node in ast.walk(tree):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                whole = bound.get(node.value.id)
                if whole and whole not in lazy and node.value.id not in stored:
                    inside = f"{whole}.{node.attr}" in modules()
                    if not inside and node.attr not in _names(modules()[whole]):
                        missing.append(f"{module}:{node.lineno}: {whole} has no {node.attr}")
    assert missing == []


def test_every_package_has_what_it_promises():
    """``__all__`` of each module names what the module defines or imports."""
    lacking = []
    for module, path in modules().items():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        promised, there = [], set()
        for node in tree.body:
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                there |= {(name.asname or name.name).split(".")[0] for name in node.names}
            elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                there.add(node.name)
            elif isinstance(node, ast.Assign):
                there |= {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
                if any(isinstance(t, ast.Name) and t.id == "__all__" for t in node.targets):
                    promised = ast.literal_eval(node.value)
        lazy = any(isinstance(n, ast.FunctionDef) and n.name == "__getattr__" for n in tree.body)
        lacking += [f"{module}.{name}" for name in promised if name not in there and not lazy]
    assert not lacking
