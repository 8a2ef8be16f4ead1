"""Values of KUKA KRL: numbers, aggregates and static expressions over them."""

import functools
import math
import re

from ....base.frames import from_abc, to_abc
from ...program import Fact, Unknown

TOKEN = re.compile(
    r"""\s*(?:(?P<number>(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?(?![\w.]))
        |(?P<string>"[^"]*")
        |(?P<enum>\#\w+)
        |(?P<name>\$?[A-Za-z_][\w$]*(?:\.[A-Za-z_]\w*)*)
        |(?P<op><=|>=|<>|==|[-+*/:(){}\[\],=<>']))""",
    re.VERBOSE,
)
FRAME = ("x", "y", "z", "a", "b", "c")
FUNCTIONS = {
    "sin": lambda v: math.sin(math.radians(v)),
    "cos": lambda v: math.cos(math.radians(v)),
    "tan": lambda v: math.tan(math.radians(v)),
    "acos": lambda v: math.degrees(math.acos(v)),
    "atan2": lambda y, x: math.degrees(math.atan2(y, x)),
    "sqrt": math.sqrt,
    "abs": abs,
}
MAX_DEPTH = 50
MAX_COMPONENTS = 100  # of an aggregate
KEPT = 1000  # characters of a statement whose tokens are kept
MAX_LENGTH = 1e12  # mm; products of frames stay finite


def tokens(text):
    """List of (kind, text) of a statement, not to be changed. Raises Unknown on anything that is no token."""
    return _kept(text) if len(text) <= KEPT else _tokens(text)


@functools.lru_cache(maxsize=256)  # loops meet their statements again and again
def _kept(text):
    return _tokens(text)


def _tokens(text):
    result, at = [], 0
    text = text.rstrip()
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise Unknown(
                "programs.cannot_be_parsed", "cannot read '{text}'", text=text[at:].strip()[:30]
            )
        result.append((match.lastgroup, match.group(match.lastgroup)))
        at = match.end()
    return result


def frame_of(value):
    """4 x 4 of an aggregate with all six components."""
    missing = [name for name in FRAME if name not in value]
    if missing:
        raise Unknown(
            "programs.krl.frame_incomplete",
            "the frame has no {names}",
            names=", ".join(missing).upper(),
        )
    x, y, z, a, b, c = (number(value[k]) for k in FRAME)
    if max(abs(x), abs(y), abs(z)) > MAX_LENGTH:
        raise Unknown("programs.krl.frame_out_of_bounds", "the frame is out of all bounds")
    return from_abc((x, y, z), (a, b, c))


def components_of(frame):
    """Aggregate of a 4 x 4."""
    return dict(zip(FRAME, [*map(float, frame[:3, 3]), *to_abc(frame)]))


