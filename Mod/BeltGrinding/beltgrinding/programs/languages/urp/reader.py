"""Reads programs of Universal Robots' PolyScope: .urp, XML packed by gzip.

Poses are those of the TCP in the move's feature as it stood when the waypoint was taught
(``urp_position`` says how); ``base`` names a feature other than the robot's base. Lines are those of
the XML. Script nodes, assignments and conditions are followed by the URScript reader. What only the
controller can know (variable and relative waypoints, URCaps, waypoints of joints without the arm's
kinematics) is a Problem.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...program import SKIPPED, Fact, Program, ProgramError, Unknown, name_of
from ..core.expression import truth
from ..core.statements import Statements
from ..urscript.scopes import MOVE
from ..xml_tree import Element, read_xml
from .position import keep_kinematics
from .scripts import Halt, Scripts

MAX_CALLS = 20
MAX_LOOP = 100_000
# Nodes that are followed, by the method that does; those beside that change nothing; those that may move the robot.
NODES = {
    "Move": "move_",
    "Waypoint": "waypoint",
    "CircleMove": "circle",
    "Folder": "inside",
    "Loop": "loop",
    "CallSubProgram": "call",
    "Script": "script_",
    "Assignment": "assignment",
    "Halt": "halt",
    "Set": "set_",
    "Force": "force",
    "Contributed": "contributed",
}
HARMLESS = frozenset(
    "Wait Comment Popup Placeholder Timer InitVariablesNode EmptyNode kinematics".split()
)
MOVING = frozenset("Move Waypoint CircleMove CallSubProgram Contributed Direction".split())
LOST = ("Force", "Contributed", "Direction", "Switch", "Thread")  # told, whatever is in them
STATEMENTS = Statements(
    followed=["If", *(node for node in NODES if node not in LOST)],
    ignored=sorted(HARMLESS),
    left_out=LOST,
)


def read(path: Path | str) -> Program:
    """The Program of a .urp. Raises ProgramError when it cannot be read at all."""
    keep = keep_kinematics()
    root = read_xml(
        path,
        text_of=("cachedContents", "loopCount", "count", "numberOfLoops"),
        finished={"Kinematics": keep, "kinematics": keep},
        shared=("TCPOffset", "BaseToFeature", "motionParameters"),
    )
    if root.tag != "URProgram":
        raise ProgramError.at(
            name_of(path),
            root.line,
            "programs.urp.no_polyscope",
            "<{tag}> is no PolyScope program (URProgram)",
            tag=root.tag,
        )
    reader = _Reader(name_of(path), root)
    reader.run()
    return reader.finish()


class _Reader(Scripts):
    """Follows the nodes of a program from top to bottom."""

    def __init__(self, name: str, root: Element) -> None:
        super().__init__(name, root)
        self.calls = 0
        self.seen: set[int] = set()
        self.moving: dict[int, bool] = {}  # what ``moves`` found, by the ids of nodes
        self.lost: set[int] = set()  # nodes that were left out
        self.passed = 0  # how often again

    def finish(self) -> Program:
        for motion in self.positions.finish():
            self.problem(
                motion.line,
                "programs.urp.far_pose",
                "the waypoint's pose is no robot's; it is left out",
            )
        self.program.base_frames.update(self.positions.frames)
        self.program.base_frames[""] = np.eye(4)  # the robot's base
        return self.program

    def run(self) -> None:
        holder = self.root.find("children")
        tops: Sequence[Element] = holder.children if holder is not None else ()
        mains = [t for t in tops if t.tag == "MainProgram"]
        if not mains:
            line = self.root.line
            raise ProgramError.at(
                self.file,
                line,
                "programs.urp.no_main",
                "there is no MainProgram; is the file whole?",
            )
        try:
            for top in tops:
                if top.tag == "SpecialSequence" and top.get("type") == "BeforeStart":
                    self.inside(top, None)
                elif top.tag == "Thread" and self.moves(top):
                    self.problem(
                        top.line,
                        "programs.urp.thread",
                        "a thread runs beside the program; it is left out",
                    )
            for main in mains:
                self.inside(main, None)
        except Halt:
            pass

    def inside(self, element: Element, move: Element | None) -> None:
        """Runs the nodes below an element; ``move``: the Move they are in, or None."""
        holder = element.find("children")
        if holder is not None and id(holder) not in self.seen:
            self.seen.add(id(holder))
            self.rounds -= len(holder.children)  # what the file has is no work beyond it
        taken: bool | None = None  # of a chain of If nodes: True, False, or None
        for node in holder.children if holder is not None else ():
            self.tick(node.line)
            if node.tag == "If":
                taken = self.branch(node, move, taken)
                continue
            try:
                self.node(node, move)
            except Unknown as unknown:
                name = node.get("name") or node.tag
                self.problem(
                    node.line,
                    "programs.left_out",
                    "{what} is left out: {reason}",
                    what=name[:60],
                    reason=unknown.fact,
                )
                self.lose(node)
                self.gap(node.line)

    def node(self, node: Element, move: Element | None) -> None:
        if node.tag in NODES:
            getattr(self, NODES[node.tag])(node, move)
        elif node.tag not in HARMLESS:
            if self.moves(node):
                raise Unknown(
                    "programs.urp.unsupported_node",
                    "the node {tag} is not supported",
                    tag=node.tag[:40],
                )
            self.lose(node)
            self.problem(
                node.line,
                "programs.urp.unknown_node",
                "the node {tag} is not known here",
                tag=node.tag[:40],
            )

    def move_(self, node: Element, move: Element | None) -> None:
        self.inside(node, node)

    def force(self, node: Element, move: Element | None) -> None:
        self.problem(
            node.line,
            "programs.urp.force_mode",
            "force mode is not followed; its poses are as programmed",
        )
        self.inside(node, move)

    def halt(self, node: Element, move: Element | None) -> None:
        raise Halt

    def set_(self, node: Element, move: Element | None) -> None:
        tcp = node.find("tcp")
        if tcp is not None:
            self.tool = self.target(tcp).get("referencedName", "")

    def contributed(self, node: Element, move: Element | None) -> None:
        name = node.get("strategyProgramNodeType") or "URCap"
        raise Unknown(
            "programs.urp.urcap",
            "the URCap node {name} is known to the controller only",
            name=name[:40],
        )

    def moves(self, element: Element) -> bool:
        """Whether anything in a node may move the robot."""
        if id(element) not in self.moving:
            self.moving[id(element)] = self.any_moves(element)
        return self.moving[id(element)]

    def any_moves(self, element: Element) -> bool:
        stack = [element]
        while stack:
            at = stack.pop()
            if at.tag in MOVING or (at.tag == "Script" and MOVE.search(self.raw(at))):
                return True
            stack += at.children
        return False

    def lose(self, element: Element) -> None:
        """Forgets the variables a node that is left out may assign."""
        stack = [element]
        while stack:
            at = stack.pop()
            stack += at.children
            if id(at) not in self.lost:  # the first time is no work beyond the file's own
                self.lost.add(id(at))
            else:
                self.passed += 1
                self.tick(at.line, self.passed % SKIPPED == 0)
            if at.tag == "variable":
                try:
                    name = self.target(at).get("name", "")
                except Unknown:
                    continue
                for scope in self.script.scopes:
                    scope.pop(name, None)
            elif at.tag == "Script":
                for name in self.assigned(at):
                    self.script.scopes[0].pop(name, None)

    def branch(self, node: Element, move: Element | None, taken: bool | None) -> bool | None:
        """If, ElseIf and Else follow each other; whether one of the chain was taken."""
        kind = node.get("type", "")
        if kind == "If":
            taken = False
        if taken is None:
            self.skip(
                node,
                Fact(
                    "programs.urp.follows_if",
                    "{word} follows an If that is decided at run time",
                    word=kind or "If",
                ),
            )
            return None
        if taken:
            return True
        try:
            known = kind == "Else" or self.truth(node)
        except Unknown as unknown:
            self.skip(
                node,
                Fact(
                    "programs.at_run_time",
                    "{word} is decided at run time ({reason})",
                    reason=unknown.fact,
                    word="If",
                ),
            )
            return None
        if known:
            self.inside(node, move)
        return known

    def truth(self, node: Element) -> bool:
        text = self.text(node.find("expression"))
        return truth(self.script.value(text))

    def skip(self, node: Element, why: Fact) -> None:
        if self.moves(node):
            self.problem(
                node.line, "programs.motions_left_out", "{what}; its motions are left out", what=why
            )
            self.gap(node.line)
        self.lose(node)

    def loop(self, node: Element, move: Element | None) -> None:
        kind = node.get("type", "").lower()
        if kind in ("forever", "always"):
            if self.moves(node):
                self.problem(
                    node.line, "programs.endless", "an endless {word} is followed once", word="Loop"
                )
            self.inside(node, move)
            return
        if node.find("expression") is not None and not kind.startswith("count"):
            for _ in range(MAX_LOOP):
                if not self.truth(node):
                    return
                self.tick(node.line)
                self.inside(node, move)
            raise ProgramError.at(
                self.file, node.line, "programs.endless_program", "the loop does not end"
            )
        for _ in range(self.count(node)):
            self.tick(node.line)
            self.inside(node, move)

    def count(self, node: Element) -> int:
        given = [v for k, v in node.attributes.items() if "count" in k.lower()]
        given += [c.text for c in node.children if c.text is not None]
        if len(given) != 1 or not re.fullmatch(r"\s*[0-9]{1,6}\s*", given[0]):
            raise Unknown(
                "programs.urp.loop_count", "how often the Loop runs is not given by a number"
            )
        return int(given[0])

    def call(self, node: Element, move: Element | None) -> None:
        holder = node.find("subprogram")
        if holder is None:
            holder = node.find("SubProgram")
        if holder is None:
            raise Unknown("programs.urp.no_subprogram", "which subprogram it calls is not said")
        called = self.target(holder)
        inner = called.find("children")
        if inner is None or not inner.children:
            name = called.get("name", "")[:60]
            raise Unknown(
                "programs.urp.empty_subprogram",
                "the subprogram {name} is empty here; it lies in a file of its own",
                name=name,
            )
        if self.calls >= MAX_CALLS:
            raise Unknown("programs.calls_itself", "it calls itself too deeply")
        self.calls += 1
        try:
            self.inside(called, None)
        finally:
            self.calls -= 1
