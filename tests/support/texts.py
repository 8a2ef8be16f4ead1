"""The texts of the workbench that are translated, found in its sources."""

import ast
import re
import string
import xml.etree.ElementTree as tree

MARKED = ("translate", "QT_TRANSLATE_NOOP")


def marked(folder):
    """{(context, text): "file:line"} of all marked texts; raises ValueError for one that is no
    literal, which lupdate would not see.
    """
    found = {}
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.Call) or _name(node.func) not in MARKED:
                continue
            if len(node.args) == 1:  # str.translate
                continue
            where = f"{path.relative_to(folder)}:{node.lineno}"
            texts = [a.value for a in node.args[:2] if isinstance(a, ast.Constant)]
            if len(texts) != 2 or not all(isinstance(text, str) for text in texts):
                raise ValueError(f"{where}: a text to be translated must be a literal")
            found[tuple(texts)] = where
    return found


def _name(node):
    return getattr(node, "id", getattr(node, "attr", ""))


def translations(path):
    """{(context, text): translation, '' for none} of a .ts file."""
    found = {}
    for context in tree.parse(path).getroot().iter("context"):
        for message in context.iter("message"):
            answer = message.find("translation")
            done = answer is not None and answer.get("type") is None
            text = (answer.text or "") if done else ""
            found[context.findtext("name"), message.findtext("source")] = text
    return found


def placeholders(text):
    """What str.format puts in: a sorted list of (name, conversion, format)."""
    return sorted((name, how or "", form) for _, name, form, how in _fields(text))


def _fields(text):
    return [field for field in string.Formatter().parse(text) if field[1] is not None]


def mistakes(folder, path):
    """What is wrong with the .ts file ``path`` for the sources in ``folder``: a list of lines."""
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
