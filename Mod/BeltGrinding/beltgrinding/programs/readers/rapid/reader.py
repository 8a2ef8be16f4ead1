"""Reads ABB RAPID modules: .mod, .prg, .modx, .sys.

Poses are those of the tool in the work object (object frame), as programmed. PERS data has the
value the module gives. What only the controller can know is a Problem.
"""

import contextlib
import re
from pathlib import Path

from ...program import LOOPED, Fact, ProgramError, Unknown, work_of
from . import data, modules
from .calls import CHANGING, HARMLESS, Exit, Jump, Return
from .control import TARGET, Control
from .data import number
from .expression import Reader, arguments, tokens
from .motion import spec_of
from .text import tree

MAX_CALLS = 20
MADE = 64  # values of an array, which are made in a unit of work
DECLARATION = re.compile(
    r"(?:(?:LOCAL|TASK)\s+)*(CONST|PERS|VAR)\s+(\w+)\s+(\w+)\s*(?:(\{[^}]*\})\s*)?(?::=(.*))?$",
    re.IGNORECASE | re.DOTALL,
)
ROUTINE = re.compile(r"\s*(?:LOCAL\s+)?(?:PROC|FUNC\s+\w+)\s+(\w+)\s*\(([^)]*)\)", re.IGNORECASE)
PARAMETER = re.compile(r"(?:(INOUT|VAR|PERS)\s+)?(\w+)\s+(\w+)\s*(?:\{[^}]*\})?$", re.IGNORECASE)
BLOCKS = ("if", "for", "while", "test")


def read(path, values=None):
    """The Program of a RAPID module; ``values``: what a person gives, by name. Raises ProgramError when it cannot be read at all."""
    interpreter = _Interpreter(path, values)
    try:
        interpreter.run(tree(path), modules.others(Path(path)))
    except RecursionError:
        raise ProgramError.at(
            interpreter.file,
            interpreter.line,
            "programs.rapid.nested",
            "statements and values are nested too deeply",
        ) from None
    return interpreter.finish()


class _Undecided(Exception):
    """What a function gives is decided at run time; ``fact`` says why."""

    def __init__(self, fact):
        super().__init__(fact)
        self.fact = fact


