"""Values of URScript: numbers, lists, poses, and static expressions over them.

URScript's expressions are a subset of Python's (p[..] reads as a subscript), so Python's own
parser takes them apart; nothing of them is ever executed.
"""

import ast
import functools
import math
import re

import numpy as np

from ....base.frames import to_quaternions
from ...program import Unknown

MAX_TEXT = 200_000  # characters: Python's parser holds everything up while it reads
MAX_BRACKETS = 50  # in each other: Python's parser may take ever longer for more
MAX_WHOLE = 2**53  # beyond, a whole number is no longer exact
# What Python reads as a number or two, but the controller does not.
FOREIGN_NUMBER = re.compile(
    r"(?<![\w.])\.?\d[\d.]*(?:[eE][-+]?\d+[A-Za-z_]|(?![eE][-+]?\d)[A-Za-z_])"
)
STRING = re.compile(r'"[^"]*"')
BRACKET = re.compile(r"[(\[]|[)\]]")
FUNCTIONS = {
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "atan2": math.atan2,
    "sqrt": math.sqrt,
    "pow": math.pow,
    "log": lambda base, value: math.log(value, base),
    "d2r": math.radians,
    "r2d": math.degrees,
    "floor": math.floor,
    "ceil": math.ceil,
    "abs": abs,
}
COMPARE = {
    ast.Lt: lambda a, b: a < b,
    ast.LtE: lambda a, b: a <= b,
    ast.Gt: lambda a, b: a > b,
    ast.GtE: lambda a, b: a >= b,
}


class Pose:
    """A pose: ``frame``, 4 x 4 in metres."""

    def __init__(self, frame):
        self.frame = frame

    def components(self):
        """[x, y, z, rx, ry, rz] in metres and radians (axis times angle)."""
        w, *axis = map(float, to_quaternions(self.frame[None, :3, :3])[0])
        sine = math.sqrt(sum(v * v for v in axis))
        factor = 2.0 * math.atan2(sine, w) / sine if sine > 1e-12 else 2.0
        return [*map(float, self.frame[:3, 3]), *(factor * v for v in axis)]

    def inverse(self):
        frame = np.eye(4)
        frame[:3, :3] = self.frame[:3, :3].T
        frame[:3, 3] = -frame[:3, :3] @ self.frame[:3, 3]
        return Pose(frame)

    def __str__(self):
        return "p[" + ", ".join(f"{v:g}" for v in self.components()) + "]"


class InReference(Pose):
    """A pose in ref_frame, of which only the controller knows where it is: only another pose in it goes
    with it.
    """

    def components(self):
        raise Unknown("programs.urscript.in_ref_frame", "where ref_frame is, is not known here")

    inverse = components


def pose_of(values):
    """Pose of six numbers in metres and radians."""
    if len(values) != 6:
        raise Unknown(
            "programs.urscript.components",
            "a pose has 6 components, not {count}",
            count=len(values),
        )
    x, y, z, rx, ry, rz = (float(number(v)) for v in values)
    angle = math.sqrt(rx * rx + ry * ry + rz * rz)
    if not math.isfinite(angle) or abs(x) + abs(y) + abs(z) > 1e6 or angle > 1e3:
        raise Unknown("programs.urscript.pose_out_of_bounds", "the pose is out of all bounds")
    frame = np.empty((4, 4))
    if angle > 1e-12:
        kx, ky, kz = rx / angle, ry / angle, rz / angle
    else:
        kx = ky = kz = 0.0
    c, s = math.cos(angle), math.sin(angle)
    d = 1.0 - c
    frame[:] = (
        (c + d * kx * kx, d * kx * ky - s * kz, d * kx * kz + s * ky, x),
        (d * kx * ky + s * kz, c + d * ky * ky, d * ky * kz - s * kx, y),
        (d * kx * kz - s * ky, d * ky * kz + s * kx, c + d * kz * kz, z),
        (0.0, 0.0, 0.0, 1.0),
    )
    return Pose(frame)