class Reader:
    """Recursive descent over the tokens of one statement; ``lookup(name, indices)`` gives the
    value of a variable or raises Unknown."""

    def __init__(self, text, lookup):
        self.tokens = tokens(text)
        self.at = 0
        self.depth = 0
        self.lookup = lookup

    def peek(self):
        return self.tokens[self.at][1] if self.at < len(self.tokens) else None

    def next(self):
        if self.at >= len(self.tokens):
            raise Unknown("programs.krl.line_ends_early", "the line ends too early")
        self.at += 1
        return self.tokens[self.at - 1]

    def accept(self, text):
        if self.peek() == text:
            self.at += 1
            return True
        return False

    def expect(self, text):
        if not self.accept(text):
            raise Unknown(
                "programs.expected",
                "'{text}' expected, not '{found}'",
                text=text,
                found=self.peek() or Fact("programs.krl.end_of_line", "the end of the line"),
            )

    def expression(self):
        """comparison of sums"""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise Unknown("programs.nested_expression", "the expression is nested too deeply")
        left = self.sum()
        operator = self.peek()
        if operator in ("==", "<>", "<", ">", "<=", ">="):
            self.at += 1
            right = self.sum()
            if isinstance(left, dict) or isinstance(right, dict):
                raise Unknown("programs.krl.not_compared", "aggregates are not compared")
            same = {"==": left == right, "<>": left != right}
            if operator in same:
                left = same[operator]
            else:
                left, right = number(left), number(right)
                left = {
                    "<": left < right,
                    ">": left > right,
                    "<=": left <= right,
                    ">=": left >= right,
                }[operator]
        self.depth -= 1
        return left

    def sum(self):
        value = self.product()
        while self.peek() in ("+", "-"):
            sign = 1 if self.next()[1] == "+" else -1
            value = number(value) + sign * number(self.product())
        return value

    def product(self):
        value = self.geometric()
        while self.peek() in ("*", "/"):
            if self.next()[1] == "*":
                value = number(value) * number(self.geometric())
            else:
                divisor = number(self.geometric())
                if divisor == 0:
                    raise Unknown("programs.division_by_zero", "division by zero")
                value = number(value) / divisor
        return value

    def geometric(self):
        """The geometric operator: a frame followed by a frame in it."""
        value = self.unary()
        while self.accept(":"):
            right = self.unary()
            if not isinstance(value, dict) or not isinstance(right, dict):
                raise Unknown("programs.krl.two_frames", "the operator ':' needs two frames")
            value = components_of(frame_of(value) @ frame_of(right))
        return value

    def unary(self):
        if self.accept("-"):
            return -number(self.unary_once())
        if self.accept("+"):
            return number(self.unary_once())
        return self.primary()

    def unary_once(self):
        if self.peek() in ("-", "+"):
            raise Unknown("programs.two_signs", "two signs in a row")
        return self.primary()

    def primary(self):
        kind, text = self.next()
        if kind == "number":
            value = float(text)
            if not math.isfinite(value):
                raise Unknown(
                    "programs.number_too_large", "{text} is too large a number", text=text[:20]
                )
            return value
        if kind in ("string", "enum"):
            return text
        if text == "(":
            value = self.expression()
            self.expect(")")
            return value
        if text == "{":
            return self.aggregate()
        if kind != "name":
            raise Unknown("programs.value_expected", "a value expected, not '{text}'", text=text)
        name = text.lower()
        if name in ("true", "false"):
            return name == "true"
        if self.peek() == "(":
            return self.call(name, text)
        return self.lookup(name, self.indices())

    def indices(self):
        result = []
        if self.accept("["):
            if self.accept("]"):
                return ()
            result.append(int(number(self.expression())))
            while self.accept(","):
                result.append(int(number(self.expression())))
            self.expect("]")
        return tuple(result)

    def call(self, name, text):
        if name not in FUNCTIONS:
            raise Unknown(
                "programs.function_of_controller",
                "the function {name} is known to the controller only",
                name=text,
            )
        self.expect("(")
        arguments = [number(self.expression())]
        while self.accept(","):
            arguments.append(number(self.expression()))
        self.expect(")")
        try:
            return float(FUNCTIONS[name](*arguments))
        except (TypeError, ValueError, OverflowError):
            raise Unknown(
                "programs.krl.not_computable",
                "{text} cannot be evaluated for {values}",
                text=text,
                values=str(arguments),
            ) from None

    def component(self):
        """An expression; most are a mere number, which needs no look for operators."""
        signed = self.at + (self.peek() == "-")
        if signed + 1 < len(self.tokens) and self.tokens[signed][0] == "number":
            if self.tokens[signed + 1][1] in (",", "}"):
                negative, self.at = signed > self.at, signed
                return -self.primary() if negative else self.primary()
        return self.expression()

    def aggregate(self):
        """{[TYPE:] name value, ...}; names in lower case."""
        result = {}
        if self.at + 1 < len(self.tokens) and self.tokens[self.at + 1][1] == ":":
            self.at += 2
        if self.accept("}"):
            return result
        while True:
            kind, name = self.next()
            if kind != "name":
                raise Unknown(
                    "programs.krl.component_expected",
                    "a component's name expected, not '{name}'",
                    name=name,
                )
            self.indices()
            name = name.lower()
            if name in result:
                raise Unknown(
                    "programs.krl.component_twice",
                    "the component {name} occurs twice",
                    name=name.upper(),
                )
            result[name] = self.component()
            if len(result) > MAX_COMPONENTS:
                raise Unknown(
                    "programs.krl.components",
                    "the aggregate has more than {limit} components",
                    limit=MAX_COMPONENTS,
                )
            if self.accept("}"):
                return result
            self.expect(",")


def number(value):
    """``value`` if it is a number."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Unknown("programs.number_expected", "a number expected")
    if not math.isfinite(value):
        raise Unknown("programs.number_not_finite", "the number is not finite")
    return value
