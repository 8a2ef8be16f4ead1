"""Expressions of Kawasaki AS: numbers, strings, poses (4 x 4 in mm) and joint positions.

The angles O, A, T of a pose are Rz(O) Ry(A) Rz(T), each about the axes that the one before has turned
(doc.rc-visard.com, "Kawasaki XYZ-OAT format"). Poses are chained by +; - chains the inverse.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from ..core import expression as core
from ..core import poses
from ..core.expression import Constant, Token, number
from ..core.poses import Joints

FUNCTIONS: dict[str, Callable[..., Any]] = {
    **poses.FUNCTIONS,
    "trans": poses.zyz,
    "rx": functools.partial(poses.turned, 0),
    "ry": functools.partial(poses.turned, 1),
    "rz": functools.partial(poses.turned, 2),
    "shift": poses.shifted,
    "frame": poses.three_points,
    "#ppoint": lambda *values: Joints(map(number, values)),
    "maxval": lambda *values: max(map(number, values)),
    "minval": lambda *values: min(map(number, values)),
}
CONSTANTS = {
    **dict.fromkeys(("true", "on"), True),
    **dict.fromkeys(("false", "off"), False),
    "pi": math.pi,
    "null": np.eye(4),
}


class Parser(core.Parser):
    TOKEN = re.compile(
        r"""\s*(?:(?P<number>(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?(?![\w.]))
            |(?P<string>"[^"]*")
            |(?P<name>[.$\#&]{0,3}[^\W\d][\w.]*)
            |(?P<op>\#\[|==|<>|<=|>=|=<|=>|[-+*/^<>=()\[\],]))""",
        re.VERBOSE,
    )
    INFIX = {**poses.INFIX, "=<": poses.INFIX["<="], "=>": poses.INFIX[">="]}
    PREFIX = poses.PREFIX
    OMITTED = Constant(0.0)
    fold = staticmethod(str.lower)

    @classmethod
    def scanned(cls, text: str) -> list[Token]:
        """Names in lower case without the sign & of a pose; BY stands for the comma."""
        found: list[Token] = []
        for kind, word, end in super().scanned(text):
            if kind == "name":
                word = word.lower().replace("&", "")
                kind, word = ("op", ",") if word == "by" else (kind, word)
            found.append((kind, word, end))
        return found

    def word(self, name: str) -> Any:
        if name in ("here", "dest"):
            return lambda env: env.asked_for(name == "here")
        return Constant(CONSTANTS[name]) if name in CONSTANTS else None

    def opened(self, text: str) -> Any:
        if text != "#[":
            return super().opened(text)
        parts = self.series("]")
        return lambda env: Joints(number(part(env)) for part in parts)
