"""Files that are written whole or not at all; and errors of files and of the keys in them."""

import errno
import json
import os

from .. import engine


def write_whole(path, data):
    """Writes bytes to ``path``, whole or not at all."""
    part = path.with_name(path.name + ".part")
    try:
        part.write_bytes(data)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def json_bytes(data):
    return (json.dumps(data, indent=2, allow_nan=False) + "\n").encode()


def cannot_be_read(path, error):
    """The InputError of an OSError or UnicodeDecodeError while reading a file."""
    reason = reason_of(error)
    return engine.InputError(
        "files.cannot_be_read", "{file}: cannot be read: {reason}", file=path, reason=reason
    )


def cannot_be_written(path, error):
    """The InputError of an OSError while writing a file or a folder."""
    reason = reason_of(error)
    return engine.InputError(
        "files.cannot_be_written", "{file}: cannot be written: {reason}", file=path, reason=reason
    )


def reason_of(error):
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
        errno.EEXIST: engine.core.Fact("files.exists", "File exists"),
    }
    known = usual.get(getattr(error, "errno", None))
    return known or getattr(error, "strerror", None) or str(error)


def in_file(error, path):
    """The InputError with its file before it, unless it names one already."""
    if "file" in error.culprit:
        return error
    return error.within("files.in_file", "{file}: ", file=path)


def at_key(error, key):
    """The InputError with the key before it whose value it is about."""
    return error.within("files.at_key", "{key}: ", key=key)


def either(*keys):
    """What to choose from: 'a' or 'b', as a fact."""
    told = f"'{keys[0]}'"
    for key in keys[1:]:
        told = engine.core.Fact("files.either", "{one} or {other}", one=told, other=f"'{key}'")
    return told
