"""Files that are written whole or not at all; and errors of files and of the keys in them."""

from __future__ import annotations

import collections
import contextlib
import errno
import hashlib
import json
import os
import shutil
import signal
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from .. import engine
from . import standard

Data = bytes | Callable[[int], object]  # what `write_to` takes

PART = ".beltgrind-part-"  # what is not whole yet; not NAME and more, which may be too long a name
LEFT_OVER = 3600.0  # s; a part of that age is a killed writer's
CHUNK = 1 << 20  # bytes, read at a time
_written: collections.deque[Path] = collections.deque(maxlen=1)
_begun: set[Path] = set()  # files and folders that are not to outlast this process


def write_whole(path: Path, data: bytes) -> None:
    """Writes bytes to ``path``, whole or not at all, and onto the disk. Raises OSError."""
    if standard.named(path):
        standard.write(data)
        return
    path = Path(os.path.realpath(path))  # a link stays one
    if path.exists() and not path.is_file():
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        path.write_bytes(data)  # a pipe or a device, which nothing may take the place of
        return
    part = path.with_name(PART + uuid.uuid4().hex)
    with interruptible():
        _remove_parts(path.parent)
        begin(part)
        try:
            write_new(part, data)
            if path.exists():
                with contextlib.suppress(OSError):
                    os.chmod(part, path.stat().st_mode & 0o7777)
            with uninterrupted():
                os.replace(part, path)
                written(path)
        finally:
            part.unlink(missing_ok=True)
            end(part)


def _remove_parts(folder: Path) -> None:
    """What killed writers could not tidy up themselves."""
    with contextlib.suppress(OSError):
        for entry in os.scandir(folder):
            if entry.name.startswith(PART) and entry.is_file(follow_symlinks=False):
                with contextlib.suppress(OSError):
                    if time.time() - entry.stat(follow_symlinks=False).st_mtime > LEFT_OVER:
                        os.unlink(entry.path)


def write_new(path: Path, data: Data, onto_disk: bool = True) -> None:
    """Writes ``data`` (see ``write_to``) to a file that is not there yet; ``onto_disk``: so that they outlast a power
    failure. Raises OSError, and what ``data`` raises."""
    number = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    with open(number, "wb", buffering=0):  # a file system may fail as late as on closing
        write_to(number, data)
        if onto_disk:
            os.fsync(number)


def write_to(number: int, data: Data) -> None:
    """Writes bytes, or what ``data(number)`` writes, to an open, empty file by its descriptor. Raises OSError, and
    what ``data`` raises."""
    if callable(data):
        data(number)
        return
    left = memoryview(data)
    while left:
        left = left[os.write(number, left) :]


def sum_of(number: int) -> dict[str, int | str]:
    """{"bytes", "sha256"} of all of an open file, by its descriptor. Raises OSError."""
    found, size = hashlib.sha256(), 0
    while data := os.pread(number, CHUNK, size):
        found.update(data)
        size += len(data)
    return {"bytes": size, "sha256": found.hexdigest()}


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """Makes Ctrl-C a KeyboardInterrupt where it would end the process at once (``cli.interrupts``): there
    is something to be tidied up."""
    before = signal.getsignal(signal.SIGINT)
    if not getattr(before, "ends_process", False) or not _in_main_thread():
        yield
        return
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    except KeyboardInterrupt:
        with uninterrupted():
            tidy()
        raise
    finally:
        signal.signal(signal.SIGINT, before)


def begin(path: Path) -> None:
    """Notes, before it is made, what is to go whatever happens: an interruption may come between its making and
    the ``try`` that would remove it, or while it is removed."""
    _begun.add(path)


def end(path: Path) -> None:
    """It is gone, or has its place."""
    _begun.discard(path)


def tidy() -> None:
    """Removes what was begun and has not ended."""
    for path in list(_begun):
        with contextlib.suppress(OSError):
            path.unlink() if not path.is_dir() else shutil.rmtree(path)
        end(path)


