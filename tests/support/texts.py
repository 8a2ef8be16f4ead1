"""The texts of the workbench that are translated, found in its sources."""

import ast
import json
import re
import string
from pathlib import Path

MARKED = ("translate", "QT_TRANSLATE_NOOP")
COMMAND = "Command"  # a row of gui/commands: its name, what the menu says, what the tip says
PROPERTY = "App::Property"  # the context in which FreeCAD looks for what is said of a property
TABLES = (
    "SETTINGS",
    "LISTS",
    "LINKS",
    "HELD",
    "PICTURES",
    "FRAMES",
    "BODIES",
    "ROBOT_FRAMES",
)  # their rows end so
SCHEMAS = Path(__file__).resolve().parents[2] / "Resources" / "schema"


def marked(folder):
    """{(context, text): "file:line"} of all marked texts and of what is said of properties; raises
    ValueError for a marked one that is no literal, which nobody can list.
    """
    found = described(folder)
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call):
                continue
            if _name(node.func) == COMMAND and path.parent.name == "commands":
                for text in node.args[1:3]:
                    where = f"{path.relative_to(folder)}:{text.lineno}"
                    found[f"BeltGrinding_{node.args[0].value}", text.value] = where
            if _name(node.func) not in MARKED:
                continue
            if len(node.args) == 1:  # str.translate
                continue
            where = f"{path.relative_to(folder)}:{node.lineno}"
            texts = [a.value for a in node.args[:2] if isinstance(a, ast.Constant)]
            if len(texts) != 2 or not all(isinstance(text, str) for text in texts):
                raise ValueError(f"{where}: a text to be translated must be a literal")
            found[tuple(texts)] = where
    return found


def described(folder):
    """{(PROPERTY, text): "file:line"} of what is said of the objects' properties: by themselves, or by
    the schema's description of their key.
    """
    found = {}
    for path in sorted((folder / "beltgrinding").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            for text in _descriptions(node, path.parent.name == "objects"):
                found[PROPERTY, text] = f"{path.relative_to(folder)}:{node.lineno}"
    return found


def _descriptions(node, of_objects):
    if isinstance(node, ast.Call) and len(node.args) > 3:
        name, given = _name(node.func), node.args[3]
        if isinstance(given, ast.Constant) and isinstance(given.value, str):
            if name == "Key":
                yield _description(given.value)
            elif name in ("Output", "addProperty", "add"):
                yield given.value
    elif of_objects and isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
        if node.targets[0].id == "text" and isinstance(node.value, ast.Constant):
            yield node.value.value
        if node.targets[0].id in TABLES:
            rows = node.value.values if isinstance(node.value, ast.Dict) else node.value.elts
            yield from (row.elts[-1].value for row in rows)


def _description(key):
    """What the schema says of a job's dotted key, or of a raster path's, a plan's or a study's."""
    first, _, rest = key.partition(".")
    own = first in ("raster", "plan", "study")
    name, parts = (first, rest.split(".")) if own else ("job", key.split("."))
    node = json.loads((SCHEMAS / f"{name}.schema.json").read_text(encoding="utf-8"))
    for part in parts:
        if not part.isdigit():
            node = (node["items"] if node.get("type") == "array" else node)["properties"][part]
    return node["description"]


def _name(node):
    return getattr(node, "id", getattr(node, "attr", ""))


def translations(path):
    """{(context, text): translation} of what a language's messages hold for the window."""
    held = json.loads(path.read_text(encoding="utf-8"))["window"]
    return {
        (context, text): told for context, texts in held.items() for text, told in texts.items()
    }


def placeholders(text):
    """What str.format puts in: a sorted list of (name, conversion, format)."""
    return sorted((name, how or "", form) for _, name, form, how in _fields(text))


def _fields(text):
    return [field for field in string.Formatter().parse(text) if field[1] is not None]


def mistakes(folder, path):
    """What is wrong with the messages' file ``path`` for the sources in ``folder``: a list of lines."""
    sources, answers = marked(folder), translations(path)
    wrong = [
        f"{sources[key]}: no translation of {key[1]!r}" for key in sources if not answers.get(key)
    ]
    wrong += [f"{path.name}: {key[1]!r} is no longer used" for key in answers if key not in sources]
    for key, answer in answers.items():
        if key not in sources or not answer:
            continue
        where = f"{sources[key]}: {key[1]!r} became {answer!r}"
        if placeholders(key[1]) != placeholders(answer):
            wrong.append(f"{where}: other placeholders")
        if len(re.findall(r"\.\.\.$|:$|\n", key[1])) != len(re.findall(r"\.\.\.$|:$|\n", answer)):
            wrong.append(f"{where}: other line breaks, dots or colon")
        if key[1].startswith(" ") != answer.startswith(" ") or key[1].endswith(
            " "
        ) != answer.endswith(" "):
            wrong.append(f"{where}: other spaces at its ends")
    return wrong
