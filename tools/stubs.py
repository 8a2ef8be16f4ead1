#!/usr/bin/env python3
"""Writes src/python/stubs: what mypy knows of the compiled modules, from what these say of themselves.

    tools/stubs.py             writes the files again
    tools/stubs.py --check     fails where a file says another thing than its module

A signature is read from a docstring of pybind11, and what facts.py adds from its source.
"""

import ast
import importlib
import inspect
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "src" / "python" / "stubs"
MODULES = ("beltgrinding_core", "beltgrinding_coin", "beltgrinding_scan")
HEAD = """# Made by tools/stubs.py from {name}: what mypy knows of it. Do not edit.
import builtins
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, SupportsIndex, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
"""
PLAIN = {
    "dict": ("Mapping[str, Any]", "dict[str, Any]"),
    "list": ("list[Any]", "list[Any]"),
    "tuple": ("tuple[Any, ...]", "tuple[Any, ...]"),
    "object": ("Any", "Any"),
    "int": ("SupportsIndex", "int"),
    "function": ("Callable[..., Any]", "Callable[..., Any]"),
    "bytes": ("builtins.bytes", "builtins.bytes"),  # of a class with a member of that name
    "os.PathLike": ("str | os.PathLike[str]", "str"),
    "array": ("ArrayLike", "NDArray[Any]"),
    "numpy.ndarray": ("ArrayLike", "NDArray[Any]"),
}  # as pybind11 calls a type: (what it takes, what it gives)


def pieces(text):
    """The parts of a text between commas that stand in no bracket or string."""
    found, depth, quote, begin = [], 0, "", 0
    for at, sign in enumerate(text):
        if quote:
            quote = "" if sign == quote else quote
        elif sign in "'\"":
            quote = sign
        elif sign in "([{":
            depth += 1
        elif sign in ")]}":
            depth -= 1
        elif sign == "," and depth == 0:
            found.append(text[begin:at].strip())
            begin = at + 1
    return [one for one in [*found, text[begin:].strip()] if one]


def type_of(text, taken):
    """A type of pybind11's docstrings as Python writes it; taken: of an argument."""
    text = re.sub(r"\bbeltgrinding_\w+\.", "", text.strip())
    if text in PLAIN:
        return PLAIN[text][0 if taken else 1]
    outer, _, inner = text.partition("[")
    inside = pieces(inner[:-1])
    if outer == "numpy.ndarray":
        kind = (
            re.match(r"[\w.]+", inside[0])[0].replace("numpy.", "np.").replace("bool", "np.bool_")
        )
        return "ArrayLike" if taken else f"NDArray[{kind}]"
    if outer == "List":
        inside = [re.sub(r"(\w)\[\d+\]$", r"\1", inside[0])]  # an array of so many
        found = f"{'Sequence' if taken else 'list'}[{type_of(inside[0], taken)}]"
        return f"{found} | NDArray[Any]" if taken and inside[0] in ("int", "float") else found
    if outer in ("Tuple", "Dict"):
        outer = "Mapping" if outer == "Dict" and taken else outer.lower()
        return f"{outer}[{', '.join(type_of(one, taken) for one in inside)}]"
    if outer == "Optional":
        return f"{type_of(inside[0], taken)} | None"
    if outer == "Union":
        return " | ".join(type_of(one, taken) for one in inside)
    if outer == "Callable":
        arguments = ", ".join(type_of(one, False) for one in pieces(inside[0][1:-1]))
        return f"Callable[[{arguments}], {type_of(inside[1], taken)}]"
    return text


def argument(text):
    name, _, rest = text.partition(":")
    kind, _, default = rest.partition(" = ")
    kind = type_of(kind, True)
    if default == "None" and "None" not in kind and kind != "Any":
        kind += " | None"
    return f"{name}: {kind}" + (" = ..." if default else "")