def number(value):
    """``value`` if it is a number."""
    if type(value) is float and math.isfinite(value):  # nearly all are
        return value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Unknown("programs.number_expected", "a number expected")
    if isinstance(value, int):
        if abs(value) > MAX_WHOLE:
            raise Unknown("programs.urscript.whole_number", "the whole number is too large")
    elif not math.isfinite(value):
        raise Unknown("programs.number_not_finite", "the number is not finite")
    return value


def a_pose(value):
    """``value`` if it is a pose."""
    if not isinstance(value, Pose):
        raise Unknown("programs.urscript.pose_expected", "a pose p[..] expected")
    return value


@functools.lru_cache(maxsize=4096)  # for loops
def parse(text):
    """Syntax tree of an expression. Raises Unknown."""
    if len(text) > MAX_TEXT:
        raise Unknown(
            "programs.urscript.long_statement",
            "the statement has more than {limit} characters",
            limit=MAX_TEXT,
        )
    if len(text) > MAX_TEXT:
        raise Unknown(
            "programs.urscript.long_statement",
            "the statement has more than {limit} characters",
            limit=MAX_TEXT,
        )
    bare = STRING.sub('""', text)
    if FOREIGN_NUMBER.search(bare) or "'" in bare or _depth(bare) > MAX_BRACKETS:
        raise Unknown("programs.cannot_be_parsed", "cannot read '{text}'", text=text.strip()[:40])
    try:
        return ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        raise Unknown(
            "programs.cannot_be_parsed", "cannot read '{text}'", text=text.strip()[:40]
        ) from None


def _depth(text):
    """How deeply brackets are nested."""
    depth = deepest = 0
    for bracket in BRACKET.findall(text):
        depth += 1 if bracket in "([" else -1
        deepest = max(deepest, depth)
    return deepest


def evaluate(node, lookup, call):
    """Value of a syntax tree; ``lookup(name)`` gives a variable's value and ``call(name, node)``
    that of a function not known here, or they raise Unknown."""
    try:
        return _value(node, lookup, call)
    except (ArithmeticError, ValueError, TypeError, IndexError) as error:
        raise Unknown(
            "programs.urscript.not_computable",
            "it cannot be computed ({reason})",
            reason=getattr(error, "fact", str(error)),
        ) from None
    except RecursionError:
        raise Unknown("programs.nested_expression", "the expression is nested too deeply") from None


def _value(node, lookup, call):
    kind = type(node)
    if kind is ast.Constant:
        value = node.value
        if isinstance(value, (bool, str)):
            return value
        return number(value)
    if kind is ast.Name:
        return lookup(node.id)
    if kind is ast.UnaryOp:
        return _unary(node, lookup, call)
    if kind is ast.Call:
        return _call(node, lookup, call)
    if kind is ast.Subscript:
        return _subscript(node, lookup, call)
    if kind is ast.List:
        return [_value(v, lookup, call) for v in node.elts]
    if kind is ast.BinOp:
        return _binary(node, lookup, call)
    if kind is ast.Compare and len(node.ops) == 1:
        left, right = (_value(v, lookup, call) for v in (node.left, node.comparators[0]))
        operator = type(node.ops[0])
        if operator in COMPARE:
            return COMPARE[operator](number(left), number(right))
        if operator in (ast.Eq, ast.NotEq):
            if not all(isinstance(v, (bool, int, float, str)) for v in (left, right)):
                raise Unknown("programs.urscript.not_compared", "lists and poses are not compared")
            return (left == right) == (operator is ast.Eq)
    if kind is ast.BoolOp:
        for operand in node.values:
            value = _truth(_value(operand, lookup, call))
            if value == isinstance(node.op, ast.Or):
                break
        return value
    raise Unknown("programs.urscript.expression", "the expression is not understood")


def _truth(value):
    if not isinstance(value, bool):
        raise Unknown("programs.truth_value_expected", "a truth value expected")
    return value


