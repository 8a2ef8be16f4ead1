"""What the core tells as facts, and its errors: compiled into ``beltgrinding_core``, so that it needs no
package, and Python's own errors are of the same class."""

import numbers


def _plain(arguments):
    """Arguments as JSON has them: {name: int, float or str}, such as a path's text or an error's fact."""

    def plain(value):
        if isinstance(value, (str, int, float)):
            return value
        if isinstance(value, numbers.Integral):  # numpy's
            return int(value)
        if isinstance(value, InputError):
            return value.fact
        return float(value) if isinstance(value, numbers.Real) else str(value)

    return {name: plain(value) for name, value in arguments.items()}


def _sentence(code, text, arguments):
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

    context = remarks = ()

    def __new__(cls, code, text, /, **arguments):
        arguments = _plain(arguments)
        self = super().__new__(cls, _sentence(code, text, arguments))
        self.code, self.text, self.arguments = code, text, arguments
        return self

    def __reduce__(self):
        return self._again, (str(self), self.__dict__)

    @classmethod
    def _again(cls, sentence, attributes):
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

    CULPRIT = ("key", "file", "line", "face", "pose")

    def __init__(self, code, text=None, /, **arguments):
        if text is None:
            code, text = "", str(code)
        arguments = _plain(arguments)
        self.code, self.text, self.arguments, self.context = code, text, arguments, []
        self.remarks = []
        super().__init__(_sentence(code, text, arguments))

    @property
    def culprit(self):
        """{name: value} of the arguments that name the culprit, the context's included."""
        told = [arguments for _, _, arguments in self.context] + [self.arguments]
        return {
            name: arguments[name]
            for arguments in told
            for name in self.CULPRIT
            if name in arguments
        }

    @property
    def fact(self):
        """What it tells, as a Fact."""
        return Fact._again(str(self), dict(self.__dict__))

    def within(self, code, text, /, **arguments):
        """The same error with a context before all that it says:

        raise error.within("programs.at_line", "{file}:{line}: ", file=path, line=3) from error
        """
        arguments = _plain(arguments)
        outer = self._copy(_sentence(code, text, arguments) + str(self))
        outer.context = [(code, text, arguments), *self.context]
        return outer

    def followed_by(self, code, text, /, **arguments):
        """The same error with a remark after all that it says:

        raise error.followed_by("simulation.notes", ". Note: {notes}", notes=notes) from error
        """
        arguments = _plain(arguments)
        more = self._copy(str(self) + _sentence(code, text, arguments))
        more.remarks = [*self.remarks, (code, text, arguments)]
        return more

    def _copy(self, sentence):
        other = type(self).__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.args = (sentence,)
        return other
