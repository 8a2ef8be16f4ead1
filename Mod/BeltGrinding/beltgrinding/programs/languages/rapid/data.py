"""Data of ABB RAPID: record types, predefined values, and poses as RAPID writes them.

A pose is [[x, y, z], [q1, q2, q3, q4]] in mm with q1 the real part, as in ABB's Technical
reference manual, RAPID instructions, functions and data types.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from ....base.frames import QUATERNION_TOLERANCE, from_abc, from_quaternion, to_abc, to_quaternions
from ...program import Fact, Unknown
from ..core.expression import number as number

MAX_MM = 1e6  # a robot's world ends before; RAPID writes 9E9 for 'not given'
MAX_ARRAY = 1_000_000  # values in one variable
MAX_RECORD = 200  # lists and values in a record; what has more is an array
MAX_DIMENSIONS = 3  # RAPID has no more
MAX_RECORDS = 10  # records in each other
A_POSITION = Fact("programs.rapid.position", "a position")
AN_ORIENTATION = Fact("programs.rapid.orientation", "an orientation")
A_POS = Fact("programs.rapid.pos", "a pos")
AN_ORIENT = Fact("programs.rapid.orient", "an orient")

# A position and a quaternion; a number, a truth value, a string, or lists of them.
Pose: TypeAlias = list[list[float]]
Records: TypeAlias = dict[str, dict[str, str]]  # {type: {component: type}}

RECORDS: Records = {
    "pos": {"x": "num", "y": "num", "z": "num"},
    "orient": {f"q{k}": "num" for k in (1, 2, 3, 4)},
    "pose": {"trans": "pos", "rot": "orient"},
    "confdata": {"cf1": "num", "cf4": "num", "cf6": "num", "cfx": "num"},
    "extjoint": {f"eax_{k}": "num" for k in "abcdef"},
    "robjoint": {f"rax_{k}": "num" for k in range(1, 7)},
    "robtarget": {"trans": "pos", "rot": "orient", "robconf": "confdata", "extax": "extjoint"},
    "jointtarget": {"robax": "robjoint", "extax": "extjoint"},
    "loaddata": {
        "mass": "num",
        "cog": "pos",
        "aom": "orient",
        "ix": "num",
        "iy": "num",
        "iz": "num",
    },
    "tooldata": {"robhold": "bool", "tframe": "pose", "tload": "loaddata"},
    "wobjdata": {
        "robhold": "bool",
        "ufprog": "bool",
        "ufmec": "string",
        "uframe": "pose",
        "oframe": "pose",
    },
    "speeddata": {"v_tcp": "num", "v_ori": "num", "v_leax": "num", "v_reax": "num"},
    "zonedata": {
        "finep": "bool",
        "pzone_tcp": "num",
        "pzone_ori": "num",
        "pzone_eax": "num",
        "zone_ori": "num",
        "zone_leax": "num",
        "zone_reax": "num",
    },
}
SIMPLE: dict[str, Any] = {"num": 0.0, "dnum": 0.0, "byte": 0.0, "bool": False, "string": ""}

# What a person can say of data, by its type: "frame": six numbers, "number", "truth".
GIVEN = {
    "num": "number",
    "dnum": "number",
    "bool": "truth",
    "speeddata": "number",
    "zonedata": "number",
    "robtarget": "frame",
    "pose": "frame",
}

IDENTITY = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]
LOAD0 = [0.001, [0.0, 0.0, 0.001], [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0]
# The manual's predefined speeds; vmax is the robot's own and therefore not among them.
SPEEDS = (
    *(5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800),
    *(1000, 1500, 2000, 2500, 3000, 4000, 5000, 6000, 7000),
)
# pzone_tcp of the predefined zonedata, mm; the other zones follow from it as in the manual.
ZONES = (0.3, *map(float, (1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200)))


def zone(size: float) -> list[Any]:
    """Predefined zonedata: z1 and below have one size for all, the others 1.5 for orientation."""
    turn = size if size <= 1.0 else 8.0 if size == 5.0 else 1.5 * size
    return [False, size, turn, turn, 0.1 * turn, turn, 0.1 * turn]


PREDEFINED: dict[str, tuple[str, Any]] = {
    "tool0": ("tooldata", [True, IDENTITY, LOAD0]),
    "wobj0": ("wobjdata", [False, True, "", IDENTITY, IDENTITY]),
    "load0": ("loaddata", LOAD0),
    "pi": ("num", math.pi),
    **{f"v{v}": ("speeddata", [float(v), 500.0, 5000.0, 1000.0]) for v in SPEEDS},
    "fine": ("zonedata", [True, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    **{f"z{int(size)}": ("zonedata", zone(size)) for size in ZONES},
    **{f"reg{k}": ("num", 0.0) for k in range(1, 6)},
}


KIND_OF = {"frame": "robtarget", "number": "num", "truth": "bool"}  # where nothing tells the type


def from_person(kind: str, value: Any) -> Any:
    """Data of what a person says: speeddata by mm/s, zonedata by mm (0: fine), a target by its frame."""
    if kind == "speeddata":
        return [value, *PREDEFINED["v5"][1][1:]]
    if kind == "zonedata":
        return zone(value) if value > 0 else PREDEFINED["fine"][1]
    if kind not in ("robtarget", "pose"):
        return value
    (turn_,) = to_quaternions(from_abc(value[:3], value[3:])[None, :3, :3])
    w_last = [float(one) for one in turn_]
    pose = [[float(one) for one in value[:3]], w_last]
    return [*pose, [0.0] * 4, [9e9] * 6] if kind == "robtarget" else pose


def initial(kind: str, records: Records, depth: int = 0) -> Any:
    """The value of declared data without one. Raises Unknown for the controller's own types."""
    if depth == 0 and _size_of(kind, records, {}) > MAX_ARRAY:
        raise Unknown("programs.rapid.array_size", "the array's size is not sensible")
    if kind in SIMPLE:
        return SIMPLE[kind]
    if kind not in records or depth > MAX_RECORDS:
        raise Unknown(
            "programs.type_of_controller",
            "data of the type {kind} is known to the controller only",
            kind=kind,
        )
    return [initial(inner, records, depth + 1) for inner in records[kind].values()]


