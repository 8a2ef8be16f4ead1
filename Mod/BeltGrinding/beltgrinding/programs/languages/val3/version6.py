"""Files of VAL3 s6 and before in the form of s7: their elements have other names, and what s7 says in one is in several.

A point's father stands beside its values there, its configuration in an element of its own (as public
post-processors for s6 and public applications have it).
"""

from __future__ import annotations

from collections.abc import Sequence

from ..xml_tree import Element

NAMES = {
    "programList": "Programs",
    "program": "Program",
    "paramSection": "Parameters",
    "param": "Parameter",
    "localSection": "Locals",
    "local": "Local",
    "code": "Code",
    "project": "Project",
    "parameters": "Parameters",
    "dataSection": "Database",
    "data": "Data",
}
ROOTS = ("programList", "project", "dataList")
FATHERS = ("pFather", "fFather", "tFather")
SOURCE = "source"  # has the code of a program


def as_s7(root: Element) -> Element:
    """The root Element itself, changed where it is one of s6."""
    if root.tag == "dataList":
        _data(root)
    elif root.tag in ROOTS:
        stack = [root]
        while stack:
            element = stack.pop()
            element.tag, element.first = NAMES.get(element.tag, element.tag), None
            if element.get("byVal") == "false":
                element.attributes = {**element.attributes, "use": "reference"}
            element.children = [
                inner
                for child in element.children
                for inner in (child.children if child.tag == SOURCE else (child,))
            ]
            stack += element.children
    return root


def _data(root: Element) -> None:
    """<dataList> of <pointSection> and so on, of <point> and so on."""
    found: list[Element] = []
    for section in root.children:
        for data in section.children:
            kind, fathers = data.tag, [one for one in data.children if one.tag in FATHERS]
            values = [one for one in data.children if one.tag.startswith("value")]
            for value in values:
                _value(value, fathers)
            size = data.get("size") or str(1 + max(map(_index, values), default=0))
            data.tag = "Data"
            data.attributes = {"name": data.get("name", ""), "type": kind, "size": size}
            data.children, data.first = values, None
            found.append(data)
    holder = root.children[0] if root.children else root
    holder.tag, holder.children, holder.first = "Datas", found, None
    root.tag, root.children, root.first = "Database", [holder], None


def _index(value: Element) -> int:
    text = value.get("key", "")
    return int(text) if text.isascii() and text.isdigit() and len(text) < 8 else 0


def _value(value: Element, fathers: Sequence[Element]) -> None:
    """<valuePoint index> with <tpValue x ..>, <cpValue shoulder ..>, as one <Value key x .. shoulder .. fatherId>."""
    attributes = {"key": value.get("index", "")}
    attributes.update((k, v) for k, v in value.attributes.items() if k != "index")
    for one in (*fathers, *value.children):
        if one.tag in FATHERS:
            alias, name = one.get("alias", ""), one.get("name", "")
            index = one.get("fatherIndex", "0")
            father = f"{alias}:{name}" if alias else name
            attributes["fatherId"] = f"{father}[{index}]" if father else ""
        elif one.tag.endswith("Value"):
            attributes.update(one.attributes)
    value.tag, value.attributes, value.children, value.first = "Value", attributes, (), None
