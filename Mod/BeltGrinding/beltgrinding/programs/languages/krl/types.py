"""KRL's types as far as they matter: which component is an INT, a REAL, a truth value; what a routine declares."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Optional
from typing import TypeAlias

PLACE: dict[str, Optional[str]] = dict.fromkeys("x y z a b c".split(), "real")
TURNS: dict[str, Optional[str]] = dict.fromkeys("s t".split(), "int")
EXTERNAL: dict[str, Optional[str]] = {f"e{k}": "real" for k in range(1, 7)}
JOINTS: dict[str, Optional[str]] = {f"a{k}": "real" for k in range(1, 7)}
Structures: TypeAlias = dict[str, dict[str, Optional[str]]]  # {type: {component: type}}

STRUCTURES: Structures = {
    "frame": PLACE,
    "pos": {**PLACE, **TURNS},
    "e3pos": {**PLACE, **TURNS, **EXTERNAL},
    "e6pos": {**PLACE, **TURNS, **EXTERNAL},
    "axis": JOINTS,
    "e3axis": {**JOINTS, **EXTERNAL},
    "e6axis": {**JOINTS, **EXTERNAL},
    "cp": dict.fromkeys("cp ori1 ori2".split(), "real"),
    "apo": dict.fromkeys("cdis cptp cvel cori cspl".split(), "real"),
    "load": {"m": "real", "cm": "frame", "j": None},
}
EVERYWHERE = {
    **PLACE,
    **TURNS,
    **EXTERNAL,
    **JOINTS,
}  # what such names mean in a type that is not known
TARGET = frozenset(EVERYWHERE)  # the components that a motion's target may have
SIMPLE = frozenset("int real bool char".split())
WORDS = SIMPLE | frozenset(name for name in STRUCTURES if name not in ("cp", "apo", "load")) | {
    "fdat", "ldat", "pdat", "signal", "channel",
}  # fmt: skip
DECLARATION = re.compile(
    r"^((?:(?:GLOBAL|DECL|CONST)\s+)*)(\w+)\s+(\$?\w[\w$]*\s*(?:\[[^\]]*\]\s*)?(?:[,=].*)?)$",
    re.IGNORECASE,
)
INDICES = re.compile(r"\[[^\[\]]*\]")
STRUC = re.compile(r"^(?:GLOBAL\s+)?STRUC\s+(\w+)\s+(.*)$", re.IGNORECASE)


def component_kind(kind: Optional[str], name: str, structures: Structures) -> Optional[str]:
    """The type of a component of a type; None where it is not known."""
    known = structures.get(kind or "") or STRUCTURES.get(kind or "")
    return known.get(name) if known is not None else EVERYWHERE.get(name)


def holds(kind: Optional[str], name: str, structures: Structures) -> bool:
    """Whether a type may have such a component."""
    known = structures.get(kind or "") or STRUCTURES.get(kind or "")
    return known is None or name in known


def declaration(text: str) -> tuple[str, list[str]] | None:
    """(type in lower case, names) of a declaration, whether it gives a value or not; else None."""
    match = DECLARATION.match(text)
    if match is None:
        return None
    words, kind, rest = match.group(1), match.group(2).lower(), match.group(3)
    if kind in ("struc", "enum", "def", "deffct") or not (words or kind in WORDS):
        return None
    names = INDICES.sub("", rest.partition("=")[0]).lower().split(",")
    return kind, [name.strip() for name in names]


def structure(text: str) -> tuple[str, dict[str, Optional[str]]] | None:
    """(name, {component: type}) of a STRUC, whose components share a type until another is named; or None."""
    match = STRUC.match(text)
    if match is None:
        return None
    components: dict[str, Optional[str]] = {}
    kind: Optional[str] = None
    for part in INDICES.sub("", match.group(2)).lower().split(","):
        *before, name = part.split() or [""]
        kind = before[-1] if before else kind
        components[name] = kind
    return match.group(1).lower(), components
