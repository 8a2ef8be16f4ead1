"""Reads programs of Universal Robots' PolyScope: .urp, XML packed by gzip.

Poses are those of the TCP in the move's feature as it stood when the waypoint was taught
(``urp_position`` says how); ``base`` names a feature other than the robot's base. Lines are those of
the XML. Script nodes, assignments and conditions are followed by the URScript reader. What only the
controller can know (variable and relative waypoints, URCaps, waypoints of joints without the arm's
kinematics) is a Problem.
"""

import re

import numpy as np

from ....base.stopping import check
from ...program import (
    MAX_UNROLLED,
    SKIPPED,
    Fact,
    Motion,
    Program,
    ProgramError,
    Unknown,
    lines_of,
    name_of,
    work_of,
)
from ..urscript.expression import Pose
from ..urscript.reader import MOVE
from ..xml_tree import read_xml
from .motion import Waypoints
from .position import Positions, keep_kinematics

MAX_MOTIONS = 1_000_000
ASSIGNED = re.compile(r"\b([A-Za-z_]\w*)\s*(?:\[[^\]\n]{0,200}\]\s*)?=(?!=)")
MAX_CALLS = 20
MAX_LOOP = 100_000
THE_BASE = Fact("programs.urp.base", "the base")
SIGNS = str.maketrans({"≟": "==", "≠": "!=", "≤": "<=", "≥": ">="})  # of the expression editor
HARMLESS = frozenset(
    "Wait Comment Popup Placeholder Timer InitVariablesNode Halt EmptyNode kinematics".split()
)
MOVING = frozenset("Move Waypoint CircleMove CallSubProgram Contributed Direction".split())


def read(path):
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
    try:
        reader.run()
    except RecursionError:
        raise ProgramError.at(
            reader.file, reader.line, "programs.nested_calls", "calls are nested too deeply"
        ) from None
    return reader.finish()


class _Halt(Exception):
    """The program ends here."""


