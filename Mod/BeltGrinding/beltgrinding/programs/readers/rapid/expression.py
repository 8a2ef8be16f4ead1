"""Values of ABB RAPID: literals, aggregates, data, and static expressions over them."""

import functools
import json
import math
import re

from ...program import Fact, Unknown
from .data import A_POS, AN_ORIENT, MAX_RECORD, bounded_size, cross, number, numbers, turn
from .functions import FUNCTIONS

TOKEN = re.compile(
    r"""\s*(?:(?P<number>(?:0[xX][0-9a-fA-F]+|0[bB][01]+|0[oO][0-7]+
            |(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)(?![\w.]))
        |(?P<string>"(?:[^"\n]|"")*")
        |(?P<name>[^\W\d]\w*)
        |(?P<op>:=|<=|>=|<>|[-+*/:(){}\[\],.=<>\\]))""",
    re.VERBOSE,
)
# Brackets with nothing but decimal numbers: nearly all of a long program.
LITERAL = re.compile(r"[-+.0-9eE,\s\[\]]*")
NUMBERS = re.compile(r"(?:\[\s{0,80}){1,6}[-+.0-9]")
MAX_FAILURES = 20
DECODER = json.JSONDecoder(parse_int=float)
BASES = {"x": 16, "b": 2, "o": 8}
COMPARISONS = ("=", "<>", "<", ">", "<=", ">=")
END = Fact("programs.end_of_statement", "the end of the statement")
MAX_DEPTH = 50


@functools.lru_cache(maxsize=4096)
def tokens(text):
    """Tuple of (kind, text or value) of a statement; kind 'value' is a bracket of numbers.

    Raises Unknown on anything that is no token.
    """
    return tuple(token for token, _ in _scan(text))


def text_after(text, count):
    """What follows the first ``count`` tokens of a statement that consists of tokens."""
    ends = [end for _, end in _scan(text)]
    return text[ends[count - 1] :].strip()


def _scan(text):
    at = failed = failures = 0
    text = text.rstrip()
    while at < len(text):
        match = TOKEN.match(text, at)
        if not match:
            raise Unknown(
                "programs.cannot_be_parsed", "cannot read '{text}'", text=text[at:].strip()[:30]
            )
        kind = match.lastgroup
        if kind == "op" and match.group(kind) == "[":
            # Brackets within one that is no literal are read one by one, and so are all after some
            # failures: each costs what is before it.
            begin = match.end() - 1
            if begin >= failed and failures < MAX_FAILURES and NUMBERS.match(text, begin):
                literal, end = _literal(text, begin)
                if literal is not None:
                    at = end
                    yield ("value", literal), at
                    continue
                failed, failures = end, failures + 1
        at = match.end()
        yield (kind, match.group(kind)), at


def _literal(text, at):
    """(value, its end), or (None, where it cannot be one)."""
    try:
        value, end = DECODER.raw_decode(text, at)
    except json.JSONDecodeError as error:
        return None, error.pos
    except (ValueError, RecursionError):
        return None, len(text)
    return (value if LITERAL.fullmatch(text, at, end) else None), end


def arguments(row):
    """The arguments of a statement's tokens: (positional, optional) as token tuples, the
    optional ones by lower-case name, () for a switch. Raises Unknown."""
    positional, optional = [], {}
    start, depth, name = 0, 0, None
    for at, (kind, text) in enumerate((*row, ("op", ","))):
        if kind != "op":
            continue
        if text in ("(", "[", "{"):
            depth += 1
        elif text in (")", "]", "}"):
            depth -= 1
        elif depth == 0 and text in (",", "\\") or at == len(row):
            piece = row[start:at]
            if name is None and piece:
                positional.append(piece)
            elif name is None and row and text == ",":
                raise Unknown("programs.argument_missing", "an argument is missing")
            elif name is not None:
                if not piece or piece[0][0] != "name":
                    raise Unknown(
                        "programs.rapid.no_optional_name",
                        "the name of an optional argument is missing",
                    )
                if len(piece) > 1 and piece[1][1] != ":=":
                    raise Unknown(
                        "programs.rapid.assignment_expected",
                        "':=' expected after \\{name}",
                        name=piece[0][1],
                    )
                if len(piece) == 2:
                    raise Unknown(
                        "programs.rapid.no_optional_value",
                        "the value of \\{name} is missing",
                        name=piece[0][1],
                    )
                optional[piece[0][1].lower()] = piece[2:]
            start, name = at + 1, (True if text == "\\" else None)
    if depth:
        raise Unknown("programs.brackets", "the brackets do not match")
    return positional, optional


