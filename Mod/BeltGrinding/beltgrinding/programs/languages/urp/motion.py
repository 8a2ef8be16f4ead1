"""The motions of a PolyScope program: its waypoints and arcs with their features, tools and speeds."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

from ...program import Fact, Motion, Program, Unknown
from ..xml_tree import Element
from ..core.telling import Telling
from ..urscript.pose import Pose
from ..urscript.reader import Interpreter
from .position import NOWHERE, NUMBER, Positions, Six, in_mm

THE_WAYPOINT = Fact("programs.urp.waypoint", "the waypoint")
# Six numbers, as they are named when they are none.
THE = {
    "pose": Fact("programs.urp.pose", "the pose"),
    "joints": Fact("programs.urp.joints", "the joint angles"),
    **{
        tag: Fact("programs.urp.part", "the {tag}", tag=tag)
        for tag in ("BaseToFeature", "poseInFeatureCoordinates", "TCPOffset")
    },
}
KINDS = {"MoveJ": "PTP", "MoveL": "LIN", "MoveP": "LIN"}
BASE, TOOL = "Joint_0_name", "Joint_6_name"  # PolyScope's own names of its two features
STEP = re.compile(r"([A-Za-z_][\w.-]*)(?:\[([0-9]{1,7})\])?")


class Waypoints(Telling):
    """Collects the motions of a program; they get their poses all at once."""

    def __init__(self, name: str, root: Element) -> None:
        super().__init__()
        self.program = Program("UR PolyScope", name)
        self.file, self.root, self.line = name, root, 1
        self.positions = Positions()
        self.script = Interpreter(name)  # script nodes share its variables
        self.script.free_reference = False  # PolyScope has features in its place
        # Children by tag, by the id of a node
        self.indices: dict[int, dict[str, list[Element]]] = {}
        self.tool = ""
        self.tools: dict[tuple[str, Six | None], str] = {}  # in words, by name and offset

    def gap(self, line: int) -> None:
        """The path beyond must not be joined over what is left out as if nothing were missing."""
        self.program.gap(line, self.file)

    def target(self, element: Element) -> Element:
        """What an element stands for: itself, or what its reference leads to (as XStream writes
        them: a path of '..' and tag[n] from the element). Raises Unknown."""
        for _ in range(10):
            path = element.get("reference")
            if path is None:
                return element
            at: Element | None = element
            for step in path.split("/")[:200]:
                match = STEP.fullmatch(step)
                if step == ".." and at is not None:
                    at = at.parent
                elif match and at is not None:
                    found = self.tagged(at).get(match[1], ())
                    n = int(match[2] or 1)
                    at = found[n - 1] if 1 <= n <= len(found) else None
            if at is None or at is element:
                break
            element = at
        raise Unknown(
            "programs.urp.reference",
            "its reference '{reference}' leads nowhere",
            reference=(element.get("reference") or "")[:60],
        )

    def tagged(self, element: Element) -> dict[str, list[Element]]:
        """Children by tag."""
        if id(element) not in self.indices:
            index: dict[str, list[Element]] = {}
            for child in element.children:
                index.setdefault(child.tag, []).append(child)
            self.indices[id(element)] = index
        return self.indices[id(element)]

    def place(
        self,
        waypoint: Element,
        motion: Motion,
        positions: Positions,
        name: str = "",
        in_base: bool = False,
    ) -> Any:
        """Hands a waypoint's position on; returns the pose of its feature, which is called
        ``name``; None where the pose is not known. Raises Unknown."""
        kind = waypoint.get("type", "Fixed")
        if kind == "Variable" and not in_base and self.variable(waypoint, motion, name):
            return NOWHERE
        if kind != "Fixed":
            raise Unknown(
                "programs.urp.waypoint_kind",
                "the waypoint's position is {kind}, known at run time",
                kind=kind[:20].lower(),
            )
        holder = waypoint.find("position")
        if holder is None:
            raise Unknown(
                "programs.urp.not_taught", "the waypoint has no position; it was not taught yet"
            )
        position = self.target(holder)
        feature = self.part(waypoint, "BaseToFeature") or NOWHERE
        inner = self.part(waypoint, "poseInFeatureCoordinates")
        pose = position.get("pose")
        if pose is not None:  # PolyScope 3
            pose = positions.six(pose, THE["pose"])
            if inner is not None and not in_base:
                positions.taught.append((motion, pose, inner, name))
                return positions.taught  # the feature follows when all poses are made
            positions.poses.append((motion, pose, NOWHERE if in_base else feature))
            return feature
        angles = position.find("JointAngles")
        text = angles.get("angles") if angles is not None else position.get("joints")
        joints = positions.six(text, THE["joints"])
        kinematics = position.find("Kinematics")
        if kinematics is None:
            kinematics = self.root.find("kinematics")
        else:
            kinematics = self.target(kinematics)
        arm = positions.arm(kinematics)
        tcp = self.part(position, "TCPOffset")
        if arm is None or tcp is None:
            motion.kind = "PTP"
            return None
        positions.joints.append((motion, joints, arm, tcp, NOWHERE if in_base else feature))
        return feature

    def variable(self, waypoint: Element, motion: Motion, name: str) -> bool:
        """Whether the program itself gives a variable waypoint its pose, which is one in the move's feature
        (PolyScope's manual, Move, feature selection). Raises Unknown where nothing tells that feature.
        """
        holder = waypoint.find("variable")
        if holder is None:
            return False
        value = self.script.scopes[0].get(self.target(holder).get("name", ""))
        if not isinstance(value, Pose):
            return False
        if name:
            raise Unknown(
                "programs.urp.variable_feature",
                "the variable is a pose in the feature {name}, and no waypoint tells where that is",
                name=name[:40],
            )
        pose = value.components()
        if not all(math.isfinite(v) for v in pose):
            return False
        self.positions.poses.append((motion, tuple(pose), NOWHERE))
        return True

    def part(self, element: Element, tag: str) -> Six | None:
        """The six numbers of a child's pose, None where there is no such child."""
        child = element.find(tag)
        return (
            None if child is None else self.positions.six(self.target(child).get("pose"), THE[tag])
        )

    def waypoint(
        self, node: Element, move: Element | None, aux: bool = False, arc: bool = False
    ) -> bool:
        """One motion; whether its pose is known."""
        line, node = node.line, self.target(node)
        if move is None:
            raise Unknown("programs.urp.no_move", "the waypoint is in no Move")
        kind = "CIRC" if arc else KINDS.get(move.get("motionType", ""))
        if kind is None:
            raise Unknown(
                "programs.urp.unknown_motion",
                "the motion '{kind}' is not known",
                kind=move.get("motionType", "")[:20],
            )
        name = self.feature(move)
        motion = Motion(kind, None, line, self.file, aux=aux)
        feature = self.place(node, motion, self.positions, name)
        motion.tool = self.tcp(node, move)
        if feature is None:
            self.problem(
                line,
                "programs.urp.joint_angles_only",
                "{name}: joint angles only; the file holds no kinematics of the arm that "
                "would give its pose",
                name=node.get("name")[:60] if node.get("name") is not None else THE_WAYPOINT,
            )
            motion.aux = False
        else:
            if feature is not self.positions.taught:
                motion.base = self.positions.described(name, feature)
            motion.speed_mm_s = self.speed(line, node, move, kind)
        self.script.here = None
        self.program.motions.append(motion)
        return feature is not None

    def circle(self, node: Element, move: Element | None) -> None:
        """Two waypoints: on the way and the end."""
        if any("fixed" in value.lower() for value in node.attributes.values()):
            raise Unknown(
                "programs.urp.turning_tool",
                "the tool turns with the arc; only unconstrained orientation is supported",
            )
        points = [w for w in _below(node) if w.find("position") is not None or w.tag == "Waypoint"]
        if len(points) != 2:
            raise Unknown(
                "programs.urp.arc_points",
                "the arc has {count} points instead of two",
                count=len(points),
            )
        positions = self.positions
        lists: tuple[list[Any], ...] = (
            self.program.motions,
            positions.joints,
            positions.poses,
            positions.taught,
        )
        before = [len(kept) for kept in lists]
        known = False
        try:
            via = self.waypoint(points[0], move, aux=True, arc=True)
            known = self.waypoint(points[1], move, arc=True) and via
        finally:
            if not known:  # half an arc is none
                for kept, length in zip(lists, before):
                    del kept[length:]
        if not known:
            raise Unknown("programs.urp.points_unknown", "where its points are is not known")

    def feature(self, move: Element) -> str:
        """Name of the move's feature, '' for the base. Raises Unknown for the tool."""
        holder = move.find("feature")
        if holder is None:
            return ""
        name = self.target(holder).get("referencedName", "")
        if name == TOOL:
            raise Unknown(
                "programs.urp.feature_is_tool",
                "the move's feature is the tool, which moves with the robot",
            )
        return "" if name == BASE else name

    def tcp(self, node: Element, move: Element) -> str:
        holder = move.find("tcp")
        name = self.tool if holder is None else self.target(holder).get("referencedName", "")
        position = node.find("position")
        offset = self.part(self.target(position), "TCPOffset") if position is not None else None
        if node.get("type") == "Variable":  # the TCP in force, if the program has met it
            known = {
                words for (one, o), words in self.tools.items() if one == name and o is not None
            }
            if len(known) == 1:
                return known.pop()
        if (name, offset) not in self.tools:
            text = "" if offset is None else "p[" + ", ".join(f"{v:g}" for v in offset) + "]"
            words = self.tools[name, offset] = f"{name} {text}".strip()
            if offset is not None:
                self.program.tool_frames[words] = in_mm(offset)
        return self.tools[name, offset]

    def speed(self, line: int, node: Element, move: Element, kind: str) -> float | None:
        """mm/s of a path; None for a joint motion or where it is not known."""
        if kind == "PTP":
            return None
        holder = node.find("motionParameters")
        own = holder.attributes if holder is not None else {}
        if own.get("time") not in (None, "", "0", "0.0"):
            self.problem(
                line, "programs.urp.time_given", "its time is given; the path speed is not known"
            )
            return None
        text = own.get("cartesianSpeed") or move.get("speed", "")
        if not NUMBER.fullmatch(text.strip()) or not 0.0 < float(text) < 100.0:
            self.problem(
                line,
                "programs.urp.speed",
                "the path speed '{text}' is not understood",
                text=text[:20],
            )
            return None
        return 1000.0 * float(text)


def _below(element: Element) -> list[Element]:
    found: list[Element] = []
    for child in element.children:
        if child.tag == "children":
            found += child.children
        elif child.tag not in ("motionParameters", "feature", "tcp"):
            found.append(child)
    return found
