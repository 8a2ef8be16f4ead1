"""How a RAPID program runs through blocks: branches, loops, jumps, each as far as it is static."""

import re

from ....base.stopping import check
from ...program import MAX_UNROLLED, SKIPPED, Fact, ProgramError, Unknown, work_of
from . import data
from .calls import HARMLESS, Jump
from .data import number
from .expression import Reader, arguments, text_after, tokens, truth
from .motion import MotionRunner, spec_of
from .text import Node

MAX_MOTIONS = 1_000_000
FOR = re.compile(
    r"FOR\s+(\w+)\s+FROM\s+(\S.*?)\sTO\s+(.+?)(?:\sSTEP\s+(.+))?$", re.IGNORECASE | re.DOTALL
)
TARGET = re.compile(r"\s*(\w+)\s*(?:\{[^}]*\}\s*|\.\s*\w+\s*)*:=")


class Control(MotionRunner):
    """Runs blocks of statements; ``statement(node)`` is what a language's reader adds."""

    def __init__(self, path, given=None):
        super().__init__(path, given)
        self.routines = {}  # (node, parameters, body) by name
        self.labels = {}  # places of labels in a block, by the id of its list
        self.rounds = 0  # units of work; below 0: what the file allows
        self.line = 1

    def tick(self, line, rounds=1):
        check()
        self.line = line
        self.rounds += rounds
        if self.rounds > MAX_UNROLLED or len(self.program.motions) > MAX_MOTIONS:
            raise ProgramError.at(
                self.file,
                line,
                "programs.too_long",
                "the program is too long or does not end; split it, or shorten its loops",
            )

    def block(self, nodes):
        at = 0
        while at < len(nodes):
            node = nodes[at]
            self.tick(node.line, work_of(node.text) + 2 * node.text.count("("))
            at += 1
            try:
                self.statement(node)
            except Jump as jump:
                label = self.labels_of(nodes).get(jump.label)
                if label is None:
                    raise
                if label >= at:
                    at = label
                else:
                    self.problem(
                        jump.line,
                        "programs.rapid.goto_back",
                        "GOTO {label} jumps back; it is followed once",
                        label=jump.label,
                    )

    def labels_of(self, nodes):
        """{label: its place} in a block."""
        if id(nodes) not in self.labels:
            found = {}
            for k, node in enumerate(nodes):
                if node.word == "label":
                    found.setdefault(node.text, k)
            self.labels[id(nodes)] = (found, nodes)  # the list is kept, for its id to stay its own
        return self.labels[id(nodes)][0]

    def copy(self, value, line):
        """A copy of data; large data counts as many statements. Raises Unknown beyond reason."""
        size = data.bounded_size(value, data.MAX_ARRAY)
        if size > data.MAX_ARRAY:
            raise Unknown("programs.rapid.array_size", "the array's size is not sensible")
        if size > data.MAX_RECORD:
            self.tick(line, size // 8)
        return data.copied(value)

    def skip(self, nodes, line, message):
        """Leaves out statements that may or may not run: what they change is unknown then."""
        moves, stack, entered = False, list(nodes), set()
        while stack:
            node = stack.pop()
            self.tick(line, 1 + work_of(node.text) // SKIPPED)
            stack += node.body or []
            words = [w.lower() for w in re.findall(r"\w+", node.text)]
            target = TARGET.match(node.text)
            if target:
                self.forget(target.group(1).lower())
            elif node.word not in HARMLESS:
                specs = [spec for spec in map(spec_of, words) if spec]
                for word in words[1:] if not specs or specs[0][2] else []:  # a search writes
                    self.forget(word)
            found = words if node.word == "if;" else words[:1]
            if {"pdispset", "pdispon", "pdispoff"} & set(found):
                self.displacement = False
            for routine in set(found) & self.routines.keys() - entered:
                entered.add(routine)
                stack += self.routines[routine][2]
            moves = moves or any(spec_of(w) is not None or w in self.routines for w in found)
        if moves:
            self.problem(line, message)
            self.gap(line)

    def if_(self, node):
        branches = node.divided(("elseif", "else"))
        for k, (inner, body) in enumerate(branches):
            line, condition = inner.line, re.sub(r"(?i)^(?:ELSE)?IF\b", "", inner.text)
            condition = "TRUE" if inner.word == "else" else condition
            self.tick(line, work_of(condition) if k else 0)
            try:
                known = truth(self.value(tokens(condition)))
            except Unknown as unknown:
                message = Fact(
                    "programs.decided_at_run_time",
                    "{word} is decided at run time ({reason}); its motions are left out",
                    reason=unknown.fact,
                    word="IF",
                )
                self.skip([n for b in branches[k:] for n in b[1]], line, message)
                return
            if known:
                self.block(body)
                return

    def short_if(self, node):
        try:
            row = tokens(node.text)
            reader = Reader(row[1:], self)
            known = truth(reader.expression())
        except Unknown as unknown:
            message = Fact(
                "programs.rapid.motion_at_run_time",
                "{word} is decided at run time ({reason}); its motion is left out",
                reason=unknown.fact,
                word="IF",
            )
            self.skip([node], node.line, message)
            return
        rest = text_after(node.text, reader.at + 1)
        word = re.match(r"\w+", rest)
        self.tick(node.line, work_of(rest))
        if known and word:
            self.statement(Node(node.line, word.group().lower(), rest))
        elif not word:
            self.problem(
                node.line,
                "programs.rapid.if_without_statement",
                "IF has neither THEN nor a statement",
            )

    def for_(self, node):
        match = FOR.match(" ".join(node.text.split()))
        try:
            if not match:
                raise Unknown("programs.it_is_not_understood", "it is not understood")
            name = match.group(1).lower()
            first, last = (int(number(self.value(tokens(match.group(k))))) for k in (2, 3))
            step = 1 if last >= first else -1
            if match.group(4):
                step = int(number(self.value(tokens(match.group(4)))))
            if step == 0:
                raise Unknown("programs.step_is_zero", "its {word} is 0", word="STEP")
        except Unknown as unknown:
            message = Fact(
                "programs.no_static_bounds",
                "{word} has no static bounds ({reason}); its motions are left out",
                reason=unknown.fact,
                word="FOR",
            )
            self.skip(node.body, node.line, message)
            return
        scope = self.globals if self.locals is None else self.locals
        before = scope.get(name)
        for value in range(first, last + (1 if step > 0 else -1), step):
            self.tick(node.line)
            scope[name] = ["num", float(value)]
            self.block(node.body)
        scope.pop(name, None)  # the loop's variable ends with it
        if before is not None:
            scope[name] = before

    def while_(self, node):
        condition = re.sub(r"(?i)^WHILE\b", "", node.text)
        if re.fullmatch(r"[\s(]*TRUE[\s)]*", condition, re.IGNORECASE):
            self.problem(
                node.line, "programs.endless", "an endless {word} is followed once", word="WHILE"
            )
            self.block(node.body)
            return
        try:
            while truth(self.value(tokens(condition))):
                self.tick(node.line, work_of(condition))
                self.block(node.body)
        except Unknown as unknown:
            message = Fact(
                "programs.decided_at_run_time",
                "{word} is decided at run time ({reason}); its motions are left out",
                reason=unknown.fact,
                word="WHILE",
            )
            self.skip(node.body, node.line, message)

    def test_(self, node):
        otherwise = []
        try:
            value = self.value(tokens(re.sub(r"(?i)^TEST\b", "", node.text)))
            for inner, body in node.divided(("case", "default"))[1:]:
                if inner.word == "default":
                    otherwise = body
                    continue
                self.tick(inner.line, work_of(inner.text))
                if any(value == self.value(row) for row in arguments(tokens(inner.text[4:]))[0]):
                    break
            else:
                body = otherwise
        except Unknown as unknown:
            message = Fact(
                "programs.decided_at_run_time",
                "{word} is decided at run time ({reason}); its motions are left out",
                reason=unknown.fact,
                word="TEST",
            )
            self.skip(node.body, node.line, message)
            return
        self.block(body)
