"""A robot's URDF: the tree of its links and joints, and the six axes from its base to its flange as a ``robot.model``.

Read here and not by urdfdom, which logs its faults in place of returning them, and which takes a link with two parents
without a word. The format: wiki.ros.org/urdf/XML. Frames are 4 x 4 in mm, angles in radian.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from ..base import frames
from ..base.files import in_file
from ..base.kinds import Floats, Json
from ..base.regular_files import read_regular
from ..engine import InputError

LIMIT = 1 << 26  # bytes
METRE = 1000.0  # mm
AXES = 6
TURNING, FIXED = ("revolute", "continuous"), "fixed"
WITHOUT_END = 2.0 * math.pi  # rad, the limits of a continuous joint, to both sides
ROUNDED = 1e-5  # rad: 1.5708 and 3.1416 are quarter turns, which no arm is built more exactly than
BASE, FLANGE = "base_link", "tool0"  # as ROS-Industrial names them (REP 199)
XACRO = ("{http://www.ros.org/wiki/xacro}", "{http://ros.org/wiki/xacro}")


class Joint(NamedTuple):
    """One of a tree's joints. ``frame``: parent_from_child with the joint at zero."""

    name: str
    kind: str
    parent: str
    child: str
    frame: Floats
    element: ElementTree.Element


class Tree:
    """Links and joints of a URDF, each link but the root on one joint. Raises InputError where it is none."""

    def __init__(self, file: Path | str) -> None:
        self.file = Path(file)
        self.data = read_regular(self.file, LIMIT)
        robot = self._parsed()
        self.links = {self._name(one, "link"): one for one in robot.findall("link")}
        self.joints = [self._joint(one) for one in robot.findall("joint")]
        self.joint_of: dict[str, Joint] = {}  # that carries each link but the root
        self.root = self._rooted()

    def fault(self, code: str, text: str, /, **values: object) -> InputError:
        return in_file(InputError(code, text, **values), self.file)

    def chain(self, base: str, tip: str) -> list[Joint] | None:
        """The joints from one link to another, in order; None: it does not carry it."""
        found: list[Joint] = []
        while tip != base:
            joint = self.joint_of.get(tip)
            if joint is None:
                return None
            found.insert(0, joint)
            tip = joint.parent
        return found

    def vector(
        self, element: ElementTree.Element | None, key: str, default: str, what: str
    ) -> Floats:
        """(3,) of an attribute, which may be missing."""
        text = default if element is None else element.get(key, default)
        values = [self.number(one, what) for one in text.split()]
        if len(values) != 3:
            raise self.fault(
                "presets.urdf_vector", "{what}: '{text}' is not three numbers", what=what, text=text
            )
        return np.array(values)

    def number(self, text: str | None, what: str) -> float:
        try:
            value = float(text or "")
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.fault(
                "presets.urdf_number", "{what}: '{text}' is not a number", what=what, text=text
            )
        return value

    def origin(self, element: ElementTree.Element, what: str) -> Floats:
        """parent_from_child of an element's ``origin``; quarter turns that were rounded are whole again."""
        at = element.find("origin")
        roll, pitch, yaw = (_unrounded(one) for one in self.vector(at, "rpy", "0 0 0", what))
        position = METRE * self.vector(at, "xyz", "0 0 0", what)
        return frames.from_abc(position, np.degrees([yaw, pitch, roll]))

    def _parsed(self) -> ElementTree.Element:
        if b"<!ENTITY" in self.data:
            raise self.fault("presets.urdf_entity", "it has entities of its own; expand them")
        try:
            robot = ElementTree.fromstring(self.data)
        except (ElementTree.ParseError, ValueError, LookupError) as error:
            raise self.fault(
                "presets.urdf_xml", "cannot be read as XML: {reason}", reason=error
            ) from None
        if any(str(one.tag).startswith(XACRO) for one in robot.iter()):
            raise self.fault(
                "presets.urdf_xacro", "has macros of xacro; expand it: xacro FILE > robot.urdf"
            )
        if robot.tag != "robot":
            raise self.fault(
                "presets.urdf_root",
                "is no URDF: its outermost element is '{tag}' in place of 'robot'",
                tag=robot.tag,
            )
        return robot

    def _name(self, element: ElementTree.Element, kind: str) -> str:
        name = element.get("name", "")
        if not name:
            raise self.fault("presets.urdf_name", "a {kind} has no name", kind=kind)
        return name

    def _joint(self, element: ElementTree.Element) -> Joint:
        name, ends = self._name(element, "joint"), []
        for kind in ("parent", "child"):
            end = element.find(kind)
            link = "" if end is None else end.get("link", "")
            if link not in self.links:
                raise self.fault(
                    "presets.urdf_link",
                    "joint {joint}: its {kind} '{link}' is no link of the robot",
                    joint=name,
                    kind=kind,
                    link=link,
                )
            ends.append(link)
        frame = self.origin(element, name)
        return Joint(name, element.get("type", ""), ends[0], ends[1], frame, element)

    def _rooted(self) -> str:
        for joint in self.joints:
            other = self.joint_of.setdefault(joint.child, joint)
            if other is not joint:
                raise self.fault(
                    "presets.urdf_loop",
                    "link {link} hangs on two joints, {first} and {second}: a loop; an arm is a tree",
                    link=joint.child,
                    first=other.name,
                    second=joint.name,
                )
        roots = [link for link in self.links if link not in self.joint_of]
        if len(roots) > 1:
            raise self.fault(
                "presets.urdf_roots",
                "links {first} and {second} hang on nothing; a robot has one root",
                first=roots[0],
                second=roots[1],
            )
        for link in self.links:
            seen = {link}
            while link in self.joint_of:
                link = self.joint_of[link].parent
                if link in seen:
                    raise self.fault(
                        "presets.urdf_circle",
                        "link {link} carries itself: a loop; an arm is a tree",
                        link=link,
                    )
                seen.add(link)
        if not roots:
            raise self.fault("presets.urdf_empty", "has no link")
        return roots[0]


