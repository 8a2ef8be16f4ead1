"""How a VAL3 program runs through blocks: decisions and loops, each as far as it is static."""

import re

from ...program import SKIPPED, Fact, ProgramError, Unknown, work_of
from .data import Missing, number
from .expression import place, split, truth
from .state import ASSIGNED, State

MOTION = re.compile(r"(?:([^=\"(]*)=(?!=)\s*)?((?:move|alterMove|alter)\w*)\s*\((.*)\)$")
MOVES = re.compile(r"(?<![\w.])(?:move|alter)\w*\s*\(")
ASSIGN = re.compile(r"([^\W\d]\w*(?:\[[^=]*\])?(?:\.\w+)*)\s*=(?!=)\s*(.+)$")
CALL = re.compile(r"call\s+(\w+(?::\w+)?)\s*(?:\((.*)\))?$", re.IGNORECASE)
INSTRUCTION = re.compile(r"(\w+(?::\w+)?)\s*\((.*)\)$")
FOR = re.compile(
    r"for\s+([^\W\d]\w*(?:\[[^=]*\])?)\s*=\s*(\S.*?)\sto\s+(.+?)(?:\sstep\s+(.+?))?(?:\sdo)?$",
    re.IGNORECASE,
)
NAME = re.compile(r"[^\W\d]\w*")
# Instructions that neither move the arm nor change data.
HARMLESS = frozenset(
    """
    waitEndMove open close delay watch wait resetMotion stopMove restartMove autoConnectMove
    resetTurn put putln cls gotoxy userPage title popUpMsg logMsg help setLanguage
    enablePower disablePower setMonitorSpeed setVelCmd getVersion
    taskKill taskSuspend taskResume taskStatus taskLock taskUnlock
    sioCtrl dioSet aioSet clearBuffer sioSet libLoad libSave libDelete setMutex
    """.split()
)


class Break(Exception):
    """The rest of a case is left."""

    def __init__(self, line):
        super().__init__(line)
        self.line = line


