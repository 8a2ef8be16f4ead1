"""What the core tells as facts, and its errors: compiled into ``beltgrinding_core``, so that it needs no
package, and Python's own errors are of the same class."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from typing import Any, Union

Value = Union[int, float, str]
Context = tuple[str, str, dict[str, Value]]  # code, text, arguments


def _plain(arguments: Mapping[str, object]) -> dict[str, Value]:
    """Arguments as JSON has them: {name: int, float or str}, such as a path's text or an error's fact."""

    def plain(value: object) -> Value:
        if isinstance(value, (str, int, float)):
            return value
        if isinstance(value, numbers.Integral):  # numpy's
            return int(value)
        if isinstance(value, InputError):
            return value.fact
        return float(value) if isinstance(value, numbers.Real) else str(value)

    return {name: plain(value) for name, value in arguments.items()}


def _sentence(code: str, text: str, arguments: Mapping[str, Value]) -> str:
    if not code:
        return text
    try:
        return text.format(**arguments)
    except (LookupError, ValueError, TypeError):
        return text  # a form that does not fit its arguments must not hide what it is to tell


class Fact(str):
    """Something that is told: the English sentence, and what it was made of.

    Attributes: ``code``, stable, "room.what"; ``text``, the English form with a field for each
    argument in it, in the syntax of str.format; ``arguments``, {name: int, float or str}, of which a
    str may be a fact itself; ``context`` and ``remarks``: as an InputError's.
    """

    code: str
    text: str
    arguments: dict[str, Value]
    context: tuple[Context, ...] | list[Context] = ()
    remarks: tuple[Context, ...] | list[Context] = ()

    def __new__(cls, code: str, text: str, /, **given: object) -> Fact:
        arguments = _plain(given)
        self = super().__new__(cls, _sentence(code, text, arguments))
        self.code, self.text, self.arguments = code, text, arguments
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return self._again, (str(self), self.__dict__)

    @classmethod
    def _again(cls, sentence: str, attributes: Mapping[str, Any]) -> Fact:
        self = str.__new__(cls, sentence)
        self.__dict__.update(attributes)
        return self


class InputError(ValueError):
    """A mistake in what the user gave: a file, a face, a pose, a value. str() is the English sentence,
    which names the culprit and says what to do; scripts branch by ``code``.

        raise InputError("programs.no_pose", "{file}: there is no pose", file=path)

    ``code``: stable, "room.what"; "" where there is none. ``text``: the English form, with fields as
    for str.format; a float has a format specification, as "{mm:.4g}". ``arguments``: {name: int, float
    or str}; the names of ``CULPRIT`` stand for the culprit and for nothing else, face and pose counted
    from 1; another value, such as a path, is kept as its text. ``context``: what the sentence begins
    with, such as "{file}: ", as [(code, text, arguments)], the outermost first; see ``within``.
    ``remarks``: what follows it, likewise; see ``followed_by``.

    ``InputError(message)`` is an error without a code.
    """

    code: str
    text: str
    arguments: dict[str, Value]
    context: list[Context]
    remarks: list[Context]

    CULPRIT = ("key", "file", "line", "face", "pose")

    def __init__(self, code: object, text: str | None = None, /, **given: object) -> None:
        self.code, self.text = ("", str(code)) if text is None else (str(code), text)
        self.arguments, self.context, self.remarks = _plain(given), [], []
        super().__init__(_sentence(self.code, self.text, self.arguments))

    @property
    def culprit(self) -> dict[str, Value]:
        """{name: value} of the arguments that name the culprit, the context's included."""
        told = [arguments for _, _, arguments in self.context] + [self.arguments]
        return {
            name: arguments[name]
            for arguments in told
            for name in self.CULPRIT
            if name in arguments
        }

    @property
    def fact(self) -> Fact:
        """What it tells, as a Fact."""
        return Fact._again(str(self), dict(self.__dict__))

    def within(self, code: str, text: str, /, **given: object) -> InputError:
        """The same error with a context before all that it says:

        raise error.within("programs.at_line", "{file}:{line}: ", file=path, line=3) from error
        """
        arguments = _plain(given)
        outer = self._copy(_sentence(code, text, arguments) + str(self))
        outer.context = [(code, text, arguments), *self.context]
        return outer

    def followed_by(self, code: str, text: str, /, **given: object) -> InputError:
        """The same error with a remark after all that it says:

        raise error.followed_by("simulation.notes", ". Note: {notes}", notes=notes) from error
        """
        arguments = _plain(given)
        more = self._copy(str(self) + _sentence(code, text, arguments))
        more.remarks = [*self.remarks, (code, text, arguments)]
        return more

    def _copy(self, sentence: str) -> InputError:
        other = type(self).__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.args = (sentence,)
        return other
