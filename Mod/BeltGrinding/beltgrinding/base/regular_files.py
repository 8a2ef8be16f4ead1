"""Files that others wrote, opened only where they are files.

A FIFO or a device in a file's place would be read for ever, or never.
"""

from __future__ import annotations

import errno
import io
import os
import stat
from pathlib import Path
from typing import BinaryIO

from ..engine import InputError, core
from . import standard
from .files import cannot_be_read

MEGABYTE = 1 << 20
KINDS = (
    (stat.S_ISFIFO, "files.kind_fifo", "a FIFO"),
    (stat.S_ISSOCK, "files.kind_socket", "a socket"),
    (stat.S_ISCHR, "files.kind_device", "a device"),
    (stat.S_ISBLK, "files.kind_device", "a device"),
)


def shown(path: Path | str) -> str:
    """A path as text that can be written in UTF-8: bytes of its name that are none as \\udcff."""
    return str(path).encode("utf-8", "backslashreplace").decode("utf-8")


def open_regular(path: Path | str, limit: int) -> BinaryIO:
    """A regular file, opened to be read as bytes. Raises InputError where there is none, or where it
    is larger than ``limit`` bytes.
    """
    if standard.named(path):
        return _standard_input(limit)
    try:
        # Opening a FIFO would wait for someone who writes into it.
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | _BINARY)
    except OSError as error:
        raise cannot_be_read(shown(path), error) from None
    except ValueError:  # zero bytes, lone surrogates
        raise InputError(
            "files.no_name", "{file}: cannot be the name of a file", file=shown(path)
        ) from None
    file = None
    try:
        state = os.fstat(descriptor)
        if stat.S_ISDIR(state.st_mode):
            folder = IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
            raise cannot_be_read(shown(path), folder)
        if not stat.S_ISREG(state.st_mode):
            raise InputError(
                "files.not_regular",
                "{file}: is {kind}; give a file",
                file=shown(path),
                kind=_kind(state.st_mode),
            )
        if state.st_size > limit:
            raise _too_large(path, state.st_size, limit)
        file = os.fdopen(descriptor, "rb")
        return file
    finally:
        if file is None:
            os.close(descriptor)


def _standard_input(limit: int) -> BinaryIO:
    try:
        data = standard.read()
    except OSError as error:
        raise cannot_be_read(standard.NAME, error) from None
    if len(data) > limit:
        raise _too_large(standard.NAME, len(data), limit)
    return io.BytesIO(data)


def _too_large(path: Path | str, size: int, limit: int) -> InputError:
    return InputError(
        "files.too_large",
        "{file}: has {size} MB, and no more than {limit} MB are read; split it",
        file=shown(path),
        size=-(-size // MEGABYTE),
        limit=limit // MEGABYTE,
    )


_BINARY = getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)


def read_regular(path: Path | str, limit: int) -> bytes:
    """The bytes of a regular file. Raises InputError as ``open_regular``."""
    with open_regular(path, limit) as file:
        try:
            return file.read()  # as long as it was found to be
        except OSError as error:
            raise cannot_be_read(shown(path), error) from None


def _kind(mode: int) -> core.Fact:
    for is_kind, code, text in KINDS:
        if is_kind(mode):
            return core.Fact(code, text)
    return core.Fact("files.kind_other", "no regular file")
