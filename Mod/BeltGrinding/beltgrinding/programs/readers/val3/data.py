"""Data of Stäubli VAL3: types, values and the .dtx file they are kept in.

A trsf is x, y, z in mm (or the application's unit) and rx, ry, rz in degrees, the rotation being
Rx(rx) Ry(ry) Rz(rz): about x, then the new y, then the new z (VAL3 Reference Manual, version 5.3,
D28062804A, chapter "Arm positions", trsf type; public post-processors write the same).
The manual's chapter "Movement control", mdesc type: tvel, rvel are tmax, rmax in the .dtx.
"""

import math
import re

import numpy as np
from ...program import Fact, Reason, Unknown

MAX_SIZE = 1_000_000  # elements of all data
MAX_DIMENSIONS = 3  # VAL3 has no more
MAX_LENGTH = 1e6  # mm; a robot's world ends before
NUMBER = re.compile(r"[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
TRSF = ("x", "y", "z", "rx", "ry", "rz")
CONFIG = ("shoulder", "elbow", "wrist")
NO_LIMIT = 9999.0  # mm/s; controllers write 9999 or 99999 for a speed without limit
MDESC = {
    "accel": 100.0,
    "vel": 100.0,
    "decel": 100.0,
    "tvel": 99999.0,
    "rvel": 99999.0,
    "blend": "off",
    "leave": 50.0,
    "reach": 50.0,
}
SIMPLE = {"num": 0.0, "bool": False, "string": ""}
JOINTS = {"joint": 6, "jointRx": 6, "jointRs": 4}
POSED = {"point": "point", "pointRx": "point", "pointRs": "point", "frame": "frame", "tool": "tool"}
WORDS = frozenset(
    "lefty righty ssame sfree epositive enegative esame efree wpositive wnegative wsame wfree "
    "off joint cartesian Cartesian".split()
)


class Missing(Reason):
    """The place of a value that is not known; ``why``, a Fact, says why."""

    @property
    def why(self):
        return self.fact


class Record:
    """A structured value: ``fields`` by name; points, frames and tools have a ``father``: the
    Record of a frame, None for world and flange, or Missing."""

    __slots__ = ("kind", "fields", "father", "name")

    def __init__(self, kind, fields, father=None, name=""):
        self.kind, self.fields, self.father, self.name = kind, fields, father, name

    def get(self, field):
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
    Element of the .dtx not read yet, or Missing."""

    __slots__ = ("kind", "items")

    def __init__(self, kind, items):
        self.kind, self.items = kind, items


def copied(value):
    """A value of its own; a point's father stays the same frame."""
    if not isinstance(value, Record):
        return value
    fields = {
        name: copied(field) if isinstance(field, Record) else field
        for name, field in value.fields.items()
    }
    return Record(value.kind, fields, value.father, value.name)


def initial(kind):
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


def trsf(values):
    return Record("trsf", dict(zip(TRSF, values)))


def posed(kind, values, father=None):
    """A point, frame or tool."""
    fields = {"trsf": trsf(values)}
    if POSED[kind] == "point":
        fields["config"] = Record("config", dict.fromkeys(CONFIG, ""))
    return Record(POSED[kind], fields, father)


def number(value):
    """``value`` if it is a finite number; raises Unknown."""
    if type(value) is float and math.isfinite(value):
        return value
    if isinstance(value, Missing):
        raise Unknown(value.why)
    if type(value) is float:
        raise Unknown("programs.number_not_finite", "the number is not finite")
    raise Unknown("programs.number_expected", "a number expected")


def as_kind(kind, value):
    """A value of the type ``kind`` made of ``value``, which may be a literal {..}. Raises Unknown."""
    if isinstance(value, list):
        return _literal(kind, value)
    expected = initial(kind)
    if isinstance(expected, Missing):
        raise Unknown(expected.why)
    if type(value) is not type(expected) or getattr(value, "kind", 0) != getattr(
        expected, "kind", 0
    ):
        raise Unknown("programs.val3.type_expected", "a {kind} expected", kind=kind)
    return copied(value)


def _literal(kind, values):
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


def six(record):
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


def matrix(values):
    """Rotation rows (3 lists) and position of six components."""
    x, y, z = values[:3]
    rx, ry, rz = (math.radians(v) for v in values[3:])
    cx, sx, cy, sy, cz, sz = (f(v) for v in (rx, ry, rz) for f in (math.cos, math.sin))
    return [
        [cy * cz, -cy * sz, sy],
        [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
        [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy],
    ], [x, y, z]


def components(rotation, position):
    """Six components of a rotation and a position; at ry = +-90 degrees rx is 0."""
    horizontal = math.hypot(rotation[0][0], rotation[0][1])
    ry = math.atan2(rotation[0][2], horizontal)
    if horizontal > 1e-9:
        rx = math.atan2(-rotation[1][2], rotation[2][2])
        rz = math.atan2(-rotation[0][1], rotation[0][0])
    else:
        rx, rz = 0.0, math.atan2(rotation[1][0], rotation[1][1])
    return (*position, *(math.degrees(v) for v in (rx, ry, rz)))


def product(a, b):
    """Six components of the trsf a * b."""
    (ra, pa), (rb, pb) = matrix(a), matrix(b)
    position = [pa[i] + sum(ra[i][k] * pb[k] for k in range(3)) for i in range(3)]
    rotation = [[sum(ra[i][k] * rb[k][j] for k in range(3)) for j in range(3)] for i in range(3)]
    return components(rotation, position)


def inverse(a):
    """Six components of the inverse trsf."""
    r, p = matrix(a)
    back = [[r[k][i] for k in range(3)] for i in range(3)]
    return components(back, [-sum(back[i][k] * p[k] for k in range(3)) for i in range(3)])


def frames(rows):
    """(n, 4, 4) of n rows of six components, lengths as given."""
    rows = np.asarray(rows, dtype=float).reshape(-1, 6)
    angles = np.radians(rows[:, 3:])
    cx, cy, cz = np.cos(angles).T
    sx, sy, sz = np.sin(angles).T
    result = np.zeros((len(rows), 4, 4))
    result[:, 0, :3] = np.stack([cy * cz, -cy * sz, sy], 1)
    result[:, 1, :3] = np.stack([cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy], 1)
    result[:, 2, :3] = np.stack([sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy], 1)
    result[:, :3, 3] = rows[:, :3]
    result[:, 3, 3] = 1.0
    return result


def in_world(record, depth=0):
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


def words(values):
    return " ".join(f"{k.upper()} {round(v, 6) + 0.0:g}" for k, v in zip(TRSF, values))


def load(root, file):
    """Arrays by name, and notes (line, Fact), of a .dtx's root Element."""
    arrays, notes, total = {}, [], 0
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
        if _form(data) == "collection" or "," in size:
            items = {child.get("key", ""): child for child in data.children}
            arrays[name] = Array(kind, items)
            continue
        items, before = [None] * max(count, 1), len(notes)
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
        arrays[name] = Array(kind, items)
    return arrays, notes


def product_of(text, otherwise):
    """The product of the sizes in 'n,m,...'; ``otherwise`` where one is no number, or they are too many."""
    sizes = text.split(",", MAX_DIMENSIONS)
    if len(sizes) > MAX_DIMENSIONS:
        return otherwise
    return math.prod(
        int(s) if s.isascii() and s.isdigit() and len(s) < 8 else otherwise for s in sizes
    )


def _form(data):
    return next((v for k, v in data.attributes.items() if k.endswith(":type")), "array")


def parsed(kind, element, file, frame_of):
    """The value of a <Value> of a .dtx. ``frame_of(text)`` gives the father 'name[index]'.

    Raises Unknown naming file and line.
    """
    value = initial(kind)
    if isinstance(value, Missing):
        return value
    given = element.attributes

    def figure(name, default=0.0):
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
        fields["trsf"] = trsf(map(figure, TRSF))
        if value.kind == "point":
            fields["config"].fields.update((name, given.get(name, "")) for name in CONFIG)
        value.father = frame_of(given.get("fatherId", ""), value.kind)
        return value
    fields.update((name, figure(name, 0.0)) for name in fields)
    return value