def signatures(documentation):
    """The ways to call it that a docstring of pybind11 names: [(arguments, what is given)]."""
    overloaded = "Overloaded function." in documentation
    begin = r"^\d+\. " if overloaded else r"\A"
    return re.findall(begin + r"\w+\((.*?)\) -> (.+?)$", documentation, re.M | re.S)


def function(name, documentation, indent="", static=False):
    lines = []
    ways = signatures(documentation)
    for arguments, given in ways:
        if len(ways) > 1:
            lines.append(f"{indent}@overload")
        if static:
            lines.append(f"{indent}@staticmethod")
        taken = [
            "self" if indent and one.startswith("self:") else argument(one)
            for one in pieces(arguments)
        ]
        lines.append(f"{indent}def {name}({', '.join(taken)}) -> {type_of(given, False)}: ...")
    return lines


def members(kind):
    lines = []
    for name, value in vars(kind).items():
        if name in ("__doc__", "__module__"):
            continue
        if isinstance(value, property):
            given = signatures("x" + (value.fget.__doc__ or ""))[0][1]
            lines += ["    @property", f"    def {name}(self) -> {type_of(given, False)}: ..."]
            if value.fset:
                lines += [
                    f"    @{name}.setter",
                    f"    def {name}(self, value: {type_of(given, True)}) -> None: ...",
                ]
        elif isinstance(value, staticmethod):
            lines += function(name, value.__func__.__doc__, "    ", static=True)
        elif "->" in (getattr(value, "__doc__", None) or ""):
            lines += function(name, value.__doc__, "    ")
        elif isinstance(value, (int, float, str)) and not name.startswith("__"):
            lines.append(f"    {name}: {type(value).__name__}")
    return lines or ["    pass"]


def of_facts():
    """The classes of facts.py, without what their functions do."""
    found = ["Value = int | float | str", "Context = tuple[str, str, dict[str, Value]]"]
    for kind in ast.parse((ROOT / "src/python/facts.py").read_text("utf-8")).body:
        if isinstance(kind, ast.ClassDef):
            kind.body = [one for one in kind.body if not isinstance(one, ast.Expr)]
            for one in kind.body:
                if isinstance(one, ast.FunctionDef):
                    one.body = [ast.Expr(ast.Constant(...))]
            found.append(ast.unparse(kind))
    return found


def stub(module):
    """The text of a module's stub."""
    lines, facts = [HEAD.format(name=module.__name__)], hasattr(module, "Fact")
    if facts and module.__name__ == MODULES[0]:
        lines += of_facts()
    elif facts:
        lines.append(f"from {MODULES[0]} import Fact, InputError")
    for name, value in sorted(vars(module).items()):
        if name.startswith("__") or facts and name in ("Fact", "InputError"):
            continue
        if inspect.isclass(value):
            above = "(Exception)" if issubclass(value, Exception) else ""
            lines += [f"class {name}{above}:", *members(value)]
        elif callable(value):
            lines += function(name, value.__doc__)
        elif isinstance(value, (list, tuple)):
            inside = " | ".join(sorted({type(one).__name__ for one in value}))
            more = ", ..." if isinstance(value, tuple) else ""
            lines.append(f"{name}: {type(value).__name__}[{inside}{more}]")
        else:
            lines.append(f"{name}: {type(value).__name__}")
    return "\n".join(lines) + "\n"


def main(arguments):
    stale = []
    FOLDER.mkdir(exist_ok=True)
    for name in MODULES:
        try:
            text = stub(importlib.import_module(name))
        except ImportError:  # built without Coin, or without what scans need
            continue
        path = FOLDER / f"{name}.pyi"
        if not path.exists() or path.read_text("utf-8") != text:
            stale.append(str(path.relative_to(ROOT)))
            if "--check" not in arguments:
                path.write_text(text, "utf-8")
    if stale and "--check" in arguments:
        return f"{', '.join(stale)}: the module says something else; run tools/stubs.py"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
