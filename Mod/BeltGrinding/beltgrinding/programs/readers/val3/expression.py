"""Expressions of VAL3, compiled to functions of an environment.

The environment gives array(name) -> Array and item(array, key, name) -> value, or raises Unknown;
result(name, arguments) is called for functions that need more than their values.
"""

import functools
import math
import re

from ...program import Fact, Unknown
from .data import WORDS, Missing, Record, as_kind, inverse, number, product, six, trsf
from .functions import FUNCTIONS, truth

TOKEN = re.compile(
    r"""\s*(?:(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?(?![\w.]))
        |(?P<string>"[^"\n]*")
        |(?P<name>[^\W\d]\w*(?::\w+)?)
        |(?P<op>==|!=|<>|<=|>=|&&|\|\||[-+*/%&!(){}\[\],.<>]))""",
    re.VERBOSE,
)
END = Fact("programs.end_of_statement", "the end of the statement")
MAX_DEPTH = 40
MAX_TERMS = 300
MAX_TEXT = 10_000
COMPARE = {
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
}


def tokens(text):
    """List of (kind, text). Raises Unknown on what is no token."""
    found, at, text = [], 0, text.rstrip()
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise Unknown(
                "programs.cannot_be_parsed", "cannot read '{text}'", text=text[at:].strip()[:30]
            )
        found.append((match.lastgroup, match.group(match.lastgroup)))
        at = match.end()
    return found


def split(text):
    """The arguments in the text of an argument list. Raises Unknown where brackets do not match."""
    if not text.strip():
        return []
    parts, depth, start, quoted = [], 0, 0, False
    for at, c in enumerate(text):
        if c == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif c in "([{":
            depth += 1
        elif c in ")]}":
            depth -= 1
            if depth < 0:
                break
        elif c == "," and depth == 0:
            parts.append(text[start:at].strip())
            start = at + 1
    if depth or quoted:
        raise Unknown("programs.brackets", "the brackets do not match")
    parts.append(text[start:].strip())
    if not all(parts):
        raise Unknown("programs.argument_missing", "an argument is missing")
    return parts


@functools.lru_cache(maxsize=4096)  # for loops
def expression(text):
    """Function of an environment that gives the value. Raises Unknown if it cannot be read."""
    parser = _Parser(tokens(text))
    function = parser.expression()
    if parser.at < len(parser.tokens):
        raise Unknown(
            "programs.not_understood_there",
            "'{found}' is not understood there",
            found=parser.peek(),
        )
    return function


@functools.lru_cache(maxsize=4096)
def place(text):
    """(name, function for the key or None, fields) of what can be assigned to. Raises Unknown."""
    parser = _Parser(tokens(text))
    kind, name = parser.next()
    if kind != "name":
        raise Unknown(
            "programs.val3.not_assignable", "'{text}' cannot be assigned to", text=text[:30]
        )
    key, fields = parser.selection()
    if parser.at < len(parser.tokens):
        raise Unknown(
            "programs.not_understood_there",
            "'{found}' is not understood there",
            found=parser.peek(),
        )
    return name, key, fields