def remove_tree(path: Path) -> None:
    """Removes a folder as far as that goes. Ctrl-C waits: in the midst of ``shutil.rmtree`` (3.11) it has a
    descriptor closed twice, and the error of that takes its place."""
    with uninterrupted():
        shutil.rmtree(path, ignore_errors=True)


def _in_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Lets Ctrl-C wait until its end; in other threads than the main one it never comes."""
    if not _in_main_thread():
        yield
        return
    came = []
    before = signal.getsignal(signal.SIGINT)
    if not callable(before):  # ignored, or not Python's: nothing that would break in
        yield
        return
    signal.signal(signal.SIGINT, lambda *told: came.append(told))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            before(*came[0])


def written(path: Path) -> None:
    """Notes that something was written there: who is interrupted can say so."""
    _written.append(path)


def last_written() -> Path | None:
    """The path noted last, None where nothing was."""
    return _written[-1] if _written else None


def absolute(folder: Path | str, name: Path | str) -> str:
    """The path of a file that is named relative to ``folder``, without links. Raises InputError for a name
    that no file can have."""
    try:
        path = os.path.realpath(os.path.join(folder, name))
        os.fsencode(path)
    except (ValueError, UnicodeEncodeError):  # a NUL in it, half a character
        raise engine.InputError(
            "files.no_name", "{file}: cannot be the name of a file", file=ascii(str(name))[1:-1]
        ) from None
    return path


def json_bytes(data: Any) -> bytes:
    return (json.dumps(data, indent=2, allow_nan=False) + "\n").encode()


def cannot_be_read(
    path: Path | str, error: OSError | ValueError | RecursionError
) -> engine.InputError:
    """The InputError of an OSError while reading a file, or of what it holds."""
    reason = reason_of(error)
    return engine.InputError(
        "files.cannot_be_read", "{file}: cannot be read: {reason}", file=path, reason=reason
    )


def cannot_be_written(path: Path | str, error: OSError) -> engine.InputError:
    """The InputError of an OSError while writing a file or a folder."""
    reason = reason_of(error)
    return engine.InputError(
        "files.cannot_be_written", "{file}: cannot be written: {reason}", file=path, reason=reason
    )


def reason_of(error: Exception) -> str:
    """What the system says, as a fact where it is a usual one."""
    if isinstance(error, UnicodeDecodeError):
        return engine.core.Fact("files.no_utf8", "it is not UTF-8 text")
    usual = {
        errno.ENOENT: engine.core.Fact("files.missing", "No such file or directory"),
        errno.EACCES: engine.core.Fact("files.no_permission", "Permission denied"),
        errno.EROFS: engine.core.Fact("files.read_only", "Read-only file system"),
        errno.ENOSPC: engine.core.Fact("files.disk_full", "No space left on device"),
        errno.EISDIR: engine.core.Fact("files.folder", "Is a directory"),
        errno.ENOTDIR: engine.core.Fact("files.no_folder", "Not a directory"),
        errno.ELOOP: engine.core.Fact("files.links", "its links lead in a circle"),
        errno.ENAMETOOLONG: engine.core.Fact("files.long_name", "its name is too long"),
        errno.EDQUOT: engine.core.Fact("files.quota", "Disk quota exceeded"),
        errno.EEXIST: engine.core.Fact("files.exists", "File exists"),
    }
    known = usual.get(getattr(error, "errno", None) or 0)
    return known or getattr(error, "strerror", None) or str(error)


def in_file(error: engine.InputError, path: Path | str) -> engine.InputError:
    """The InputError with its file before it, unless it names one already."""
    if "file" in error.culprit:
        return error
    return error.within("files.in_file", "{file}: ", file=path)


def at_key(error: engine.InputError, key: str) -> engine.InputError:
    """The InputError with the key before it whose value it is about."""
    return error.within("files.at_key", "{key}: ", key=key)


def either(*keys: str) -> str:
    """What to choose from: 'a' or 'b', as a fact."""
    told = f"'{keys[0]}'"
    for key in keys[1:]:
        told = engine.core.Fact("files.either", "{one} or {other}", one=told, other=f"'{key}'")
    return told