class _Interpreter(Control):
    """Follows a program from PROC main on with the values it can know."""

    def __init__(self, path, given=None):
        super().__init__(path, given)
        self.calls = 0
        self.missing = set()
        self.functions = {}  # as routines
        self.evaluating = 0  # functions in each other
        self.homes = {}  # of routines of other modules, by the id of their node
        self.own = None  # the data of another module while its routine runs
        self.private = set()  # LOCAL data of this module

    def run(self, nodes, near=()):
        """``near``: the other modules of the folder, (file, nodes) each."""
        for one in (nodes, *(others for _, others in near)):
            stack = list(one)
            while stack:
                node = stack.pop()
                stack += node.body or []
                self.rounds -= LOOPED * (work_of(node.text) + 2 * node.text.count("("))
        loose = self.module(nodes)
        own = dict(self.routines)
        self.neighbours(near)
        self.follow(loose, own)

    def neighbours(self, near):
        """Declares what other modules tell all, where this one does not and no two of them do."""
        mine = set(self.globals) | set(self.routines) | set(self.functions)
        told, homes = {}, []
        for file, nodes in near:
            home = modules.Home(file)
            kept = self.globals, self.routines, self.functions, self.constants
            self.globals, self.routines, self.functions, self.constants = {}, {}, {}, set()
            with contextlib.suppress(ProgramError):
                self.module(nodes)
            found = self.globals, self.routines, self.functions
            self.globals, self.routines, self.functions, self.constants = kept
            home.data, home.routines, home.functions = found
            homes.append(home)
            for name in {*found[0], *found[1], *found[2]} - self.local_names(nodes) - mine:
                told.setdefault(name, []).append(home)
        shared = {name: found[0] for name, found in told.items() if len(found) == 1}
        for name, home in shared.items():
            for here, there in (
                (self.globals, home.data),
                (self.routines, home.routines),
                (self.functions, home.functions),
            ):
                if name in there and name != "main":
                    here[name] = there[name]
        for home in homes:
            for node, _, _ in (*home.routines.values(), *home.functions.values()):
                self.homes[id(node)] = home
        for home in homes:  # before the names of this module's own are the only ones that are seen
            home.routines = {**self.routines, **home.routines}
            home.functions = {**self.functions, **home.functions}
            with self.within(home):
                for name in home.data:
                    with contextlib.suppress(Unknown):
                        self.variable(name)

    @staticmethod
    def local_names(nodes):
        """Names that a module declares LOCAL, in lower case."""
        names, stack = set(), list(nodes)
        while stack:
            node = stack.pop()
            if node.word == "module":
                stack += node.body
            elif modules.LOCAL.match(node.text):
                for pattern, group in ((DECLARATION, 3), (ROUTINE, 1)):
                    match = pattern.match(node.text)
                    if match:
                        names.add(match.group(group).lower())
        return names

    @contextlib.contextmanager
    def within(self, home):
        """Runs statements of another module (None: of the one that runs)."""
        if home is None:
            yield
            return
        kept = self.file, self.own, self.routines, self.functions, self.locals
        self.file, self.own = home.file, home.data
        self.routines, self.functions = home.routines, home.functions
        self.other_names()
        try:
            yield
        finally:
            self.file, self.own, self.routines, self.functions, self.locals = kept
            self.other_names()

    def other_names(self):
        """The names of frames may mean others from here on; in functions nothing moves."""
        if not self.evaluating:
            self.texts.clear()

    def entry(self, name):
        if self.own is None or self.locals is not None and name in self.locals:
            return super().entry(name)
        if name in self.own:
            return self.own[name]
        return None if name in self.private else self.globals.get(name)

    def problem(self, line, told, text=None, /, once=None, **arguments):
        if self.evaluating:
            raise _Undecided(told if text is None else Fact(told, text, **arguments))
        super().problem(line, told, text, once=once, **arguments)

    def skip(self, nodes, line, message):
        if self.evaluating:
            raise _Undecided(message)
        super().skip(nodes, line, message)

    def function(self, name, positional, optional):
        """The value of a function of the program, or None where there is none of that name. Raises
        Unknown where it is decided at run time."""
        if name not in self.functions:
            return None
        head, parameters, body = self.functions[name]
        written = head.text.split("(")[0].split()[-1]
        if self.calls >= MAX_CALLS or optional or len(positional) != len(parameters):
            raise Unknown(
                "programs.rapid.function_call", "the call of {name} is not followed", name=written
            )
        self.tick(head.line, 2)
        inner = {}
        for (by_reference, kind, parameter), row in zip(parameters, positional):
            if by_reference:
                raise Unknown(
                    "programs.rapid.function_call",
                    "the call of {name} is not followed",
                    name=written,
                )
            inner[parameter] = [kind, self.copy(self.value(row), head.line)]
        kept = self.locals
        self.calls, self.evaluating = self.calls + 1, self.evaluating + 1
        try:
            with self.within(self.homes.get(id(head))):
                self.locals = inner
                self.block(body)
            fact = Fact("programs.rapid.no_return", "no RETURN is reached")
        except Return as found:
            if found.args:
                return found.args[0]
            fact = Fact("programs.rapid.no_return", "no RETURN is reached")
        except _Undecided as undecided:
            fact = undecided.fact
        except (Jump, Exit):
            fact = Fact("programs.rapid.no_return", "no RETURN is reached")
        finally:
            self.calls, self.evaluating = self.calls - 1, self.evaluating - 1
            self.locals = kept
        stack = list(body)  # what it may have changed is not known
        while stack:
            node = stack.pop()
            stack += node.body or []
            for word in re.findall(r"\w+", node.text):
                if word.lower() in self.globals:
                    self.forget(word.lower())
        raise Unknown(
            "programs.rapid.function_unknown",
            "what {name} gives is not known: {reason}",
            name=written,
            reason=fact,
        )

    def follow(self, loose, own):
        """Runs the program: ``loose`` statements, or the routines ``own`` of its module."""
        for name in list(self.globals):
            try:
                self.variable(name)
            except Unknown:
                pass  # whoever uses it reports it
        starts = [own["main"]] if "main" in own else self.uncalled(own)
        if loose and not own:  # an excerpt without its PROC
            starts = [(loose[0], [], loose)]
        elif "main" not in own and starts:
            self.problem(
                starts[0][0].line,
                "programs.rapid.no_main",
                "there is no PROC main; the procedures nothing here calls are followed in turn",
            )
        try:
            for head, parameters, body in starts:
                self.forget_position()
                self.locals = {name: [kind, None] for _, kind, name in parameters}
                self.routine(head, body)
        except Exit:
            pass

    def module(self, nodes):
        """Declares a module's data and routines; returns statements outside of any routine."""
        loose = []
        for node in nodes:
            if node.word == "module":
                loose += self.module(node.body)
            elif node.word == "record":
                self.record(node)
            elif node.word in ("proc", "func") and ROUTINE.match(node.text):
                name, parameters = ROUTINE.match(node.text).groups()
                handler = next(
                    (k for k, n in enumerate(node.body) if n.word in ("error", "undo", "backward")),
                    len(node.body),
                )
                kept = self.routines if node.word == "proc" else self.functions
                kept[name.lower()] = (
                    node,
                    self.parameters(parameters),
                    node.body[:handler],
                )
            elif node.word in ("func", "trap"):
                continue  # evaluated, and interrupted by, on the controller only
            elif DECLARATION.match(node.text):
                self.declare(node, self.globals)
                if modules.LOCAL.match(node.text):
                    self.private.add(DECLARATION.match(node.text).group(3).lower())
            else:
                loose.append(node)
        return loose

    def record(self, node):
        parts = {}
        for part in node.body:
            words = part.text.lower().split()
            if len(words) == 2:
                parts[words[1]] = words[0]
        self.records[node.text.split()[-1].lower()] = parts

    def parameters(self, text):
        """List of (by reference, type, name) of the required parameters."""
        result = []
        for part in text.split(","):
            for piece in part.split("\\")[:1]:  # optional ones are never given here
                match = PARAMETER.match(piece.strip())
                if match:
                    result.append((bool(match.group(1)), *(g.lower() for g in match.groups()[1:])))
        return result

    def uncalled(self, own):
        called = set()

        def visit(nodes):
            stack = list(nodes)
            while stack:
                node = stack.pop()
                stack += node.body or []
                called.update(w.lower() for w in re.findall(r"\w+", node.text))

        for _, _, body in own.values():
            visit(body)
        return [r for name, r in own.items() if name not in called] or list(own.values())[:1]

    def declare(self, node, scope):
        storage, kind, name, dimensions, text = DECLARATION.match(node.text).groups()
        kind, name = kind.lower(), name.lower()
        self.other_names()
        scope[name] = [kind, None]
        if storage.lower() == "const" and scope is self.globals:
            self.constants.add(name)
        if text is not None:
            if not text.strip():
                raise ProgramError.at(
                    self.file,
                    node.line,
                    "programs.rapid.given_no_value",
                    "{name} is given no value",
                    name=name,
                )
            scope[name].append((node.line, text))
            return
        try:
            value = data.initial(kind, self.records)
            if dimensions:
                row = tokens(dimensions[1:-1])
                sizes = [int(number(self.value(p))) for p in arguments(row)[0]]
                count = data.array_size(sizes, value)
                self.tick(node.line, count // MADE)
                value = data.array(sizes, value)
            # Persistent data without a value keeps what the controller last had.
            scope[name][1] = None if storage.lower() == "pers" else value
        except Unknown:
            pass

    def routine(self, node, body):
        try:
            self.block(body)
        except Return:
            pass
        except Jump as jump:
            self.problem(
                jump.line,
                "programs.rapid.goto_nowhere",
                "GOTO {label}: there is no such label to jump to",
                label=jump.label,
            )
            self.gap(jump.line)

    def statement(self, node):
        spec = spec_of(node.word)
        if spec is not None and self.evaluating:
            raise _Undecided(Fact("programs.rapid.function_moves", "it moves the robot"))
        if spec is not None:
            self.motion(node.line, node.text, spec)
        elif node.word in BLOCKS:
            getattr(self, node.word + "_")(node)
        elif node.word == "if;":
            self.short_if(node)
        elif node.word == "label":
            return
        elif DECLARATION.match(node.text):
            scope = self.globals if self.locals is None else self.locals
            self.declare(node, scope)
            try:
                self.variable(DECLARATION.match(node.text).group(3).lower())
            except Unknown:
                pass  # whoever uses it reports it
        elif TARGET.match(node.text):
            self.assign(node)
        else:
            self.instruction(node)

    def assign(self, node):
        name = TARGET.match(node.text).group(1).lower()
        try:
            row = tokens(node.text)
            at = row.index(("op", ":="))
            value = self.copy(self.value(row[at + 1 :]), node.line)
            if at == 1:
                self.store(name, value)
                return
            holder, kind = self.variable(name)
            if self.entry(name) is None:  # predefined: this program's own from here on
                self.store(name, data.copied(holder))
                holder = self.variable(name)[0]
            reader, path = Reader(row[:at], self), []
            reader.next()
            while reader.peek() is not None:
                if reader.accept("{"):
                    path += [("element", i) for i in reader.indices()]
                else:
                    reader.expect(".")
                    index, kind = self.component(kind, reader.next()[1])
                    path.append(("component", index + 1))
            for _, index in path[:-1]:
                holder = holder[reader.element(holder, index, name)]
            holder[reader.element(holder, path[-1][1], name)] = value
            self.texts.clear()
        except Unknown as unknown:
            # Not known from here on: whoever uses it reports it.
            self.forget(name, unknown.fact)
        except ValueError:
            self.problem(
                node.line,
                "programs.rapid.assignment",
                "the assignment to {name} is not understood",
                name=name,
            )
            self.forget(name)

    def instruction(self, node):
        word, line = node.word, node.line
        if word == "goto":
            raise Jump(node.text[4:].strip().lower(), line)
        if word == "return" and self.evaluating:
            try:
                raise Return(self.copy(self.value(tokens(node.text)[1:]), line))
            except Unknown as unknown:
                raise _Undecided(unknown.fact) from None
        if word in ("return", "raise"):
            raise Return
        if word in ("exit", "exitcycle"):
            raise Exit
        if word in ("velset", "pdispset", "pdispon", "pdispoff") and self.evaluating:
            raise _Undecided(Fact("programs.rapid.function_sets", "it changes what motions follow"))
        if word in ("velset", "pdispset", "pdispon", "pdispoff"):
            self.setting(line, word, node.text)
            return
        if word in self.routines:
            self.call(node)
            return
        if word in ("incr", "decr", "add", "clear"):
            self.count(node)
            return
        if word in CHANGING or word not in HARMLESS:
            for name in re.findall(r"\w+", node.text)[1:]:
                self.forget(name.lower())
        if word not in HARMLESS and word not in CHANGING and word not in self.missing:
            self.missing.add(word)
            what = node.text.split("\n")[0][:30] if not word else re.match(r"\w+", node.text)[0]
            self.problem(
                line,
                "programs.not_in_file",
                "{name} is not in this file; motions in it are left out",
                name=what,
            )
            self.gap(line)

    def count(self, node):
        name = ""
        try:
            row = arguments(tokens(node.text)[1:])[0]
            name = row[0][0][1].lower() if len(row[0]) == 1 else ""
            before = number(self.variable(name)[0])
            step = number(self.value(row[1])) if node.word == "add" else 1.0
            change = {"incr": 1.0, "decr": -1.0, "add": step, "clear": -before}[node.word]
            self.store(name, before + change)
        except (Unknown, IndexError, AttributeError):
            self.forget(name)

    def call(self, node):
        head, parameters, body = self.routines[node.word]
        if self.calls >= MAX_CALLS:
            self.problem(
                node.line,
                "programs.rapid.calls_itself",
                "{word} calls itself too deeply; it is left out",
                word=node.word,
            )
            self.gap(node.line)
            return
        self.tick(node.line, 2)
        own, inner, back = self.locals, {}, []
        try:
            row = tokens(node.text)[1:]
            if row and row[0][1] == "(" and row[-1][1] == ")":
                row = row[1:-1]  # not RAPID, yet found in programs
            given = arguments(row)[0]
        except Unknown:
            given = []
        for k, (by_reference, kind, name) in enumerate(parameters):
            inner[name] = [kind, None]
            try:
                inner[name][1] = self.copy(self.value(given[k]), node.line)
            except (Unknown, IndexError):
                pass
            if by_reference and k < len(given):
                back.append((given[k], name))
        home, before = self.homes.get(id(head)), len(self.program.motions)
        away = self.own is not None
        self.calls += 1
        try:
            with self.within(home):
                self.locals = inner
                self.texts.clear()
                self.routine(head, body)
        finally:
            self.calls, self.locals = self.calls - 1, own
            self.texts.clear()
            if home is not None and not away:  # to who looks at this file they are the call's
                for motion in self.program.motions[before:]:
                    motion.line, motion.file = node.line, self.file
        for row, name in back:
            value = inner[name][1]
            if len(row) == 1 and value is not None:
                self.store(str(row[0][1]).lower(), value)
            else:
                self.forget(str(row[0][1]).lower())
