"""Expressions of robot languages: a language's tables, and what they become.

A language's ``Parser`` says which tokens, operators and brackets it has. An expression becomes a function of
an environment, the language's interpreter, which gives ``read(place)``, the value of a Place, and
``function(call)``, that of a Call. Everything raises Unknown for what cannot be read, or is not known.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from ...program import Fact, Unknown

# A language takes most of them from here, beside the Parser.
from .values import COMPARED as COMPARED, NOT_COMPUTABLE as NOT_COMPUTABLE
from .values import Environment, Evaluated
from .values import alike as alike, applied as applied, both as both, divided as divided
from .values import either as either, finite as finite, number as number, power as power
from .values import true as true, truth as truth

END = Fact("programs.end_of_statement", "the end of the statement")
DEEPEST = 50  # of brackets and prefixes in each other
LONGEST = 300  # operators in a row
# Brackets with nothing but decimal numbers: nearly all of a long program.
LITERAL = re.compile(r"[-+.0-9eE,\s\[\]]*")
NUMBERS = re.compile(r"(?:\[\s{0,80}){1,6}[-+.0-9]")
MAX_FAILURES = 20
Token: TypeAlias = tuple[Any, Any, int]  # its kind, its text or value, its end
# In the signatures of a class that has a method ``list``.
Tokens: TypeAlias = list[Token]
Texts: TypeAlias = list[str]
Series: TypeAlias = list[Any]
# Expressions, and by name expressions or None (a switch); of a language that has them, None for what is left out.
Arguments: TypeAlias = tuple[list[Any], dict[str, Any]]


class Infix(NamedTuple):
    """An operator between two values: the higher its rank, the closer it binds; ``function(left, right)``.
    ``lazy``: it is given functions, since it may not need the right value; ``once``: a < b < c is an error.
    """

    rank: int
    function: Callable[..., Any]
    lazy: bool = False
    once: bool = False


class Prefix(NamedTuple):
    """An operator before a value, of which the operators of a lower rank are no part."""

    rank: int
    function: Callable[..., Any]


class Place:
    """What names data: the name as it is written, and steps into it: a field's name, or a tuple of the
    expressions of an index.
    """

    __slots__ = ("name", "steps")

    def __init__(self, name: str, steps: Sequence[Any] = ()) -> None:
        self.name, self.steps = name, steps

    def __call__(self, env: Environment) -> Any:
        return env.read(self)


class Constant:
    """A value that is written as such."""

    __slots__ = ("value",)

    def __init__(self, value: Any) -> None:
        self.value = value

    def __call__(self, env: Environment) -> Any:
        return self.value


class Call:
    """A function with what it is given: expressions, and by name expressions or None (a switch)."""

    __slots__ = ("name", "arguments", "named")

    def __init__(self, name: str, arguments: Sequence[Any], named: Mapping[str, Any]) -> None:
        self.name, self.arguments, self.named = name, arguments, named

    def __call__(self, env: Environment) -> Any:
        return env.function(self)

    def values(self, env: Environment) -> tuple[list[Any], dict[str, Any]]:
        """(values, values by name) of all arguments."""
        named = {name: one and one(env) for name, one in self.named.items()}
        return [one(env) for one in self.arguments], named


class Parser:
    """Takes the tokens of a text apart; a language overrides its tables and what else is its own.

    Fields are behind '.', indices in ``INDEX``, arguments in '(' and ')', where ``NAMING`` stands between a name
    and its value. ``literal``, ``opened`` and ``word`` say what is its own among the operands.
    """

    TOKEN: Any = None  # with the groups number, string, name, op
    INFIX: Mapping[str, Infix] = {}
    PREFIX: Mapping[str, Prefix] = {}
    INDEX = "[]"
    NAMING: str | None = None
    # The expression of what is left out between commas, where it may be
    OMITTED: Evaluated | None = None
    # Of lists of numbers in [..], where a language has them: a JSONDecoder
    LITERALS: json.JSONDecoder | None = None
    fold: Callable[..., str] = staticmethod(str)  # makes of a name what tables have

    def __init__(self, text: str | Tokens) -> None:
        """``text``: that of an expression, or tokens of one."""
        self.at = self.depth = 0
        self.tokens = self.scanned(text) if isinstance(text, str) else text

    @classmethod
    def scanned(cls, text: str) -> Tokens:
        """[(kind, text or value, its end)]; the kind 'value' is a list of numbers."""
        found: list[Token] = []
        at, text = 0, text.rstrip()
        failed = failures = 0
        match, decoder = cls.TOKEN.match, cls.LITERALS
        while at < len(text):
            token = match(text, at)
            if not token:
                raise Unknown(
                    "programs.cannot_be_parsed", "cannot read '{text}'", text=text[at:].strip()[:30]
                )
            kind = token.lastgroup
            word = token.group(kind)
            at = token.end()
            # Brackets within one that is no literal are read one by one, and so are all after some
            # failures: each costs what is before it.
            if decoder and word == "[" and at > failed and failures < MAX_FAILURES:
                if NUMBERS.match(text, at - 1) and not cls.indexes(found):
                    literal, end = _literal(decoder, text, at - 1)
                    if literal is not None:
                        at = end
                        found.append(("value", literal, at))
                        continue
                    failed, failures = end, failures + 1
            found.append((kind, word, at))
        return found

    @classmethod
    def indexes(cls, before: Tokens) -> bool:
        """Whether a bracket [ behind tokens is that of an index."""
        return False

    @classmethod
    def expression(cls, text: str) -> Evaluated:
        """The function of an environment that a text is."""
        parser = cls(text)
        function = parser.infix()
        parser.end()
        return function

    @classmethod
    def place(cls, text: str) -> Place:
        """The Place that a text is."""
        parser = cls(text)
        found = parser.path()
        parser.end()
        return found

    @classmethod
    def list(cls, text: str) -> Arguments:
        """(expressions, by name expressions or None) of the text of an argument list."""
        parser = cls(text)
        found = parser.arguments(None)
        parser.end()
        return found

    @staticmethod
    def split(text: str) -> Texts:
        """The texts between the commas of a list that stand in no bracket or string."""
        found, depth, quoted = [""], 0, False
        for c in text:
            quoted ^= c == '"'
            depth += 0 if quoted else (c in "([{") - (c in ")]}")
            if c == "," and not depth and not quoted:
                found.append("")
            else:
                found[-1] += c
        return found if text.strip() else []

    def path(self) -> Place:
        """The Place that stands here."""
        kind, name = self.next()
        if kind != "name":
            raise Unknown(
                "programs.not_assignable", "'{text}' cannot be assigned to", text=str(name)[:30]
            )
        return Place(name, self.steps())

    def peek(self) -> Any:
        return self.tokens[self.at][1] if self.at < len(self.tokens) else None

    def kind(self) -> Any:
        return self.tokens[self.at][0] if self.at < len(self.tokens) else None

    def operator(self) -> Any:
        """The next token as the tables of operators have it; None: none."""
        if self.at >= len(self.tokens):
            return None
        kind, text, _ = self.tokens[self.at]
        return self.fold(text) if kind == "name" else text if kind == "op" else None

    def next(self) -> tuple[Any, Any]:
        if self.at >= len(self.tokens):
            raise Unknown("programs.statement_ends_early", "the statement ends too early")
        self.at += 1
        return self.tokens[self.at - 1][:2]

    def accept(self, text: str) -> bool:
        if self.at < len(self.tokens) and self.tokens[self.at][:2] == ("op", text):
            self.at += 1
            return True
        return False

    def expect(self, text: str) -> None:
        if not self.accept(text):
            raise Unknown(
                "programs.expected",
                "'{text}' expected, not '{found}'",
                text=text,
                found=self.peek() or END,
            )

    def end(self) -> None:
        if self.at < len(self.tokens):
            raise Unknown(
                "programs.not_understood_there",
                "'{found}' is not understood there",
                found=self.peek(),
            )

    def infix(self, rank: int = 0) -> Any:
        """An expression of which the operators below ``rank`` are no part."""
        self.depth += 1
        if self.depth > DEEPEST:
            raise Unknown("programs.nested_expression", "the expression is nested too deeply")
        left: Any = self.prefix(rank)
        ceiling = math.inf
        for _ in range(LONGEST):
            operator = self.operator()
            found = self.INFIX.get(operator)
            if found is None or not rank <= found.rank < ceiling:
                break
            self.at += 1
            ceiling = found.rank if found.once else math.inf
            left = self.joined(found, left, self.infix(found.rank + 1))
        else:
            raise Unknown("programs.long_expression", "the expression is too long")
        self.depth -= 1
        return left

    @staticmethod
    def joined(operator: Infix, left: Evaluated, right: Evaluated) -> Evaluated:
        function = operator.function
        if operator.lazy:
            return lambda env: function(left, right, env)
        return lambda env: function(left(env), right(env))

    def prefix(self, rank: int) -> Any:
        operator = self.operator()
        found = self.PREFIX.get(operator)
        if found is None:
            return self.operand(*self.next())
        self.at += 1
        if operator in ("-", "+") and self.operator() in ("-", "+"):
            raise Unknown("programs.two_signs", "two signs in a row")
        inner, function = self.infix(max(rank, found.rank)), found.function
        if operator == "-" and type(inner) is Constant and type(inner.value) in (int, float):
            return Constant(-inner.value)
        return lambda env: function(inner(env))

    def operand(self, kind: str, text: str) -> Any:
        if kind == "op":
            if text == "(":
                inner = self.infix()
                self.expect(")")
                return inner
            return self.opened(text)
        if kind != "name":
            return Constant(self.literal(kind, text))
        found = self.word(self.fold(text))
        if found is not None:
            return found
        if self.accept("("):
            return Call(text, *self.arguments(")"))
        return Place(text, self.steps())

    def word(self, name: str) -> Any:
        """What a name is that is no Place's, in the tables' form; None: nothing else."""
        return Constant(name == "true") if name in ("true", "false") else None

    def literal(self, kind: str, text: str) -> Any:
        """The value of a number, a string or another token."""
        if kind == "number":
            return finite(float(text), text)
        return text if kind == "value" else text[1:-1]

    def opened(self, text: str) -> Any:
        """What stands in a bracket of the language's own."""
        raise Unknown("programs.value_expected", "a value expected, not '{text}'", text=text)

    def series(self, end: str) -> Series:
        """The expressions up to a bracket."""
        parts: list[Any] = []
        while not self.accept(end):
            if parts:
                self.expect(",")
            parts.append(self.given(end))
        return parts

    def given(self, end: str | None) -> Any:
        """What stands between commas."""
        if self.OMITTED is not None and (self.kind(), self.peek()) in (
            ("op", ","),
            ("op", end),
            (None, None),
        ):
            return self.OMITTED
        return self.infix()

    def steps(self) -> tuple[Any, ...]:
        found: list[Any] = []
        begin, end = self.INDEX[0], self.INDEX[1]
        while True:
            if self.accept(begin):
                found.append(tuple(self.series(end)))
            elif self.accept("."):
                kind, name = self.next()
                if kind != "name":
                    raise Unknown(
                        "programs.field_expected", "a field expected, not '{name}'", name=name
                    )
                found.append(name)
            else:
                return tuple(found)

    def arguments(self, end: str | None) -> Arguments:
        """(expressions, by name expressions or None) of what is given up to a bracket, or (None) to the end."""
        positional: list[Any] = []
        named: dict[str, Any] = {}
        while not (self.accept(end) if end else self.at >= len(self.tokens)):
            if positional or named:
                self.expect(",")
            if self.NAMING and self.tokens[self.at + 1 : self.at + 2]:
                (kind, name, _), (other, sign, _) = self.tokens[self.at : self.at + 2]
                if kind == "name" and (other, sign) == ("op", self.NAMING):
                    self.at += 2
                    named[name] = self.infix()
                    continue
            positional.append(self.given(end))
        return positional, named


def _literal(decoder: json.JSONDecoder, text: str, at: int) -> tuple[list[Any] | None, int]:
    """(list of numbers, its end), or (None, where it cannot be one)."""
    try:
        value, end = decoder.raw_decode(text, at)
    except json.JSONDecodeError as error:
        return None, error.pos
    except (ValueError, RecursionError):
        return None, len(text)
    return (value if LITERAL.fullmatch(text, at, end) else None), end