class Reader:
    """Recursive descent over tokens; ``data`` gives variable(name) -> (value, type),
    component(type, name) -> (index, type) and position(options) -> robtarget, or raises Unknown."""

    def __init__(self, row, data):
        self.tokens = row
        self.at = 0
        self.depth = 0
        self.data = data

    def whole(self):
        """The value of an expression that must take all tokens."""
        if len(self.tokens) == 1 and self.tokens[0][0] == "value":
            return self.tokens[0][1]
        value = self.expression()
        if self.at < len(self.tokens):
            raise Unknown(
                "programs.not_understood_there",
                "'{found}' is not understood there",
                found=self.peek(),
            )
        return value

    def peek(self):
        return self.tokens[self.at][1] if self.at < len(self.tokens) else None

    def word(self):
        """The next token in lower case if it is a name."""
        if self.at < len(self.tokens) and self.tokens[self.at][0] == "name":
            return self.tokens[self.at][1].lower()
        return None

    def next(self):
        if self.at >= len(self.tokens):
            raise Unknown("programs.statement_ends_early", "the statement ends too early")
        self.at += 1
        return self.tokens[self.at - 1]

    def accept(self, text):
        if self.peek() == text and self.tokens[self.at][0] == "op":
            self.at += 1
            return True
        return False

    def expect(self, text):
        if not self.accept(text):
            raise Unknown(
                "programs.expected",
                "'{text}' expected, not '{found}'",
                text=text,
                found=self.peek() or END,
            )

    def expression(self):
        """OR and XOR of terms"""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise Unknown("programs.nested_expression", "the expression is nested too deeply")
        value = self.term()
        while self.word() in ("or", "xor"):
            operator = self.next()[1].lower()
            left, right = truth(value), truth(self.term())
            value = left or right if operator == "or" else left != right
        self.depth -= 1
        return value

    def term(self):
        """[NOT] AND of comparisons"""
        negated = self.word() == "not"
        self.at += negated
        value = self.comparison()
        while self.word() == "and":
            self.at += 1
            inverted = self.word() == "not"  # not in the manual's grammar, yet in programs
            self.at += inverted
            left, right = truth(value), truth(self.comparison()) != inverted
            value = left and right
        return not truth(value) if negated else value

    def comparison(self):
        left = self.sum()
        operator = self.peek()
        if operator not in COMPARISONS or self.tokens[self.at][0] != "op":
            return left
        self.at += 1
        right = self.sum()
        if operator in ("=", "<>"):
            if bounded_size(left, MAX_RECORD) > MAX_RECORD:
                raise Unknown("programs.rapid.arrays_not_compared", "arrays are not compared")
            return (left == right) == (operator == "=")
        left, right = number(left), number(right)
        if operator in ("<", ">"):
            return left < right if operator == "<" else left > right
        return left <= right if operator == "<=" else left >= right

    def sum(self):
        value = self.product()
        while self.peek() in ("+", "-"):
            sign = 1.0 if self.next()[1] == "+" else -1.0
            right = self.product()
            if isinstance(value, str) and isinstance(right, str) and sign > 0:
                value = value + right
                if len(value) > 10_000:
                    raise Unknown("programs.string_too_long", "the string is too long")
            elif isinstance(value, list):
                pairs = zip(numbers(value, 3, A_POS), numbers(right, 3, A_POS))
                value = [a + sign * b for a, b in pairs]
            else:
                value = number(value) + sign * number(right)
        return value

    def product(self):
        value = self.unary()
        while self.peek() in ("*", "/") or self.word() in ("div", "mod"):
            operator = self.next()[1].lower()
            right = self.unary()
            if operator == "*":
                value = times(value, right)
                continue
            divisor = number(right)
            if divisor == 0:
                raise Unknown("programs.division_by_zero", "division by zero")
            if operator == "/" and isinstance(value, list):
                value = [v / divisor for v in numbers(value, 3, A_POS)]
            elif operator == "/":
                value = number(value) / divisor
            else:
                whole = float(math.trunc(number(value) / divisor))
                value = whole if operator == "div" else number(value) - whole * divisor
        return value

    def unary(self):
        if self.accept("-"):
            value = self.once()
            return times(-1.0, value)
        return number(self.once()) if self.accept("+") else self.primary()

    def once(self):
        if self.peek() in ("-", "+"):
            raise Unknown("programs.two_signs", "two signs in a row")
        return self.primary()

    def primary(self):
        kind, text = self.next()
        if kind == "value":
            return text
        if kind == "number":
            return number_of(text)
        if kind == "string":
            return text[1:-1].replace('""', '"')
        if text == "(":
            value = self.expression()
            self.expect(")")
            return value
        if text == "[":
            return self.aggregate()
        if kind != "name":
            raise Unknown("programs.value_expected", "a value expected, not '{text}'", text=text)
        name = text.lower()
        if name in ("true", "false"):
            return name == "true"
        if self.peek() == "(":
            return self.call(name, text)
        return self.select(*self.data.variable(text), text)

    def select(self, value, kind, name):
        """An element or a component of data: name{i,j}.part"""
        while True:
            if self.accept("{"):
                for index in self.indices():
                    value = value[self.element(value, index, name)]
            elif self.accept("."):
                at, kind = self.data.component(kind, self.next()[1])
                if not isinstance(value, list) or at >= len(value):
                    raise Unknown(
                        "programs.rapid.no_component", "{name} has no such component", name=name
                    )
                value = value[at]
            else:
                return value

    @staticmethod
    def element(value, index, name):
        if not isinstance(value, list) or not 1 <= index <= len(value):
            raise Unknown(
                "programs.no_element", "{name} has no element {index}", name=name, index=index
            )
        return index - 1

    def indices(self):
        result = [int(number(self.expression()))]
        while self.accept(","):
            result.append(int(number(self.expression())))
        self.expect("}")
        return result

    def aggregate(self):
        result = []
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise Unknown("programs.rapid.nested_aggregate", "the aggregate is nested too deeply")
        while True:
            result.append(self.expression())
            if self.accept("]"):
                self.depth -= 1
                return result
            self.expect(",")

    def call(self, name, text):
        start = self.at = self.at + 1
        depth = 1
        while depth:
            kind, token = self.next()
            depth += (kind == "op") * ((token == "(") - (token == ")"))
        positional, optional = arguments(self.tokens[start : self.at - 1])
        if name == "crobt":
            return self.data.position(optional)
        own = self.data.function(name, positional, optional)
        if own is not None:
            return own
        if name not in FUNCTIONS:
            raise Unknown(
                "programs.function_of_controller",
                "the function {name} is known to the controller only",
                name=text,
            )
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise Unknown("programs.rapid.nested_calls", "the calls are nested too deeply")
        values = [self.inner(row) for row in positional]
        options = {key: self.inner(row) if row else None for key, row in optional.items()}
        self.depth -= 1
        try:
            return FUNCTIONS[name](*values, **options)
        except (
            TypeError,
            ValueError,
            OverflowError,
            ZeroDivisionError,
            IndexError,
            AttributeError,
        ):
            raise Unknown(
                "programs.rapid.not_computable",
                "{text} cannot be evaluated for these arguments",
                text=text,
            ) from None

    def inner(self, row):
        reader = Reader(row, self.data)
        reader.depth = self.depth
        return reader.whole()


def number_of(text):
    """The value of a number's literal. Raises Unknown if it is too large."""
    try:
        base = BASES.get(text[1:2].lower()) if text[0] == "0" else None
        return number(float(int(text[2:], base)) if base else float(text))
    except (OverflowError, Unknown):
        raise Unknown(
            "programs.number_too_large", "{text} is too large a number", text=text[:20]
        ) from None


def truth(value):
    if not isinstance(value, bool):
        raise Unknown("programs.truth_value_expected", "a truth value expected")
    return value


def times(a, b):
    """The operator *: numbers, a number and a pos, two pos (vector product), two orient."""
    if isinstance(a, list) and isinstance(b, list):
        if len(a) == len(b) == 4:
            return turn(numbers(a, 4, AN_ORIENT), numbers(b, 4, AN_ORIENT))
        return cross(numbers(a, 3, A_POS), numbers(b, 3, A_POS))
    if isinstance(a, list) or isinstance(b, list):
        vector, factor = (a, b) if isinstance(a, list) else (b, a)
        return [v * number(factor) for v in numbers(vector, 3, A_POS)]
    return number(a) * number(b)
