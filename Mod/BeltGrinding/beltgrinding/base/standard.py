"""Standard input and output in a file's place: ``-``, as the command line alone takes it."""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

NAME = "-"


class _Streams:
    allowed = False  # when not, "-" is a file of that name
    read: bytes | None = None  # what came, for those who read it again
    output: int | None = None  # a descriptor of what was standard output


@contextlib.contextmanager
def allowed() -> Iterator[None]:
    """Takes ``-`` for standard input and output meanwhile."""
    _Streams.allowed = True
    try:
        yield
    finally:
        _Streams.allowed, _Streams.read = False, None
        output, _Streams.output = _Streams.output, None
        if output is not None:
            try:
                sys.stdout.flush()
            finally:
                os.dup2(output, sys.stdout.fileno())
                os.close(output)


def named(path: Path | str) -> bool:
    """Whether a file's path means standard input or output."""
    return _Streams.allowed and str(path) == NAME


def read() -> bytes:
    """All of standard input. Raises OSError."""
    if _Streams.read is None:
        _Streams.read = sys.stdin.buffer.read() if sys.stdin else b""
    return _Streams.read


def keep_for_file() -> None:
    """Leaves standard output to the file that is written there: what else is printed goes to standard error."""
    sys.stdout.flush()
    _Streams.output = os.dup(sys.stdout.fileno())
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())


def write(data: bytes) -> None:
    """Writes a file to standard output. A reader that has gone, as ``head`` goes, is no error. Raises OSError."""
    left = memoryview(data)
    with contextlib.suppress(BrokenPipeError):
        while left:
            left = left[os.write(1 if _Streams.output is None else _Streams.output, left) :]
