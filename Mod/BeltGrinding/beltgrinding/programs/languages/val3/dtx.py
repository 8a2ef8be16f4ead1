"""Data of Stäubli VAL3 in a .dtx file."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any, TypeAlias

from ...program import Fact, Unknown
from ..xml_tree import Element
from .data import CONFIG, MDESC, POSED, TRSF, Array, Missing, initial, number, trsf

Notes: TypeAlias = list[tuple[int, Fact]]  # lines, and what is wrong there

MAX_SIZE = 1_000_000  # elements of all data
MAX_DIMENSIONS = 3  # VAL3 has no more
NUMBER = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")


def load(root: Element, file: str) -> tuple[dict[str, Array], Notes]:
    """Arrays by name, and notes (line, Fact), of a .dtx's root Element."""
    arrays: dict[str, Array] = {}
    notes: Notes = []
    total = 0
    holder = root.find("Datas") if root.tag == "Database" else None
    if holder is None:
        fact = Fact(
            "programs.val3.no_dtx",
            "<{tag}> is no VAL3 data of s7 or later; save it with those",
            tag=root.tag,
        )
        notes.append((root.line, fact))
        return arrays, notes
    for data in holder.children:
        name, kind = data.get("name", ""), data.get("type", "")
        if data.tag != "Data" or not name:
            continue
        size = data.get("size", "1")
        count = product_of(size, MAX_SIZE + 1)
        total += max(count, len(data.children))
        if total > MAX_SIZE:
            fact = Fact(
                "programs.val3.size_of",
                "{name}: the size '{text}' is not sensible",
                name=name,
                text=size[:20],
            )
            notes.append((data.line, fact))
            arrays[name] = Array(
                kind,
                Missing("programs.val3.no_sensible_size", "{name} has no sensible size", name=name),
            )
            break
        arrays[name] = array_of(data, name, file, count, notes)
    return arrays, notes


def array_of(data: Element, name: str, file: str, count: int, notes: Notes) -> Array:
    """The Array of a <Data>, or of a <Field> of one, with ``count`` elements; ``notes`` gets what is wrong."""
    kind, size = data.get("type", ""), data.get("size", "1")
    if _form(data) == "collection" or "," in size:
        return Array(kind, {child.get("key", ""): child for child in data.children}, file)
    items: list[Any] = [None] * max(count, 1)
    before = len(notes)
    for child in data.children:
        key = child.get("key", "")
        if not (key.isascii() and key.isdigit() and len(key) < 8 and int(key) < len(items)):
            fact = Fact(
                "programs.val3.no_element",
                "{name} has no element '{index}'",
                name=name,
                index=key[:20],
            )
            notes.append((child.line, fact))
            continue
        if items[int(key)] is not None:
            fact = Fact(
                "programs.val3.twice", "{name}[{index}] is given twice", name=name, index=key
            )
            notes.append((child.line, fact))
            child = Missing(
                "programs.val3.given_twice",
                "{name}[{index}] is given twice in {file}",
                name=name,
                index=key,
                file=file,
            )
        items[int(key)] = child
    if len(notes) > before:  # what is absent may be what the damaged ones were
        lost = Missing(
            "programs.val3.damaged_elements",
            "{name} has damaged elements in {file}",
            name=name,
            file=file,
        )
        items = [lost if item is None else item for item in items]
    return Array(kind, items, file)


def product_of(text: str, otherwise: int) -> int:
    """The product of the sizes in 'n,m,...'; ``otherwise`` where one is no number, or they are too many."""
    sizes = text.split(",", MAX_DIMENSIONS)
    if len(sizes) > MAX_DIMENSIONS:
        return otherwise
    return math.prod(
        int(s) if s.isascii() and s.isdigit() and len(s) < 8 else otherwise for s in sizes
    )


def _form(data: Element) -> str:
    return next((v for k, v in data.attributes.items() if k.endswith(":type")), "array")


def parsed(kind: str, element: Element, file: str, frame_of: Callable[[str, str], Any]) -> Any:
    """The value of a <Value> of a .dtx. ``frame_of(text)`` gives the father 'name[index]'.

    Raises Unknown naming file and line.
    """
    value = initial(kind)
    if isinstance(value, Missing):
        return value
    given = element.attributes

    def figure(name: str, default: float = 0.0) -> float:
        text = given.get(name)
        if text is None:
            return default
        if not NUMBER.fullmatch(text.strip()):
            raise Unknown(
                "programs.val3.no_number",
                "{file}:{line}: {name}='{text}' is no number",
                file=file,
                line=element.line,
                name=name,
                text=text[:20],
            )
        return number(float(text))

    if kind == "num":
        return figure("value", 0.0)
    if kind == "bool":
        text = given.get("value", "false").lower()
        if text not in ("true", "false"):
            raise Unknown(
                "programs.val3.no_truth_value",
                "{file}:{line}: '{text}' is neither true nor false",
                file=file,
                line=element.line,
                text=text[:20],
            )
        return text == "true"
    if kind == "string":
        return given.get("value", "")[:10_000]
    fields = value.fields
    if kind == "mdesc":
        for name, default in MDESC.items():
            other = {"tvel": "tmax", "rvel": "rmax"}.get(name, name)
            if isinstance(default, str):
                fields[name] = given.get(name, default)
            else:
                fields[name] = figure(name if name in given else other, default)
        return value
    if kind in POSED or kind == "trsf":
        odd = [name for name in given if len(name) < 3 and name not in TRSF]
        if odd:  # a zero is left out: a damaged name must not become one
            raise Unknown(
                "programs.val3.odd_component",
                "{file}:{line}: {name} is no component of a {kind}",
                file=file,
                line=element.line,
                name=odd[0],
                kind=kind,
            )
    if kind in POSED:
        fields["trsf"] = trsf(list(map(figure, TRSF)))
        if value.kind == "point":
            fields["config"].fields.update((name, given.get(name, "")) for name in CONFIG)
        value.father = frame_of(given.get("fatherId", ""), value.kind)
        return value
    fields.update((name, figure(name, 0.0)) for name in fields)
    return value
