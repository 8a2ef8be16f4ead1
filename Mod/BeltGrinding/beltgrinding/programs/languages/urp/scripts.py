"""The script nodes, assignments and expressions of a PolyScope program, which URScript's reader follows."""

from __future__ import annotations

import re

from ...program import SKIPPED, Motion, Program, ProgramError, Unknown, lines_of, work_of
from ..core.tree import Node
from ..xml_tree import Element
from ..core.flow import Leave, Working
from ..urscript.pose import Pose
from .motion import Waypoints
from .position import Positions

ASSIGNED = re.compile(r"\b([A-Za-z_]\w*)\s*(?:\[[^\]\n]{0,200}\]\s*)?=(?!=)")
SIGNS = str.maketrans({"≟": "==", "≠": "!=", "≤": "<=", "≥": ">="})  # of the expression editor


class Halt(Exception):
    """The program ends here."""


class Scripts(Waypoints, Working):
    """Runs what is URScript in a program."""

    def __init__(self, name: str, root: Element) -> None:
        super().__init__(name, root)
        self.named = False  # whether the script knows the waypoints
        # (text, statements) of script nodes by their ids
        self.trees: dict[int, tuple[str, list[Node]]] = {}
        self.names: dict[int, set[str]] = {}  # variables that script nodes may assign, likewise

    def text(self, expression: Element | None) -> str:
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

    def script_text(self, node: Element) -> str:
        cached = node.find("cachedContents")
        if cached is not None:
            return cached.text or ""
        expression = node.find("expression")
        if expression is None:
            raise Unknown("programs.urp.no_script_text", "the script's text is not in the file")
        return self.text(expression)

    def raw(self, node: Element) -> str:
        try:
            return self.script_text(node)
        except Unknown:
            return "movel("

    def assignment(self, node: Element, move: Element | None) -> None:
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

    def assigned(self, node: Element) -> set[str]:
        """The variables that a script node may assign."""
        if id(node) not in self.names:
            self.names[id(node)] = set(ASSIGNED.findall(self.raw(node)))
        return self.names[id(node)]

    def script_(self, node: Element, move: Element | None) -> None:
        self.run_script(node, self.script_text(node))

    def run_script(self, node: Element, text: str) -> None:
        """Runs URScript; its motions get the line of the node."""
        if not self.named:
            self.name_waypoints()
        script = self.script
        script.program = Program("URScript", self.file)
        left = ""
        try:
            if self.trees.get(id(node), ("", []))[0] != text:
                self.trees[id(node)] = (text, script.tree(lines_of(text, self.file)))
            self.tick(node.line, work_of(text) // SKIPPED)
            script.block(self.trees[id(node)][1])
        except Leave as leave:
            left = leave.word
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
        if left == "exit":
            raise Halt

    def name_waypoints(self) -> None:
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
