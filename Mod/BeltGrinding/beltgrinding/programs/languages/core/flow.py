"""The way through a program's blocks: branches, loops and jumps, each as far as what decides it is known.

What is decided at run time is left out: its motions are a gap, and what it may change is not known behind it.
"""

from __future__ import annotations

import contextlib
import operator
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from ....base.kinds import known
from ....base.stopping import check
from ... import force_device
from ...program import MAX_UNROLLED, SKIPPED, Fact, Program, ProgramError, Reason, Unknown, work_of
from .values import Evaluated
from .expression import number, truth
from .tree import Node, every

MAX_MOTIONS = 1_000_000
HEAD = re.compile(r"\s*\w+")
TAIL = re.compile(r"(?:\bthen|\bdo|\bof|:)\s*$", re.IGNORECASE)
TRUE = re.compile(r"[\s(]*true[\s)]*", re.IGNORECASE)
FALSE = re.compile(r"[\s(]*false[\s)]*", re.IGNORECASE)
SLACK = 1e-9  # of a step, by which a counter may pass its end


class Leave(Exception):
    """A statement leaves a loop ("break", "continue"), the routine ("return") or the program ("exit")."""

    def __init__(self, word: str, line: int, value: Any = None) -> None:
        super().__init__(word)
        self.word, self.line, self.value = word, line, value


class Jump(Exception):
    """A jump of a Node to a label; with a Reason why it is decided at run time, to one of ``labels``."""

    def __init__(
        self, labels: set[str], line: int, node: Node, reason: Reason | None = None
    ) -> None:
        super().__init__(*labels)
        self.labels, self.line, self.node, self.reason = labels, line, node, reason

    @property
    def label(self) -> str:
        return min(self.labels)


class Working:
    """Counts the work that a program takes; ``program`` and ``file`` are the reader's."""

    program: Program
    file: str
    line = 0
    rounds = 0  # units of work; below 0: what the file allows
    overrun = False

    def tick(self, line: int, work: int = 1) -> None:
        check()
        self.line = line
        self.rounds += work
        if self.rounds > MAX_UNROLLED or len(self.program.motions) > MAX_MOTIONS:
            self.overrun = True
            raise ProgramError.at(
                self.file,
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )


class Flow(Working):
    """Runs Nodes. A language says what is its own:

    ``BLOCKS``: {word: "if_", "for_", "while_", "until_" or "switch_"}; ``OTHERWISE``: the words that divide an
    "if", ``CASES`` those that divide a "switch"; ``LEAVING``: the words of statements that leave a loop, and
    may do so anywhere. ``value(text)``: that of an expression; ``series(text)``: functions of the
    expressions in a list; ``counted(node)``: (target, first, last, step or None) of a "for", as text, or None;
    ``assign(target, value)``; ``statement(node)``: runs any other; ``may_change(node)``: makes unknown
    what a statement changes, and gives (whether it may move the robot, the bodies of routines that it calls,
    by their names). ``problem``, ``gap``, ``program``, ``file`` and ``line`` are the reader's.
    """

    value: Callable[..., Any]
    counted: Callable[..., Sequence[Any] | None]
    assign: Callable[..., None]
    statement: Callable[..., None]
    may_change: Callable[..., tuple[bool, Mapping[str, Sequence[Node]]]]
    problem: Callable[..., None]
    gap: Callable[..., None]
    PARSER: Any

    BLOCKS: Mapping[str, str] = {}
    OTHERWISE: tuple[str, ...] = ("elseif", "else")
    CASES: tuple[str, ...] = ("case", "default")
    LEAVING: frozenset[str] = frozenset()
    RETURNING: frozenset[str] = frozenset()  # of those, the words that end a routine or the program
    MAY_RETURN = (
        "programs.krl.may_leave",
        "whether {word} is reached is decided at run time; the program is read as if it were not",
    )
    SHOUTED = False  # whether its words are written in upper case

    truth: Callable[..., bool] = staticmethod(truth)  # of the value of a condition
    alike: Callable[..., bool] = staticmethod(
        operator.eq
    )  # whether a case has the value of its switch
    changes = 0  # of data, as far as assign() counts them
    doubt = False  # the loop may have been left
    unreached = False  # an endless loop is behind
    device_N: float | None = None  # by the program's force device; None: the program has set none
    pressed = 0  # so many motions have their force

    def cost(self, node: Node) -> int:
        """Units of work that a statement takes."""
        return work_of(node.text)

    def shown(self, node: Node) -> str:
        """The word of a block as a problem names it."""
        return node.word.upper() if self.SHOUTED else node.word

    def condition(self, text: str) -> str:
        """The expression of a statement without its words."""
        return TAIL.sub("", HEAD.sub("", text, count=1))

    def series(self, text: str) -> Iterable[Evaluated]:
        """Functions of the expressions in the text of a list."""
        return self.PARSER.list(text)[0]

    def block(self, nodes: Sequence[Node]) -> None:
        at = 0
        while at < len(nodes):
            node = nodes[at]
            self.tick(node.line, self.cost(node))
            at += 1
            try:
                if node.word in self.BLOCKS and node.body is not None:
                    getattr(self, self.BLOCKS[node.word])(node)
                elif not self.sets_force(node.line, node.text):
                    self.statement(node)
            except Jump as jump:
                at = self.jumped(jump, nodes, at)
            finally:
                self.press()

    def sets_force(self, line: int, text: str) -> bool:
        """Whether a statement is the force device's (``force_device.reading``); the motions after it have its force."""
        operand = self.device_operand(text)
        if operand is None:
            return False
        self.press()
        self.device_N = None
        try:
            literal = force_device.NUMBER.fullmatch(operand)
            value = float(operand) if literal else number(self.value(operand))
            self.device_N = known(force_device.in_use()).newton(value)
        except Unknown as unknown:
            self.program.need(unknown)
            self.problem(
                line,
                "programs.force_unknown",
                "the force of {what} is not known: {reason}; that of the job is taken",
                what=text[:40],
                reason=unknown.fact,
            )
        return True

    def may_set_force(self, line: int, text: str) -> None:
        """Makes the force unknown where a statement that may run or not is the force device's."""
        if self.device_operand(text) is not None:
            self.press()
            self.device_N = None
            told = Fact(
                "programs.force_at_run_time",
                "whether {what} runs is decided at run time; the motions after it are read without it",
                what=text[:40],
            )
            said: set[tuple[str, int]] = vars(self).setdefault("forces_said", set())
            if (self.file, line) not in said:
                said.add((self.file, line))
                self.problem(line, told)

    def device_operand(self, text: str) -> str | None:
        device = force_device.in_use()
        return None if device is None else device.operand(self.program.language, text)

    def press(self) -> None:
        """Gives the motions since the last call the device's force, those of an arc that is not complete too."""
        motions = self.program.motions
        if self.device_N is not None:
            for motion in (*motions[self.pressed :], *getattr(self, "arc", ())):
                if motion.force_N is None and motion.kind not in ("PTP", "GAP"):
                    motion.force_N = self.device_N
        self.pressed = len(motions)

    def jumped(self, jump: Jump, nodes: Sequence[Node], at: int) -> int:
        """Where a block goes on after a jump. Raises it on where its label is in a block around."""
        raise jump

    def decided(self, node: Node, reason: Reason, nodes: Sequence[Node], line: int) -> None:
        """Leaves out ``nodes``, which may run or not for a Reason that ``node`` gives."""
        message = Fact(
            "programs.decided_at_run_time",
            "{word} is decided at run time ({reason}); its motions are left out",
            reason=reason.fact,
            word=self.shown(node),
        )
        self.skip(nodes, line, message, reason)

    def skip(self, nodes: Sequence[Node], line: int, message: Fact, why: Reason) -> None:
        """Leaves out statements that may or may not run: what they change is unknown then. ``message`` says so;
        ``why``: the Reason."""
        self.may_return(nodes)
        moves, stack = False, list(nodes)
        entered: set[str] = set()
        while stack:
            node = stack.pop()
            self.tick(line, 1 + work_of(node.text) // SKIPPED)
            stack += node.body or []
            self.doubt |= self.leaves(node)
            self.may_set_force(node.line, node.text)
            moved, called = self.may_change(node)
            for name in called.keys() - entered:
                entered.add(name)
                stack += called[name]
            moves |= moved
        if moves:
            self.program.need(why)
            self.problem(line, message)
            self.gap(line)

    def may_return(self, nodes: Sequence[Node]) -> None:
        """Tells of the ends of a routine among statements that may run; those of what they call end that alone."""
        for node in every(nodes):
            word = self.returns(node)
            if word:
                self.may_leave(node.line, word)

    def may_leave(self, line: int, word: str) -> None:
        """Tells of the end of a routine that may be reached, once, however often a loop comes by."""
        said: set[tuple[str, int]] = vars(self).setdefault("ends_said", set())
        if (self.file, line) not in said:
            said.add((self.file, line))
            self.problem(line, *self.MAY_RETURN, word=word)

    def returns(self, node: Node) -> str:
        """The word with which a statement ends its routine or the program, ""."""
        return self.shown(node) if node.word in self.RETURNING else ""

    def leaves(self, node: Node) -> bool:
        """Whether a statement leaves the loop around it, or more."""
        return node.word in self.LEAVING

    def if_(self, node: Node) -> None:
        branches = node.divided(self.OTHERWISE)
        for k, (inner, body) in enumerate(branches):
            known = inner.word == "else"
            if not known:
                self.tick(inner.line, work_of(inner.text) if k else 0)
                try:
                    known = self.truth(self.value(self.condition(inner.text)))
                except Unknown as unknown:
                    left = [one for _, body in branches[k:] for one in body]
                    self.decided(node, unknown, left, inner.line)
                    return
            if known:
                self.block(body)
                return

    def switch_(self, node: Node) -> None:
        chosen: Sequence[Node] = []
        try:
            value = self.value(self.condition(node.text))
            for inner, body in node.divided(self.CASES)[1:]:
                if inner.word == "default":
                    chosen = body
                    continue
                self.tick(inner.line, work_of(inner.text))
                if any(
                    self.alike(one(self), value) for one in self.series(self.condition(inner.text))
                ):
                    chosen = body
                    break
        except Unknown as unknown:
            self.decided(node, unknown, known(node.body), node.line)
            return
        self.block(chosen)

    def one_pass(self, node: Node) -> str:
        """Runs a loop's body once: "break" where it is left, "doubt" where it may have been, else ""."""
        outer, self.doubt = self.doubt, False
        left = ""
        try:
            self.block(known(node.body))
        except Leave as leave:
            if leave.word not in ("break", "continue"):
                raise
            left = leave.word if leave.word == "break" else ""
        finally:
            doubt, self.doubt = self.doubt, outer
        return "doubt" if doubt and not left else left

    def while_(self, node: Node) -> None:
        self.repeated(node, self.condition(node.text), None)

    def until_(self, node: Node) -> None:
        """A loop whose text is the condition at its end."""
        self.repeated(node, None, node.text)

    def repeated(self, node: Node, before: str | None, after: str | None) -> None:
        """Passes of a loop; ``before``, ``after``: the condition to go on, or to end; None: there is none."""
        before = None if before is None or TRUE.fullmatch(before) else before
        after = None if after is None or FALSE.fullmatch(after) else after
        mark: tuple[int, int] | None = None
        reason: Reason | None = None
        endless = before is None and after is None
        if endless and not any(map(self.leaves, every(known(node.body)))):
            self.once(node)
            return
        try:
            while True:
                self.tick(node.line, work_of(node.text))
                try:
                    if before is not None and not self.truth(self.value(before)):
                        return
                except Unknown as unknown:
                    if mark is None:
                        self.decided(node, unknown, known(node.body), node.line)
                        return
                    reason = unknown
                    break
                changes = self.changes
                left = self.one_pass(node)
                mark = mark or (len(self.program.motions), len(self.program.problems))
                if left == "break":
                    return
                if left == "doubt":
                    break
                try:
                    if after is not None and self.truth(self.value(after)):
                        return
                except Unknown as unknown:
                    reason = unknown
                    break
                if changes == self.changes or not node.closed:  # nor is it known what belongs to it
                    del self.program.motions[mark[0] :], self.program.problems[mark[1] :]
                    self.endless(node)
                    return
        except ProgramError:
            if self.overrun and mark:
                self.cut(node, *mark)
            raise
        self.open_ended(node, reason)

    def once(self, node: Node) -> None:
        """An endless loop, of which one pass is followed."""
        before = len(self.program.motions)
        self.one_pass(node)
        if len(self.program.motions) > before:
            self.endless(node)

    def endless(self, node: Node) -> None:
        self.problem(
            node.line,
            "programs.endless",
            "an endless {word} is followed once",
            word=self.shown(node),
        )
        self.unreached = True

    def reached(self, line: int) -> None:
        """Is called before a motion: behind an endless loop it is not reached from that loop's first pass."""
        if self.unreached:
            self.unreached = False
            self.gap(line)

    def cut(self, node: Node, motions: int, problems: int) -> None:
        """Leaves an endless loop: what it did behind its first pass goes."""
        del self.program.motions[motions:], self.program.problems[problems:]
        self.endless(node)
        self.gap(node.line)
        raise Leave("exit", node.line)

    def open_ended(self, node: Node, reason: Reason | None = None) -> None:
        """A loop of which not all passes are known."""
        message = Fact(
            "programs.passes",
            "how often {word} runs is decided at run time ({reason}); its further motions are left out",
            word=self.shown(node),
            reason=reason.fact if reason else Fact("programs.left_within", "it may be left within"),
        )
        self.skip(known(node.body), node.line, message, reason or Reason(message))

    def for_(self, node: Node) -> None:
        try:
            found = self.counted(node)
            if found is None:
                raise Unknown("programs.it_is_not_understood", "it is not understood")
            target, *texts = found
            first, last, step = self.bounds(*texts)
            if step == 0.0:
                raise Unknown("programs.step_is_zero", "its {word} is 0", word="step")
        except Unknown as unknown:
            message = Fact(
                "programs.no_static_bounds",
                "{word} has no static bounds ({reason}); its motions are left out",
                reason=unknown.fact,
                word=self.shown(node),
            )
            self.skip([node], node.line, message, unknown)
            return
        with self.counter(target):
            self.passes(node, target, first, last, step)

    def counter(self, target: str) -> contextlib.AbstractContextManager[Any]:
        """A context in which the counter of a "for" lives."""
        return contextlib.nullcontext()

    def bounds(self, first: str, last: str, step: str | None) -> tuple[float, float, float]:
        """Numbers of a "for". Raises Unknown."""
        return (
            number(self.value(first)),
            number(self.value(last)),
            number(self.value(step)) if step else 1.0,
        )

    def passes(self, node: Node, target: str, first: float, last: float, step: float) -> None:
        k, value, slack = 0, first, SLACK * abs(step)
        reason: Reason | None = None
        try:
            while value <= last + slack if step > 0 else value >= last - slack:
                self.tick(node.line)
                self.assign(target, value)
                left = self.one_pass(node)
                if left == "break":
                    return
                if left == "doubt":
                    break
                k, now = k + 1, number(self.value(target))
                if now != value:  # the loop has changed its variable
                    first, k = now, 1
                value = first + k * step
                if value == now:
                    raise Unknown("programs.small_step", "the step is too small")
            else:
                return
        except Unknown as unknown:
            reason = unknown
        self.open_ended(node, reason)