class _Reader(Waypoints):
    """Follows the nodes of a program from top to bottom."""

    def __init__(self, name, root):
        super().__init__(name, root)
        self.named = False  # whether the script knows the waypoints
        self.rounds = self.calls = 0
        self.seen = set()
        self.trees = {}  # (text, statements) of script nodes by their ids
        self.names = {}  # variables that script nodes may assign, likewise
        self.moving = {}  # what ``moves`` found, likewise
        self.lost, self.passed = set(), 0  # nodes that were left out, and how often again

    def tick(self, line, work=1):
        check()
        self.line, self.rounds = line, self.rounds + work
        if self.rounds > MAX_UNROLLED or len(self.program.motions) > MAX_MOTIONS:
            raise ProgramError.at(
                self.file,
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )

    def finish(self):
        for motion in self.positions.finish():
            self.problem(
                motion.line,
                "programs.urp.far_pose",
                "the waypoint's pose is no robot's; it is left out",
            )
        self.program.base_frames.update(self.positions.frames)
        self.program.base_frames[""] = np.eye(4)  # the robot's base
        return self.program

    def run(self):
        tops = self.root.find("children")
        tops = tops.children if tops is not None else ()
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
        except _Halt:
            pass

    def inside(self, element, move):
        """Runs the nodes below an element; ``move``: the Move they are in, or None."""
        holder = element.find("children")
        if holder is not None and id(holder) not in self.seen:
            self.seen.add(id(holder))
            self.rounds -= len(holder.children)  # what the file has is no work beyond it
        taken = None  # of a chain of If nodes: True, False, or None
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

    def node(self, node, move):
        tag = node.tag
        if tag == "Move":
            self.inside(node, node)
        elif tag == "Waypoint":
            self.waypoint(node, move)
        elif tag == "CircleMove":
            self.circle(node, move)
        elif tag in ("Folder", "Force"):
            if tag == "Force":
                self.problem(
                    node.line,
                    "programs.urp.force_mode",
                    "force mode is not followed; its poses are as programmed",
                )
            self.inside(node, move)
        elif tag == "Loop":
            self.loop(node, move)
        elif tag == "CallSubProgram":
            self.call(node)
        elif tag == "Script":
            self.run_script(node, self.script_text(node))
        elif tag == "Assignment":
            self.assignment(node)
        elif tag == "Halt":
            raise _Halt
        elif tag == "Set":
            tcp = node.find("tcp")
            if tcp is not None:
                self.tool = self.target(tcp).get("referencedName", "")
        elif tag == "Contributed":
            name = node.get("strategyProgramNodeType") or "URCap"
            raise Unknown(
                "programs.urp.urcap",
                "the URCap node {name} is known to the controller only",
                name=name[:40],
            )
        elif tag not in HARMLESS:
            if self.moves(node):
                raise Unknown(
                    "programs.urp.unsupported_node", "the node {tag} is not supported", tag=tag[:40]
                )
            self.lose(node)
            self.problem(
                node.line,
                "programs.urp.unknown_node",
                "the node {tag} is not known here",
                tag=tag[:40],
            )

    def moves(self, element):
        """Whether anything in a node may move the robot."""
        if id(element) not in self.moving:
            self.moving[id(element)] = self.any_moves(element)
        return self.moving[id(element)]

    def any_moves(self, element):
        stack = [element]
        while stack:
            at = stack.pop()
            if at.tag in MOVING or (at.tag == "Script" and MOVE.search(self.raw(at))):
                return True
            stack += at.children
        return False

    def raw(self, node):
        try:
            return self.script_text(node)
        except Unknown:
            return "movel("

    def lose(self, element):
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

    def assigned(self, node):
        """The variables that a script node may assign."""
        if id(node) not in self.names:
            self.names[id(node)] = set(ASSIGNED.findall(self.raw(node)))
        return self.names[id(node)]

    def branch(self, node, move, taken):
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

    def truth(self, node):
        text = self.text(node.find("expression"))
        return self.script.truth(text)

    def skip(self, node, why):
        if self.moves(node):
            self.problem(
                node.line, "programs.motions_left_out", "{what}; its motions are left out", what=why
            )
            self.gap(node.line)
        self.lose(node)

    def loop(self, node, move):
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

    def count(self, node):
        given = [v for k, v in node.attributes.items() if "count" in k.lower()]
        given += [c.text for c in node.children if c.text is not None]
        if len(given) != 1 or not re.fullmatch(r"\s*[0-9]{1,6}\s*", given[0]):
            raise Unknown(
                "programs.urp.loop_count", "how often the Loop runs is not given by a number"
            )
        return int(given[0])

    def call(self, node):
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

    def text(self, expression):
        """An <expression> as URScript. Raises Unknown."""
        pieces = []
        for part in expression.children if expression is not None else ():
            if part.tag == "ExpressionChar":
                pieces.append(part.get("character", ""))
            elif part.tag == "ExpressionToken":
                pieces.append(part.get("token", ""))
            elif part.tag == "ExpressionVariable":
                inner = part.children[0] if part.children else part
                pieces.append(self.target(inner).get("name", "") or "?")
            else:
                raise Unknown(
                    "programs.urp.expression_with",
                    "an expression with {tag} is not understood",
                    tag=part.tag[:40],
                )
        if not pieces:
            raise Unknown("programs.urp.empty_expression", "the expression is empty")
        return "".join(pieces).translate(SIGNS)

    def script_text(self, node):
        cached = node.find("cachedContents")
        if cached is not None:
            return cached.text or ""
        expression = node.find("expression")
        if expression is None:
            raise Unknown("programs.urp.no_script_text", "the script's text is not in the file")
        return self.text(expression)

    def assignment(self, node):
        variable = node.find("variable")
        if variable is None:
            raise Unknown("programs.urp.no_variable", "what is assigned is not said")
        name = self.target(variable).get("name", "")
        if not re.fullmatch(r"[A-Za-z_]\w*", name):
            raise Unknown("programs.urp.variable_name", "the variable's name is not understood")
        try:
            self.run_script(node, f"global {name} = {self.text(node.find('expression'))}")
        except Unknown:  # whoever uses it reports it
            self.script.scopes[0].pop(name, None)

    def run_script(self, node, text):
        """Runs URScript; its motions get the line of the node."""
        if not self.named:
            self.name_waypoints()
        script = self.script
        script.program = Program("URScript", self.file)
        end = None
        try:
            if self.trees.get(id(node), ("",))[0] != text:
                self.trees[id(node)] = (text, script.tree(lines_of(text, self.file)))
            self.tick(node.line, work_of(text) // SKIPPED)
            end = script.block(self.trees[id(node)][1])
        except ProgramError as error:
            raise Unknown(
                "programs.urp.script",
                "its script cannot be followed ({reason})",
                reason=error.fact,
            ) from None
        finally:
            for problem in script.program.problems:
                self.problem(
                    node.line,
                    "programs.urp.script_line",
                    "script line {number}: {what}",
                    number=problem.line,
                    what=problem.message,
                )
            for motion in script.program.motions:
                motion.line = node.line
            self.program.motions += script.program.motions
        if end == "halt":
            raise _Halt

    def name_waypoints(self):
        """PolyScope gives each fixed waypoint's pose to its scripts as NAME_p."""
        self.named = True
        waypoints, stack, found = [], [self.root], Positions()
        while stack:
            at = stack.pop()
            stack += at.children
            if at.tag == "Waypoint" and re.fullmatch(r"[A-Za-z_]\w*", at.get("name", "")):
                motion = Motion("LIN", None, at.line, at.get("name"))
                try:
                    self.place(at, motion, found, in_base=True)
                    waypoints.append(motion)
                except Unknown:
                    continue
        found.finish()
        for motion in waypoints:
            if motion.pose is not None:
                frame = motion.pose.copy()
                frame[:3, 3] /= 1000.0
                self.script.scopes[0][f"{motion.file}_p"] = Pose(frame)