class Arm(NamedTuple):
    """The six axes of a tree, from the link ``base`` to the link ``tip``, the flange."""

    tree: Tree
    base: str
    tip: str
    joints: list[Joint]  # all from base to tip, fixed ones too

    def moving(self) -> list[Joint]:
        return [joint for joint in self.joints if joint.kind != FIXED]


def arm_of(model: Json) -> Arm:
    """Of a ``robot.model`` with its defaults that names a URDF. Raises InputError."""
    tree = Tree(model["urdf"])
    base = _named(tree, model, "base_link") or (BASE if BASE in tree.links else tree.root)
    tip = _named(tree, model, "tip_link") or _flange(tree, base)
    joints = tree.chain(base, tip)
    if joints is None:
        raise tree.fault(
            "presets.urdf_chain", "link {base} does not carry link {tip}", base=base, tip=tip
        )
    found = Arm(tree, base, tip, joints)
    for joint in found.moving():
        _check_kind(tree, joint)
    if len(found.moving()) != AXES:
        raise tree.fault(
            "presets.urdf_axes",
            "{count} joints turn between {base} and {tip}; only arms of six axes can be followed: give another base_link "
            "or tip_link",
            count=len(found.moving()),
            base=base,
            tip=tip,
        )
    return found


def model_of(model: Json) -> dict[str, Any]:
    """A ``robot.model`` without defaults, by its joints, of one that names a URDF. Raises InputError."""
    arm = arm_of(model)
    rows, at = [], np.eye(4)
    for joint in arm.joints:
        at = at @ joint.frame
        if joint.kind != FIXED:
            rows.append({**_placed(at), **_limits(arm.tree, joint)})
            at = np.eye(4)
    flange = {"position_mm": at[:3, 3].tolist(), "abc_deg": list(frames.to_abc(at))}
    return {"convention": "urdf", "joints": rows, "joint6_from_flange": flange}


def _named(tree: Tree, model: Json, key: str) -> str:
    name = str(model[key])
    if name and name not in tree.links:
        raise tree.fault(
            "presets.urdf_no_link",
            "robot.model.{key}: there is no link '{link}'",
            key=key,
            link=name,
        )
    return name


def _flange(tree: Tree, base: str) -> str:
    """``tool0``, or the one link behind six joints that move."""
    if tree.chain(base, FLANGE) is not None and FLANGE in tree.links:
        return FLANGE
    counts = dict(_counts(tree, base))
    last = [
        link
        for link, count in counts.items()
        if count == AXES and link in tree.joint_of and tree.joint_of[link].kind != FIXED
    ]
    if not last:
        raise tree.fault(
            "presets.urdf_too_few",
            "no more than {count} joints in a row move from {base} on; only arms of six axes can be followed",
            count=max(counts.values()),
            base=base,
        )
    if len(last) > 1:
        raise tree.fault(
            "presets.urdf_which",
            "{links} each lie behind six joints; give robot.model.tip_link",
            links=", ".join(sorted(last)),
        )
    return last[0]


def _counts(tree: Tree, base: str) -> Iterator[tuple[str, int]]:
    """(link, joints that move before it) of all that ``base`` carries."""
    for link in tree.links:
        joints = tree.chain(base, link)
        if joints is not None:
            yield link, sum(joint.kind != FIXED for joint in joints)


def _check_kind(tree: Tree, joint: Joint) -> None:
    if joint.kind not in TURNING:
        raise tree.fault(
            "presets.urdf_kind",
            "joint {joint} of the arm is of the type '{kind}'; its six axes must turn (revolute or continuous)",
            joint=joint.name,
            kind=joint.kind,
        )
    if joint.element.find("mimic") is not None:
        raise tree.fault(
            "presets.urdf_mimic",
            "joint {joint} of the arm mimics another; each of its six axes must turn by itself",
            joint=joint.name,
        )


def _placed(at: Floats) -> dict[str, Any]:
    yaw, pitch, roll = frames.to_abc(at)
    return {"origin_mm": at[:3, 3].tolist(), "rpy_deg": [roll, pitch, yaw]}


def _limits(tree: Tree, joint: Joint) -> dict[str, Any]:
    limit = joint.element.find("limit")
    axis = tree.vector(joint.element.find("axis"), "xyz", "1 0 0", joint.name)
    if limit is None and joint.kind == "revolute":
        raise tree.fault(
            "presets.urdf_limit", "joint {joint} has no limit; give one", joint=joint.name
        )
    given: Json = {} if limit is None else limit.attrib
    ends = (
        [tree.number(given.get(key, "0"), joint.name) for key in ("lower", "upper")]
        if joint.kind == "revolute"
        else [-WITHOUT_END, WITHOUT_END]
    )
    speed = tree.number(given.get("velocity", "0"), joint.name)
    lower, upper, fast = (math.degrees(one) for one in (*ends, speed))
    return {
        "axis": axis.tolist(),
        "lower_deg": lower,
        "upper_deg": upper,
        "max_speed_deg_s": max(fast, 0.0),
    }


def _unrounded(angle: float) -> float:
    quarter = round(angle / (0.5 * math.pi)) * 0.5 * math.pi
    return quarter if abs(angle - quarter) < ROUNDED else angle
