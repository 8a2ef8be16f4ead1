"""What the core tells as facts, and its errors: compiled into ``beltgrinding_core``, so that it needs no
package, and Python's own errors are of the same class."""


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
    argument in it, in the syntax of str.format; ``arguments``, {name: int, float or str}.
    """

    def __new__(cls, code, text, /, **arguments):
        self = super().__new__(cls, _sentence(code, text, arguments))
        self.code, self.text, self.arguments = code, text, arguments
        return self

    def __getnewargs_ex__(self):
        return (self.code, self.text), self.arguments


class InputError(ValueError):
    """A mistake in what the user gave: a file, a face, a pose, a value. str() is the English sentence,
    which names the culprit and says what to do; scripts branch by ``code``.

        raise InputError("programs.no_pose", "{file}: there is no pose", file=path)

    ``code``: stable, "room.what"; "" where there is none. ``text``: the English form, with fields as
    for str.format; a float has a format specification, as "{mm:.4g}". ``arguments``: {name: int, float
    or str}; the names of ``CULPRIT`` stand for the culprit and for nothing else, face and pose counted
    from 1. ``context``: what the sentence begins with, such as "{file}: ", as [(code, text,
    arguments)], the outermost first; see ``within``.

    ``InputError(message)`` is an error without a code.
    """

    CULPRIT = ("key", "file", "line", "face", "pose")

    def __init__(self, code, text=None, /, **arguments):
        if text is None:
            code, text = "", str(code)
        self.code, self.text, self.arguments, self.context = code, text, arguments, []
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

    def within(self, code, text, /, **arguments):
        """The same error with a context before all that it says:

        raise error.within("programs.at_line", "{file}:{line}: ", file=path, line=3) from error
        """
        outer = type(self).__new__(type(self))
        outer.__dict__.update(self.__dict__)
        outer.context = [(code, text, arguments), *self.context]
        outer.args = (_sentence(code, text, arguments) + str(self),)
        return outer
