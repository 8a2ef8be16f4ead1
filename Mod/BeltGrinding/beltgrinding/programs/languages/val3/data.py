"""Data of Stäubli VAL3: types, values and the .dtx file they are kept in.

A trsf is x, y, z in mm (or the application's unit) and rx, ry, rz in degrees, the rotation being
Rx(rx) Ry(ry) Rz(rz): about x, then the new y, then the new z (VAL3 Reference Manual, version 5.3,
D28062804A, chapter "Arm positions", trsf type; public post-processors write the same).
The manual's chapter "Movement control", mdesc type: tvel, rvel are tmax, rmax in the .dtx.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from ....base.kinds import Floats
from ...program import Fact, Reason, Unknown

Six: TypeAlias = Any  # six floats: a position and three angles in degrees
Rows: TypeAlias = list[list[float]]  # of a rotation, three by three

MAX_LENGTH = 1e6  # mm; a robot's world ends before
TRSF = ("x", "y", "z", "rx", "ry", "rz")
CONFIG = ("shoulder", "elbow", "wrist")
NO_LIMIT = 9999.0  # mm/s; controllers write 9999 or 99999 for a speed without limit
MDESC: dict[str, Any] = {
    "accel": 100.0,
    "vel": 100.0,
    "decel": 100.0,
    "tvel": 99999.0,
    "rvel": 99999.0,
    "blend": "off",
    "leave": 50.0,
    "reach": 50.0,
}
SIMPLE: dict[str, Any] = {"num": 0.0, "bool": False, "string": ""}
JOINTS = {"joint": 6, "jointRx": 6, "jointRs": 4}
POSED = {"point": "point", "pointRx": "point", "pointRs": "point", "frame": "frame", "tool": "tool"}
WORDS = frozenset(
    "lefty righty ssame sfree epositive enegative esame efree wpositive wnegative wsame wfree "
    "off joint cartesian Cartesian".split()
)


class Missing(Reason):
    """The place of a value that is not known; ``why``, a Fact, says why."""

    @property
    def why(self) -> Fact:
        return self.fact


class Record:
    """A structured value: ``fields`` by name; points, frames and tools have a ``father``: the
    Record of a frame, None for world and flange, or Missing."""

    __slots__ = ("kind", "fields", "father", "name")

    def __init__(
        self, kind: str, fields: dict[str, Any], father: Any = None, name: str = ""
    ) -> None:
        self.kind, self.fields, self.father, self.name = kind, fields, father, name

    def get(self, field: str) -> Any:
        value = self.fields.get(field)
        if isinstance(value, Missing):
            raise Unknown(value.why)
        if value is None:
            raise Unknown(
                "programs.val3.type_without_field",
                "a {kind} has no field {field}",
                kind=self.kind,
                field=field,
            )
        return value


class Array:
    """Data of one type: ``items`` is a list, or a dict of a collection. An item is a value, an
    Element of the .dtx ``file`` not read yet, or Missing."""

    __slots__ = ("kind", "items", "file")

    def __init__(self, kind: str, items: Any, file: str = "") -> None:
        self.kind, self.items, self.file = kind, items, file


def copied(value: Any) -> Any:
    """A value of its own; a point's father stays the same frame."""
    if isinstance(value, Array):
        items = value.items
        if isinstance(items, dict):
            items = {key: copied(one) for key, one in items.items()}
        elif isinstance(items, list):
            items = [copied(one) for one in items]
        return Array(value.kind, items, value.file)
    if not isinstance(value, Record):
        return value
    fields = {name: copied(field) for name, field in value.fields.items()}
    return Record(value.kind, fields, value.father, value.name)


def initial(kind: str) -> Any:
    """The value VAL3 gives data without one; Missing for the controller's and the user's types."""
    if kind in SIMPLE:
        return SIMPLE[kind]
    if kind == "trsf":
        return trsf((0.0,) * 6)
    if kind in POSED:
        return posed(kind, (0.0,) * 6)
    if kind in JOINTS:
        return Record("joint", {f"j{k + 1}": 0.0 for k in range(JOINTS[kind])})
    if kind == "mdesc":
        return Record("mdesc", dict(MDESC))
    if kind == "config":
        return Record("config", dict.fromkeys(CONFIG, ""))
    return Missing(
        "programs.type_of_controller",
        "data of the type {kind} is known to the controller only",
        kind=kind,
    )


def trsf(values: Sequence[float]) -> Record:
    return Record("trsf", dict(zip(TRSF, values)))


def posed(kind: str, values: Sequence[float], father: Any = None) -> Record:
    """A point, frame or tool."""
    fields: dict[str, Any] = {"trsf": trsf(values)}
    if POSED[kind] == "point":
        fields["config"] = Record("config", dict.fromkeys(CONFIG, ""))
    return Record(POSED[kind], fields, father)


def number(value: object) -> float:
    """``value`` if it is a finite number; raises Unknown."""
    if type(value) is float and math.isfinite(value):
        return value
    if isinstance(value, Missing):
        raise Unknown(value.why)
    if type(value) is float:
        raise Unknown("programs.number_not_finite", "the number is not finite")
    raise Unknown("programs.number_expected", "a number expected")