def _unary(node, lookup, call):
    if isinstance(node.op, ast.Not):
        return not _truth(_value(node.operand, lookup, call))
    if isinstance(node.operand, ast.UnaryOp) or not isinstance(node.op, (ast.USub, ast.UAdd)):
        raise Unknown("programs.two_signs", "two signs in a row")
    value = number(_value(node.operand, lookup, call))
    return -value if isinstance(node.op, ast.USub) else value


def _binary(node, lookup, call):
    left, right = (number(_value(v, lookup, call)) for v in (node.left, node.right))
    kind = type(node.op)
    if kind is ast.Add:
        return number(left + right)
    if kind is ast.Sub:
        return number(left - right)
    if kind is ast.Mult:
        return number(left * right)
    if kind is ast.Mod and left >= 0 and right > 0:
        return number(left % right)
    if kind is ast.Div:
        if isinstance(left, int) and isinstance(right, int):
            if left % right:  # rounded or not: versions of the controller differ
                raise Unknown(
                    "programs.urscript.remainder",
                    "a quotient of two whole numbers leaves a remainder",
                )
            return left // right
        return number(left / right)
    raise Unknown("programs.urscript.operator", "the operator is not understood")


def _subscript(node, lookup, call):
    if isinstance(node.value, ast.Name) and node.value.id == "p":
        inner = node.slice
        values = inner.elts if isinstance(inner, ast.Tuple) else [inner]
        return pose_of([_component(v, lookup, call) for v in values])
    value = _value(node.value, lookup, call)
    if isinstance(value, Pose):
        value = value.components()
    at = _value(node.slice, lookup, call)
    if not isinstance(value, list):
        raise Unknown("programs.urscript.no_index", "only lists and poses have an index")
    if isinstance(at, bool) or not isinstance(at, int) or not 0 <= at < len(value):
        raise Unknown(
            "programs.urscript.no_list_element",
            "the list of {count} has no element [{at}]",
            count=len(value),
            at=at,
        )
    return value[at]


def _component(node, lookup, call):
    """The value of a pose's component: a number with or without a sign, or any expression."""
    sign, inner = 1.0, node
    if type(node) is ast.UnaryOp and type(node.op) is ast.USub:
        sign, inner = -1.0, node.operand
    if type(inner) is ast.Constant and type(inner.value) is float:
        return sign * inner.value
    return _value(node, lookup, call)


def _call(node, lookup, call):
    if not isinstance(node.func, ast.Name):
        raise Unknown("programs.urscript.call", "the call is not understood")
    name = node.func.id
    if name in ("pose_trans", "pose_add", "pose_inv") and not node.keywords:
        poses = [a_pose(_value(v, lookup, call)) for v in node.args]
        if len(poses) != (1 if name == "pose_inv" else 2):
            raise Unknown(
                "programs.urscript.argument_count",
                "{name}() has {count} arguments",
                name=name,
                count=len(poses),
            )
        if name == "pose_inv":
            return poses[0].inverse()
        frame = poses[0].frame @ poses[1].frame
        inside = isinstance(poses[0], InReference)
        if isinstance(poses[1], InReference) or (inside and name == "pose_add"):
            poses[0 if inside else 1].components()
        if name == "pose_add":  # positions add up, rotations follow each other
            frame[:3, 3] = poses[0].frame[:3, 3] + poses[1].frame[:3, 3]
        if not np.abs(frame[:3, 3]).max() < 1e6:
            raise Unknown("programs.urscript.pose_out_of_bounds", "the pose is out of all bounds")
        return InReference(frame) if inside else Pose(frame)
    if name in FUNCTIONS and not node.keywords:
        return number(FUNCTIONS[name](*(number(_value(v, lookup, call)) for v in node.args)))
    if name in ("length", "get_list_length") and len(node.args) == 1 and not node.keywords:
        value = _value(node.args[0], lookup, call)
        if isinstance(value, list):
            return len(value)
    return call(name, node)