class Control(State):
    """Runs blocks of statements; ``statement(node)`` is what the reader adds."""

    def block(self, nodes):
        for node in nodes:
            self.tick(node.line, work_of(node.text))
            self.statement(node)

    def unknown(self, target, why):
        try:
            self.assign(target, Missing(why))
        except Unknown:
            match = NAME.match(target)
            if match:
                self.forget(match.group(), why)

    def handed(self, text):
        """What is handed to something that is not followed is not known afterwards."""
        try:
            for part in split(text):
                if ASSIGN.match(part + "=0") and "[" in part:
                    self.unknown(part, ASSIGNED)
                else:
                    self.lose(part)
        except Unknown:
            self.lose(text)

    def lose(self, text):
        """Whatever is named in a text may have changed."""
        for name in set(NAME.findall(text)):
            self.forget(name)

    def skip(self, nodes, line, message):
        """Leaves out statements that may or may not run: what they change is unknown then."""
        moves, stack, entered = False, list(nodes), set()
        while stack:
            node = stack.pop()
            self.tick(line, 1 + work_of(node.text) // SKIPPED)
            stack += node.body or []
            match = ASSIGN.match(node.text) if node.body is None else None
            if MOTION.match(node.text) and not match:
                moves = True
            elif match:
                try:
                    self.forget(place(match[1])[0])
                except Unknown:
                    self.lose(match[1])
            elif node.word == "for":
                self.lose(node.text.split("=")[0])
            elif node.body is None:
                called = INSTRUCTION.match(node.text)
                if not called or called[1] not in HARMLESS:
                    self.lose(node.text)
            moves = moves or bool(MOVES.search(node.text)) or node.word.startswith("taskcreate")
            call = CALL.match(node.text)
            moves = moves or (node.word == "call" and not call)
            if call and call[1] not in entered:
                entered.add(call[1])
                try:
                    inner = self.project.routine(call[1])
                    stack += inner.body if inner else []
                    moves = moves or inner is None
                except ProgramError:
                    moves = True
        if moves:
            self.problem(line, message)
            self.gap(line)

    def if_(self, node):
        branches = node.divided(("elseif", "else"))
        for k, (inner, body) in enumerate(branches):
            line, condition = inner.line, re.sub(r"(?i)^(?:else)?if", "", inner.text)
            condition = "true" if inner.word == "else" else condition
            self.tick(line, work_of(condition) if k else 0)
            try:
                known = truth(self.value(re.sub(r"(?i)\bthen\s*$", "", condition)))
            except Unknown as unknown:
                message = Fact(
                    "programs.decided_at_run_time",
                    "{word} is decided at run time ({reason}); its motions are left out",
                    reason=unknown.fact,
                    word="if",
                )
                self.skip([n for b in branches[k:] for n in b[1]], line, message)
                return
            if known:
                self.block(body)
                return

    def for_(self, node):
        match = FOR.match(node.text)
        try:
            if not match:
                raise Unknown("programs.it_is_not_understood", "it is not understood")
            target = match[1]
            first, last = number(self.value(match[2])), number(self.value(match[3]))
            step = number(self.value(match[4])) if match[4] else 1.0
            if step == 0.0:
                raise Unknown("programs.step_is_zero", "its {word} is 0", word="step")
        except Unknown as unknown:
            message = Fact(
                "programs.no_static_bounds",
                "{word} has no static bounds ({reason}); its motions are left out",
                reason=unknown.fact,
                word="for",
            )
            self.skip([node, *node.body] if not match else node.body, node.line, message)
            return
        k, value, slack = 0, first, 1e-9 * abs(step)
        try:
            while value <= last + slack if step > 0 else value >= last - slack:
                self.tick(node.line)
                self.assign(target, value)
                self.block(node.body)
                k, now = k + 1, number(self.value(target))
                if now != value:  # the loop has changed its variable
                    first, k = now, 1
                value = first + k * step
                if value == now:
                    raise Unknown("programs.val3.small_step", "the step is too small")
        except Unknown as unknown:
            message = Fact(
                "programs.val3.rest_left_out",
                "for goes on as only the controller knows ({reason}); the rest is left out",
                reason=unknown.fact,
            )
            self.skip(node.body, node.line, message)

    def while_(self, node):
        condition = re.sub(r"(?i)\bdo\s*$", "", node.text[5:])
        if re.fullmatch(r"[\s(]*true[\s)]*", condition):
            self.once(node)
            return
        try:
            while truth(self.value(condition)):
                self.tick(node.line, work_of(condition))
                self.block(node.body)
        except Unknown as unknown:
            message = Fact(
                "programs.decided_at_run_time",
                "{word} is decided at run time ({reason}); its motions are left out",
                reason=unknown.fact,
                word="while",
            )
            self.skip(node.body, node.line, message)

    def once(self, node):
        before = len(self.program.motions)
        self.block(node.body)
        if len(self.program.motions) > before:
            self.problem(
                node.line, "programs.endless", "an endless {word} is followed once", word="loop"
            )

    def do_(self, node):
        """do .. until; the body runs at least once."""
        while True:
            self.tick(node.line, work_of(node.text))
            if re.fullmatch(r"[\s(]*false[\s)]*", node.text):
                self.once(node)
                return
            self.block(node.body)
            try:
                if truth(self.value(node.text)):
                    return
            except Unknown as unknown:
                message = Fact(
                    "programs.val3.rounds_at_run_time",
                    "until is decided at run time ({reason}); further rounds are left out",
                    reason=unknown.fact,
                )
                self.skip(node.body, node.line, message)
                return

    def switch_(self, node):
        body = []
        try:
            value = self.value(node.text[6:])
            for inner, statements in node.divided(("case", "default"))[1:]:
                if inner.word == "default":
                    body = statements
                    continue
                self.tick(inner.line, work_of(inner.text))
                text = inner.text[4:].strip().rstrip(":")
                if any(self.value(part) == value for part in split(text)):
                    body = statements
                    break
        except Unknown as unknown:
            message = Fact(
                "programs.decided_at_run_time",
                "{word} is decided at run time ({reason}); its motions are left out",
                reason=unknown.fact,
                word="switch",
            )
            self.skip(node.body, node.line, message)
            return
        try:
            self.block(body)
        except Break:
            pass