def _size_of(kind: str, records: Records, known: dict[str, int], depth: int = 0) -> int:
    """How many values a type holds: each type is looked at once, or they would be counted for ever."""
    if kind not in records or depth > MAX_RECORDS:
        return 1
    if kind not in known:
        known[kind] = 1  # one that holds itself: ``initial`` refuses it
        inner = (_size_of(one, records, known, depth + 1) for one in records[kind].values())
        known[kind] = min(sum(inner), 2 * MAX_ARRAY)
    return known[kind]


def array_size(dimensions: Sequence[int], value: Any) -> int:
    """How many values an array of copies of ``value`` has. Raises Unknown beyond reason."""
    if min(dimensions) < 1 or len(dimensions) > MAX_DIMENSIONS:
        raise Unknown("programs.rapid.array_size", "the array's size is not sensible")
    count = math.prod(dimensions) * size(value)
    if count > MAX_ARRAY:
        raise Unknown("programs.rapid.array_size", "the array's size is not sensible")
    return count


def array(dimensions: Sequence[int], value: Any) -> list[Any]:
    """Nested lists with a copy of ``value`` in each element. Raises Unknown beyond reason."""
    array_size(dimensions, value)
    if len(dimensions) == 1:
        return [copied(value) for _ in range(dimensions[0])]
    return [array(dimensions[1:], value) for _ in range(dimensions[0])]


def size(value: Any) -> int:
    """How many numbers, strings and truth values data holds."""
    return sum(map(size, value)) if isinstance(value, list) else 1


def bounded_size(value: Any, most: int) -> int:
    """How many lists and values data are made of, counted to beyond ``most``: what holds the same list
    many times over has no end otherwise."""
    count, stack = 0, [value]
    while stack and count <= most:
        one = stack.pop()
        count += 1
        if isinstance(one, list):
            if len(one) > most:
                return most + 1
            stack += one
    return count


def copied(value: Any) -> Any:
    return [copied(v) for v in value] if isinstance(value, list) else value


def numbers(value: Any, count: int, what: Fact) -> list[float]:
    """``value`` if it is a list of ``count`` finite numbers; raises Unknown."""
    if not isinstance(value, list) or len(value) != count:
        raise Unknown(
            "programs.rapid.numbers_needed", "{what} needs {count} numbers", what=what, count=count
        )
    for v in value:
        number(v)
    return value


def pose_of(value: Any) -> Pose:
    """[position, unit quaternion] of a robtarget or a pose. Raises Unknown."""
    if not isinstance(value, list) or len(value) not in (2, 4):
        raise Unknown("programs.rapid.no_position", "it is no position with an orientation")
    position = numbers(value[0], 3, A_POSITION)
    if max(position) > MAX_MM or min(position) < -MAX_MM:
        raise Unknown(
            "programs.rapid.far_position",
            "{value:g} mm is no robot's position",
            value=max(position, key=abs),
        )
    w, x, y, z = quaternion = numbers(value[1], 4, AN_ORIENTATION)
    sound = max(quaternion) < 2 and min(quaternion) > -2
    length = math.sqrt(w * w + x * x + y * y + z * z) if sound else math.inf
    if abs(length - 1.0) > QUATERNION_TOLERANCE:
        raise Unknown(
            "programs.rapid.quaternion",
            "the quaternion has length {length:.4g} instead of 1",
            length=length,
        )
    return [list(position), [w / length, x / length, y / length, z / length]]


def is_joints(value: object) -> bool:
    """True for a jointtarget: six axes and the external ones, in degrees or mm."""
    return (
        isinstance(value, list)
        and len(value) == 2
        and all(isinstance(v, list) and len(v) == 6 for v in value)
    )


def turn(a: Sequence[float], b: Sequence[float]) -> list[float]:
    """Product of two quaternions."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return [
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    ]


def cross(a: Sequence[float], b: Sequence[float]) -> list[float]:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def rotated(quaternion: Sequence[float], vector: Sequence[float]) -> list[float]:
    """A vector turned by a unit quaternion."""
    w, axis = quaternion[0], quaternion[1:]
    t = [2.0 * v for v in cross(axis, vector)]
    c = cross(axis, t)
    return [vector[k] + w * t[k] + c[k] for k in range(3)]


def product(a: Pose, b: Pose) -> Pose:
    """a_from_c of the poses a_from_b and b_from_c."""
    step = rotated(a[1], b[0])
    return [[a[0][k] + step[k] for k in range(3)], turn(a[1], b[1])]


def inverse(pose: Pose) -> Pose:
    """b_from_a of the pose a_from_b."""
    back = [pose[1][0], *(-v for v in pose[1][1:])]
    return [rotated(back, [-v for v in pose[0]]), back]


def about(axis: int, degrees: float) -> list[float]:
    """The quaternion of a turn about one axis (0, 1, 2)."""
    half = math.radians(degrees) / 2.0
    result = [math.cos(half), 0.0, 0.0, 0.0]
    result[1 + axis] = math.sin(half)
    return result


def components(pose: Pose) -> str:
    """A pose in words: X Y Z in mm, A B C in degrees."""
    frame = from_quaternion(*pose)
    values = [*pose[0], *to_abc(frame)]
    return " ".join(f"{k} {round(v, 6) + 0.0:g}" for k, v in zip("XYZABC", values))