class _Parser:
    """Recursive descent; every method gives a function of the environment."""

    def __init__(self, row):
        self.tokens, self.at, self.depth, self.terms = row, 0, 0, 0

    def peek(self):
        return self.tokens[self.at][1] if self.at < len(self.tokens) else None

    def next(self):
        if self.at >= len(self.tokens):
            raise Unknown("programs.statement_ends_early", "the statement ends too early")
        self.at += 1
        return self.tokens[self.at - 1]

    def accept(self, *texts):
        if self.at < len(self.tokens) and self.tokens[self.at][0] != "string":
            if self.tokens[self.at][1] in texts:
                self.at += 1
                return self.tokens[self.at - 1][1]
        return None

    def expect(self, text):
        if not self.accept(text):
            raise Unknown(
                "programs.expected",
                "'{text}' expected, not '{found}'",
                text=text,
                found=self.peek() or END,
            )

    def nested(self, function):
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise Unknown("programs.nested_expression", "the expression is nested too deeply")
        result = function()
        self.depth -= 1
        return result

    def expression(self):
        return self.nested(self.disjunction)

    def disjunction(self):
        left = self.conjunction()
        while operator := self.accept("or", "||", "xor"):
            left = _either(left, self.conjunction(), operator == "xor")
        return left

    def conjunction(self):
        left = self.comparison()
        while self.accept("and", "&&"):
            left = _both(left, self.comparison())
        return left

    def comparison(self):
        if self.accept("not"):
            inner = self.nested(self.comparison)
            return lambda env: not truth(inner(env))
        left = self.sum()
        operator = self.accept("==", "!=", "<>", "<", ">", "<=", ">=")
        if not operator:
            return left
        right = self.sum()
        if operator in COMPARE:
            compare = COMPARE[operator]
            return lambda env: compare(number(left(env)), number(right(env)))
        return lambda env: _equal(left(env), right(env)) == (operator == "==")

    def sum(self):
        left = self.product()
        while operator := self.accept("+", "-", "&"):
            left = _sum(left, self.product(), operator)
        return left

    def product(self):
        left = self.unary()
        while operator := self.accept("*", "/", "%"):
            left = _product(left, self.unary(), operator)
        return left

    def unary(self):
        self.terms += 1
        if self.terms > MAX_TERMS:
            raise Unknown("programs.val3.long_expression", "the expression is too long")
        operator = self.accept("-", "+", "!")
        if not operator:
            return self.primary()
        if operator != "!" and self.peek() in ("-", "+"):
            raise Unknown("programs.two_signs", "two signs in a row")
        inner = self.nested(self.unary)
        if operator == "!":
            return lambda env: _inverted(inner(env))
        if operator == "-":
            return lambda env: -number(inner(env))
        return lambda env: number(inner(env))

    def primary(self):
        kind, text = self.next()
        if kind == "number":
            value = float(text)
            if not math.isfinite(value):
                raise Unknown(
                    "programs.number_too_large", "{text} is too large a number", text=text[:20]
                )
            return lambda env: value
        if kind == "string":
            return lambda env: text[1:-1]
        if text == "(":
            inner = self.expression()
            self.expect(")")
            return inner
        if text == "{":
            parts = self.list("}")
            return lambda env: [part(env) for part in parts]
        if kind != "name":
            raise Unknown("programs.value_expected", "a value expected, not '{text}'", text=text)
        if text in ("true", "false"):
            return lambda env: text == "true"
        if self.accept("("):
            return self.call(text)
        key, fields = self.selection()
        return functools.partial(_read, text, key, fields)

    def list(self, end):
        parts = []
        while not self.accept(end):
            if parts:
                self.expect(",")
            parts.append(self.expression())
        return parts

    def selection(self):
        key, fields = None, []
        if self.accept("["):
            parts = self.list("]")
            key = parts[0] if len(parts) == 1 else _refused
        while self.accept("."):
            kind, name = self.next()
            if kind != "name":
                raise Unknown(
                    "programs.val3.field_expected", "a field expected, not '{name}'", name=name
                )
            fields.append(name)
            if self.accept("["):
                raise Unknown(
                    "programs.val3.field_with_index", "a field with an index is not understood"
                )
        return key, tuple(fields)

    def call(self, name):
        if (
            name == "size"
            and self.tokens[self.at : self.at + 1]
            and self.tokens[self.at][0] == "name"
        ):
            array = self.next()[1]
            self.expect(")")
            return lambda env: float(len(_items(env.array(array), array)))
        parts = self.list(")")
        if name in FUNCTIONS:
            return functools.partial(_called, name, parts)
        return lambda env: env.result(name, parts)


def _refused(env):
    raise Unknown("programs.val3.dimensions", "arrays of several dimensions are not supported")


def _items(array, name):
    if isinstance(array.items, Missing):
        raise Unknown(array.items.why)
    return array.items


def _read(name, key, fields, env):
    try:
        array = env.array(name)
    except Unknown:
        if name in WORDS and key is None and not fields:
            return name
        raise
    value = env.item(array, 0.0 if key is None else key(env), name)
    for field in fields:
        if not isinstance(value, Record):
            raise Unknown(
                "programs.val3.no_field", "{name} has no field {field}", name=name, field=field
            )
        value = value.get(field)
    if isinstance(value, Missing):
        raise Unknown(value.why)
    return value


def _either(left, right, exclusive):
    if exclusive:
        return lambda env: truth(left(env)) != truth(right(env))
    return lambda env: truth(left(env)) or truth(right(env))


def _both(left, right):
    return lambda env: truth(left(env)) and truth(right(env))


def _equal(left, right):
    if type(left) is not type(right) or isinstance(left, (list, Record)):
        raise Unknown("programs.val3.not_compared", "these values are not compared")
    return left == right


def _sum(left, right, operator):
    def value(env):
        a, b = left(env), right(env)
        if isinstance(a, str) and isinstance(b, str) and operator != "-":
            if len(a) + len(b) > MAX_TEXT:
                raise Unknown("programs.string_too_long", "the string is too long")
            return a + b
        if operator == "&":
            raise Unknown("programs.val3.join", "'&' joins strings")
        return number(number(a) - number(b) if operator == "-" else number(a) + number(b))

    return value


def _product(left, right, operator):
    def value(env):
        a, b = left(env), right(env)
        if operator == "*":
            if isinstance(a, Record) or isinstance(b, Record):
                return trsf(product(six(as_kind("trsf", a)), six(as_kind("trsf", b))))
            return number(number(a) * number(b))
        if number(b) == 0.0:
            raise Unknown("programs.division_by_zero", "division by zero")
        return number(number(a) / b) if operator == "/" else math.fmod(number(a), b)

    return value


def _inverted(value):
    return not value if isinstance(value, bool) else trsf(inverse(six(as_kind("trsf", value))))


def _called(name, parts, env):
    values = [part(env) for part in parts]
    try:
        return FUNCTIONS[name](*values)
    except (TypeError, ValueError, OverflowError, ZeroDivisionError):
        raise Unknown(
            "programs.val3.not_computable",
            "{name}() cannot be evaluated for these arguments",
            name=name,
        ) from None
