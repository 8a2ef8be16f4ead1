"""Jumps to labels, which are Nodes of the word "label" with the label as their text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

from ....base.kinds import known
from ...program import Fact, Reason, Unknown
from .flow import Flow, Jump, Leave
from .tree import Node, every


# What a jump back has seen: states, rounds; how many motions and problems there were before.
Rounds: TypeAlias = tuple[set[Any], int, int, int]


class Jumping(Flow):
    """A Flow with jumps. One back is followed as long as what decides how it goes on changes; what one decided at
    run time jumps over, or would run again, may run or not.

    ``leads_to(node)``: the label to which a statement jumps, of a language whose blocks may be left by a jump.
    """

    MAX_ROUNDS: float = 1000  # of a jump back

    def __init__(self) -> None:
        self.jumps: dict[int, Rounds] = {}  # of each jump back, by the id of its Node
        self.skipping = False  # what a jump passes over is left out
        # Of labels in a block, by the id of its list
        self.label_places: dict[int, tuple[dict[str, int], Sequence[Node]]] = {}

    def leads_to(self, node: Node) -> str | None:
        return None

    def state(self) -> Any:
        """What is the same again where a jump back leads nowhere else than the last time."""
        return self.changes

    def goes_to(self, node: Node, label: str, condition: str | None = None) -> None:
        """Jumps, where the text of a condition holds."""
        reason: Reason | None = None
        try:
            if condition and not self.truth(self.value(condition)):
                return
        except Unknown as unknown:
            reason = unknown
        self.perhaps_goes_to(node, label, reason)

    def perhaps_goes_to(self, node: Node, label: str, reason: Reason | None) -> None:
        """Jumps, or (``reason`` is not None) may do so."""
        raise Jump({label}, node.line, node, reason)

    def skip(self, nodes: Sequence[Node], line: int, message: Fact, why: Reason) -> None:
        """As Flow's; a jump among the statements may lead out of them, so it is decided at run time, too."""
        super().skip(nodes, line, message, why)
        labels: set[str] = set() if self.skipping else self._out_of(nodes)
        if labels:
            node = next(node for node in every(nodes) if self.leads_to(node) in labels)
            raise Jump(labels, line, node, why)

    def _out_of(self, nodes: Sequence[Node]) -> set[str]:
        """The labels outside of Nodes to which a jump among them, or within them, leads."""
        inside: set[str] = set()
        led: set[Any] = set()
        for node in every(nodes):
            if node.word == "label":
                inside.add(node.text)
            else:
                led.add(self.leads_to(node))
        return led - inside - {None}

    def labels_of(self, nodes: Sequence[Node]) -> dict[str, int]:
        """{label: its place} in a block; of two the first."""
        if id(nodes) not in self.label_places:
            found: dict[str, int] = {}
            for k, node in enumerate(nodes):
                if node.word == "label":
                    found.setdefault(node.text, k)
            # The list is kept, for its id to stay its own.
            self.label_places[id(nodes)] = found, nodes
        return self.label_places[id(nodes)][0]

    def jumped(self, jump: Jump, nodes: Sequence[Node], at: int) -> int:
        if jump.reason is not None:
            return self._perhaps(jump, nodes, at)
        label = self.labels_of(nodes).get(jump.label)
        if label is None:
            raise jump
        if label >= at:
            return label
        program = self.program
        fresh: Rounds = set(), 0, len(program.motions), len(program.problems)
        states, rounds, motions, problems = self.jumps.setdefault(id(jump.node), fresh)
        state = self.state()
        if state in states or rounds >= self.MAX_ROUNDS:
            del program.motions[motions:], program.problems[problems:]
            self.endless(jump.node)
            return self.never_left(jump, at)
        states.add(state)
        self.jumps[id(jump.node)] = states, rounds + 1, motions, problems
        return label

    def never_left(self, jump: Jump, at: int) -> int:
        """Where a block goes on behind a jump back without an end."""
        raise Leave("exit", jump.line)

    def overlong(self) -> Rounds | None:
        """After what a file allows is used up in jumps back: what they did behind their first pass goes; gives the
        first of them, None where they move nothing."""
        first = min(self.jumps.values(), key=lambda one: one[2:], default=None)
        if first is None or not self.overrun or len(self.program.motions) <= first[2]:
            return None
        del self.program.motions[first[2] :], self.program.problems[first[3] :]
        return first

    def _perhaps(self, jump: Jump, nodes: Sequence[Node], at: int) -> int:
        """Where a block goes on after a jump that may be made or not; raises it on where a label is in a block
        around."""
        labels, outer = set(jump.labels), self.skipping
        seen: set[str] = set()
        begin, end = at - 1, at
        while labels - seen:
            seen |= labels
            of = self.labels_of(nodes)
            places = [of[label] for label in seen if label in of]
            missing = seen - of.keys()
            begin = min([begin, *places])
            end = len(nodes) if missing else max([end, *places])
            labels = seen | self._out_of(nodes[begin:end])
        self.skipping = True
        try:
            if begin < at - 1:
                self.again(jump, nodes[begin:at])
            # A branch with the jump is left out already; of a loop not what is before it.
            around = nodes[at - 1]
            own = around is jump.node or self.BLOCKS.get(around.word) not in ("if_", "switch_")
            if end > at or begin == at - 1:
                self.decided(jump.node, known(jump.reason), nodes[at - own : end], jump.line)
        finally:
            self.skipping = outer
        if missing:
            jump.labels = missing
            raise jump
        return end

    def again(self, jump: Jump, nodes: Sequence[Node]) -> None:
        """Statements to which a jump may lead back."""
        self.decided(jump.node, known(jump.reason), nodes, jump.line)

    def no_label(self, jump: Jump) -> None:
        """What a jump leads to is not known."""
        self.problem(jump.line, "programs.no_label", "there is no label {label}", label=jump.label)
        self.gap(jump.line)