def as_kind(kind: str, value: Any) -> Any:
    """A value of the type ``kind`` made of ``value``, which may be a literal {..}. Raises Unknown."""
    if isinstance(value, list):
        return _literal(kind, value)
    expected = initial(kind)
    if isinstance(expected, Missing):
        if isinstance(value, Record) and value.kind == kind:  # of a user type
            return copied(value)
        raise Unknown(expected.why)
    if type(value) is not type(expected) or getattr(value, "kind", 0) != getattr(
        expected, "kind", 0
    ):
        raise Unknown("programs.val3.type_expected", "a {kind} expected", kind=kind)
    return copied(value)


def _literal(kind: str, values: Sequence[Any]) -> Record:
    value = initial(kind)
    if isinstance(value, Missing):
        raise Unknown(value.why)
    if not isinstance(value, Record) or len(values) > len(value.fields):
        raise Unknown("programs.val3.literal", "the literal is no {kind}", kind=kind)
    if kind in ("trsf", *JOINTS) and len(values) != len(value.fields):
        raise Unknown(
            "programs.val3.literal_components",
            "a {kind} has {count} components, not {given}",
            kind=kind,
            count=len(value.fields),
            given=len(values),
        )
    for name, given in zip(value.fields, values):
        before = value.fields[name]
        if isinstance(before, Record):
            given = as_kind(before.kind, given)
        elif type(given) is not type(before):
            raise Unknown(
                "programs.val3.literal_field",
                "the literal's {name} is no {kind}'s",
                name=name,
                kind=kind,
            )
        value.fields[name] = given
    return value


def weight(value: Any) -> int:
    """How many values a value of a user type has, those of its elements aside."""
    if isinstance(value, Array):
        return len(value.items) if isinstance(value.items, (list, dict)) else 1
    return sum(map(weight, value.fields.values())) if isinstance(value, Record) else 1


def six(record: object) -> Six:
    """The components of a trsf as six finite floats. Raises Unknown."""
    if not isinstance(record, Record) or record.kind != "trsf":
        raise Unknown("programs.val3.trsf_expected", "a trsf expected")
    values = tuple(record.fields.values())
    for value in values:
        number(value)
    if max(values) > MAX_LENGTH or min(values) < -MAX_LENGTH:
        raise Unknown(
            "programs.val3.far_position",
            "{value:g} is no robot's position",
            value=max(values, key=abs),
        )
    return values


def matrix(values: Six) -> tuple[Rows, list[float]]:
    """Rotation rows (3 lists) and position of six components."""
    x, y, z = values[:3]
    rx, ry, rz = (math.radians(v) for v in values[3:])
    cx, sx, cy, sy, cz, sz = (f(v) for v in (rx, ry, rz) for f in (math.cos, math.sin))
    return [
        [cy * cz, -cy * sz, sy],
        [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
        [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy],
    ], [x, y, z]


def components(rotation: Rows, position: Sequence[float]) -> Six:
    """Six components of a rotation and a position; at ry = +-90 degrees rx is 0."""
    horizontal = math.hypot(rotation[0][0], rotation[0][1])
    ry = math.atan2(rotation[0][2], horizontal)
    if horizontal > 1e-9:
        rx = math.atan2(-rotation[1][2], rotation[2][2])
        rz = math.atan2(-rotation[0][1], rotation[0][0])
    else:
        rx, rz = 0.0, math.atan2(rotation[1][0], rotation[1][1])
    return (*position, *(math.degrees(v) for v in (rx, ry, rz)))


def product(a: Six, b: Six) -> Six:
    """Six components of the trsf a * b."""
    (ra, pa), (rb, pb) = matrix(a), matrix(b)
    position = [pa[i] + sum(ra[i][k] * pb[k] for k in range(3)) for i in range(3)]
    rotation = [[sum(ra[i][k] * rb[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return components(rotation, position)


def inverse(a: Six) -> Six:
    """Six components of the inverse trsf."""
    r, p = matrix(a)
    back = [[r[k][i] for k in range(3)] for i in range(3)]
    return components(back, [-sum(back[i][k] * p[k] for k in range(3)) for i in range(3)])


def frames(rows: Sequence[Six]) -> Floats:
    """(n, 4, 4) of n rows of six components, lengths as given."""
    values = np.asarray(rows, dtype=float).reshape(-1, 6)
    angles = np.radians(values[:, 3:])
    cx, cy, cz = np.cos(angles).T
    sx, sy, sz = np.sin(angles).T
    result = np.zeros((len(values), 4, 4))
    result[:, 0, :3] = np.stack([cy * cz, -cy * sz, sy], 1)
    result[:, 1, :3] = np.stack([cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy], 1)
    result[:, 2, :3] = np.stack([sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy], 1)
    result[:, :3, 3] = values[:, :3]
    result[:, 3, 3] = 1.0
    return result


def in_world(record: Any, depth: int = 0) -> Six:
    """Six components of a point or frame in the world, through the chain of its frames."""
    for value in (record, getattr(record, "father", None)):
        if isinstance(value, Missing):
            raise Unknown(value.why)
    own = six(record.get("trsf"))
    if record.father is None:
        return own
    if depth > 20:
        raise Unknown(
            "programs.val3.circle_or_chain",
            "the frames hang on each other in a circle, or the chain is too long",
        )
    return product(in_world(record.father, depth + 1), own)


def words(values: Six) -> str:
    return " ".join(f"{k.upper()} {round(v, 6) + 0.0:g}" for k, v in zip(TRSF, values))
